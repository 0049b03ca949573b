"""Read-only arrays with named axes, for the records of this package."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vml_course.errors import ShapeError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Axes:
    """Axis lengths of one record: the first array that has an axis fixes it, the others must agree.

    >>> axes = Axes()
    >>> time_s = axes.freeze("time_s", [0.0, 0.1], "n")
    >>> axes.freeze("xy_px", [[1.0, 2.0]], "n", 2)
    Traceback (most recent call last):
    ...
    vml_course.errors.ShapeError: xy_px: expected shape (n=2, 2), got (1, 2).
    """

    def __init__(self) -> None:
        self._length: dict[str, int] = {}

    def freeze(self, name: str, values: object, *shape: str | int, dtype: DTypeLike = np.float64) -> NDArray[Any]:
        """Return `values` as a read-only array of its own, after checking its shape.

        Parameters
        ----------
        name : str
            What the array is called in the error.
        values : array_like
            The numbers; they are copied.
        *shape : str or int
            One entry an axis: a name that is shared with the record's other arrays, or a fixed length.
        dtype : dtype
            Type of the result.

        Raises
        ------
        ShapeError
            When an axis has another length than declared.
        """
        array = np.array(values, dtype=dtype)
        if array.ndim != len(shape) or any(
            length != self._length.get(axis, length) if isinstance(axis, str) else length != axis
            for axis, length in zip(shape, array.shape, strict=False)
        ):
            raise ShapeError(name, f"shape ({', '.join(map(self._show, shape))})", array.shape)
        self._length.update({a: n for a, n in zip(shape, array.shape, strict=True) if isinstance(a, str)})
        array.setflags(write=False)
        return array

    def _show(self, axis: str | int) -> str:
        return f"{axis}={self._length[axis]}" if isinstance(axis, str) and axis in self._length else str(axis)


def set_frozen(record: object, **values: object) -> None:
    """Set fields of a frozen dataclass from inside its own `__post_init__`."""
    for name, value in values.items():
        object.__setattr__(record, name, value)
