"""A face for aiavatarkit: the faces that its language model asks for are shown in a window.

Give ``controller`` to a client of the kit as its ``face_controller``, and run that in ``talk``; here the kit's faces
are shown one after the other. Needs the extras aiavatar and window.
"""

from __future__ import annotations

import asyncio
import threading

from agentface import Face
from agentface.agents.aiavatar import AIAvatarFaceController
from agentface.window.window import Window


async def talk(controller: AIAvatarFaceController) -> None:
    """Show every face for two seconds."""
    while True:
        for name in ("joy", "angry", "sorrow", "fun", "surprised", "neutral"):
            await controller.set_face(name, 2.0)
            await asyncio.sleep(3.0)


def main() -> None:
    """Run the example until the window is closed."""
    face = Face(liveliness=0.6)
    controller = AIAvatarFaceController(face)
    threading.Thread(target=lambda: asyncio.run(talk(controller)), daemon=True).start()
    Window(face).run()


if __name__ == "__main__":
    main()
