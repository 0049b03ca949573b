"""Points as platforms write them: two decimals at most, never a mark between thousands."""

from __future__ import annotations

import re
from collections.abc import Iterable
from decimal import ROUND_HALF_UP
from decimal import Decimal as Exact

from grader.filling.job import Decimal

_NUMBER = re.compile(r"\s*-?\d+(?:[.,]\d+)?\s*%?\s*")
_SHOWS_COMMA, _SHOWS_POINT = re.compile(r"\s*-?\d+,\d{1,2}\s*"), re.compile(r"\s*-?\d+\.\d{1,2}\s*")


def points_text(points: float, *, comma: bool = False) -> str:
    """Return points with two decimals at most, halves rounded up.

    >>> points_text(17.525), points_text(1234.0), points_text(8.5, comma=True), points_text(-0.0)
    ('17.53', '1234', '8,5', '0')
    """
    exact = Exact(repr(round(points + 0.0, 9))).quantize(Exact("0.01"), ROUND_HALF_UP)
    text = f"{exact:f}".rstrip("0").rstrip(".")
    return text.replace(".", ",") if comma else text


def number_in(text: str) -> float | None:
    """Return the number that a cell says, None when it says something else.

    >>> number_in("8,50"), number_in(" 10 "), number_in("EX"), number_in("")
    (8.5, 10.0, None, None)
    """
    if not _NUMBER.fullmatch(text) or "%" in text:
        return None
    return float(text.strip().replace(",", "."))


def uses_comma(cells: Iterable[str], wanted: Decimal) -> bool:
    """Tell whether a decimal comma is written: as wanted, or as most numbers of a table that show their mark."""
    if wanted != "auto":
        return wanted == "comma"
    cells = tuple(cells)
    commas = sum(_SHOWS_COMMA.fullmatch(cell) is not None for cell in cells)
    return commas > sum(_SHOWS_POINT.fullmatch(cell) is not None for cell in cells)
