"""Lays what is already at the picture's scale over a part of it."""

from __future__ import annotations

import numpy as np
from numba import njit

from vml_course.synth.texture import Plane

f4 = np.float32


def cover(region: Plane, veil: Plane) -> None:
    """Lay what is already at the picture's scale over a part of it: shapes (rows, columns, c) and (.., c + 1)."""
    _cover(region, veil, (0,) * region.shape[2])


@njit(cache=True, nogil=True, error_model="numpy")
def _cover(region, veil, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    for y in range(region.shape[0]):
        for x in range(region.shape[1]):
            clear = f4(1) - veil[y, x, len(colours)]
            for c in range(len(colours)):
                region[y, x, c] = region[y, x, c] * clear + veil[y, x, c]
