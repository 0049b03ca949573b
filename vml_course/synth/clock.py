"""When things happen in a clip: frames, the fine steps between them, and the impact."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray

STEPS_PER_FRAME = 100
LONGEST_STEP_S = 1 / 48000  # of a fast impact; longer steps leave the pixel tolerance (tests/synth measure it)


@dataclass(frozen=True, slots=True)
class Clock:
    """Whole numbers only, so that steps, frames and the impact never drift apart.

    Attributes
    ----------
    fps : float
    steps_per_frame : int
    frame_count : int
        Frame 0 is at time 0.
    impact_step : int
        The step at whose end the bodies meet.
    """

    fps: float
    steps_per_frame: int
    frame_count: int
    impact_step: int

    @property
    def step_s(self) -> float:
        """Length of a step; it divides the frame interval."""
        return 1.0 / (self.fps * self.steps_per_frame)

    @property
    def impact_s(self) -> float:
        """Time of the impact on the clip's clock."""
        return self.impact_step * self.step_s

    @property
    def frame_before(self) -> int:
        """Last frame that shows the state before the impact."""
        return self.impact_step // self.steps_per_frame

    @property
    def frame_s(self) -> FloatArray:
        """Time of every frame, shape (n,)."""
        return np.arange(self.frame_count) / self.fps

    @property
    def since_impact_s(self) -> FloatArray:
        """Time of every frame after the impact, shape (n,); exactly 0 on a frame that shows the contact."""
        steps = np.arange(self.frame_count) * self.steps_per_frame - self.impact_step
        return np.asarray(steps * self.step_s, dtype=np.float64)


def set_clock(
    fps: float, shown_s: tuple[float, float], phase: float, longest_step_s: float = LONGEST_STEP_S, refine: int = 1
) -> Clock:
    """Return the clock of a clip.

    Parameters
    ----------
    fps : float
        Frames per second.
    shown_s : (float, float)
        Time that is shown before and after the impact, at least.
    phase : float
        Where between two frames the impact falls: 0 on a frame, 0.5 half-way.
    longest_step_s : float
    refine : int
        Divides the step further; the default is fine enough, tests use more.
    """
    steps = refine * max(STEPS_PER_FRAME, math.ceil(1 / (longest_step_s * fps) - 1e-9))
    before = math.ceil(shown_s[0] * fps - 1e-9)
    after = math.ceil(phase + shown_s[1] * fps - 1e-9)
    return Clock(fps, steps, before + after + 1, before * steps + round(phase * steps))
