"""Errors as JSON tells them."""

from __future__ import annotations

from typing import Any

from agentface.errors import AgentFaceError, DataError, InvalidValueError, UnknownNameError

_LONGEST = 400


def error_json(error: AgentFaceError) -> dict[str, Any]:
    """``{"error": {where, expected, got, hint}}``."""
    if isinstance(error, UnknownNameError):
        told = (error.kind, f"the name of one {error.kind}", repr(error.got), error.hint)
    elif isinstance(error, InvalidValueError):
        told = (error.where, error.expected, repr(error.got), error.hint)
    elif isinstance(error, DataError) and error.faults:
        fault = error.faults[0]
        told = (fault.where or str(fault.line or ""), fault.expected, fault.got, fault.hint)
    else:
        told = ("", "", str(error), "")
    return {"error": dict(zip(("where", "expected", "got", "hint"), (text[:_LONGEST] for text in told), strict=True))}
