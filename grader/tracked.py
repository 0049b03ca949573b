"""What a student's tracking table says, once it has been laid over the truth and solved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from grader.trajectory import TrajectoryFit

LEAST_EACH_SIDE = 5  # rows

FARTHEST_PX = 4.0
"""A table that lies farther from the true path than this supports nothing."""


OUR_FAILURE = "the grader could not work with your tracking table"


@dataclass(frozen=True, eq=False)
class FromTable:
    """What follows from a tracking table.

    Attributes
    ----------
    fit : TrajectoryFit or None
        The table laid over the truth; None where there is no table.
    values, sds : mapping of str to float
        By question, SI units; one standard deviation where the solver knows it. Empty where it cannot be solved.
    is_corrected : bool
        Whether scale or axis were put right first.
    why_not : str
        Why there are no values.
    window_s : float
        The time each side of the impact that the reference fits.
    """

    fit: TrajectoryFit | None = None
    values: Mapping[str, float] = field(default_factory=dict)
    sds: Mapping[str, float] = field(default_factory=dict)
    is_corrected: bool = False
    why_not: str = "there is no tracking table"
    window_s: float = 0.040

    @property
    def is_near(self) -> bool:
        """Whether the table follows the true path."""
        return self.fit is not None and self.fit.rms_px <= FARTHEST_PX

    def rows(self, impact_s: float) -> tuple[int, int]:
        """Return how many rows are complete before and after the impact."""
        if self.fit is None:
            return 0, 0
        seen = np.isfinite(self.fit.own_m).all(axis=(1, 2))
        before = self.fit.clip_time_s < impact_s
        return int((seen & before).sum()), int((seen & ~before).sum())
