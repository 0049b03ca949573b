"""What a solver says: values with their uncertainty."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from vml_course.model.arrays import Axes, FloatArray, set_frozen
from vml_course.model.motion import Motion


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value, one standard deviation, and the unit of both."""

    value: float
    sd: float
    unit: str = ""


@dataclass(frozen=True, eq=False)
class Kinematics:
    """Positions and their derivatives, never taken across an event.

    Attributes
    ----------
    points : tuple of str
    time_s : float array, shape (n,)
    position_m, velocity_m_s, acceleration_m_s2 : float array, shape (n, p, 2)
        y up; NaN where not measured or inside a contact.
    velocity_sd_m_s, acceleration_sd_m_s2 : float array, shape (n, p)
        One standard deviation of a component.
    """

    points: tuple[str, ...]
    time_s: FloatArray
    position_m: FloatArray
    velocity_m_s: FloatArray
    acceleration_m_s2: FloatArray
    velocity_sd_m_s: FloatArray
    acceleration_sd_m_s2: FloatArray

    def __post_init__(self) -> None:
        axes, p = Axes(), len(self.points)
        set_frozen(self, time_s=axes.freeze("time_s", self.time_s, "n"))
        for name in ("position_m", "velocity_m_s", "acceleration_m_s2"):
            set_frozen(self, **{name: axes.freeze(name, getattr(self, name), "n", p, 2)})
        for name in ("velocity_sd_m_s", "acceleration_sd_m_s2"):
            set_frozen(self, **{name: axes.freeze(name, getattr(self, name), "n", p)})


@dataclass(frozen=True)
class ImpactSolution:
    """What was found out of an impact.

    Attributes
    ----------
    model : str
        Name of the impact model.
    method : str
        "joint" (reference: joint least squares) or "lines" (the student's: straight lines each side).
    estimates : mapping of str to Estimate
        By symbol, SI units: `e`, `I`, `omega1`, `omega2`, `v_f1`, `v_f2`, `v_b1`, `v_b2`, `J`, `t_impact`,
        `loss` ... (v_f = foot speed along its path, v_b = ball speed; 1 before, 2 after).
    correlation_e_I : float
        Correlation coefficient of e and I (NaN when the method gives none).
    frame_before : int
        Last source frame before the impact.
    notes : tuple of str
        What a person should know: pivot away from the knee mark, correlated residuals, few frames ...
    figures : mapping of str to float
        Diagnostics: residual_rms_m, residual_lag1, knee_offset_m, r, frames_before, frames_after ...
    covariance : float array, shape (k, k)
        Of all estimates in their order, in SI units; shape (0, 0) when the method gives none.
    fitted : Motion or None
        Where the model puts the points in the frames that were fitted, NaN elsewhere.
    """

    model: str
    method: str
    estimates: Mapping[str, Estimate]
    correlation_e_I: float  # noqa: N815 - I is the symbol of the moment of inertia
    frame_before: int
    notes: tuple[str, ...] = ()
    figures: Mapping[str, float] = field(default_factory=dict)
    covariance: FloatArray = field(default_factory=lambda: np.zeros((0, 0)), compare=False)
    fitted: Motion | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        set_frozen(self, covariance=Axes().freeze("covariance", self.covariance, "k", "k"))

    def value(self, symbol: str) -> float:
        """Return one value by its symbol."""
        return self.estimates[symbol].value
