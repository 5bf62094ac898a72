""":func:`face_server`: an MCP server whose tools move a face."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import wraps
from importlib.metadata import version
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from agentface.agents.mcp.actor import Actor
from agentface.agents.mcp.tools import FaceTools
from agentface.errors import AgentFaceError, MissingPackageError, UnknownNameError
from agentface.io.picture import encode
from agentface.motion.eyesight import Eyesight
from agentface.motion.gestures.table import all_gestures

if TYPE_CHECKING:
    from mcp.server.mcpserver import MCPServer

_PICTURE_SIZE = 512
_INSTRUCTIONS = """These tools move the face of {name}, an animated human head that a person sees.
Show what you feel with set_emotion, speak with say, look with set_gaze and look_at (0, 0 is at the person), nod and
shake with gesture, and set_state to listening or thinking while you do. Every tool answers with what the face is doing.
A face that shows one thing for long looks wrong: give hold_s, or go back with neutral."""


def face_server(actor: Actor) -> MCPServer[Any]:
    """A server with the tools of a face; raises MissingPackageError without the extra ``mcp``."""
    try:
        from mcp.server.mcpserver import Image, MCPServer
        from mcp.server.mcpserver.exceptions import ToolError
    except ImportError as error:
        raise MissingPackageError("mcp", "mcp", "it speaks to language models") from error

    instructions = _INSTRUCTIONS.format(name=actor.model.name)
    server: MCPServer[Any] = MCPServer(
        "agentface", title="A face", instructions=instructions, version=version("agentface"), log_level="WARNING"
    )
    tools = FaceTools(actor)

    async def picture(
        camera: Annotated[Literal["front", "three-quarter", "profile"], Field(description="from where")] = "front",
    ) -> Any:
        """See the face as it is shown now, as a PNG picture."""
        image = await tools.picture(camera, (_PICTURE_SIZE, _PICTURE_SIZE))
        return Image(data=encode(image, "face.png"), format="png")

    picture.__annotations__["return"] = Image  # the SDK reads it, and knows it here alone
    asked: list[Callable[..., Awaitable[Any]]] = [
        *(tools.set_emotion, tools.set_emotions, tools.set_mood, tools.neutral),
        *(tools.say, tools.hush, tools.gesture, tools.set_gaze, tools.look_at, tools.set_state),
        *(tools.status, picture),
    ]
    for function in asked:
        _add(server, _telling(function, ToolError))
    eye = ", ".join(f"{at:.2f}" for at in Eyesight.of(actor.model).eye)
    described = _properties(server, "look_at")
    described["x_m"]["description"] += f"; the eyes are at {eye}"
    _properties(server, "gesture")["name"]["enum"] = sorted(all_gestures())
    return server


def explained(error: AgentFaceError) -> str:
    """An error in words that a model can act on: with all the names that there are."""
    if isinstance(error, UnknownNameError) and not error.hint.startswith("known"):
        return f"{error} Known: {', '.join(error.known)}."
    return str(error)


def _telling(function: Callable[..., Awaitable[Any]], failure: type[Exception]) -> Callable[..., Awaitable[Any]]:
    """``function``, whose errors reach the model as they are."""

    @wraps(function)
    async def told(*arguments: Any, **named: Any) -> Any:
        try:
            return await function(*arguments, **named)
        except AgentFaceError as error:
            raise failure(explained(error)) from error

    return told


def _add(server: MCPServer[Any], function: Callable[..., Awaitable[Any]]) -> None:
    """Add a tool that refuses arguments that it does not have: a wrong name must not be passed over."""
    server.add_tool(function)
    tool = server._tool_manager.get_tool(function.__name__)  # noqa: SLF001 - the SDK has no other way to reach it
    assert tool is not None, "added above"  # noqa: S101 - for the type checker
    model = tool.fn_metadata.arg_model
    model.model_config["extra"] = "forbid"
    model.model_rebuild(force=True)
    tool.parameters = model.model_json_schema(by_alias=True)


def _properties(server: MCPServer[Any], name: str) -> dict[str, Any]:
    tool = server._tool_manager.get_tool(name)  # noqa: SLF001 - likewise
    assert tool is not None, "one of those above"  # noqa: S101 - for the type checker
    properties: dict[str, Any] = tool.parameters["properties"]
    return properties
