"""Without its framework an adapter is one error that names the extra, and nothing else knows the frameworks."""

from __future__ import annotations

import importlib
import sys

import pytest

from agentface.errors import AgentFaceError, MissingPackageError

ADAPTERS = {
    "pipecat": ("pipecat", "pipecat.frames.frames"),
    "livekit": ("livekit", "livekit.agents.types"),
    "aiavatar": ("aiavatar", "aiavatar.face"),
}


@pytest.mark.parametrize("name", ADAPTERS)
def test_a_missing_framework_is_one_error_with_its_extra(name, monkeypatch):
    for module in ADAPTERS[name]:
        monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.delitem(sys.modules, f"agentface.agents.{name}", raising=False)
    with pytest.raises(MissingPackageError, match=rf'pip install "agentface\[{name}\]"') as caught:
        importlib.import_module(f"agentface.agents.{name}")
    assert isinstance(caught.value, AgentFaceError)
    assert isinstance(caught.value, ImportError)


def test_the_package_knows_no_framework_until_it_is_asked():
    import subprocess

    program = "import sys, agentface.agents; from agentface.agents import Speaker; print(*sys.modules)"
    modules = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout.split()
    assert not {"pipecat", "livekit", "aiavatar", "mcp", "pocketsphinx", "moderngl", "av"} & set(modules)
