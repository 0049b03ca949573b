"""A value written with as many digits as its uncertainty deserves."""

from __future__ import annotations

import math

ROUNDING = 1e-7  # relative: nothing is measured so well


def with_uncertainty(value: float, sd: float) -> str:
    """Return value and uncertainty as text: two digits of the uncertainty, the value to the same place.

    Without a usable uncertainty, or with one that is rounding alone, the value has six digits; very large or small ones
    get a power of ten.

    >>> with_uncertainty(0.733334, 0.002213), with_uncertainty(1.8816, 0.21), with_uncertainty(1535.2, 37.0)
    ('0.7333 ± 0.0022', '1.88 ± 0.21', '1535 ± 37')
    >>> with_uncertainty(-2.3e-9, 4.1e-9)
    '(-2.3 ± 4.1)e-09'
    >>> with_uncertainty(0.5599999985, 2e-9)
    '0.56'
    """
    if not (math.isfinite(value) and math.isfinite(sd) and sd > ROUNDING * abs(value)):
        return f"{value:.6g}"
    size = max(abs(value), sd)
    power = math.floor(math.log10(size))
    if not -4 <= power <= 5:
        return f"({with_uncertainty(value / 10.0**power, sd / 10.0**power)})e{power:+03d}"
    places = max(1 - math.floor(math.log10(float(f"{sd:.1e}"))), 0)
    if places > 12:
        return f"{value:.12g}"
    return f"{value:.{places}f} ± {sd:.{places}f}"
