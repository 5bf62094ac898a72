"""How many vertices a kernel takes at once."""

LANES = 16
"""Vertices a block: a register of AVX-512; where registers are narrower, LLVM takes as many as it needs."""
