from __future__ import annotations

import pytest

from agentface.view.gl.quality import QUALITIES, suited_quality


@pytest.mark.parametrize(
    ("driver", "quality"),
    [
        ("llvmpipe (LLVM 15.0.6, 256 bits)", "fast"),
        ("SwiftShader Device (LLVM 10.0.0)", "fast"),
        ("Apple Software Renderer", "fast"),
        ("Mesa Intel(R) UHD Graphics 620 (KBL GT2)", "portrait"),
        ("NVIDIA H100/PCIe/SSE2", "portrait"),
        ("AMD Radeon RX 6600 (radeonsi, navi23, LLVM 15.0.6)", "portrait"),
    ],
)
def test_a_window_draws_portraits_where_there_is_a_gpu(driver, quality):
    assert suited_quality(driver) == quality
    assert quality in QUALITIES
