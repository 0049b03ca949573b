"""A physical parameter declared once: default, unit, range, meaning.

The one declaration serves the constructor's check, the variant generator, the command line's `--set`,
the handout's units and Hypothesis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Any

from vml_course.errors import InputError, OutOfRangeError


@dataclass(frozen=True, slots=True)
class Quantity:
    """What is declared of one parameter; `low` and `high` are inclusive, in `unit`."""

    name: str
    default: float
    unit: str
    low: float
    high: float
    about: str
    symbol: str
    whole: bool

    @property
    def shown_name(self) -> str:
        """The field's name with the textbook's letter, such as `restitution (e)`."""
        return f"{self.name} ({self.symbol})" if self.symbol else self.name

    @property
    def range_text(self) -> str:
        """The range as a person reads it, such as `0.1 to 2 kg`."""
        return f"{self.low:g} to {self.high:g} {self.unit}".rstrip()


def quantity(  # noqa: PLR0913 - one declaration says it all
    default: float, unit: str, low: float, high: float, *, about: str = "", symbol: str = "", whole: bool = False
) -> Any:
    """Declare a dataclass field that is a physical quantity.

    Parameters
    ----------
    default, low, high : float
        Default and inclusive range, in `unit`.
    unit : str
        SI unit as it is written in text, "" for a pure number.
    about : str
        One phrase that a student understands.
    symbol : str
        The textbook's letter, which `--set` and `-g` accept beside the field's name.
    whole : bool
        Whether only whole numbers are allowed.
    """
    declared = {"unit": unit, "low": low, "high": high, "about": about, "symbol": symbol, "whole": whole}
    return field(default=default, metadata={"quantity": declared})


def quantities_of(record: Any) -> dict[str, Quantity]:
    """Return the quantities of a dataclass (or of its instance) by field name, in declared order."""
    return {
        item.name: Quantity(name=item.name, default=float(str(item.default)), **item.metadata["quantity"])
        for item in fields(record)
        if "quantity" in item.metadata
    }


def check_quantities(record: Any) -> None:
    """Check every quantity of an instance; call it from `__post_init__`.

    Raises
    ------
    InputError
        When a value is no finite number, or not whole where it must be.
    OutOfRangeError
        When a value lies outside its declared range.
    """
    for name, declared in quantities_of(record).items():
        value, name = getattr(record, name), declared.shown_name  # noqa: PLW2901 - as the user may know it
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise InputError(name, f"a number from {declared.range_text}", repr(value))
        if declared.whole and value != int(value):
            raise InputError(name, f"a whole number from {declared.range_text}", f"{value:g}")
        if not declared.low <= value <= declared.high:
            raise OutOfRangeError(name, declared.low, declared.high, declared.unit, value)
