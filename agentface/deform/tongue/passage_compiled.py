"""The way out of the mouth, compiled; the numpy twin is :mod:`agentface.deform.tongue.passage`, whose code this is."""

from __future__ import annotations

from agentface.deform.tongue import passage
from agentface.deform.tongue.passage import EDGE_CLEAR, LIP_CLEAR  # noqa: F401  # the twin's names
from agentface.kernel import compiled_twin

FAST = {"contract", "arcp"}
"""What the compiler may do to its numbers: products and sums in one, factors for constant divisors."""
_NAMES = {**vars(passage), "__name__": __name__}
inward = _NAMES["inward"] = compiled_twin(passage.inward, _NAMES, error_model="numpy", fastmath=FAST)
half_width = compiled_twin(passage.half_width, _NAMES, error_model="numpy", fastmath=FAST)
beyond_edge = compiled_twin(passage.beyond_edge, _NAMES, error_model="numpy", fastmath=FAST)
beyond_lip = compiled_twin(passage.beyond_lip, _NAMES, error_model="numpy", fastmath=FAST)
_NAMES["_along"] = compiled_twin(passage._along, _NAMES, error_model="numpy", fastmath=FAST)  # noqa: SLF001  # its twin
_NAMES["_gap"] = compiled_twin(passage._gap, _NAMES, error_model="numpy", fastmath=FAST)  # noqa: SLF001  # its twin
_NAMES["_fits"] = compiled_twin(passage._fits, _NAMES, error_model="numpy", fastmath=FAST)  # noqa: SLF001  # its twin
look_at_lips = compiled_twin(passage.look_at_lips, _NAMES, error_model="numpy", fastmath=FAST)
slot = compiled_twin(passage.slot, _NAMES, error_model="numpy", fastmath=FAST)
