"""XML without its dangers: no document types, no entities, bounded depth and number of elements."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from xml.parsers import expat

from grader.read import limits
from grader.read.errors import OUR_TEMPLATE, RefusedError

Attributes = Mapping[str, str]
Start = Callable[[str, Attributes], None]
End = Callable[[str], None]
Text = Callable[[str], None]

_CHUNK = 1 << 16


def parse(content: bytes, start: Start, end: End | None = None, text: Text | None = None) -> None:
    """Run through a part; names come without their namespace.

    Raises
    ------
    RefusedError
        When it is no well-formed XML, declares a document type, or passes a limit.
    """
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = _refuse_doctype
    guard = _Guard(start, end)
    parser.StartElementHandler, parser.EndElementHandler = guard.start, guard.end
    if text is not None:
        parser.CharacterDataHandler = text
    try:
        for at in range(0, len(content), _CHUNK):
            parser.Parse(content[at : at + _CHUNK], False)  # noqa: FBT003 - expat's own signature
        parser.Parse(b"", True)  # noqa: FBT003
    except (expat.ExpatError, UnicodeError, ValueError, LookupError) as error:
        raise RefusedError("a damaged workbook") from error


def _refuse_doctype(*_: object) -> None:
    raise RefusedError("a workbook with a document type declaration", OUR_TEMPLATE)


class _Guard:
    def __init__(self, start: Start, end: End | None) -> None:
        self._start, self._end = start, end
        self._depth = self._count = 0

    def start(self, name: str, attributes: Attributes) -> None:
        self._depth += 1
        self._count += 1
        if self._depth > limits.XML_DEPTH or self._count > limits.XML_ELEMENTS:
            raise RefusedError("a workbook with far too many cells", OUR_TEMPLATE)
        self._start(_local(name), attributes)

    def end(self, name: str) -> None:
        self._depth -= 1
        if self._end is not None:
            self._end(_local(name))


def _local(name: str) -> str:
    return name.rpartition(" ")[2]


def plain(attributes: Attributes) -> dict[str, str]:
    """Return attributes without their namespaces."""
    return {_local(name): value for name, value in attributes.items()}
