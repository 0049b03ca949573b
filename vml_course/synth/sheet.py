"""A body that is strained while one watches: what such a scene is.

Nothing is hit and nothing is simulated step by step: a sheet follows a known displacement field, in proportion to a
load that rises, is held and goes back, so slowly that no mass matters. What the field is, is its closed form.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.quantity import quantity
from vml_course.model.truth import Check
from vml_course.synth.scene import AnyScene

RISE = 0.5  # the part of a load step in which the load rises; then it is held, as one does to take a reading
CLOSE_M = 1e-10
MOST_ROUNDS = 60


@dataclass(frozen=True)
class Sheet(AnyScene):
    """Base of all scenes in which a body is strained; places are in metres, y up, before loading.

    To add one, write a file in `synth/scenes` with one subclass: a frozen dataclass with the class attributes of
    `AnyScene` and those below, its fields by `quantity()`, and the abstract methods; and a file of the scene's name in
    `synth/looks` that draws it.

    Attributes
    ----------
    bodies : tuple of str
        What is rigid and lies over the sheet: grips, a ruler.
    """

    bodies: ClassVar[tuple[str, ...]]

    rest_s: float = quantity(0.2, "s", 0.1, 5.0, about="time shown before loading")
    ramp_s: float = quantity(0.8, "s", 0.2, 10.0, about="time in which the load rises")
    hold_s: float = quantity(0.4, "s", 0.1, 10.0, about="time at full load")
    unload_s: float = quantity(0.6, "s", 0.2, 10.0, about="time in which the load goes back to nothing")
    load_steps: float = quantity(
        1, "", 1, 10, whole=True, about="steps in which the load rises; with 2 or more, each is held half its time"
    )
    slip_m: float = quantity(0.0, "m", -0.003, 0.003, about="how far the sheet slides as a whole, at full load")
    turn_deg: float = quantity(0.0, "deg", -1.0, 1.0, about="how far the sheet turns as a whole, at full load")
    speckle: float = quantity(1.0, "", 0.1, 1.0, about="contrast of the speckle; 1 is black on white")
    speckle_px: float = quantity(4.0, "px", 2.5, 10.0, about="diameter of the speckle's dots")

    @abstractmethod
    def displacement_m(self, xy_m: FloatArray) -> FloatArray:
        """Return the displacement at full load: shape (..., 2) -> (..., 2)."""

    @abstractmethod
    def gradient(self, xy_m: FloatArray) -> FloatArray:
        """Return the displacement gradient du_i / dX_j at full load: shape (..., 2) -> (..., 2, 2)."""

    @abstractmethod
    def points_m(self) -> dict[str, tuple[float, float]]:
        """Return the points to track."""

    @abstractmethod
    def looked_for(self) -> dict[str, float]:
        """Return the true value of every unknown, at full load."""

    @abstractmethod
    def own_checks(self) -> Iterable[Check]:
        """Yield what holds for this field beside what holds for all: equilibrium, what is looked for."""

    @abstractmethod
    def rigid_pose(self, load: FloatArray) -> FloatArray:
        """Return where the rigid bodies are at some loads: shape (n,) -> (n, b, 3); m, m, rad."""

    @property
    def length_s(self) -> float:
        """How long the clip is."""
        return self.rest_s + self.ramp_s + self.hold_s + self.unload_s

    def frame_s(self, fps: float) -> FloatArray:
        """Return the time of every frame, shape (n,)."""
        return np.arange(math.floor(self.length_s * fps + 1e-9) + 1) / fps

    def history(self, time_s: FloatArray) -> FloatArray:
        """Return the load at some times as a part of the full one, 0 to 1; of straight pieces."""
        steps = int(self.load_steps)
        share = 1.0 if steps == 1 else RISE
        time, load = [0.0, self.rest_s], [0.0, 0.0]
        for step in range(steps):
            time += [self.rest_s + (step + part) * self.ramp_s / steps for part in (share, 1.0)]
            load += [(step + 1) / steps] * 2
        time += [self.rest_s + self.ramp_s + self.hold_s, self.length_s]
        return np.asarray(np.interp(time_s, time, [*load, 1.0, 0.0]))

    def place(self, xy_m: FloatArray, load: FloatArray | float) -> FloatArray:
        """Return where points are under a load: strained, then turned about the origin, then slid along x.

        Parameters
        ----------
        xy_m : float array, shape (..., 2)
        load : float array or float
            Of a shape that goes with that of the points, without its last axis.
        """
        placed = _plane(xy_m) + load * _plane(self.displacement_m(xy_m))
        return _pairs(placed * self._turned(load) + load * self.slip_m)

    def origin_of(self, xy_m: FloatArray, load: float) -> FloatArray:
        """Return which points lie at some places under a load: the way back of `place`, by fixed-point iteration.

        The displacements differ by far less than the places do (strains are a few hundredths), so that every round
        adds a digit or more.
        """
        straight = _pairs((_plane(xy_m) - load * self.slip_m) / self._turned(load))
        found = straight
        for _ in range(MOST_ROUNDS):
            before, found = found, straight - load * self.displacement_m(found)
            if float(np.abs(found - before).max()) < CLOSE_M:
                break
        return found

    def whole_gradient(self, xy_m: FloatArray, load: FloatArray) -> FloatArray:
        """Return the gradient of `place`, less the identity, at p points and n loads: shape (n, p, 2, 2)."""
        turn = self._turned(load)
        c, s, one = turn.real, turn.imag, np.eye(2)
        rotation = np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)
        stretched = one + load[:, None, None, None] * self.gradient(xy_m)
        return np.asarray(rotation[:, None] @ stretched - one)

    def _turned(self, load: FloatArray | float) -> FloatArray:
        return np.asarray(np.exp(1j * math.radians(self.turn_deg) * np.asarray(load)))


def _plane(xy: FloatArray) -> FloatArray:
    return np.asarray(xy[..., 0] + 1j * xy[..., 1])


def _pairs(z: FloatArray) -> FloatArray:
    return np.stack([z.real, z.imag], axis=-1)
