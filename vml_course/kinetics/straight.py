"""Straight lines through points in time: the arithmetic that events, lines and windows share.

Everything takes plain arrays without NaN; a "path" is one array of shape (n, d), d coordinates of one thing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Line:
    """A least-squares line x(t) = at + slope (t - middle).

    Attributes
    ----------
    middle : float
        Mean time of its points.
    at, slope : float array, shape (d,)
        Position at `middle`, and rate.
    spread : float
        Sum of squared distances of the times from their middle.
    count : int
    residual_sd : float
        Root of the residual sum of squares over the degrees of freedom, per coordinate.
    """

    middle: float
    at: FloatArray
    slope: FloatArray
    spread: float
    count: int
    residual_sd: float

    def position(self, time_s: FloatArray | float) -> FloatArray:
        """Return x(t), shape (..., d)."""
        return np.asarray(self.at + np.multiply.outer(np.asarray(time_s) - self.middle, self.slope))

    def slope_sd(self, sigma: float | None = None) -> float:
        """Return one standard deviation of a slope's component; `sigma` defaults to the scatter."""
        return (self.residual_sd if sigma is None else sigma) / float(np.sqrt(self.spread))

    def prediction_sd(self, time_s: float, sigma: float) -> float:
        """Return one standard deviation of a new measurement about the line at a time."""
        lever = (time_s - self.middle) ** 2 / self.spread
        return sigma * float(np.sqrt(1.0 + 1.0 / self.count + lever))


def fit_line(time_s: FloatArray, path: FloatArray) -> Line:
    """Fit a line to a path, shape (n, d), n >= 2 different times."""
    middle = float(np.mean(time_s))
    apart = time_s - middle
    at = np.mean(path, axis=0)
    spread = float(apart @ apart)
    slope = apart @ (path - at) / spread
    rest = path - at - np.multiply.outer(apart, slope)
    freedom = max(path.size - 2 * path.shape[1], 1)
    return Line(middle, at, slope, spread, len(time_s), float(np.sqrt(np.sum(rest**2) / freedom)))


def meeting_time(before: Line, after: Line) -> float:
    """Return the time at which two lines are nearest to each other: when the velocity changed.

    With d = slope_after - slope_before and c the difference of the positions at time 0, the distance
    |c + d t| is least at t = -c.d / d.d .
    """
    jump = after.slope - before.slope
    apart = after.position(0.0) - before.position(0.0)
    return float(-(apart @ jump) / (jump @ jump))
