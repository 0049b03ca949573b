"""What the tracker saw: pixels, y down."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from vml_course.errors import UnknownNameError
from vml_course.model.arrays import Axes, FloatArray, IntArray, set_frozen


class Status(IntEnum):
    """How a position came about; the numbers are those of the MAT file."""

    AUTO = 0
    MANUAL = 1
    INTERP = 2
    LOST = 3
    VIRTUAL = 4


@dataclass(frozen=True, slots=True)
class Seed:
    """Where a point was placed: its name, its place (sub-pixel, y down), and in which frame; None: in the first."""

    name: str
    x_px: float
    y_px: float
    frame: int | None = None


@dataclass(frozen=True, eq=False)
class Sighting:
    """What a tracker says of all its points in one frame.

    Attributes
    ----------
    xy_px : float array, shape (p, 2)
        NaN where lost.
    sigma_px : float array, shape (p,)
        One standard deviation of a coordinate (root mean square of x and y); NaN where lost.
    zncc : float array, shape (p,)
        Zero-normalised cross-correlation with the reference block, -1 to 1; NaN where lost.
    iterations : int array, shape (p,)
    status : int array, shape (p,)
        Values of `Status`.
    gradient : float array, shape (p, 4)
        Displacement gradients du/dx, du/dy, dv/dx, dv/dy; NaN where lost.
    drift_px : float array, shape (p,)
        The part of `sigma_px` that comes from references cut anew on the way; 0 as long as a point is compared with
        its first block, NaN where lost. It rises where a reference is renewed, and at no other place.
    """

    xy_px: FloatArray
    sigma_px: FloatArray
    zncc: FloatArray
    iterations: IntArray
    status: NDArray[np.int8]
    gradient: FloatArray
    drift_px: FloatArray = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        axes = Axes()
        drift_px = self.drift_px if len(self.drift_px) else np.zeros(len(self.xy_px))
        set_frozen(
            self,
            xy_px=axes.freeze("xy_px", self.xy_px, "p", 2),
            sigma_px=axes.freeze("sigma_px", self.sigma_px, "p"),
            zncc=axes.freeze("zncc", self.zncc, "p"),
            iterations=axes.freeze("iterations", self.iterations, "p", dtype=np.int64),
            status=axes.freeze("status", self.status, "p", dtype=np.int8),
            gradient=axes.freeze("gradient", self.gradient, "p", 4),
            drift_px=axes.freeze("drift_px", drift_px, "p"),
        )


@dataclass(frozen=True, eq=False)
class Track:
    """The points of a clip through time, in pixels of the source picture.

    Attributes
    ----------
    points : tuple of str
    frame : int array, shape (n,)
        Numbers in the source video.
    time_s : float array, shape (n,)
        0 at the clip's first frame.
    xy_px, sigma_px, zncc, iterations, status, gradient, drift_px
        As in `Sighting`, with a leading axis n.
    settings : mapping of str to (str, int or float)
        How it was tracked: method, block, ...
    reference : int array, shape (n, p)
        Number of the frame whose block the point was compared with; where it changes, the point was referenced
        anew. The first frame everywhere when left out.
    """

    points: tuple[str, ...]
    frame: IntArray
    time_s: FloatArray
    xy_px: FloatArray
    sigma_px: FloatArray
    zncc: FloatArray
    iterations: IntArray
    status: NDArray[np.int8]
    gradient: FloatArray
    settings: Mapping[str, str | int | float] = field(default_factory=dict)
    drift_px: FloatArray = field(default_factory=lambda: np.zeros(0))
    reference: IntArray = field(default=None)  # type: ignore[arg-type] # filled in below

    def __post_init__(self) -> None:
        axes, p = Axes(), len(self.points)
        drift_px = self.drift_px if len(self.drift_px) else np.zeros(np.shape(self.sigma_px))
        set_frozen(
            self,
            frame=axes.freeze("frame", self.frame, "n", dtype=np.int64),
            time_s=axes.freeze("time_s", self.time_s, "n"),
            xy_px=axes.freeze("xy_px", self.xy_px, "n", p, 2),
            sigma_px=axes.freeze("sigma_px", self.sigma_px, "n", p),
            zncc=axes.freeze("zncc", self.zncc, "n", p),
            iterations=axes.freeze("iterations", self.iterations, "n", p, dtype=np.int64),
            status=axes.freeze("status", self.status, "n", p, dtype=np.int8),
            gradient=axes.freeze("gradient", self.gradient, "n", p, 4),
            drift_px=axes.freeze("drift_px", drift_px, "n", p),
            reference=axes.freeze("reference", self._reference(p), "n", p, dtype=np.int64),
        )

    def _reference(self, p: int) -> IntArray:
        if self.reference is not None:
            return self.reference
        return np.full((len(self.frame), p), self.frame[0] if len(self.frame) else 0)

    @property
    def is_lost(self) -> NDArray[np.bool_]:
        """Where a point was not found: shape (n, p)."""
        return np.asarray(self.status == Status.LOST)

    def point_index(self, name: str) -> int:
        """Return the column of a point.

        Raises
        ------
        UnknownNameError
        """
        if name not in self.points:
            raise UnknownNameError("point", name, self.points)
        return self.points.index(name)
