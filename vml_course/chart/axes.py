"""Axes of small charts: round numbers, their labels, and where a number lies in the picture."""

from __future__ import annotations

import math


class Scale:
    """A straight map from numbers to places in the picture."""

    def __init__(self, low: float, high: float, start: float, end: float) -> None:
        self._low, self._start = low, start
        self._slope = (end - start) / (high - low) if high > low else 0.0

    def __call__(self, value: float) -> float:
        """Return the place of a number, rounded to a tenth."""
        return round(float(self._start + (value - self._low) * self._slope), 1)


def nice_ticks(low: float, high: float, count: int) -> tuple[float, ...]:
    """Return round numbers that enclose `low` and `high`, about `count` steps apart.

    >>> nice_ticks(0.13, 0.87, 4)
    (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
    """
    if not high > low:
        high, low = low + abs(low) * 0.1 + 1e-9, low - abs(low) * 0.1 - 1e-9
    rough = (high - low) / count
    power = 10.0 ** math.floor(math.log10(rough))
    step = power * next(factor for factor in (1, 2, 2.5, 5, 10) if factor * power >= rough * 0.999)
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return tuple(float(f"{i * step:.12g}") for i in range(first, last + 1))


def label(value: float) -> str:
    """Return a number for an axis, with a real minus sign."""
    return f"{value:.6g}".replace("-", "−")
