"""What one worker of the compiled pipeline has before it, as a kernel takes it fast: :class:`Desk`.

numba takes a record of a hundred arrays apart at every call, which costs as much as a stage of the face; a desk it
takes as one pointer.
"""

# mypy: disable-error-code="misc, no-untyped-call, untyped-decorator"
# numba's extension points carry no types.
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from numba import types
from numba.experimental import structref


@structref.register
class DeskType(types.StructRef):
    """The type of a desk."""

    def preprocess_fields(self, fields: Any) -> Any:
        """The fields with types that do not depend on their values."""
        return tuple((name, types.unliteral(kind)) for name, kind in fields)


class Desk(structref.StructRefProxy):
    """A face's tables and the worker's scratch; kernels make it and read it."""

    tables: Any
    """:class:`~agentface.deform.tables.FaceTables`"""
    scratch: Any
    """:class:`~agentface.deform.order_compiled.Scratch`"""

    if TYPE_CHECKING:

        def __init__(self, tables: Any, scratch: Any) -> None: ...


structref.define_constructor(Desk, DeskType, ["tables", "scratch"])
structref.define_attributes(DeskType)
structref.define_boxing(DeskType, Desk)
