"""How many vertices a kernel takes at once."""

PART = 8
"""Lanes of a register."""
PARTS = 2
"""Two registers, because the chain of operations of one alone leaves the processor idle."""
LANES = PART * PARTS
"""Vertices a block."""
