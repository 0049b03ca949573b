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
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = _refuse_doctype
    parser.StartElementHandler, parser.EndElementHandler = _guarded(start, end)
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


def _guarded(start: Start, end: End | None) -> tuple[Start, End]:
    """Wrap both handlers with the limits; closures, because they run twice for every cell."""
    depth = count = 0
    names = _LocalNames()

    def on_start(name: str, attributes: Attributes) -> None:
        nonlocal depth, count
        depth += 1
        count += 1
        if depth > limits.XML_DEPTH or count > limits.XML_ELEMENTS:
            raise RefusedError("a workbook with far too many cells", OUR_TEMPLATE)
        start(names[name], attributes)

    def on_end(name: str) -> None:
        nonlocal depth
        depth -= 1
        if end is not None:
            end(names[name])

    return on_start, on_end


class _LocalNames(dict[str, str]):
    """Names without their namespace; each is worked out once."""

    def __missing__(self, name: str) -> str:
        local = name.rpartition(":")[2]
        if len(self) < limits.XML_NAMES:
            self[name] = local
        return local


def plain(attributes: Attributes) -> dict[str, str]:
    """Return attributes without their namespaces."""
    return {name.rpartition(":")[2]: value for name, value in attributes.items()}
