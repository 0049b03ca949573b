"""From a scene to its truth: step it, read the impact, check it, or refuse."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict
from importlib.metadata import version

import numpy as np
import pymunk

from vml_course.errors import SceneRefusedError
from vml_course.model.camera import Camera
from vml_course.model.truth import Check, ImpactTruth, Truth
from vml_course.synth.clock import Clock
from vml_course.synth.closed_form import pair_mass
from vml_course.synth.honesty import contact_checks, energy_checks, frame_checks, impact_checks, place
from vml_course.synth.rows import with_rows
from vml_course.synth.scene import Scene
from vml_course.synth.shake import wander
from vml_course.synth.stepping import Contact, Run, run_stage


def simulate(scene: Scene, camera: Camera, seed: int, *, refine: int = 1) -> Truth:
    """Simulate a scene as a camera sees it.

    Parameters
    ----------
    scene : Scene
    camera : Camera
    seed : int
        Kept for the textures and the noise; the motion does not depend on it.
    refine : int
        Divides the time step further than is needed.

    Returns
    -------
    Truth
        Frames, realised impact, and every honesty check with its figure.

    Raises
    ------
    SceneRefusedError
        When a check fails: the impact is not what the parameters promise, or is not seen.
    """
    clock = scene.clock(camera.fps, refine)
    stage = scene.build(clock)
    start = (stage.striker.angle, stage.striker.angular_velocity)
    run = run_stage(stage, clock)
    counted = _hold(scene, contact_checks(run))
    if run.contact is None:  # cannot happen while contacts are counted; tells the type checker so
        raise SceneRefusedError(scene.name, ["no contact"])
    impact = read_impact(scene, run.contact, clock)
    checks = _hold(
        scene,
        [
            *counted,
            *impact_checks(scene, impact, run),
            *energy_checks(scene, run.contact, start, run),
            *frame_checks(scene, camera, clock, run.pose),
        ],
    )
    return with_rows(_truth(scene, camera, seed, (clock, run, impact, checks)), scene)


def read_impact(scene: Scene, contact: Contact, clock: Clock) -> ImpactTruth:
    """Turn the recorded states into the realised impact: e and I from the states, and from the impulse."""
    strike, before, after = scene.strike(), contact.before, contact.after
    normal = np.array(contact.normal)
    # The lever arm of the line of action, which passes through the centre of the round head.
    turn, (x, y) = before.angle_rad, strike.head_m
    head = np.array([x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)])
    a = float(head[0] * normal[1] - head[1] * normal[0])
    w1, w2, m = before.omega_rad_s, after.omega_rad_s, strike.ball_mass_kg
    u1, u2 = float(np.dot(before.ball_m_s, normal)), float(np.dot(after.ball_m_s, normal))
    impulse = float(np.dot(contact.impulse_N_s, normal))
    return ImpactTruth(
        time_s=contact.step * clock.step_s,
        frame_before=contact.step // clock.steps_per_frame,
        contact_m=np.array(contact.point_m),
        normal=normal,
        arm_m=a,
        impulse_N_s=impulse,
        restitution=(u2 - a * w2) / (a * w1 - u1),
        inertia_kg_m2=m * a * (u2 - u1) / (w1 - w2),
        restitution_by_impulse=impulse / (pair_mass(strike.inertia_kg_m2, m, a) * (a * w1 - u1)) - 1.0,
        inertia_by_impulse_kg_m2=a * impulse / (w1 - w2),
        restitution_nominal=strike.restitution,
        inertia_nominal_kg_m2=strike.inertia_kg_m2,
        omega_before_rad_s=w1,
        omega_after_rad_s=w2,
        struck_before_m_s=np.array(before.ball_m_s),
        struck_after_m_s=np.array(after.ball_m_s),
        struck_mass_kg=m,
    )


def _hold(scene: Scene, checks: Iterable[Check]) -> tuple[Check, ...]:
    held = tuple(checks)
    failed = [f"{check.name} is {check.value:.3g} (limit {check.limit:g})" for check in held if not check.passed]
    if failed:
        raise SceneRefusedError(scene.name, failed)
    return held


def _truth(scene: Scene, camera: Camera, seed: int, found: tuple[Clock, Run, ImpactTruth, tuple[Check, ...]]) -> Truth:
    clock, run, impact, checks = found
    xy_m, names = place(scene, run.pose), tuple(marker.name for marker in scene.markers())
    tail, head = (np.array(marker.local_m) for end in scene.vector for marker in scene.markers() if marker.name == end)
    x, y = head - tail
    return Truth(
        scene=scene.name,
        parameters=asdict(scene),
        camera=camera,
        time_s=clock.frame_s,
        bodies=scene.bodies,
        pose=run.pose,
        points=names,
        xy_m=xy_m,
        leg_angle_rad=math.atan2(y, x) + run.pose[:, 0, 2],
        marks_m=scene.marks_m(),
        impact=impact,
        checks=checks,
        versions={
            "vml_course": version("vml-course"),
            "pymunk": pymunk.version,
            "chipmunk": pymunk.chipmunk_version,
            "steps_per_frame": str(clock.steps_per_frame),
        },
        model=scene.model,
        given=scene.given(),
        seed=seed,
        offset_px=wander(seed, camera.shake_px, clock.frame_s),
    )
