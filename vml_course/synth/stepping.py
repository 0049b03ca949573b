"""The loop that every scene runs in: leap-frog steps, and a recorder at the contact.

Leap-frog: a body's velocity lives half a step ahead of its position, and the torque is taken at the angle
that the body will have when pymunk adds it. That makes the swing accurate to a millionth of a pixel where
the plain loop loses half a pixel. In the step of the impact the torque waits: the recorder brings the
velocity to the time of the impact, takes the torque away, and the loop gives it back afterwards. So the
states before and after differ by the impact alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pymunk

from vml_course.model.arrays import FloatArray
from vml_course.synth.clock import Clock
from vml_course.synth.stage import Stage


@dataclass(frozen=True)
class State:
    """Velocities of striker and ball at one instant, and the striker's angle."""

    angle_rad: float
    omega_rad_s: float
    ball_m_s: tuple[float, float]
    ball_spin_rad_s: float


@dataclass(frozen=True)
class Contact:
    """The first contact step; the normal points from the striker to the ball, the impulse acts on the ball."""

    step: int
    point_m: tuple[float, float]
    normal: tuple[float, float]
    impulse_N_s: tuple[float, float]  # noqa: N815 - the unit is newton second
    before: State
    after: State


@dataclass(frozen=True, eq=False)
class Run:
    """What a simulation gave: the logged poses of the bodies, shape (n, b, 3), and the contact."""

    pose: FloatArray
    contact: Contact | None
    episodes: int
    other_contacts: int
    later_impulse_N_s: float  # noqa: N815
    end: State


@dataclass
class _Recorder:
    """Listens to pymunk's collisions; knows the step that is being made."""

    stage: Stage
    half_step_s: float
    step: int = 0
    episodes: int = 0
    others: int = 0
    later: float = 0.0
    first: dict[str, Any] = field(default_factory=dict)

    def begin(self, arbiter: pymunk.Arbiter, *_: object) -> None:
        if self._is_ours(arbiter):
            self.episodes += 1
        else:
            self.others += 1

    def pre_solve(self, arbiter: pymunk.Arbiter, *_: object) -> None:
        if self.first or not self._is_ours(arbiter):
            return
        striker, sign = self.stage.striker, self._sign(arbiter)
        half_kick(self.stage, self.half_step_s, ball=False)
        striker.torque = 0.0
        points = arbiter.contact_point_set
        self.first = {
            "step": self.step,
            "point_m": tuple((points.points[0].point_a + points.points[0].point_b) / 2),
            "normal": tuple(sign * points.normal),
            "before": state_of(self.stage),
        }

    def post_solve(self, arbiter: pymunk.Arbiter, *_: object) -> None:
        if not self._is_ours(arbiter):
            return
        impulse = -self._sign(arbiter) * arbiter.total_impulse  # pymunk tells what acts on the first shape
        if "after" in self.first:
            self.later += impulse.length
        else:
            self.first |= {"impulse_N_s": tuple(impulse), "after": state_of(self.stage)}

    def _is_ours(self, arbiter: pymunk.Arbiter) -> bool:
        return set(arbiter.shapes) == {self.stage.head, self.stage.ball}

    def _sign(self, arbiter: pymunk.Arbiter) -> int:
        return 1 if arbiter.shapes[0] is self.stage.head else -1


def run_stage(stage: Stage, clock: Clock, log_every: int | None = None) -> Run:
    """Step a stage through a clip and log the poses of its bodies in every frame, or every so many steps."""
    dt, log_every = clock.step_s, log_every or clock.steps_per_frame
    recorder = _Recorder(stage, dt / 2)
    stage.space.on_collision(begin=recorder.begin, pre_solve=recorder.pre_solve, post_solve=recorder.post_solve)
    poses = [_poses(stage)]
    half_kick(stage, dt / 2, ball=False)
    for step in range(1, (clock.frame_count - 1) * clock.steps_per_frame + 1):
        _advance(stage, recorder, step, dt)
        if step % log_every == 0:
            poses.append(_poses(stage))
    half_kick(stage, -dt / 2, ball=bool(recorder.first))
    contact = Contact(**recorder.first) if recorder.first else None
    return Run(np.array(poses), contact, recorder.episodes, recorder.others, recorder.later, state_of(stage))


def _advance(stage: Stage, recorder: _Recorder, step: int, dt: float) -> None:
    striker, was_struck = stage.striker, bool(recorder.first)
    striker.torque = stage.torque(striker.angle + striker.angular_velocity * dt)
    if was_struck:
        stage.struck.force = stage.weight_N
    recorder.step = step
    stage.space.step(dt)
    if recorder.first and not was_struck:
        half_kick(stage, dt / 2, ball=True)


def half_kick(stage: Stage, time_s: float, *, ball: bool) -> None:
    """Change the velocities by what torque and, for a struck ball, weight do in `time_s`."""
    striker, struck = stage.striker, stage.struck
    striker.angular_velocity += stage.torque(striker.angle) * time_s / striker.moment
    if ball:
        struck.velocity += pymunk.Vec2d(*stage.weight_N) * (time_s / struck.mass)


def state_of(stage: Stage) -> State:
    """Return the velocities as pymunk holds them."""
    striker, ball = stage.striker, stage.struck
    return State(striker.angle, striker.angular_velocity, (ball.velocity.x, ball.velocity.y), ball.angular_velocity)


def _poses(stage: Stage) -> list[tuple[float, float, float]]:
    return [(*body.position, body.angle) for body in (stage.striker, stage.struck)]
