"""The command line: ``agentface --help``."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

import click

from agentface.commands.streams import output_told, tell, watch_output
from agentface.errors import AgentFaceError, DataError

COMMANDS = (
    "render",
    "sheet",
    "serve",
    "show",
    "mcp",
    "play",
    "say",
    "convert",
    "export",
    "explain",
    "check",
    "unwrap",
    "build",
    "bench",
    "calibrate",
    "figures",
)


class _Commands(click.Group):
    """Commands that are imported when they are asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = getattr(import_module(f"agentface.commands.{cmd_name}"), cmd_name)
        return command

    def make_context(self, *args: Any, **extra: Any) -> click.Context:
        with output_told():  # --help and --version are printed here
            return super().make_context(*args, **extra)

    def invoke(self, ctx: click.Context) -> object:
        try:
            with output_told():
                return super().invoke(ctx)
        except AgentFaceError as error:
            # Faults begin with file:line, which editors follow.
            tell(str(error) if isinstance(error, DataError) else f"agentface: {error}")
            ctx.exit(1)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 120})
@click.version_option(package_name="agentface")
def cli() -> None:
    """A facial animation engine for conversational agents: an emotion message comes in, a face shows it."""


def main() -> None:
    """Run the command line."""
    watch_output()
    sys.exit(cli(prog_name="agentface"))
