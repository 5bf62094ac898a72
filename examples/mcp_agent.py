"""What a language model's program does with ``agentface mcp``: start it, ask for its tools, and use them.

``python examples/mcp_agent.py --picture happy.png`` opens a window; ``--view none`` opens none. Needs the extra mcp.
"""

from __future__ import annotations

import argparse
import asyncio
import base64
import os
import sys
from pathlib import Path

from mcp.client.client import Client
from mcp.client.stdio import StdioServerParameters, stdio_client

DISPLAY = ("DISPLAY", "WAYLAND_DISPLAY", "XAUTHORITY", "XDG_RUNTIME_DIR")
"""What a window needs of the environment, of which MCP's clients hand on next to nothing by themselves."""


async def converse(view: str, picture: Path | None) -> None:
    """Show joy, nod, and be told what is wrong with a wrong name."""
    display = {name: os.environ[name] for name in DISPLAY if name in os.environ}
    command = ["-m", "agentface", "mcp", "--view", view]
    server = StdioServerParameters(command=sys.executable, args=command, env=display)
    async with Client(stdio_client(server)) as face:
        print("tools:", ", ".join(tool.name for tool in (await face.list_tools()).tools))
        await face.call_tool("set_mood", {"emotions": {"happiness": 0.2}})
        shown = await face.call_tool("set_emotion", {"emotion": "joy", "intensity": 0.8, "hold_s": 3})
        print("emotion:", shown.structured_content["emotion"])
        await face.call_tool("gesture", {"name": "nod"})
        wrong = await face.call_tool("gesture", {"name": "wave"})
        print("refused:", wrong.content[0].text)
        await asyncio.sleep(1.0)
        if picture is not None:
            seen = await face.call_tool("picture", {})
            picture.write_bytes(base64.b64decode(seen.content[0].data))
            print(f"{picture}: what the model sees")


def main() -> None:
    """Run the example."""
    parser = argparse.ArgumentParser(description="Move a face by the Model Context Protocol.")
    parser.add_argument("--view", choices=["window", "none"], default="window")
    parser.add_argument("--picture", type=Path, metavar="FILE.png")
    options = parser.parse_args()
    asyncio.run(converse(options.view, options.picture))


if __name__ == "__main__":
    main()
