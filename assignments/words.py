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


_BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def symbol_text(symbol: str) -> str:
    """Return a symbol as plain text comes nearest to print: digits below the line, letters as they are.

    >>> symbol_text("ω_1"), symbol_text("v_f1"), symbol_text("e")
    ('ω₁', 'v_f1', 'e')
    """
    letter, below = split_symbol(symbol)
    return letter + below.translate(_BELOW) if below.isdigit() else symbol


def tolerance_text(question: Question) -> str:
    """Say how near an answer must come for full points."""
    relative = f"within {question.tolerance * 100:g} %"
    return f"{relative} or {question.floor:g} {question.unit}".rstrip() if question.floor else relative


def tracking_columns(points: Iterable[str]) -> tuple[str, ...]:
    """Return the header of the tracking sheet: unit in every name, metres, y up."""
    return ("frame", "t_s", *(f"{point}_{axis}_m" for point in points for axis in "xy"))
