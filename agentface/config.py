"""Strict YAML into pydantic models: no duplicate keys, no yes/no booleans, every fault with file and line.

A file is read once into a :class:`Document`, which remembers the line of every value. ``Document.parse``
validates it into a model; checks that need more than one value add their own faults, so that a
user sees all faults of a file at once.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from agentface.errors import DataError, Fault

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

_LARGEST_FILE = 4 * 1024 * 1024
_Where = tuple[str | int, ...]


class Table(BaseModel):
    """The base of all models of data files: unknown keys are faults, values are not coerced, objects are frozen."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False, defer_build=True)


Model = TypeVar("Model", bound=BaseModel)


class Document:
    """A YAML file and the line of each of its values."""

    def __init__(self, path: str | Path) -> None:
        path = Path(path)
        self.path = path
        self.data, self._lines, self._faults = _read(path)

    def line(self, where: _Where) -> int | None:
        """The line of a value, or of its nearest parent that is in the file."""
        for end in range(len(where), -1, -1):
            if where[:end] in self._lines:
                return self._lines[where[:end]]
        return None

    def fault(self, where: _Where, expected: str, got: str, hint: str = "") -> None:
        """Remember a fault, to be raised with all others by :meth:`check`."""
        dotted = ".".join(str(part) for part in where)
        self._faults.append(Fault(self.path, self.line(where), dotted, expected, got, hint))

    def check(self) -> None:
        """Raise DataError if any fault was remembered."""
        if self._faults:
            raise DataError(sorted(self._faults, key=lambda fault: fault.line or 0))

    def parse(self, model: type[Model]) -> Model:
        """The document as ``model``; raises DataError with every fault found."""
        parsed = self.collect(model)
        self.check()
        assert parsed is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
        return parsed

    def collect(self, model: type[Model]) -> Model | None:
        """The document as ``model``, or None with its faults remembered, for callers that look for more of them."""
        try:
            return model.model_validate(self.data)
        except ValidationError as error:
            for item in error.errors():
                self.fault(*_told(item, self.data))
            return None


def load(path: str | Path, model: type[Model]) -> Model:
    """The file at ``path`` as ``model``; raises DataError with every fault found."""
    return Document(path).parse(model)


def _told(item: ErrorDetails, data: Any) -> tuple[_Where, str, str]:
    """Where in ``data`` pydantic found an error, what it expected, and what it got."""
    kind = item["type"]
    where = _place(item["loc"], data, missing=kind == "missing")
    if kind.startswith("union_tag"):  # of the key that says which of several tables it is
        where, context = (*where, item["ctx"]["discriminator"].strip("'")), item["ctx"]
        if kind == "union_tag_invalid":
            return where, f"one of {context['expected_tags'].replace(chr(39), '')}", _shown(context["tag"])
        kind = "missing"
    if kind == "missing":
        return where, "this key", "nothing"
    return where, _expectation(item["msg"], kind), _shown(item["input"])


def _place(found: _Where, data: Any, *, missing: bool) -> _Where:
    """The keys and indices of ``found`` that lead into ``data``: pydantic puts the tags of models among them."""
    where: list[str | int] = []
    for part in found[:-1] if missing else found:
        leads = part in data if isinstance(data, dict) else isinstance(data, list) and isinstance(part, int)
        if leads:
            where.append(part)
            data = data[part]
    return (*where, found[-1]) if missing else tuple(where)


def _expectation(message: str, kind: str) -> str:
    if kind == "extra_forbidden":
        return "no such key"
    for prefix in ("Input should be a valid dictionary or instance of", "Input should be a valid dictionary"):
        if message.startswith(prefix):
            return "a table of keys and values"
    for prefix in ("Input should be ", "Value error, expected ", "Value error, ", "List should have "):
        message = message.removeprefix(prefix)
    return message.removesuffix(" after validation")


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """YAML with the booleans and numbers of YAML 1.2; the C parser where PyYAML has it."""


def _resolvers() -> dict[str, list[Any]]:
    # YAML 1.1 reads yes, no, on, off as booleans and 12:30 as a number: none of that here.
    kept: dict[str, list[Any]] = {}
    for first, pairs in yaml.SafeLoader.yaml_implicit_resolvers.items():
        kept[first] = [(tag, regexp) for tag, regexp in pairs if not tag.endswith((":bool", ":timestamp", ":float"))]
    return kept


_Loader.yaml_implicit_resolvers = _resolvers()

_Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(?:true|false)$"), list("tf"))
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(
        r"^[-+]?(?:(?:\.[0-9]+|[0-9]+\.[0-9]*)(?:[eE][-+]?[0-9]+)?|[0-9]+[eE][-+]?[0-9]+)$|^[-+]?\.inf$|^\.nan$"
    ),
    list("-+0123456789."),
)


def _read(path: Path) -> tuple[Any, dict[_Where, int], list[Fault]]:
    faults: list[Fault] = []
    lines: dict[_Where, int] = {}
    loader: _Loader | None = None
    try:
        if path.stat().st_size > _LARGEST_FILE:
            _stop(path, None, f"a file of at most {_LARGEST_FILE} bytes", f"{path.stat().st_size} bytes")
        loader = _Loader(path.read_text(encoding="utf-8"))
        node = loader.get_single_node()
        if node is None:
            _stop(path, 1, "a YAML mapping", "an empty file")
        data = _walk(loader, node, (), path, lines, faults, set())
    except OSError as error:
        _stop(path, None, "a readable file", error.strerror or type(error).__name__)
    except UnicodeDecodeError:
        _stop(path, None, "text in UTF-8", "bytes that are not")
    except RecursionError:
        _stop(path, None, "a YAML file", "values nested too deeply")
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        _stop(path, mark.line + 1 if mark else None, "valid YAML", error.problem or "something else")
    except (yaml.YAMLError, ValueError) as error:
        _stop(path, None, "valid YAML", str(error).splitlines()[0])
    finally:
        if loader is not None:
            loader.dispose()
    return data, lines, faults


def _stop(path: Path, line: int | None, expected: str, got: str) -> NoReturn:
    raise DataError([Fault(path, line, "", expected, got)])


def _walk(
    loader: _Loader,
    node: yaml.Node,
    where: _Where,
    path: Path,
    lines: dict[_Where, int],
    faults: list[Fault],
    seen: set[yaml.Node],
) -> Any:
    lines.setdefault(where, node.start_mark.line + 1)
    if isinstance(node, yaml.CollectionNode):
        if node in seen:  # an alias, with which a small file can blow up
            faults.append(
                Fault(path, node.start_mark.line + 1, ".".join(map(str, where)), "the value itself", "an alias")
            )
            return None
        seen.add(node)
    if isinstance(node, yaml.SequenceNode):
        return [_walk(loader, item, (*where, i), path, lines, faults, seen) for i, item in enumerate(node.value)]
    if not isinstance(node, yaml.MappingNode):
        return loader.construct_object(node)
    mapping: dict[Any, Any] = {}
    for key_node, value_node in node.value:
        key = loader.construct_object(key_node)
        inner = (*where, key)
        line = key_node.start_mark.line + 1
        if not isinstance(key, (str, int)):
            faults.append(Fault(path, line, ".".join(map(str, where)), "a word as key", repr(key)))
            continue
        if key in mapping:
            faults.append(Fault(path, line, ".".join(map(str, inner)), "each key once", "the key a second time"))
            continue
        lines[inner] = line
        mapping[key] = _walk(loader, value_node, inner, path, lines, faults, seen)
    return mapping
