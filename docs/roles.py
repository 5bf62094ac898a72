"""The reference's docstrings name things as Sphinx does, ``:class:`Face```; the site shows the name alone."""

from __future__ import annotations

import re
from typing import Any

import griffe

_ROLE = re.compile(r":(?:class|func|data|mod|attr|meth):(`+)[.~]?([^`]+)\1")


class PlainRoles(griffe.Extension):
    """Takes the roles out of every docstring before it is read."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Called for each module, class, function and attribute when its docstring is there."""
        if obj.docstring is not None:
            obj.docstring.value = _ROLE.sub(r"`\2`", obj.docstring.value)
