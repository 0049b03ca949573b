"""What really happened in a simulated clip: the yardstick of every measurement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from vml_course.errors import InputError, UnknownNameError
from vml_course.model.arrays import Axes, FloatArray, set_frozen
from vml_course.model.camera import Camera
from vml_course.model.recording import Recording
from vml_course.model.strained import StrainTruth


@dataclass(frozen=True, slots=True)
class Check:
    """One honesty check of a simulation: `value` must not exceed `limit`."""

    name: str
    value: float
    limit: float

    @property
    def passed(self) -> bool:
        """Whether the value keeps its limit; NaN does not."""
        return bool(self.value <= self.limit)


@dataclass(frozen=True, slots=True)
class Realised:
    """One unknown of an impact, SI units: as the simulation realised it, twice, and as the parameters say."""

    from_states: float
    from_impulse: float
    nominal: float


@dataclass(frozen=True, eq=False)
class ImpactTruth:
    """The impact as it was realised, from the states around the first contact step.

    Signs: x right, y up, angular velocity counter-clockwise. The normal points from the striker to the struck
    body; `arm_m` is the signed lever arm of that normal about the striker's origin (its pivot, or its centre where
    it is free), so that a point of the striker at the contact approaches along the normal with `arm_m * omega`.

    Attributes
    ----------
    time_s : float
        Time of the impact on the clip's clock.
    frame_before : int
        Last frame that shows the state before the impact.
    contact_m, normal : float array, shape (2,)
    arm_m : float
    impulse_xy_N_s : float array, shape (2,)
        Contact impulse on the struck body.
    before, after : float array, shape (b, 3)
        Of every body: vx and vy of its origin in m/s, angular velocity in rad/s.
    mass : float array, shape (b, 3)
        What multiplies them in momentum and energy: kg, kg, kg m^2. A pinned body has no mass but its inertia about
        the pivot; what is not allowed to turn has no inertia.
    striker, struck : int
        Which of the bodies these are; the same one where a body meets the ground.
    unknowns : mapping of str to Realised
        What students look for, by the textbook's letter: `e`, `I`, ...
    duration_s : float
        How long the contact lasts, from `time_s` on; 0 is an instant.
    """

    time_s: float
    frame_before: int
    contact_m: FloatArray
    normal: FloatArray
    arm_m: float
    impulse_xy_N_s: FloatArray  # noqa: N815 - the unit is newton second
    before: FloatArray
    after: FloatArray
    mass: FloatArray
    striker: int
    struck: int
    unknowns: Mapping[str, Realised]
    duration_s: float = 0.0

    def __post_init__(self) -> None:
        axes = Axes()
        for name in ("contact_m", "normal", "impulse_xy_N_s"):
            set_frozen(self, **{name: axes.freeze(name, getattr(self, name), 2)})
        for name in ("before", "after", "mass"):
            set_frozen(self, **{name: axes.freeze(name, getattr(self, name), "b", 3)})

    def unknown(self, symbol: str) -> float:
        """Return the true value of an unknown, from the states before and after, SI units.

        Raises
        ------
        UnknownNameError
            When this impact has no such unknown.
        """
        if symbol not in self.unknowns:
            raise UnknownNameError("unknown", symbol, sorted(self.unknowns))
        return self.unknowns[symbol].from_states

    @property
    def impulse_N_s(self) -> float:  # noqa: N802 - the unit is newton second
        """Contact impulse along the normal, on the struck body."""
        return float(self.impulse_xy_N_s @ self.normal)

    @property
    def impulse_tangent_N_s(self) -> float:  # noqa: N802
        """Contact impulse across the normal, to its left, on the struck body."""
        return float(self.impulse_xy_N_s[1] * self.normal[0] - self.impulse_xy_N_s[0] * self.normal[1])

    @property
    def restitution(self) -> float:
        """The coefficient of restitution, where it is an unknown of this impact."""
        return self.unknown("e")

    @property
    def inertia_kg_m2(self) -> float:
        """The striker's inertia about its pivot or centre, where it is an unknown of this impact."""
        return self.unknown("I")

    @property
    def omega_before_rad_s(self) -> float:
        """The striker's angular velocity before the impact."""
        return float(self.before[self.striker, 2])

    @property
    def omega_after_rad_s(self) -> float:
        """The striker's angular velocity after the impact."""
        return float(self.after[self.striker, 2])

    @property
    def struck_before_m_s(self) -> FloatArray:
        """Velocity of the struck body's centre before the impact, shape (2,)."""
        return self.before[self.struck, :2]

    @property
    def struck_after_m_s(self) -> FloatArray:
        """Velocity of the struck body's centre after the impact, shape (2,)."""
        return self.after[self.struck, :2]

    @property
    def struck_mass_kg(self) -> float:
        """Mass of the struck body."""
        return float(self.mass[self.struck, 0])


