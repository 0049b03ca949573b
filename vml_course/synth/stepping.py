"""The loop that every scene runs in: leap-frog steps, and a recorder at the contact.

Leap-frog: a body's velocity lives half a step ahead of its position, and the forces are taken at the angle
that the body will have when pymunk adds them. That makes a swing accurate to a millionth of a pixel where
the plain loop loses half a pixel. In the step of the impact the forces wait: the recorder brings the
velocities to the time of the impact and takes the forces away, and the loop gives them back afterwards. So the
states before and after differ by the impact alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pymunk

from vml_course.model.arrays import FloatArray
from vml_course.synth.clock import Clock
from vml_course.synth.run import Contact, Run
from vml_course.synth.stage import Push, Stage


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
        half_kick(self.stage, self.half_step_s, self.stage.before)
        for body in self.stage.bodies:
            body.force, body.torque = (0.0, 0.0), 0.0
        points = arbiter.contact_point_set
        self.first = {
            "step": self.step,
            "point_m": np.array((points.points[0].point_a + points.points[0].point_b) / 2),
            "normal": self._sign(arbiter) * np.array(points.normal),
            "pose": poses_of(self.stage),
            "before": rates_of(self.stage),
        }

    def post_solve(self, arbiter: pymunk.Arbiter, *_: object) -> None:
        if not self._is_ours(arbiter):
            return
        impulse = -self._sign(arbiter) * arbiter.total_impulse  # pymunk tells what acts on the first shape
        if "impulse_N_s" in self.first:
            self.later += impulse.length
        else:
            self.first["impulse_N_s"] = np.array(impulse)

    def _is_ours(self, arbiter: pymunk.Arbiter) -> bool:
        return set(arbiter.shapes) == set(self.stage.pair)

    def _sign(self, arbiter: pymunk.Arbiter) -> int:
        return 1 if arbiter.shapes[0] is self.stage.pair[0] else -1


def run_stage(stage: Stage, clock: Clock, log_every: int | None = None) -> Run:
    """Step a stage through a clip and log the poses of its bodies in every frame, or every so many steps."""
    dt, log_every = clock.step_s, log_every or clock.steps_per_frame
    recorder = _Recorder(stage, dt / 2)
    stage.space.on_collision(begin=recorder.begin, pre_solve=recorder.pre_solve, post_solve=recorder.post_solve)
    poses, start = [poses_of(stage)], rates_of(stage)
    half_kick(stage, dt / 2, stage.before)
    for step in range(1, (clock.frame_count - 1) * clock.steps_per_frame + 1):
        _advance(stage, recorder, step, dt)
        if step % log_every == 0:
            poses.append(poses_of(stage))
    half_kick(stage, -dt / 2, stage.after if recorder.first else stage.before)
    contact = Contact(**recorder.first) if recorder.first else None
    return Run(
        np.array(poses), start, rates_of(stage), contact, recorder.episodes, recorder.others, recorder.later
    )  # fmt: skip


def _advance(stage: Stage, recorder: _Recorder, step: int, dt: float) -> None:
    was_struck = bool(recorder.first)
    for body, push in zip(stage.bodies, stage.after if was_struck else stage.before, strict=True):
        if push:
            x, y, turn = push(body.angle + body.angular_velocity * dt, body.velocity, dt)
            if x or y:  # pymunk forgets both after every step
                body.force = (x, y)
            if turn:
                body.torque = turn
    recorder.step = step
    stage.space.step(dt)
    if recorder.first and not was_struck:
        if stage.on_impact:
            stage.on_impact()
        recorder.first["after"] = rates_of(stage)
        half_kick(stage, dt / 2, stage.after)


def half_kick(stage: Stage, time_s: float, pushes: Sequence[Push | None]) -> None:
    """Change the velocities by what the forces do in `time_s`."""
    for body, push in zip(stage.bodies, pushes, strict=True):
        if push:
            x, y, turn = push(body.angle, body.velocity, abs(time_s))
            body.velocity += pymunk.Vec2d(x, y) * (time_s / body.mass)
            body.angular_velocity += turn * time_s / body.moment


def poses_of(stage: Stage) -> FloatArray:
    """Return where the bodies are, shape (b, 3)."""
    if stage.follow:
        stage.follow()
    return np.array([(*body.position, body.angle) for body in stage.bodies])


def rates_of(stage: Stage) -> FloatArray:
    """Return the velocities as pymunk holds them, shape (b, 3)."""
    if stage.follow:
        stage.follow()
    return np.array([(*body.velocity, body.angular_velocity) for body in stage.bodies])
