"""BML: blocks of behaviors, and when each of them happens."""
