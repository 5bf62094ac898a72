"""Our controller where aiavatarkit's own class is demanded: make frameworks.

Of aiavatarkit only its module of faces is loaded: the package as a whole needs torch.
"""

from __future__ import annotations

import asyncio
import importlib.util
import sys
from importlib.metadata import distribution
from types import ModuleType

import pytest

from tests.voices import talking_face

pytestmark = pytest.mark.frameworks


@pytest.fixture
def kit(monkeypatch):
    """The real module ``aiavatar.face`` of the installed package."""
    path = distribution("aiavatar").locate_file("aiavatar/face/__init__.py")
    spec = importlib.util.spec_from_file_location("aiavatar.face", path)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "aiavatar", ModuleType("aiavatar"))
    monkeypatch.setitem(sys.modules, "aiavatar.face", module)
    spec.loader.exec_module(module)
    monkeypatch.delitem(sys.modules, "agentface.agents.aiavatar", raising=False)
    yield module
    sys.modules.pop("agentface.agents.aiavatar", None)


def test_it_is_one_of_the_kit_s_and_shows_its_faces(kit):
    from agentface.agents.aiavatar import AIAvatarFaceController

    with talking_face() as face:
        controller = AIAvatarFaceController(face)
        assert isinstance(controller, kit.FaceController)
        for name in kit.FaceControllerDummy().faces:
            asyncio.run(controller.set_face(name, 2.0))
            face.step(0.01)
            assert controller.current_face == name
        controller.reset()
        face.step(0.01)
        assert controller.current_face == "neutral"
