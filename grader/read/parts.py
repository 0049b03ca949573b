"""The small parts of a workbook: relations, sheet list, shared strings, number formats."""

from __future__ import annotations

import functools
import posixpath
import re
from dataclasses import dataclass, field

from grader.read import limits
from grader.read.errors import OUR_TEMPLATE, RefusedError
from grader.read.markup import Attributes, parse, plain

_BUILTIN_DATES = frozenset([*range(14, 23), *range(27, 37), *range(45, 48), *range(50, 59)])
_NOT_LETTERS = re.compile(r'"[^"]*"|\\.|_.|\*.|\[(?!h+\]|m+\]|s+\])[^\]]*\]', re.IGNORECASE)


@dataclass(frozen=True)
class Relation:
    """One line of a relations part."""

    target: str
    type: str


@dataclass
class Directory:
    """What `workbook.xml` lists: sheets as (name, state, relation id), defined names, the date system."""

    sheets: list[tuple[str, str, str]] = field(default_factory=list)
    names: dict[str, str] = field(default_factory=dict)
    is_1904: bool = False


def read_relations(content: bytes, folder: str) -> dict[str, Relation]:
    """Return the relations by id, with targets as member names."""
    relations: dict[str, Relation] = {}

    def relation(attributes: Attributes) -> None:
        if attributes.get("TargetMode") == "External":
            return
        target = attributes.get("Target", "").replace("\\", "/")
        path = target.lstrip("/") if target.startswith("/") else posixpath.normpath(posixpath.join(folder, target))
        kind = attributes.get("Type", "").rpartition("/")[2]
        relations[attributes.get("Id", "")] = Relation(path.lower(), kind)
        _limit(len(relations), limits.MEMBERS, "relations")

    parse(content, {"Relationship": relation})
    return relations


def read_directory(content: bytes) -> Directory:
    """Read the list of sheets and the defined names; of a name that single sheets have too, the workbook's counts."""
    found = Directory()
    named: list[Attributes] = [{}]

    def sheet(attributes: Attributes) -> None:
        said = plain(attributes)
        found.sheets.append((said.get("name", ""), said.get("state", "visible"), said.get("id", "")))
        _limit(len(found.sheets), limits.SHEETS, "sheets")

    def system(attributes: Attributes) -> None:
        found.is_1904 = attributes.get("date1904", "0").lower() in {"1", "true"}

    def name(attributes: Attributes) -> None:
        named[0] = attributes

    def place(text: str) -> None:
        name = named[0].get("name", "").lower()
        if "localSheetId" not in named[0] or name not in found.names:
            found.names[name] = text[: limits.TEXT_LENGTH]
        _limit(len(found.names), limits.NAMES, "names")

    parse(content, {"sheet": sheet, "workbookPr": system, "definedName": name}, {"definedName": place})
    return found


def read_strings(content: bytes) -> list[str]:
    """Return the shared strings; pronunciation guides are left out."""
    strings: list[str] = []
    runs: list[str] = []
    before = [0]

    def string(_: Attributes) -> None:
        runs.clear()

    def guide(_: Attributes) -> None:
        before[0] = len(runs)

    def no_guide(_: str) -> None:
        del runs[before[0] :]

    def end(_: str) -> None:
        strings.append("".join(runs)[: limits.TEXT_LENGTH])
        _limit(len(strings), limits.STRINGS, "texts")

    parse(content, {"si": string, "rPh": guide}, {"t": runs.append, "rPh": no_guide, "si": end})
    return strings


def read_formats(content: bytes) -> list[str]:
    """Return the number format of each cell style: its code, `date` for built-in dates, or "" for general."""
    codes: dict[str, str] = {}
    formats: list[str] = []
    inside = [False]

    def cells(_: Attributes) -> None:
        inside[0] = True

    def code(attributes: Attributes) -> None:
        codes[attributes.get("numFmtId", "")] = attributes.get("formatCode", "")[: limits.TEXT_LENGTH]
        _limit(len(codes), limits.STYLES, "styles")

    def style(attributes: Attributes) -> None:
        if inside[0]:
            formats.append(_format(attributes.get("numFmtId", "0"), codes))
            _limit(len(formats), limits.STYLES, "styles")

    def end(_: str) -> None:
        inside[0] = False

    parse(content, {"cellXfs": cells, "numFmt": code, "xf": style}, {"cellXfs": end})
    return formats


def _format(number: str, codes: dict[str, str]) -> str:
    if number in codes:  # LibreOffice gives the general format a number of its own
        return "" if codes[number].lower() == "general" else codes[number]
    if number in {"9", "10"}:
        return "0%"
    return "date" if number.isascii() and number.isdigit() and int(number[:6]) in _BUILTIN_DATES else ""


@functools.lru_cache(maxsize=1024)
def shows_date(code: str) -> bool:
    """Tell whether a number format shows its number as a date or a time of day.

    >>> shows_date("dd/mm/yyyy"), shows_date('0.00" days"'), shows_date("0.0E+00"), shows_date("[h]:mm")
    (True, False, False, True)
    """
    bare = _NOT_LETTERS.sub("", code).lower().replace("general", "")
    return any(letter in bare for letter in "ymdhs")


def _limit(count: int, most: int, what: str) -> None:
    if count > most:
        raise RefusedError(f"a workbook with more than {most} {what}", OUR_TEMPLATE)
