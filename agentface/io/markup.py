"""XML as elements that know their line, from bytes that may come from anywhere."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any
from xml.sax import SAXParseException
from xml.sax.handler import ContentHandler, feature_namespaces
from xml.sax.xmlreader import AttributesNSImpl, InputSource

from defusedxml.common import DefusedXmlException
from defusedxml.expatreader import DefusedExpatParser

from agentface.errors import DataError, Fault

_DEEPEST = 100
_MOST_ELEMENTS = 200_000
_MOST_TEXT = 100_000


@dataclass(slots=True)
class Element:
    """An element: its namespace and name, the line that it begins on, its attributes without a namespace.

    ``content`` is text and children in their order, of those elements of which it is kept.
    """

    namespace: str
    name: str
    line: int
    attributes: dict[str, str]
    children: list[Element] = field(default_factory=list)
    content: list[str | Element] = field(default_factory=list)


def read_xml(data: bytes, where: Path, texts: Container[str] = ()) -> Element:
    """The root of a document, comments left out, and text, but that of the elements named in ``texts``.

    A document type, and with it every entity, is refused, and so are more than 200 000 elements, and more than 100 000
    characters of text that is kept. Raises DataError with the one fault that ends the reading.
    """
    parser = DefusedExpatParser(forbid_dtd=True, forbid_entities=True, forbid_external=True)
    builder = _Builder(texts)
    parser.setFeature(feature_namespaces, True)
    parser.setContentHandler(builder)
    source = InputSource()
    source.setByteStream(BytesIO(data))
    try:
        parser.parse(source)
    except SAXParseException as error:
        raise _fault(where, error.getLineNumber(), "well-formed XML", error.getMessage()) from error
    except DefusedXmlException as error:
        got = "one; leave <!DOCTYPE ...> and <!ENTITY ...> out"
        raise _fault(where, parser.getLineNumber(), "no document type and no entities", got) from error
    except _TooMuchError as error:
        raise _fault(where, error.line, error.expected, "more") from error
    except (ValueError, LookupError) as error:  # an encoding that expat cannot use
        raise _fault(where, None, "XML in UTF-8", str(error)) from error
    assert builder.root is not None, "a well-formed document has a root"  # noqa: S101 - for the type checker
    return builder.root


def _fault(where: Path, line: int | None, expected: str, got: str) -> DataError:
    return DataError([Fault(where, line or None, "", expected, got)])


class _TooMuchError(Exception):
    def __init__(self, line: int, expected: str) -> None:
        self.line, self.expected = line, expected


class _Builder(ContentHandler):
    def __init__(self, texts: Container[str]) -> None:
        super().__init__()
        self.root: Element | None = None
        self._open: list[Element] = []
        self._count = self._characters = 0
        self._texts = texts
        self._locator: Any = None

    def setDocumentLocator(self, locator: Any) -> None:  # noqa: N802 - the name is SAX's
        self._locator = locator

    def startElementNS(self, name: tuple[str | None, str], qname: str | None, attrs: AttributesNSImpl) -> None:  # noqa: N802 - the name is SAX's
        line = int(self._locator.getLineNumber())
        if len(self._open) == _DEEPEST:
            raise _TooMuchError(line, f"elements nested at most {_DEEPEST} deep")
        self._count += 1
        if self._count > _MOST_ELEMENTS:
            raise _TooMuchError(line, f"at most {_MOST_ELEMENTS} elements")
        plain = {key: value for (namespace, key), value in attrs.items() if namespace is None}
        element = Element(name[0] or "", name[1], line, plain)
        if self._open:
            self._open[-1].children.append(element)
            if self._open[-1].name in self._texts:
                self._open[-1].content.append(element)
        else:
            self.root = element
        self._open.append(element)

    def endElementNS(self, name: tuple[str | None, str], qname: str | None) -> None:  # noqa: N802 - the name is SAX's
        self._open.pop()

    def characters(self, content: str) -> None:
        element = self._open[-1]
        if element.name not in self._texts:
            return
        self._characters += len(content)
        if self._characters > _MOST_TEXT:
            line = int(self._locator.getLineNumber())
            raise _TooMuchError(line, f"at most {_MOST_TEXT} characters of text")
        element.content.append(content)
