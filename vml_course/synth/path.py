"""Where the bodies are at any time of a clip, also between its frames.

The simulation is run once more with every fine step logged. Between two steps the way is straight: at
1/48000 s that leaves the true curve by less than 1e-4 px, and since the impact falls on the end of a step,
no straight piece leads across it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.synth.scene import Scene


@dataclass(frozen=True, eq=False)
class Path:
    """Poses at every fine step.

    Attributes
    ----------
    start_s, step_s : float
        Time of the first pose on the clip's clock, and between two.
    pose : float array, shape (n, b, 3)
        x in m, y in m (y up), angle in rad of each body.
    """

    start_s: float
    step_s: float
    pose: FloatArray

    def at(self, time_s: FloatArray) -> FloatArray:
        """Return the poses at some times, shape (k,) -> (k, b, 3)."""
        steps = np.clip((time_s - self.start_s) / self.step_s, 0.0, len(self.pose) - 1.0)
        before = np.minimum(steps.astype(np.int64), len(self.pose) - 2)
        part = (steps - before)[:, None, None]
        return np.asarray((1.0 - part) * self.pose[before] + part * self.pose[before + 1])


def fine_path(scene: Scene, fps: float) -> Path:
    """Return the motion of a scene from one frame before its clip to one frame after, for exposures reach there."""
    clock = scene.clock(fps)
    longer = replace(clock, frame_count=clock.frame_count + 2, impact_step=clock.impact_step + clock.steps_per_frame)
    return Path(-1.0 / fps, clock.step_s, scene.law().run(longer, log_every=1).pose)
