"""A window that is dragged to another size gives back what the old one took."""

from __future__ import annotations

import pytest

pytestmark = [pytest.mark.gl, pytest.mark.slow, pytest.mark.untraced]


@pytest.mark.parametrize("resizes", [40, pytest.param(200, marks=pytest.mark.soak)])
def test_many_sizes_leave_no_memory_behind(on_a_display, resizes):
    seen = on_a_display(f"""
        def mb(): return int(open("/proc/self/statm").read().split()[1]) * 4096 / 1e6

        def play():
            yield from frames(3)
            began, sizes = mb(), set()
            for number in range({resizes}):
                window.glfw.set_window_size(window.handle, 800 + 2 * number % 300, 600 + number % 200)
                yield from frames(1)
                sizes.add(window._targets.size)
            window.glfw.set_window_size(window.handle, 800, 600)
            yield from frames(3)
            seen["grown_mb"], seen["sizes"] = mb() - began, len(sizes)

        show(size=(800, 600))
    """)
    assert seen["sizes"] > 20
    assert seen["grown_mb"] < 30
