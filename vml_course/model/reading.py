"""The one reader of typed numbers and units: prompt, workbook and studio all read with it.

Text is never evaluated, and a unit is looked up in a short list, never parsed: `float` accepts `1_000`,
`nan` and `1e999`, and unit libraries can be kept busy for ever by one cell (`9**9**9`) or drop what they do
not understand (`0,73 kg m^2` becomes 0). Everything here takes time linear in a text of bounded length.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from vml_course.errors import AmbiguousNumberError, NumberError
from vml_course.model.typed_text import shown, straighten
from vml_course.model.units import UNITS, find_unit, spread_to_si, to_si

__all__ = ["UNITS", "Reading", "read_number", "read_quantity"]


@dataclass(frozen=True, slots=True)
class Reading:
    """What a text says.

    Attributes
    ----------
    value : float
        In the SI unit of its dimension.
    unit : str
        The unit as `UNITS` spells it; "" for a pure number.
    uncertainty : float or None
        What follows the plus-minus sign, in the same SI unit.
    unit_assumed : bool
        Whether no unit was typed and the default was taken.
    """

    value: float
    unit: str
    uncertainty: float | None = None
    unit_assumed: bool = False


def read_number(text: str, *, name: str = "value") -> float:
    """Read a pure number as a person types it, with a decimal point or comma.

    Raises
    ------
    NumberError
        When the text is no finite number.
    AmbiguousNumberError
        When it can be read as two numbers.
    UnitError
        When a unit follows.

    >>> read_number("−7,3·10⁻¹"), read_number("73 %"), read_number("1.234,5")
    (-0.73, 0.73, 1234.5)
    >>> read_number("1,234")
    Traceback (most recent call last):
    ...
    vml_course.errors.AmbiguousNumberError: value: expected a number with one reading, got '1,234'. Write 1.234 or 1234.
    """
    return read_quantity(text, "number", name=name).value


def read_quantity(text: str, dimension: str, default_unit: str | None = None, *, name: str = "value") -> Reading:
    """Read a number with its unit, such as `0,22 m`, `22 cm` or `(0.50 ± 0.01) kg`.

    Parameters
    ----------
    text : str
        What was typed.
    dimension : str
        A key of `UNITS`.
    default_unit : str, optional
        Unit to assume when none is typed; without it a missing unit is an error (except of a pure number).
    name : str
        What the user calls the value, for messages.

    Raises
    ------
    NumberError, AmbiguousNumberError
        When there is no finite number, or two readings of it.
    UnitError, UncalibratedUnitError
        When the unit is missing, unknown, of another dimension, or of pixels where metres are meant.

    >>> read_quantity("22 cm", "length")
    Reading(value=0.22, unit='cm', uncertainty=None, unit_assumed=False)
    >>> read_quantity("(0,50 ± 0,01) kg", "mass").uncertainty
    0.01
    """
    parts = straighten(text, name).split("±")
    if len(parts) > 2:
        raise NumberError(name, "a number", shown(text))
    number, unit_text = _split(parts[0], text, name)
    if len(parts) == 1:
        unit = find_unit(unit_text, dimension, default_unit, name)
        return Reading(_finite(to_si(number, unit, dimension, name), text, name), unit, None, _assumed(unit_text, unit))
    spread, spread_text = _split(parts[1], text, name)
    is_share = _is_share(spread_text, unit_text, dimension, text, name)
    unit_text = unit_text or ("" if is_share else spread_text)
    unit = find_unit(unit_text, dimension, default_unit, name)
    value = to_si(number, unit, dimension, name)
    uncertainty = abs(value) * abs(spread) * 0.01
    if not is_share:
        uncertainty = spread_to_si(spread, value, find_unit(spread_text, dimension, unit, name), dimension, name)
    return Reading(_finite(value, text, name), unit, _finite(uncertainty, text, name), _assumed(unit_text, unit))


# ---------------------------------------------------------------- one number

_START = re.compile(
    r"(?P<sign>[+-]?) ?"
    r"(?P<body>[0-9.,]+(?: [0-9]{3}(?![0-9])[.,]?[0-9]*)*)"
    r"(?:[eE](?P<e>[+-]?[0-9]+)| ?[·*x] ?10 ?(?:\^|\*\*) ?(?P<ten>[+-]?[0-9]+))?"
    r"(?P<rest>.*)",
    re.DOTALL,
)

# Ways to write the digits, and the decimal mark of each; anything else with two marks has no single reading.
_FORMS = (
    (re.compile(r"[0-9]+\.?[0-9]*|\.[0-9]+"), "."),
    (re.compile(r"[0-9]*,[0-9]+"), ","),
    (re.compile(r"[1-9][0-9]{0,2}(,[0-9]{3})+\.[0-9]*"), "."),
    (re.compile(r"[1-9][0-9]{0,2}(\.[0-9]{3})+,[0-9]+"), ","),
    (re.compile(r"[1-9][0-9]{0,2}(,[0-9]{3}){2,}"), "."),
    (re.compile(r"[1-9][0-9]{0,2}(\.[0-9]{3}){2,}"), ","),
    (re.compile(r"[1-9][0-9]{0,2}( [0-9]{3})+(\.[0-9]*)?"), "."),
    (re.compile(r"[1-9][0-9]{0,2}( [0-9]{3})+,[0-9]+"), ","),
)
_UNIT_START = re.compile(r"[^\W\d_xX]|[%°\"]|1 ?/ ?s")
_TWO_READINGS = re.compile(r"[1-9][0-9]{0,2},[0-9]{3}")


def _split(part: str, text: str, name: str) -> tuple[float, str]:
    """Return the number at the start of `part` and the unit text after it."""
    part = part.strip()
    start = _START.fullmatch(part)
    if start is None:
        raise NumberError(name, "a number", shown(text))
    rest = start["rest"].strip()
    if rest and not _UNIT_START.match(rest):
        raise NumberError(name, "a number", shown(text))
    digits = _with_point(start["body"], text, name)
    return _finite(float(f"{start['sign']}{digits}e{start['e'] or start['ten'] or 0}"), text, name), rest


def _with_point(body: str, text: str, name: str) -> str:
    if _TWO_READINGS.fullmatch(body):
        readings = (body.replace(",", "."), body.replace(",", ""))
        hint = f"Write {readings[0]} or {readings[1]}."
        raise AmbiguousNumberError(name, "a number with one reading", shown(text), hint)
    mark = next((mark for form, mark in _FORMS if form.fullmatch(body)), None)
    if mark is None:
        kind = AmbiguousNumberError if re.search("[0-9]", body) else NumberError
        raise kind(name, "a number with one decimal mark", shown(text))
    grouping = {".": ", ", ",": ". "}[mark]
    return body.translate(dict.fromkeys(map(ord, grouping))).replace(",", ".")


def _finite(value: float, text: str, name: str) -> float:
    if not math.isfinite(value):
        raise NumberError(name, "a finite number", shown(text))
    return value


def _assumed(unit_text: str, unit: str) -> bool:
    return not unit_text and bool(unit)


def _is_share(spread_unit: str, unit_text: str, dimension: str, text: str, name: str) -> bool:
    """Tell whether the uncertainty is a percentage of the value, as in `0.50 kg ± 2 %`."""
    if spread_unit != "%":
        return False
    if dimension == "number" and unit_text != "%":
        hint = "Write the uncertainty without %, or put both in brackets before it."
        raise AmbiguousNumberError(name, "an uncertainty with one reading", shown(text), hint)
    return dimension != "number"
