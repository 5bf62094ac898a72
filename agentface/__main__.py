"""``python -m agentface``: the command line."""

from __future__ import annotations

from agentface.cli import main

if __name__ == "__main__":
    main()
