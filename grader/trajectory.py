"""A student's tracking table laid over the true trajectory: scale, time lag, axis direction, and what remains.

The table is in metres about an origin of the student's choice, so only its shape can be compared: a common
scale, shift and time lag are fitted, then the remaining distance is measured in pixels of the video.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from assignments.model import AnswerKey
from vml_course.model.arrays import FloatArray

LEAST_ROWS = 10
LARGEST_LAG = 12.0  # frames
SCALE_SLIP = 0.02  # relative error of a scale that is one
CLEAR_SDS = 5.0  # a delay is one when the fit without it is so much worse
_FINE = 0.05  # frames
HOPELESS, CLEARLY = 0.05, 0.2
"""Points are tried the other way round when the rest is more than this part of their paths, and that must be so much
better."""

Signs = tuple[float, float]
"""The directions of x and y in a table: 1, or -1 where it is turned round."""

_SIGNS: tuple[Signs, ...] = ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0))


@dataclass(frozen=True, eq=False)
class TrajectoryFit:
    """How a table fits the truth.

    Attributes
    ----------
    points : tuple of str
    frame : float array, shape (n,)
    rms_px : float
        Root mean square distance in the picture, after scale, shift and lag.
    scale_ratio : float
        The table's metres over true metres: 1 when calibrated, `px_per_m` when still in pixels.
    lag_frames, lag_s : float
        By how many frames the table is late, and by how many seconds.
    y_down, x_left : bool
        Whether y was left pointing down, or x points to the left.
    swapped : tuple of str
        Two points whose columns were exchanged; () when none were.
    own_m, true_m : float array, shape (n, p, 2)
        Both in true metres, y up, about the picture's origin; NaN where the student has no number.
    """

    points: tuple[str, ...]
    frame: FloatArray
    time_s: FloatArray
    rms_px: float
    scale_ratio: float
    lag_frames: float
    y_down: bool
    own_m: FloatArray
    true_m: FloatArray
    x_left: bool = False
    swapped: tuple[str, ...] = ()
    lag_s: float = 0.0

    @property
    def is_off_scale(self) -> bool:
        """Whether the scale is a slip, no error of measurement."""
        return abs(self.scale_ratio - 1.0) > SCALE_SLIP

    @property
    def clip_frame(self) -> FloatArray:
        """The frames by the count of the clip itself, shape (n,)."""
        return self.frame - self.lag_frames

    @property
    def clip_time_s(self) -> FloatArray:
        """The times since the clip's first frame, shape (n,)."""
        return self.time_s - self.lag_s


@dataclass(frozen=True, eq=False)
class _Trial:
    lag: float
    signs: Signs
    scale: float
    shift: FloatArray
    rms: float


_FINER = ((0.25, 1.0), (_FINE, 0.25))


@dataclass(frozen=True)
class _Search:
    """Where the delay of a table is looked for: around `start`, in steps over a reach, ever finer; frames.

    `least` rows must lie within the clip.
    """

    start: float = 0.0
    steps: tuple[tuple[float, float], ...] = ((1.0, LARGEST_LAG), *_FINER)
    least: float = LEAST_ROWS


def fit_trajectory(
    tracking: Mapping[str, FloatArray], key: AnswerKey, lag_frames: float | None = None, *, is_far_tried: bool = False
) -> TrajectoryFit | None:
    """Fit a tracking table to the truth; None when the table has too little to compare.

    Parameters
    ----------
    tracking : mapping of str to float array, shape (n,)
        Columns `frame` (or `t_s`) and `<point>_x_m`, `<point>_y_m`.
    key : AnswerKey
    lag_frames : float, optional
        The delay, where an earlier fit has found it.
    is_far_tried : bool
        Whether delays up to the length of the clip are tried where smaller ones do not fit, as of a table that counts
        frames from the impact or from another film.
    """
    px_per_m = key.truth["px_per_m"]
    frame, points, own = _table(tracking, key)
    true_m = key.xy_px * np.array([1.0, -1.0]) / px_per_m
    if _rows(own).sum() < LEAST_ROWS:
        return None
    truth = true_m[:, [key.points.index(point) for point in points]]
    true_frame = key.frame.astype(float)
    search = _Search() if lag_frames is None else _Search(lag_frames, ((1.0, 0.0),))
    best, order = _best_order(frame, own, true_frame, truth, search)
    if is_far_tried and _is_hopeless(best, truth):
        far = _best(frame, own, true_frame, truth, _far(frame, own, true_frame))
        if far is not None and (best is None or far.rms < CLEARLY * best.rms):
            best, order = far, list(range(len(points)))
    if best is None:
        return None
    best = _not_late(best, own[:, order], _shifted(true_frame, truth, frame)) if lag_frames is None else best
    return TrajectoryFit(
        points=points,
        frame=frame,
        time_s=frame / key.truth["fps"],
        rms_px=best.rms * px_per_m,
        scale_ratio=1.0 / best.scale,
        lag_frames=best.lag,
        y_down=best.signs[1] < 0,
        own_m=own[:, order] * np.array(best.signs) * best.scale + best.shift,
        true_m=_shifted(true_frame, truth, frame - best.lag),
        x_left=best.signs[0] < 0,
        swapped=tuple(point for k, point in enumerate(points) if order[k] != k),
        lag_s=best.lag / key.truth["fps"],
    )