@dataclass(frozen=True, eq=False)
class Truth:
    """Everything known of a simulated clip, exact to the simulation.

    Attributes
    ----------
    scene : str
        Name of the scene.
    parameters : mapping of str to float
        The scene's parameters, SI units.
    camera : Camera
    time_s : float array, shape (n,)
        Time of each frame's mid-exposure; the first frame is at 0.
    bodies : tuple of str
    pose : float array, shape (n, b, 3)
        x in m, y in m (y up), angle in rad (counter-clockwise), of each body in each frame.
    points : tuple of str
        The tracked points.
    xy_m : float array, shape (n, p, 2)
        Their positions, metres, y up.
    leg_angle_rad : float array, shape (n,)
        Angle of the striker's vector (pivot to striking point) from +x, unwrapped; nothing, shape (0,), where the
        scene has no such vector.
    marks_m : mapping of str to (float, float)
        Still points to calibrate with, such as both ends of the scale bar.
    impact : ImpactTruth or None
        None where nothing is hit but a body is strained.
    checks : tuple of Check
    versions : mapping of str to str
    model : str
        Name of the impact model in `kinetics` that solves this scene; "" where there is no impact.
    given : mapping of str to float
        What the solver is told, by symbol, SI units (`m`, `L`, ...).
    seed : int
    recording : Recording or None
        How the clip was stored, once it was; with it, the truth is enough to make every picture again.
    offset_px : float array, shape (n, 2)
        How far each frame is shifted by a camera that is held by hand; nothing in frame 0.
    declared : mapping of str to str, float or bool
        What the solver is told beside the given numbers, in the words of `kinetics.impact_model.ImpactOptions`.
    row_time_s : float array, shape (n, p)
    row_xy_px : float array, shape (n, p, 2)
    row_marks_px : float array, shape (n, m, 2)
        With a rolling shutter only, else empty: when the row is exposed in which each tracked point is seen
        (middle of the exposure), and where points and marks are seen then.
    strain : StrainTruth or None
        How a body is strained, where one is.
    """

    scene: str
    parameters: Mapping[str, float]
    camera: Camera
    time_s: FloatArray
    bodies: tuple[str, ...]
    pose: FloatArray
    points: tuple[str, ...]
    xy_m: FloatArray
    leg_angle_rad: FloatArray
    marks_m: Mapping[str, tuple[float, float]]
    impact: ImpactTruth | None
    checks: tuple[Check, ...]
    versions: Mapping[str, str]
    model: str
    given: Mapping[str, float]
    seed: int
    recording: Recording | None = None
    offset_px: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    declared: Mapping[str, str | float | bool] = field(default_factory=dict)
    row_time_s: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))
    row_xy_px: FloatArray = field(default_factory=lambda: np.zeros((0, 0, 2)))
    row_marks_px: FloatArray = field(default_factory=lambda: np.zeros((0, 0, 2)))
    strain: StrainTruth | None = None

    def __post_init__(self) -> None:
        axes = Axes()
        offset_px = self.offset_px if len(self.offset_px) else np.zeros((len(self.time_s), 2))
        set_frozen(
            self,
            time_s=axes.freeze("time_s", self.time_s, "n"),
            pose=axes.freeze("pose", self.pose, "n", len(self.bodies), 3),
            xy_m=axes.freeze("xy_m", self.xy_m, "n", len(self.points), 2),
            leg_angle_rad=axes.freeze("leg_angle_rad", self.leg_angle_rad, "n" if len(self.leg_angle_rad) else 0),
            offset_px=axes.freeze("offset_px", offset_px, "n", 2),
        )
        for name, shape in (
            ("row_time_s", (len(self.points),)),
            ("row_xy_px", (len(self.points), 2)),
            ("row_marks_px", (len(self.marks_m), 2)),
        ):
            values = np.asarray(getattr(self, name))
            full = values if len(values) else np.zeros((0, *shape))
            set_frozen(self, **{name: (axes if len(values) else Axes()).freeze(name, full, "n", *shape)})

    @property
    def met(self) -> ImpactTruth:
        """The impact of a clip that has one.

        Raises
        ------
        InputError
            When nothing is hit in this scene.
        """
        if self.impact is None:
            raise InputError(self.scene, "a scene with an impact", "one without", "Choose another scene.")
        return self.impact

    @property
    def seen_s(self) -> FloatArray:
        """When each tracked point is seen, shape (n, p): the frame's time, or with a rolling shutter its row's."""
        if len(self.row_time_s):
            return self.row_time_s
        return np.broadcast_to(self.time_s[:, None], self.xy_m.shape[:2])

    @property
    def xy_px(self) -> FloatArray:
        """Where the tracked points are seen: shape (n, p, 2), pixels, y down."""
        if len(self.row_xy_px):
            return self.row_xy_px
        return self.camera.to_px(self.xy_m) + self.offset_px[:, None]

    def mark_px(self, name: str, frame: int = 0) -> tuple[float, float]:
        """Return where a still mark is seen in one frame, in pixels."""
        if len(self.row_marks_px):
            x, y = self.row_marks_px[frame, list(self.marks_m).index(name)]
        else:
            x, y = self.camera.to_px(np.array(self.marks_m[name])) + self.offset_px[frame]
        return float(x), float(y)

    def point_index(self, name: str) -> int:
        """Return the column of a tracked point.

        Raises
        ------
        UnknownNameError
        """
        if name not in self.points:
            raise UnknownNameError("point", name, self.points)
        return self.points.index(name)

    def point_px(self, name: str, frame: int = 0) -> tuple[float, float]:
        """Return where a tracked point is seen in one frame, in pixels."""
        x, y = self.xy_px[frame, self.point_index(name)]
        return float(x), float(y)

    @property
    def leg_angle_deg(self) -> FloatArray:
        """The striker's angle in degrees, unwrapped, y up."""
        return np.degrees(self.leg_angle_rad)
