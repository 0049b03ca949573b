"""A large speckled plate with a round hole is pulled: strain gathers beside the hole."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.quantity import quantity
from vml_course.model.truth import Check
from vml_course.synth.kirsch import Kirsch
from vml_course.synth.sheet import Sheet

RULER_M = 0.1
CONCENTRATION = 3.0
FREE = 1e-9  # of the remote stress
RIM = 720


@dataclass(frozen=True)
class PlateWithHole(Sheet):
    """The middle of a plate that is far larger than the picture; the hole's middle is the world's origin."""

    name: ClassVar[str] = "plate_with_hole"
    title: ClassVar[str] = "A large speckled plate with a round hole is pulled"
    story: ClassVar[str] = (
        "The middle of a large plastic plate with a round hole of radius R, sprayed with speckle, is pulled along x by "
        "the stress S, far from the hole; Young's modulus is E, Poisson's ratio nu. The load rises, is held, and goes "
        "back. Track the speckle beside the hole, above and below it, and far away: find the strain eps far away at "
        "full load, and how many times it is exceeded at the hole: the stress concentration Kt, for there nothing "
        "presses across and the stress is E times the strain. The marks a and b left and right of the hole, c and d "
        "above and below it, tell how the hole becomes an ellipse; e and f, g and h are far away."
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "Kt": "stress concentration: greatest stress at the hole over remote stress",
        "eps": "strain far from the hole, at full load",
    }
    default_camera: ClassVar[Camera] = Camera(fps=30.0, px_per_m=5000.0, origin_x_px=640.0, origin_y_px=330.0)
    bodies: ClassVar[tuple[str, ...]] = ("ruler",)

    stress_Pa: float = quantity(24e6, "Pa", 2e6, 40e6, symbol="S", about="stress far from the hole, at full load")  # noqa: N815
    modulus_Pa: float = quantity(2.4e9, "Pa", 2e9, 4e9, symbol="E", about="Young's modulus")  # noqa: N815
    poisson: float = quantity(0.37, "", 0.0, 0.5, symbol="nu", about="Poisson's ratio")
    radius_m: float = quantity(0.02, "m", 0.012, 0.03, symbol="R", about="radius of the hole, before loading")

    @property
    def field(self) -> Kirsch:
        """The field at full load."""
        return Kirsch(self.radius_m, self.stress_Pa, self.modulus_Pa, self.poisson)

    def displacement_m(self, xy_m: FloatArray) -> FloatArray:
        """Return the displacement at full load; the hole's middle stays."""
        return self.field.displacement_m(xy_m)

    def gradient(self, xy_m: FloatArray) -> FloatArray:
        """Return the displacement gradient, outside the hole."""
        return self.field.gradient(xy_m)

    def points_m(self) -> dict[str, tuple[float, float]]:
        """Return two pairs at the hole, and two pairs far away."""
        near, far, up = self.radius_m + 0.006, 0.11, 0.05  # a block of the usual size does not see the hole
        return {
            "a": (-near, 0.0), "b": (near, 0.0), "c": (0.0, near), "d": (0.0, -near),
            "e": (-far, up), "f": (far, up), "g": (-far, -0.6 * up), "h": (far, -0.6 * up),
        }  # fmt: skip

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the ruler, 100 mm apart."""
        return {"ruler_left": (-0.05, -0.065), "ruler_right": (-0.05 + RULER_M, -0.065)}

    def given(self) -> dict[str, float]:
        """Return load, material and hole."""
        return {"S": self.stress_Pa, "E": self.modulus_Pa, "nu": self.poisson, "R": self.radius_m}

    def looked_for(self) -> dict[str, float]:
        """Return the stress concentration, and the strain far from the hole."""
        return {"Kt": CONCENTRATION, "eps": self.stress_Pa / self.modulus_Pa}

    def own_checks(self) -> Iterator[Check]:
        """Yield that nothing presses on the hole, that stress gathers as it should, and what shape the hole takes."""
        angle = np.linspace(0.0, 2 * np.pi, RIM, endpoint=False)
        normal = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        rim_m, field = self.radius_m * normal, self.field
        xx, yy, xy = np.moveaxis(field.stress_of(field.gradient(rim_m)), -1, 0) / self.stress_Pa
        x, y = normal.T
        yield Check("traction on the hole, of the remote stress", _most(xx * x + xy * y, xy * x + yy * y), FREE)
        hoop = xx * y**2 + yy * x**2 - 2 * xy * x * y
        yield Check("stress concentration against 3", abs(float(hoop.max()) - CONCENTRATION), FREE)
        stated = field.stress(rim_m) / self.stress_Pa
        yield Check(
            "stress against Hooke's law, of the remote stress", _most(stated - np.stack([xx, yy, xy], -1)), FREE
        )
        ellipse = rim_m * (1 + self.stress_Pa / self.modulus_Pa * np.array([3.0, -1.0]))
        off = _most(self.place_unmoved(rim_m) - ellipse) / self.radius_m
        yield Check("shape of the hole against an ellipse, of its radius", off, FREE)

    def place_unmoved(self, xy_m: FloatArray) -> FloatArray:
        """Return where points are at full load, without slip and turn."""
        return xy_m + self.displacement_m(xy_m)

    def rigid_pose(self, load: FloatArray) -> FloatArray:
        """Return where the ruler lies, which is still."""
        return np.broadcast_to([*self.marks_m()["ruler_left"], 0.0], (len(load), 1, 3))


def _most(*values: FloatArray) -> float:
    return float(max(np.abs(value).max() for value in values))
