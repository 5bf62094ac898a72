"""``agentface calibrate``, called in this process."""

from __future__ import annotations

from click.testing import CliRunner, Result

from agentface.cli import cli


def call(*arguments: object, code: int = 0) -> Result:
    """What the command printed; it must end with ``code``."""
    result = CliRunner().invoke(cli, ["calibrate", *map(str, arguments)], prog_name="agentface")
    assert result.exit_code == code, result.output
    assert not result.exception or isinstance(result.exception, SystemExit)
    return result
