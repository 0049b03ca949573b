"""A pinned body that strikes a resting ball with a contact that lasts: a force law in place of an impulse.

Weight and drive wait during the contact, as they do in the step of an instantaneous impact; so the states before and
after differ by the contact alone. There is no pymunk here: a force at the end of each of its steps would add energy.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.errors import InputError
from vml_course.model.arrays import FloatArray
from vml_course.model.truth import Realised
from vml_course.synth.clock import Clock
from vml_course.synth.closed_form import swing
from vml_course.synth.law import Answer, Law, Movement
from vml_course.synth.laws.pinned import PinnedStrike
from vml_course.synth.laws.touch import Touch, as_movement, head_at, settle
from vml_course.synth.run import Contact, Run
from vml_course.synth.stage import Vector

MOST_TURN_RAD = 0.25  # of the striker while it touches: beyond, the foot slides off the ball
MOST_RESTITUTION = 0.95
SHORTEST_S = 1e-4  # a shorter one looks like an instant, and is stiff


@dataclass(frozen=True)
class SoftStrike(Law):
    """As `PinnedStrike`, with time 0 at touch-down; the ball lies at rest, level with the striker's lowest point.

    The normal is the direction of the whole impulse, the lever arm that of the whole impulse about the pivot.

    Attributes
    ----------
    rigid : PinnedStrike
        The same impact without duration.
    contact_s : float
        How long the contact would last if the striker did not turn; what it really lasts is in the truth.
    """

    rigid: PinnedStrike
    contact_s: float

    @property
    def touch(self) -> Touch:
        """The contact, found once."""
        return settle(self.rigid, self.contact_s)

    @property
    def duration_s(self) -> float:
        """How long the contact lasts."""
        return self.touch.duration_s

    @property
    def normal(self) -> Vector:  # type: ignore[override]
        """Direction of the whole impulse on the ball."""
        x, y = self.touch.impulse_N_s / np.hypot(*self.touch.impulse_N_s)
        return float(x), float(y)

    @property
    def arm_m(self) -> float:
        """Lever arm of the whole impulse."""
        return self.touch.moment_N_m_s / float(np.hypot(*self.touch.impulse_N_s))

    @property
    def ball_m(self) -> FloatArray:
        """Where the ball rests, shape (2,)."""
        return self.touch.start[1, :2]

    @property
    def mass(self) -> FloatArray:
        """As of the rigid impact."""
        return self.rigid.mass

    @property
    def before(self) -> FloatArray:
        """Velocities at touch-down."""
        return self.rigid.before

    def answer(self) -> Answer:
        """Return the velocities at separation, and the whole impulse."""
        return Answer(self.touch.rate_end, self.touch.impulse_N_s)

    def motion(self, time_s: FloatArray) -> Movement:
        """Return swing, contact, and swing and flight."""
        touch, strike = self.touch, self.rigid
        before, during = time_s <= 0, (time_s > 0) & (time_s <= touch.duration_s)
        after = time_s > touch.duration_s
        state = np.zeros((len(time_s), 6))
        early = swing(strike.inertia_kg_m2, strike.torque, _turning(touch.start, self.before), time_s[before][::-1])
        state[before, :2], state[before, 2:4] = early[::-1], touch.start[1, :2]
        if during.any():
            state[during] = touch.path(time_s[during])[:6].T
        later = time_s[after] - touch.duration_s
        state[after, :2] = swing(strike.inertia_kg_m2, strike.torque, _turning(touch.end, touch.rate_end), later)
        way, state[after, 4:] = strike.other.glide(touch.rate_end[1, :2], later, after=True)
        state[after, 2:4] = touch.end[1, :2] + way
        return as_movement(state)

    def potential(self, pose: FloatArray, *, after: bool) -> float:
        """Return the work of weights and drive since touch-down, or since separation."""
        level = (self.touch.end if after else self.touch.start).copy()
        shifted = pose.copy()
        shifted[1, :2] += self.rigid.ball_m - level[1, :2]
        level[1, :2] = self.rigid.ball_m
        return self.rigid.potential(shifted, after=after) - self.rigid.potential(level, after=after)

    def unknowns(self, run: Run) -> dict[str, Realised]:
        """Return e and I."""
        return self.rigid.unknowns(run)

    def run(self, clock: Clock, log_every: int | None = None) -> Run:
        """Integrate a clip by Runge-Kutta."""
        every = log_every or clock.steps_per_frame
        steps = np.arange(0, (clock.frame_count - 1) * clock.steps_per_frame + 1)
        moved = self.motion(np.asarray((steps - clock.impact_step) * clock.step_s, dtype=np.float64))
        touch, normal = self.touch, np.array(self.normal)
        beside = np.array([normal[1], -normal[0]])  # a point on the line of action, where head and ball meet
        head = head_at(self.rigid, float(touch.start[0, 2] + touch.end[0, 2]) / 2)
        point = self.arm_m * beside + (float(head @ normal) + self.rigid.head_radius_m) * normal
        contact = Contact(
            clock.impact_step, point, normal, touch.impulse_N_s, touch.end, self.before, touch.rate_end
        )  # fmt: skip
        touching = self._overlaps(moved.pose)
        episodes = int(np.count_nonzero(np.diff(touching.astype(int)) > 0)) + int(touching[0])
        return Run(moved.pose[::every], moved.rate[0], moved.rate[-1], contact, episodes, 0, 0.0)

    def _overlaps(self, pose: FloatArray) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Return in which of many poses the two touch; a hair is allowed at touch-down and separation."""
        heads = np.stack(head_at(self.rigid, pose[:, 0, 2]), axis=-1)
        gap = np.hypot(*(pose[:, 1, :2] - heads).T) - self.rigid.head_radius_m - self.rigid.other.radius_m
        return np.asarray(gap < -1e-9)


def soften(strike: PinnedStrike, contact_s: float) -> PinnedStrike | SoftStrike:
    """Return a strike whose contact lasts; the same strike where it lasts no time.

    Raises
    ------
    InputError
        When the striker would turn too far meanwhile, or would have to be driven to give so high a restitution.
    """
    if not contact_s:
        return strike
    if contact_s < SHORTEST_S:
        raise InputError("contact_ms", f"0 or at least {1e3 * SHORTEST_S:g} ms", f"{1e3 * contact_s:g} ms")
    longest = MOST_TURN_RAD / abs(strike.omega_before_rad_s)
    if contact_s > longest:
        wanted = f"at most {1e3 * longest:.3g} ms, in which the striker turns by {MOST_TURN_RAD:g} rad"
        raise InputError("contact_ms", wanted, f"{1e3 * contact_s:g} ms")
    if strike.restitution > MOST_RESTITUTION:
        wanted = f"at most {MOST_RESTITUTION:g} where the contact lasts"
        raise InputError("restitution (e)", wanted, f"{strike.restitution:g}")
    return SoftStrike(strike, contact_s)


def _turning(pose: FloatArray, rate: FloatArray) -> tuple[float, float]:
    return float(pose[0, 2]), float(rate[0, 2])
