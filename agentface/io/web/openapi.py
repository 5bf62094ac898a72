"""The OpenAPI document of what can be asked over HTTP."""

from __future__ import annotations

from functools import cache
from typing import Any

from agentface.io.web.asked import ASKED, RequestKind

_STATUS = "What the face is doing now, as Face.status() in Python and /agentface/status over OSC."


@cache
def openapi() -> dict[str, Any]:
    """The document, of OpenAPI 3.1."""
    from importlib.metadata import version

    paths: dict[str, Any] = {"/status": {"get": _get("read_status", _STATUS, [_query("face", "the id of a face")])}}
    paths["/faces"] = {"get": _get("list_faces", "The faces that there are, and who looks at them.", [])}
    paths["/faces/{face}/head.glb"] = {
        "get": {
            "operationId": "read_head",
            "summary": "The head, with what a page needs to draw it.",
            "parameters": [_path("face"), _query("look", "the name of one of its looks")],
            "responses": {"200": {"description": "a binary glTF 2.0 file", "content": {"model/gltf-binary": {}}}},
        }
    }
    for name, asked in ASKED.items():
        paths[f"/{name}"] = {"post": _post(name, asked, [_query("face", "the id of a face; the first when left out")])}
        paths[f"/faces/{{face}}/{name}"] = {"post": _post(f"{name}_of", asked, [_path("face")])}
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "agentface",
            "version": version("agentface"),
            "description": "What can be asked of a face, as over OSC. A body is an object, or a list of the arguments "
            "that the OSC address of the same name takes.",
        },
        "paths": paths,
        "security": [{}, {"token": []}],
        "components": {
            "securitySchemes": {"token": {"type": "http", "scheme": "bearer"}},
            "schemas": {"Error": _ERROR},
        },
    }


_ERROR = {
    "type": "object",
    "properties": {
        "error": {
            "type": "object",
            "properties": {name: {"type": "string"} for name in ("where", "expected", "got", "hint")},
            "required": ["where", "expected", "got", "hint"],
        }
    },
    "required": ["error"],
}


def _get(name: str, summary: str, parameters: list[dict[str, Any]]) -> dict[str, Any]:
    answer = {"description": "as it is now", "content": {"application/json": {"schema": {"type": "object"}}}}
    return {"operationId": name, "summary": summary, "parameters": parameters, "responses": {"200": answer, **_REFUSED}}


def _post(name: str, asked: RequestKind, parameters: list[dict[str, Any]]) -> dict[str, Any]:
    schema = {
        "type": "object",
        "properties": dict(asked.fields),
        "required": list(asked.needed),
        "additionalProperties": False,
    }
    content = {"application/json": {"schema": {"oneOf": [schema, {"type": "array"}]}}}
    return {
        "operationId": name,
        "summary": asked.summary,
        "parameters": parameters,
        "requestBody": {"required": bool(asked.needed), "content": content},
        "responses": {"200": {"description": "the face does it"}, **_REFUSED},
    }


def _query(name: str, description: str) -> dict[str, Any]:
    return {"name": name, "in": "query", "description": description, "schema": {"type": "string"}}


def _path(name: str) -> dict[str, Any]:
    return {"name": name, "in": "path", "required": True, "schema": {"type": "string"}}


_REFUSED = {
    code: {"description": why, "content": {"application/json": {"schema": {"$ref": "#/components/schemas/Error"}}}}
    for code, why in (
        ("400", "what is asked cannot be meant"),
        ("401", "the token is missing"),
        ("403", "Host or Origin are not those of this server"),
        ("404", "there is no such thing"),
        ("413", "too much at once"),
        ("429", "too often"),
        ("503", "the face does not run, or has too much to do"),
    )
}
