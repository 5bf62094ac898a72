"""Who owns what on the graphics card: a renderer's context, or what it made in another's, until it gives it back."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from agentface.errors import GraphicsError
from agentface.view.gl.context import open_context
from agentface.view.gl.current import Current, current_context, kept_current, make_current

_MAKERS = frozenset(
    ("buffer", "depth_renderbuffer", "depth_texture", "framebuffer", "program", "renderbuffer", "texture", "texture3d")
) | {"vertex_array"}
_MANY = 512
_process: int | None = None  # the one that drew first; the driver's threads live in it alone


def check_process() -> None:
    """Raise GraphicsError in a child that was forked after its parent had begun to draw: it would wait for ever."""
    global _process  # noqa: PLW0603 - of the process, as is the driver
    _process = _process or os.getpid()
    if _process != os.getpid():
        raise GraphicsError(
            "a picture: expected a process that may draw, got a child forked from one that had drawn already;"
            ' start it otherwise (multiprocessing.get_context("spawn")), or draw only in the children'
        )


class Ownership:
    """The context of one renderer: its own, which goes with all that is in it, or a given one, which stays.

    Attributes:
        context: the ``moderngl.Context``.
        maker: makes buffers, textures, programs and the rest in it, all of which :meth:`release` gives back.
    """

    def __init__(self, given: Any = None) -> None:
        check_process()
        self._owned = given is None
        self.closed = False
        with kept_current():
            self.context = open_context() if given is None else given
            self.context.__enter__()  # its __exit__ would leave no context current, not the one before
            self._handle = current_context()
        self.maker = self.context if self._owned else TrackedContext(self.context)

    @contextmanager
    def current(self) -> Iterator[None]:
        """In the block OpenGL draws in the context, afterwards in whichever it drew before.

        Raises GraphicsError when the context was given back, is used by another thread, or belongs to a parent process.
        """
        if self.closed:
            raise GraphicsError("a picture: expected a renderer that is open, got one that was closed; make another")
        check_process()
        before = current_context()
        if _same(before, self._handle):
            yield
            return
        try:
            self._enter(before)
            yield
        finally:
            make_current(before)

    def release(self) -> None:
        """Give back to the driver what was taken from it; does nothing the second time, and in a forked child."""
        if self.closed:
            return
        self.closed = True
        if _process != os.getpid():
            return
        if self._owned:
            self.context.release()
        else:
            with kept_current():
                self.context.__enter__()
                self.maker.release()

    def abandon(self) -> None:
        """As :meth:`release` where nobody is left to call it, in whatever thread.

        What was made in a context that is not ours waits in its ``objects`` for its owner's ``context.gc()``.
        """
        if self._owned:
            self.release()
        elif not self.closed:
            self.closed = True
            self.context.objects.extend(item.mglo for item in self.maker.made() if not _given_back(item))

    def _enter(self, before: Current | None) -> None:
        if before is not None and self._handle is not None and before.api != self._handle.api:
            make_current(None)
        self.context.__enter__()
        if not _same(current_context(), self._handle):
            raise GraphicsError(
                "a picture: expected to get the renderer's OpenGL context, got none: another thread draws in it;"
                " let one thread draw at a time"
            )


def _same(one: Current | None, other: Current | None) -> bool:
    return one is not None and other is not None and one[:2] == other[:2]


def _given_back(item: Any) -> bool:
    import moderngl

    return isinstance(item.mglo, moderngl.InvalidObject)


class TrackedContext:
    """A context that remembers what is made through it."""

    def __init__(self, context: Any) -> None:
        object.__setattr__(self, "_context", context)
        object.__setattr__(self, "_made", [])
        object.__setattr__(self, "_limit", _MANY)

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._context, name)
        if name not in _MAKERS:
            return value

        def make(*arguments: Any, **options: Any) -> Any:
            made = value(*arguments, **options)
            if len(self._made) >= self._limit:
                self._made[:] = [item for item in self._made if not _given_back(item)]
                object.__setattr__(self, "_limit", max(_MANY, 2 * len(self._made)))
            self._made.append(made)
            return made

        return make

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self._context, name, value)

    def made(self) -> list[Any]:
        """What was made, and is now forgotten."""
        made = list(self._made)
        self._made.clear()
        return made

    def release(self) -> None:
        """Give all of it back; the context must be the current one."""
        for item in reversed(self.made()):
            item.release()
