"""XML without its dangers: no document types, no entities, bounded depth and number of elements.

Who reads a part says what is to happen where an element begins, and, with its text, where one ends.
Elements that nobody asks for cost nearly nothing: a workbook has tens of thousands.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Generic, TypeVar
from xml.parsers import expat

from grader.read import limits
from grader.read.errors import OUR_TEMPLATE, RefusedError

Attributes = Mapping[str, str]
Start = Callable[[Attributes], None]
End = Callable[[str], None]
Handler = TypeVar("Handler")

_CHUNK = 1 << 16


def parse(content: bytes, starts: Mapping[str, Start], ends: Mapping[str, End] | None = None) -> None:
    """Run through a part.

    Parameters
    ----------
    content : bytes
    starts : mapping of str to function
        What to do with the attributes where an element begins, by its name without namespace.
    ends : mapping of str to function, optional
        What to do with the text of an element, where it ends: all since a tag began the last time.

    Raises
    ------
    RefusedError
        When it is no well-formed XML, declares a document type, or passes a limit.
    """
    if content.count(b"<") - content.count(b"</") > limits.XML_ELEMENTS:  # comments count too: nobody has millions
        raise _too_many()
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = _refuse_doctype
    pieces: list[str] = []
    parser.CharacterDataHandler = pieces.append
    parser.StartElementHandler, parser.EndElementHandler = _guarded(_ByName(starts), _ByName(ends or {}), pieces)
    try:
        for at in range(0, len(content), _CHUNK):
            parser.Parse(content[at : at + _CHUNK], False)  # noqa: FBT003 - expat's own signature
        parser.Parse(b"", True)  # noqa: FBT003
    except (expat.ExpatError, UnicodeError, ValueError, LookupError) as error:
        raise RefusedError("a damaged workbook") from error


def _refuse_doctype(*_: object) -> None:
    raise RefusedError("a workbook with a document type declaration", OUR_TEMPLATE)


def _too_many() -> RefusedError:
    return RefusedError("a workbook with far too many cells", OUR_TEMPLATE)


def _guarded(
    starts: Mapping[str, Start | None], ends: Mapping[str, End | None], pieces: list[str]
) -> tuple[Callable[[str, Attributes], None], Callable[[str], None]]:
    """Return what expat calls at every tag; closures, because that is twice for every element."""
    depth, deepest = 0, limits.XML_DEPTH

    def on_start(name: str, attributes: Attributes) -> None:
        nonlocal depth
        depth += 1
        if depth > deepest:
            raise _too_many()
        pieces.clear()
        handler = starts[name]
        if handler is not None:
            handler(attributes)

    def on_end(name: str) -> None:
        nonlocal depth
        depth -= 1
        handler = ends[name]
        if handler is not None:
            handler("".join(pieces))

    return on_start, on_end


class _ByName(dict[str, Handler | None], Generic[Handler]):
    """Handlers by name, also by names with a namespace before them; each name is looked at once."""

    def __init__(self, handlers: Mapping[str, Handler]) -> None:
        super().__init__(handlers)
        self._handlers = handlers

    def __missing__(self, name: str) -> Handler | None:
        handler = self._handlers.get(name.rpartition(":")[2])
        if len(self) < limits.XML_NAMES:
            self[name] = handler
        return handler


def plain(attributes: Attributes) -> dict[str, str]:
    """Return attributes without their namespaces."""
    return {name.rpartition(":")[2]: value for name, value in attributes.items()}