def _best_order(
    frame: FloatArray, own: FloatArray, true_frame: FloatArray, truth: FloatArray, search: _Search
) -> tuple[_Trial | None, list[int]]:
    """Fit the points as they are named; where that is hopeless, with two of them exchanged."""
    usual = list(range(own.shape[1]))
    best, order = _best(frame, own, true_frame, truth, search), usual
    if not _is_hopeless(best, truth):
        return best, usual
    for one, other in itertools.combinations(usual, 2):
        exchanged = [{one: other, other: one}.get(k, k) for k in usual]
        trial = _best(frame, own[:, exchanged], true_frame, truth, search)
        if trial is not None and (best is None or trial.rms < CLEARLY * best.rms):
            best, order = trial, exchanged
    return best, order


def _is_hopeless(best: _Trial | None, truth: FloatArray) -> bool:
    return best is None or best.rms > HOPELESS * float(np.nanstd(truth, axis=0).max())


def _far(frame: FloatArray, own: FloatArray, true_frame: FloatArray) -> _Search:
    """Search all delays at which half of the table lies within the clip: its middle row does so, too."""
    used = frame[_rows(own)]
    centre = np.round(np.median(used) - np.median(true_frame))
    return _Search(float(centre), ((1.0, true_frame.size // 2), *_FINER), max(LEAST_ROWS, used.size / 2))


def _not_late(best: _Trial, own: FloatArray, at: FloatArray) -> _Trial:
    """Return the fit without a delay, where noise could feign the one that was found."""
    usual = next(_trials(0.0, (best.signs,), own, at, LEAST_ROWS), None)
    if usual is None:
        return best
    numbers = 2 * int(np.isfinite(own).all(axis=2).sum())
    gain = numbers * (usual.rms**2 - best.rms**2)
    return usual if gain <= CLEAR_SDS**2 * best.rms**2 else best


def _rows(own: FloatArray) -> np.ndarray:
    """Tell which rows hold at least one whole point."""
    return np.asarray(np.any(np.isfinite(own).all(axis=2), axis=1))


def _table(tracking: Mapping[str, FloatArray], key: AnswerKey) -> tuple[FloatArray, tuple[str, ...], FloatArray]:
    points = tuple(p for p in key.points if {f"{p}_x_m", f"{p}_y_m"} <= tracking.keys())
    frame = tracking.get("frame")
    if frame is None and "t_s" in tracking:
        frame = tracking["t_s"] * key.truth["fps"]
    if frame is None or not points:
        return np.empty(0), (), np.empty((0, 0, 2))
    own = np.stack([np.stack([tracking[f"{p}_x_m"], tracking[f"{p}_y_m"]], axis=1) for p in points], axis=1)
    kept = (
        np.isfinite(frame) & (np.abs(np.nan_to_num(frame)) < 1e7) & (np.abs(np.nan_to_num(own)) < 1e9).all(axis=(1, 2))
    )
    order = np.argsort(frame[kept], kind="stable")
    return frame[kept][order], points, own[kept][order]


def _best(
    frame: FloatArray, own: FloatArray, true_frame: FloatArray, truth: FloatArray, search: _Search
) -> _Trial | None:
    """Search the lag coarsely, then finely, for all directions of both axes."""
    best: _Trial | None = None
    for step, reach in search.steps:
        centre, signs = (best.lag, (best.signs,)) if best else (search.start, _SIGNS)
        for lag in np.arange(centre - reach, centre + reach + step / 2, step):
            at = _shifted(true_frame, truth, frame - lag)
            for trial in _trials(float(lag), signs, own, at, search.least):
                if best is None or trial.rms < best.rms:
                    best = trial
    return best


def _shifted(true_frame: FloatArray, truth: FloatArray, at: FloatArray) -> FloatArray:
    """Return the true positions at fractional frames, NaN outside the clip."""
    result = np.full((at.size, *truth.shape[1:]), np.nan)
    for p in range(truth.shape[1]):
        for axis in range(2):
            result[:, p, axis] = np.interp(at, true_frame, truth[:, p, axis], left=np.nan, right=np.nan)
    return result


def _trials(
    lag: float, directions: Iterable[Signs], own: FloatArray, truth: FloatArray, least: float
) -> Iterator[_Trial]:
    """Fit one scale and one shift by least squares for each direction of the axes: truth = scale * own + shift."""
    seen = np.isfinite(own).all(axis=2) & np.isfinite(truth).all(axis=2)
    if np.any(seen, axis=1).sum() < least:
        return
    a, b = own[seen], truth[seen]
    a_mean, b_mean = a.mean(axis=0), b.mean(axis=0)
    a0, b0 = a - a_mean, b - b_mean
    spread, along = float((a0**2).sum()), (a0 * b0).sum(axis=0)
    for signs in directions:
        scale = float(along @ np.array(signs)) / spread if spread > 0 else 0.0
        if scale > 0:
            turned = scale * np.array(signs)
            rms = float(np.sqrt(((a0 * turned - b0) ** 2).sum(axis=1).mean()))
            yield _Trial(lag, signs, scale, b_mean - turned * a_mean, rms)
