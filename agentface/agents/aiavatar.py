""":class:`AIAvatarFaceController`: a face for aiavatarkit (github.com/uezo/aiavatarkit)."""

from __future__ import annotations

from agentface.agents.face_controller import FaceController
from agentface.errors import MissingPackageError

try:
    from aiavatar.face import FaceController as _Demanded
except ImportError as error:
    raise MissingPackageError("aiavatar", "aiavatar", "its clients are what a face controller is for") from error


class AIAvatarFaceController(FaceController, _Demanded):  # type: ignore[misc]  # aiavatarkit has no types
    """Our ``FaceController`` where aiavatarkit's own class is demanded: ``client.face_controller = ...``."""
