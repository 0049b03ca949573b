"""A speckled strip is pulled in a testing machine: the same strain everywhere between the grips."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.quantity import quantity
from vml_course.model.truth import Check
from vml_course.synth.sheet import Sheet

GRIP_M = 0.018  # half the length of a grip
HELD_M = 0.012  # of the strip, in each grip
RULER_M = 0.1
REALISED = 1e-9


@dataclass(frozen=True)
class TensileStrip(Sheet):
    """A strip along x, its middle the world's origin; the left grip is still, the right one pulls."""

    name: ClassVar[str] = "tensile_strip"
    title: ClassVar[str] = "A speckled strip is pulled in a testing machine"
    story: ClassVar[str] = (
        "A strip of plastic, sprayed with speckle, is pulled along x: the load rises, is held, and goes back. The "
        "strip is W wide and L long between the grips; the ruler shows mm. Away from the grips the strain is the same "
        "everywhere. Track the marks a and b along the strip and c and d across it, and let their distances be "
        "extensometers: find the strain eps along the strip at full load, and from the strain across it "
        "Poisson's ratio nu. The mark e tells whether the strip slid in its grip."
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "eps": "engineering strain along the strip, at full load",
        "nu": "Poisson's ratio",
    }
    default_camera: ClassVar[Camera] = Camera(fps=30.0, px_per_m=5000.0, origin_x_px=620.0, origin_y_px=320.0)
    bodies: ClassVar[tuple[str, ...]] = ("left_grip", "right_grip", "ruler")

    strain: float = quantity(0.02, "", 0.001, 0.05, symbol="eps", about="strain along the strip at full load")
    poisson: float = quantity(0.38, "", 0.0, 0.5, symbol="nu", about="Poisson's ratio")
    length_m: float = quantity(0.16, "m", 0.14, 0.18, symbol="L", about="length between the grips, before loading")
    width_m: float = quantity(0.05, "m", 0.02, 0.06, symbol="W", about="width of the strip, before loading")

    def displacement_m(self, xy_m: FloatArray) -> FloatArray:
        """Return the displacement at full load; the strip's left end stays."""
        rest = np.array([-self.length_m / 2, 0.0])
        return np.asarray((xy_m - rest) * np.array([self.strain, -self.poisson * self.strain]))

    def gradient(self, xy_m: FloatArray) -> FloatArray:
        """Return the displacement gradient, the same everywhere."""
        whole = np.diag([self.strain, -self.poisson * self.strain])
        return np.broadcast_to(whole, (*xy_m.shape[:-1], 2, 2))

    def points_m(self) -> dict[str, tuple[float, float]]:
        """Return a pair along, a pair across, and one at the left grip."""
        along, across = 0.34 * self.length_m, 0.35 * self.width_m
        at_grip = -0.44 * self.length_m, 0.0
        return {"a": (-along, 0.0), "b": (along, 0.0), "c": (0.0, across), "d": (0.0, -across), "e": at_grip}

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the ruler, 100 mm apart."""
        y = -self.width_m / 2 - 0.012
        return {"ruler_left": (-0.05, y), "ruler_right": (-0.05 + RULER_M, y)}

    def given(self) -> dict[str, float]:
        """Return length and width."""
        return {"L": self.length_m, "W": self.width_m}

    def looked_for(self) -> dict[str, float]:
        """Return strain and Poisson's ratio."""
        return {"eps": self.strain, "nu": self.poisson}

    def own_checks(self) -> Iterator[Check]:
        """Yield that the marks, as extensometers, tell the strain and Poisson's ratio at every load."""
        load, points = np.linspace(0.0, 1.0, 11)[:, None], self.points_m()
        along, across = (np.array([points[name] for name in pair]) for pair in ("ab", "cd"))
        stretch, shrink = (_extension(self.place(pair, load)) for pair in (along, across))
        yield Check("strain from marks a, b", float(np.abs(stretch - load[:, 0] * self.strain).max()), REALISED)
        yield Check("strain from marks c, d", float(np.abs(shrink + self.poisson * stretch).max()), REALISED)

    def rigid_pose(self, load: FloatArray) -> FloatArray:
        """Return where grips and ruler are: the right grip moves by the strip's lengthening."""
        middle = self.length_m / 2 + GRIP_M
        x, y = self.marks_m()["ruler_left"]
        pose = np.zeros((len(load), 3, 3))
        pose[:, 0, 0], pose[:, 1, 0] = -middle, middle + load * self.strain * self.length_m
        pose[:, 2, 0], pose[:, 2, 1] = x, y
        return pose


def _extension(pair_m: FloatArray) -> FloatArray:
    """Return by which part two points are farther apart than without load: shape (n, 2, 2) -> (n,)."""
    length = np.hypot(*np.moveaxis(pair_m[:, 1] - pair_m[:, 0], -1, 0))
    return np.asarray(length / length[0] - 1.0)
