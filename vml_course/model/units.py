"""Units that may be typed, by dimension: a short list on purpose, with the factor to SI."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from vml_course.errors import NumberError, UncalibratedUnitError, UnitError, UnknownNameError

_INCH_M, _FOOT_M, _POUND_KG, _DEG_RAD = 0.0254, 0.3048, 0.45359237, math.pi / 180.0

_UNITS: dict[str, dict[str, float]] = {
    "number": {"": 1.0, "%": 0.01},
    "length": {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "in": _INCH_M, "ft": _FOOT_M},
    "mass": {"kg": 1.0, "g": 0.001, "lb": _POUND_KG},
    "time": {"s": 1.0, "ms": 0.001},
    "velocity": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "km/h": 1 / 3.6, "ft/s": _FOOT_M},
    "acceleration": {"m/s^2": 1.0, "cm/s^2": 0.01, "mm/s^2": 0.001, "ft/s^2": _FOOT_M},
    "angle": {"rad": 1.0, "deg": _DEG_RAD},
    "angular_velocity": {"rad/s": 1.0, "deg/s": _DEG_RAD, "rpm": math.pi / 30, "rev/s": 2 * math.pi, "1/s": 1.0},
    "angular_acceleration": {"rad/s^2": 1.0, "deg/s^2": _DEG_RAD},
    "inertia": {
        "kg m^2": 1.0,
        "kg cm^2": 1e-4,
        "g m^2": 1e-3,
        "g cm^2": 1e-7,
        "N m s^2": 1.0,
        "lb ft^2": _POUND_KG * _FOOT_M**2,
    },
    "force": {"N": 1.0, "kN": 1000.0},
    "torque": {"N m": 1.0, "N cm": 0.01},
    "impulse": {"N s": 1.0, "kg m/s": 1.0},
    "energy": {"J": 1.0, "kJ": 1000.0, "mJ": 0.001},
    "rate": {"1/s": 1.0, "Hz": 1.0, "kHz": 1000.0, "fps": 1.0},
    "scale": {"px/m": 1.0, "px/cm": 100.0, "px/mm": 1000.0, "px/in": 1 / _INCH_M, "px/ft": 1 / _FOOT_M},
    "pixel_length": {"px": 1.0},
    "pixel_velocity": {"px/s": 1.0},
}

# Per pixel instead of pixels per: the value is turned over after the factor.
_TURNED: dict[str, dict[str, float]] = {"scale": {"m/px": 1.0, "cm/px": 0.01, "mm/px": 0.001, "in/px": _INCH_M}}

UNITS: Mapping[str, Mapping[str, float]] = MappingProxyType({k: MappingProxyType(v) for k, v in _UNITS.items()})
"""Factor to SI of each unit, by dimension; the first unit of a dimension is its SI unit."""

# Other spellings, after spaces, ^ and multiplication signs have been taken away.
_ALIASES: dict[str, tuple[str, ...]] = {
    "%": ("percent",),
    "m": ("meter", "meters", "metre", "metres"),
    "in": ("inch", "inches", '"'),
    "ft": ("foot", "feet"),
    "lb": ("lbs", "lbm"),
    "s": ("sec", "second", "seconds"),
    "m/s": ("ms-1", "m/sec", "mps"),
    "cm/s": ("cms-1", "cm/sec"),
    "mm/s": ("mms-1", "mm/sec"),
    "km/h": ("kmh", "kph", "kmh-1", "km/hr"),
    "ft/s": ("fts-1", "fps", "ft/sec"),
    "m/s^2": ("ms-2", "m/s/s", "m/sec2"),
    "rad": ("radian", "radians"),
    "deg": ("°", "degree", "degrees"),
    "rad/s": ("rads-1", "rad/sec", "radians/s"),
    "deg/s": ("degs-1", "°/s", "°s-1", "deg/sec", "degrees/s"),
    "rpm": ("rev/min", "r/min", "1/min", "min-1"),
    "rev/s": ("rps", "r/s", "turns/s"),
    "1/s": ("s-1", "/s", "1/sec"),
    "rad/s^2": ("rads-2",),
    "deg/s^2": ("°/s2", "degs-2"),
    "kg m^2": ("kgsqm", "m2kg"),
    "N m s^2": ("Nm/s-2",),
    "N s": ("Ns", "Nsec"),
    "kg m/s": ("kgms-1",),
    "Hz": ("hertz",),
    "fps": ("frames/s", "frame/s", "framespersecond", "f/s"),
    "px/m": ("pixel/m", "pixels/m", "pxm-1", "pixels/meter", "px/meter"),
    "px/cm": ("pixel/cm", "pixels/cm"),
    "px/mm": ("pixel/mm", "pixels/mm"),
    "m/px": ("m/pixel",),
    "cm/px": ("cm/pixel",),
    "mm/px": ("mm/pixel",),
    "px": ("pixel", "pixels"),
    "px/s": ("pxs-1", "pixel/s", "pixels/s"),
}

_PER_METRE = {"length": "pixel_length", "velocity": "pixel_velocity"}


def dimension_of(unit: str) -> str:
    """Return the dimension of an SI unit as scenes declare it, such as `kg m^2` -> `inertia`.

    Raises
    ------
    UnknownNameError
        When no dimension has that unit.
    """
    for dimension, units in UNITS.items():
        if unit in units:
            return dimension
    raise UnknownNameError("unit", unit, (next(iter(units)) for units in UNITS.values()))


def find_unit(text: str, dimension: str, default_unit: str | None, name: str) -> str:
    """Return the unit's own spelling in `UNITS` (or of a reciprocal scale), for text as typed.

    Raises
    ------
    UnitError
        When the unit is missing, unknown or of another dimension.
    UncalibratedUnitError
        When pixels are given where metres are meant.
    """
    if dimension not in UNITS:
        raise UnknownNameError("dimension", dimension, UNITS)
    if not text:
        default_unit = "" if dimension == "number" else default_unit
        if default_unit is None:
            raise UnitError(name, f"a unit after the number ({_accepted(dimension)})", "none")
        return default_unit
    found = _SPELLINGS[dimension].get(_compact(text)) or _SPELLINGS[dimension].get(_compact(text).lower())
    if found is not None:
        return found
    if _compact(text) in _SPELLINGS.get(_PER_METRE.get(dimension, ""), {}):
        raise UncalibratedUnitError(name, _accepted(dimension), text)
    wanted = "no unit, or %" if dimension == "number" else f"a unit of {dimension} ({_accepted(dimension)})"
    raise UnitError(name, wanted, repr(text[:40]))


def to_si(value: float, unit: str, dimension: str, name: str = "value") -> float:
    """Convert a value in `unit` to the SI unit of its dimension.

    Raises
    ------
    NumberError
        When a scale per pixel is zero.

    >>> to_si(2.0, "mm/px", "scale")
    500.0
    """
    if unit in UNITS[dimension]:
        return value * UNITS[dimension][unit]
    turned = value * _TURNED[dimension][unit]
    if turned == 0.0:
        raise NumberError(name, "a scale other than zero", f"{value:g} {unit}")
    return 1.0 / turned


def spread_to_si(spread: float, value_si: float, unit: str, dimension: str, name: str = "value") -> float:
    """Convert a small uncertainty of `value_si`; that of a turned unit grows with the square of the value.

    >>> spread_to_si(0.1, 500.0, "mm/px", "scale")
    25.0
    """
    if unit in UNITS[dimension]:
        return abs(to_si(spread, unit, dimension, name))
    return abs(spread * _TURNED[dimension][unit]) * value_si**2


def _accepted(dimension: str) -> str:
    return ", ".join(unit for unit in (*UNITS[dimension], *_TURNED.get(dimension, {})) if unit)


def _compact(text: str) -> str:
    return "".join(character for character in text if character not in " ^*·()")


def _spellings(dimension: str) -> dict[str, str]:
    """Return every accepted spelling of a dimension; capitals forgiven where that leaves one meaning."""
    exact = {
        _compact(spelling): unit
        for unit in (*UNITS[dimension], *_TURNED.get(dimension, {}))
        for spelling in (unit, *_ALIASES.get(unit, ()))
        if spelling
    }
    relaxed: dict[str, set[str]] = {}
    for spelling, unit in exact.items():
        relaxed.setdefault(spelling.lower(), set()).add(unit)
    return {**{key: next(iter(units)) for key, units in relaxed.items() if len(units) == 1}, **exact}


_SPELLINGS = {dimension: _spellings(dimension) for dimension in UNITS}
