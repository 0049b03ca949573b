"""Words that workbook and handout share."""

from __future__ import annotations

from collections.abc import Iterable

from assignments.model import Question


def split_symbol(symbol: str) -> tuple[str, str]:
    """Split a symbol into its letter and its subscript.

    >>> split_symbol("v_f1"), split_symbol("e")
    (('v', 'f1'), ('e', ''))
    """
    letter, _, below = symbol.partition("_")
    return letter, below


def tolerance_text(question: Question) -> str:
    """Say how near an answer must come for full points."""
    relative = f"within {question.tolerance * 100:g} %"
    return f"{relative} or {question.floor:g} {question.unit}".rstrip() if question.floor else relative


def tracking_columns(points: Iterable[str]) -> tuple[str, ...]:
    """Return the header of the tracking sheet: unit in every name, metres, y up."""
    return ("frame", "t_s", *(f"{point}_{axis}_m" for point in points for axis in "xy"))
