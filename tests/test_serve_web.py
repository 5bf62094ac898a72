"""``agentface serve --web``: what it says, serves and refuses."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import threading
import urllib.request

import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.commands.pages import PagesAsked, served_pages


def call(*arguments):
    return CliRunner().invoke(cli, ["serve", *map(str, arguments)], prog_name="agentface")


@pytest.mark.parametrize(
    ("options", "told"),
    [(["--token", "correct-horse"], "--token goes with --web"), (["--allow-origin", "https://a.b"], "goes with --web"),
     (["--web", "8080"], "expected HOST:PORT"), (["--web", "localhost:99999"], "expected HOST:PORT")],
)  # fmt: skip
def test_usage(options, told):
    result = call(*options)
    assert result.exit_code == 2, result.output
    assert told in " ".join(result.stderr.split())


@pytest.mark.parametrize(
    ("options", "told"),
    [(["--token", "short"], "token: expected 12 to 256 characters"),
     (["--allow-origin", "*"], "origin: expected a web")],
)  # fmt: skip
def test_what_would_be_unsafe_is_refused(options, told):
    result = call("--osc", "127.0.0.1:0", "--web", "127.0.0.1:0", *options)
    assert result.exit_code == 1, result.output
    assert told in " ".join(result.stderr.split())


def test_without_the_extra_one_error_names_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    result = call("--osc", "127.0.0.1:0", "--web", "127.0.0.1:0", "--duration", "1")
    assert result.exit_code == 1
    assert 'pip install "agentface[web]"' in result.stderr
    assert "Traceback" not in result.stderr


def test_who_may_ask_is_said(monkeypatch, capsys):
    from agentface.io.web import server

    made = {}

    class Server:
        def __init__(self, faces, host, port, **options):
            made.update(options, host=host)
            self.url = "http://0.0.0.0:8080/?token=t"
            self.access = server.Access.of(host, options["origins"], options["token"])

        def __enter__(self):
            return self

        def __exit__(self, *_):
            pass

    monkeypatch.setattr(server, "WebServer", Server)
    asked = PagesAsked(("0.0.0.0", 8080), None, ("https://faces.example",))  # noqa: S104
    with served_pages({}, asked, "geometric", "ginger", 30.0) as (only,):
        said = capsys.readouterr().out
    assert only.access.token in said
    assert "every machine" in said
    assert "https://faces.example" in said
    assert (made["look"], made["fps"], made["deformer"]) == ("ginger", 30.0, "geometric")


@pytest.mark.slow
def test_it_serves_until_it_is_told_to_end():
    program = (
        "import sys; from agentface.cli import cli; from agentface.io.web import basis; "
        "basis.SAMPLES = (40, 12); from agentface.io.web import stage; stage.SAMPLES = basis.SAMPLES; "
        "sys.argv[1:] = ['serve', '--osc', '127.0.0.1:0', '--web', '127.0.0.1:0']; cli()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    watchdog = threading.Timer(200, process.kill)
    watchdog.start()
    try:
        place = re.search(r"the page is (http://127.0.0.1:\d+)/", process.stdout.readline())
        assert "programs on this machine" in process.stdout.readline()
        assert "listens to OSC" in process.stdout.readline()
        with urllib.request.urlopen(f"{place[1]}/status", timeout=60) as answer:  # noqa: S310
            assert json.load(answer)["face"] == "amber"
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == 0, errors
        assert "Traceback" not in errors
    finally:
        watchdog.cancel()
        process.kill()
        process.wait()
