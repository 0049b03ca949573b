"""Vectors between two tracked points: angle, length, change of length."""

from __future__ import annotations

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.motion import VectorSeries


def vector_series(name: str, tail: str, head: str, tail_xy: FloatArray, head_xy: FloatArray) -> VectorSeries:
    """Return angle and length of the vector from tail to head in every frame.

    Parameters
    ----------
    name, tail, head : str
        What the vector and its ends are called.
    tail_xy, head_xy : float array, shape (n, 2)
        Positions in axes whose y points up; NaN where a point was not seen.

    Returns
    -------
    VectorSeries
        Angles counter-clockwise from +x, unwrapped across gaps; lengths in the unit of the positions.

    >>> way = np.radians([170.0, 190.0])
    >>> head = np.column_stack([np.cos(way), np.sin(way)])
    >>> shin = vector_series("shin", "knee", "foot", np.zeros((2, 2)), head)
    >>> np.degrees(shin.angle_rad), shin.angle_vml_deg
    (array([170., 190.]), array([170., 170.]))
    """
    way = np.asarray(head_xy, dtype=np.float64) - np.asarray(tail_xy, dtype=np.float64)
    length = np.hypot(way[:, 0], way[:, 1])
    return VectorSeries(
        name, tail, head, unwrapped(np.arctan2(way[:, 1], way[:, 0])), vml_angle_deg(way), length, change_pct(length)
    )


def unwrapped(angle_rad: FloatArray) -> FloatArray:
    """Take out jumps of whole turns, also across frames that are NaN."""
    seen = np.isfinite(angle_rad)
    result = np.full_like(angle_rad, np.nan)
    result[seen] = np.unwrap(angle_rad[seen])
    return result


def vml_angle_deg(way: FloatArray) -> FloatArray:
    """Return the angle to the unit x vector by the inner product, 0 to 180 degrees: it knows no sign.

    The original VML exports this angle (its paper, section 4.2); near 0 and 180 it is blunt.
    """
    length = np.hypot(way[:, 0], way[:, 1])
    cosine = np.divide(way[:, 0], length, out=np.full_like(length, np.nan), where=length > 0)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def change_pct(length: FloatArray) -> FloatArray:
    """Return the change of a length since the first frame in which it was seen, in percent."""
    seen = length[np.isfinite(length)]
    if not len(seen) or seen[0] == 0:
        return np.full_like(length, np.nan)
    return np.asarray(100.0 * (length / seen[0] - 1.0))
