"""The same points in metres, y up."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vml_course.errors import InputError, UnknownNameError
from vml_course.model.arrays import Axes, FloatArray, IntArray, set_frozen
from vml_course.model.track import Track


@dataclass(frozen=True, eq=False)
class Motion:
    """Tracked points in world coordinates.

    Attributes
    ----------
    points : tuple of str
    frame : int array, shape (n,)
    time_s : float array, shape (n,)
    xy_m : float array, shape (n, p, 2)
        y up; NaN where lost.
    sigma_m : float array, shape (n, p)
        One standard deviation of a coordinate; NaN where unknown.
    px_per_m : float
        Scale of the picture that the points were seen in; NaN where unknown.
    """

    points: tuple[str, ...]
    frame: IntArray
    time_s: FloatArray
    xy_m: FloatArray
    sigma_m: FloatArray
    px_per_m: float = math.nan

    def __post_init__(self) -> None:
        axes, p = Axes(), len(self.points)
        set_frozen(
            self,
            frame=axes.freeze("frame", self.frame, "n", dtype=np.int64),
            time_s=axes.freeze("time_s", self.time_s, "n"),
            xy_m=axes.freeze("xy_m", self.xy_m, "n", p, 2),
            sigma_m=axes.freeze("sigma_m", self.sigma_m, "n", p),
        )

    def of(self, name: str) -> FloatArray:
        """Return one point's positions, shape (n, 2), metres.

        Raises
        ------
        UnknownNameError
        """
        if name not in self.points:
            raise UnknownNameError("point", name, self.points)
        return np.asarray(self.xy_m[:, self.points.index(name)])


@dataclass(frozen=True)
class Calibration:
    """From pixels (y down) to metres (y up): a scale, an origin and the direction of the x axis.

    Attributes
    ----------
    px_per_m : float
    origin_px : (float, float)
        Where the world's origin is seen.
    axis_angle_rad : float
        Angle of the world's x axis from the picture's horizontal, counter-clockwise as one sees it.
    stick_px : (x1, y1, x2, y2)
        The two clicked points.
    length_m : float
        Their true distance.
    length_text : str
        What was typed, such as "22 cm".
    """

    px_per_m: float
    origin_px: tuple[float, float]
    axis_angle_rad: float = 0.0
    stick_px: tuple[float, float, float, float] | None = None
    length_m: float | None = None
    length_text: str = ""

    def __post_init__(self) -> None:
        if not (np.isfinite(self.px_per_m) and self.px_per_m > 0):
            raise InputError("px_per_m", "a positive scale in px/m", self.px_per_m)

    def to_m(self, xy_px: FloatArray) -> FloatArray:
        """Map picture points, shape (..., 2), to metres, y up.

        >>> Calibration(px_per_m=500, origin_px=(100, 200)).to_m(np.array([350.0, 100.0]))
        array([0.5, 0.2])
        """
        flipped = (np.asarray(xy_px, dtype=np.float64) - np.array(self.origin_px)) * np.array([1.0, -1.0])
        return np.asarray(flipped @ _rotation(self.axis_angle_rad) / self.px_per_m)

    def to_px(self, xy_m: FloatArray) -> FloatArray:
        """Map world points, shape (..., 2), metres, y up, to the picture; the inverse of `to_m`."""
        flipped = np.asarray(xy_m, dtype=np.float64) @ _rotation(self.axis_angle_rad).T * self.px_per_m
        return np.asarray(flipped * np.array([1.0, -1.0]) + np.array(self.origin_px))

    def apply(self, track: Track) -> Motion:
        """Return the track in metres: the only door from pixels to the world."""
        return Motion(
            points=track.points,
            frame=track.frame,
            time_s=track.time_s,
            xy_m=self.to_m(track.xy_px),
            sigma_m=track.sigma_px / self.px_per_m,
            px_per_m=self.px_per_m,
        )


@dataclass(frozen=True, eq=False)
class VectorSeries:
    """A vector between two points through time.

    Attributes
    ----------
    name, tail, head : str
    angle_rad : float array, shape (n,)
        Signed, unwrapped, from +x, counter-clockwise (y up).
    angle_vml_deg : float array, shape (n,)
        VML's inner-product angle: 0 to 180 degrees, without sign; for comparison only.
    length : float array, shape (n,)
        In the unit of the positions (`px` or `m`).
    change_pct : float array, shape (n,)
        Change of the length since the first frame in which both points were seen, in percent.
    """

    name: str
    tail: str
    head: str
    angle_rad: FloatArray
    angle_vml_deg: FloatArray
    length: FloatArray
    change_pct: FloatArray

    def __post_init__(self) -> None:
        axes = Axes()
        for name in ("angle_rad", "angle_vml_deg", "length", "change_pct"):
            set_frozen(self, **{name: axes.freeze(name, getattr(self, name), "n")})


def vector_between(name: str, tail: str, head: str, tail_xy: FloatArray, head_xy: FloatArray) -> VectorSeries:
    """Measure the vector from `tail` to `head`.

    Parameters
    ----------
    name, tail, head : str
    tail_xy, head_xy : float array, shape (n, 2)
        Positions with y *up* (flip pixels first). NaN rows give NaN, and the angle is unwrapped over gaps.
    """
    across = np.asarray(head_xy, dtype=np.float64) - np.asarray(tail_xy, dtype=np.float64)
    length = np.hypot(across[:, 0], across[:, 1])
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = np.clip(across[:, 0] / length, -1.0, 1.0)
        first = length[np.isfinite(length)][:1]
        change = (length / first - 1.0) * 100.0 if first.size else np.full_like(length, np.nan)
    return VectorSeries(
        name=name,
        tail=tail,
        head=head,
        angle_rad=_unwrap_seen(np.arctan2(across[:, 1], across[:, 0])),
        angle_vml_deg=np.degrees(np.arccos(cosine)),
        length=length,
        change_pct=change,
    )


def _unwrap_seen(angle_rad: FloatArray) -> FloatArray:
    seen: NDArray[np.bool_] = np.isfinite(angle_rad)
    result = np.full_like(angle_rad, np.nan)
    result[seen] = np.unwrap(angle_rad[seen])
    return result


def _rotation(angle_rad: float) -> FloatArray:
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    return np.array([[c, -s], [s, c]])
