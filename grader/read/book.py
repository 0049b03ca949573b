"""A workbook as plain cells: the only thing that leaves the reader."""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from grader.kind import Kind
from grader.read import limits
from grader.read.container import Container, open_container
from grader.read.errors import OUR_TEMPLATE, SAVE_AS, UNPACKED, RefusedError, UnreadableError
from grader.read.flags import Flag
from grader.read.parts import Relation, read_directory, read_formats, read_relations, read_strings
from grader.read.sheet import BookCell, Place, SheetContent, read_sheet
from grader.read.sniff import require_zip

__all__ = ["Book", "BookCell", "ReadRequest", "Sheet", "read_workbook"]


@dataclass(frozen=True)
class ReadRequest:
    """A file to read: its name, for messages only, and its bytes. Small and picklable, so that a worker can do it."""

    name: str
    data: bytes


@dataclass(frozen=True)
class Sheet:
    """One sheet; cells by (row, column) from 1, merged ranges as four numbers."""

    name: str
    is_visible: bool
    cells: Mapping[Place, BookCell]
    merges: tuple[tuple[int, int, int, int], ...] = ()

    def at(self, place: Place) -> BookCell:
        """Return a cell, blank when there is none; inside a merged range, the one that shows its value."""
        cell = self.cells.get(place)
        if cell is not None:
            return cell
        row, column = place
        for top, left, bottom, right in self.merges:
            if top <= row <= bottom and left <= column <= right:
                return self.cells.get((top, left), BookCell(Kind.BLANK))
        return BookCell(Kind.BLANK)

    def __getstate__(self) -> dict[str, object]:
        """Travel between processes as columns of plain values, not as thousands of cells: a third of the work."""
        return {**self.__dict__, "cells": (tuple(_columns(self.cells)), tuple(_columns(self.cells.values())))}

    def __setstate__(self, state: dict[str, Any]) -> None:
        places, values = (_columns(columns) for columns in state["cells"])
        self.__dict__.update(state, cells=dict(zip(places, itertools.starmap(BookCell, values), strict=True)))


def _columns(rows: Iterable[tuple[object, ...]]) -> Iterator[tuple[Any, ...]]:
    """Turn rows into columns, or columns into rows."""
    return zip(*rows, strict=True)


@dataclass(frozen=True)
class Book:
    """A workbook as plain cells, with its defined names (lower case) and what a person should know of it."""

    name: str
    sheets: tuple[Sheet, ...]
    names: Mapping[str, str]
    flags: tuple[Flag, ...]
    file_sha256: str


def read_workbook(request: ReadRequest) -> Book:
    """Read any bytes as a workbook.

    Module-level, of one small record, opening no file: it can be run in a worker process as it is.

    Raises
    ------
    UnreadableError
        One polite line that says what the file is and what to do.
    """
    try:
        return _read(request)
    except RefusedError as error:
        raise UnreadableError(shown_name(request.name), error.got, error.hint) from error


def _read(request: ReadRequest, *, is_inner: bool = False) -> Book:
    require_zip(request.data)
    container = open_container(request.data)
    if "[content_types].xml" not in container:
        return _read_inner(request, container, is_inner=is_inner)
    relations = read_relations(container.read("_rels/.rels"), "") if "_rels/.rels" in container else {}
    path = next((r.target for r in relations.values() if r.type == "officeDocument"), "xl/workbook.xml")
    if not path.endswith(".xml") or path not in container:
        raise _other_document(container)
    return _read_book(request, container, path)


def _read_book(request: ReadRequest, container: Container, path: str) -> Book:
    folder, _, file = path.rpartition("/")
    relations_path = f"{folder}/_rels/{file}.rels".removeprefix("/")
    relations = read_relations(container.read(relations_path), folder)
    directory = read_directory(container.read(path))
    strings = read_strings(_part(container, relations, "sharedStrings"))
    formats = read_formats(_part(container, relations, "styles"))
    sheets, flags = [], _flags_of(container)
    for name, state, relation in directory.sheets:
        found = relations.get(relation)
        if found is None or found.type != "worksheet":
            continue  # a chart sheet holds no cells
        content = read_sheet(container.read(found.target), strings, formats, is_1904=directory.is_1904)
        flags |= content.flags
        sheets.append(_sheet(name, content, is_visible=state == "visible"))
        if sum(len(sheet.cells) for sheet in sheets) > limits.CELLS:
            raise RefusedError(f"a workbook with more than {limits.CELLS} cells")
    if directory.is_1904:
        flags.add(Flag.DATE_SYSTEM_1904)
    return Book(request.name, tuple(sheets), directory.names, tuple(sorted(flags)), _sha(request.data))


def _sheet(name: str, content: SheetContent, *, is_visible: bool) -> Sheet:
    return Sheet(name, is_visible, content.cells, tuple(content.merges))


def _part(container: Container, relations: Mapping[str, Relation], kind: str) -> bytes:
    for relation in relations.values():
        if relation.type == kind and relation.target in container:
            return container.read(relation.target)
    return b"<none/>"


def _flags_of(container: Container) -> set[Flag]:
    flags: set[Flag] = set()
    if any(name.endswith("vbaproject.bin") for name in container.members):
        flags.add(Flag.MACROS)
    if any("/externallinks/" in name for name in container.members):
        flags.add(Flag.LINKS)
    return flags


def _read_inner(request: ReadRequest, container: Container, *, is_inner: bool) -> Book:
    """Look into a ZIP that is no workbook: one workbook inside is unwrapped, once."""
    inner = [n for n in container.members if n.endswith((".xlsx", ".xlsm")) and not n.startswith("__macosx/")]
    if is_inner or len(inner) != 1:
        raise _other_document(container)
    data = container.read(inner[0])
    book = _read(ReadRequest(request.name, data), is_inner=True)
    return Book(book.name, book.sheets, book.names, (*book.flags, Flag.ZIPPED), _sha(request.data))


def _other_document(container: Container) -> RefusedError:
    names = container.members
    if "mimetype" in names and b"opendocument" in container.read("mimetype")[:200]:
        return RefusedError("an OpenDocument file (.ods)", SAVE_AS)
    if any(name.endswith(".iwa") for name in names):
        return RefusedError("an Apple Numbers file", "In Numbers choose File, Export To, Excel, and hand in that file.")
    if "xl/workbook.bin" in names:
        return RefusedError("a binary workbook (.xlsb)", SAVE_AS)
    if "word/document.xml" in names:
        return RefusedError("a Word document", OUR_TEMPLATE)
    if "ppt/presentation.xml" in names:
        return RefusedError("a presentation", OUR_TEMPLATE)
    return RefusedError("a ZIP archive", UNPACKED)


def _sha(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def shown_name(name: str) -> str:
    """Return a file's name fit for a message: printable and short."""
    printable = "".join(character if character.isprintable() else "?" for character in name)
    return printable if len(printable) <= 80 else printable[:77] + "..."
