"""The last stages, compiled: :func:`.order.finish` with the compiled twins in the places of the numpy forms."""

from __future__ import annotations

from agentface.deform.eyes import eyeballs_compiled as eyeballs  # noqa: F401  # the twin's names
from agentface.deform.finish import chest_compiled as chest  # noqa: F401
from agentface.deform.finish import head_turn_compiled as head_turn  # noqa: F401
from agentface.deform.finish import neck_compiled as neck  # noqa: F401
from agentface.deform.finish import order
from agentface.deform.finish import smooth_normals_compiled as smooth_normals  # noqa: F401
from agentface.deform.finish import teeth_compiled as teeth  # noqa: F401
from agentface.deform.finish import wrinkle_normals_compiled as wrinkle_normals  # noqa: F401
from agentface.deform.finish import wrinkles_compiled as wrinkles  # noqa: F401
from agentface.deform.finish.order import FinishStage  # noqa: F401
from agentface.deform.tongue import tongue_compiled as tongue  # noqa: F401
from agentface.kernel import compiled_twin

finish = compiled_twin(order.finish, globals(), error_model="numpy")
