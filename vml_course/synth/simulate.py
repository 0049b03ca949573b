"""From a scene to its truth: step it, read the impact, check it, or refuse."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict
from importlib.metadata import version

import numpy as np
import pymunk

from vml_course.errors import SceneRefusedError
from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.truth import Check, ImpactTruth, Truth
from vml_course.synth.clock import Clock
from vml_course.synth.honesty import (
    contact_checks,
    energy_checks,
    frame_checks,
    impact_checks,
    momentum_checks,
    place,
)
from vml_course.synth.law import Law
from vml_course.synth.loading import load_sheet
from vml_course.synth.rows import with_rows
from vml_course.synth.run import Contact, Run
from vml_course.synth.scene import AnyScene, Scene
from vml_course.synth.shake import wander
from vml_course.synth.sheet import Sheet

OUT_OF_SIGHT = "Lower px_per_m, move origin_x_px or origin_y_px, or widen the picture."


def simulate(scene: AnyScene, camera: Camera, seed: int, *, refine: int = 1) -> Truth:
    """Simulate a scene as a camera sees it.

    Parameters
    ----------
    scene : AnyScene
        With an impact (`Scene`), or with a body that is strained (`Sheet`).
    camera : Camera
    seed : int
        Kept for the textures and the noise; the motion does not depend on it.
    refine : int
        Divides the time step further than is needed.

    Returns
    -------
    Truth
        Frames, realised impact or strain, and every honesty check with its figure.

    Raises
    ------
    SceneRefusedError
        When a check fails: the impact is not what the parameters promise, or is not seen.
    """
    if isinstance(scene, Sheet):
        return load_sheet(scene, camera, seed)
    if not isinstance(scene, Scene):
        raise TypeError(f"{scene.name}: neither an impact nor a sheet")
    law, clock = scene.law(), scene.clock(camera.fps, refine)
    run = law.run(clock)
    if run.contact is None:
        raise SceneRefusedError(scene.name, ["nothing is hit"])
    counted = _hold(scene, contact_checks(run, run.contact, clock))
    impact = read_impact(law, run, run.contact, clock)
    checks = _hold(
        scene,
        [
            *counted,
            *impact_checks(law, impact, run),
            *momentum_checks(law, run.contact),
            *energy_checks(law, run.contact, run),
            *frame_checks(scene, camera, clock, run.pose),
        ],
    )
    return with_rows(_truth(scene, camera, seed, (clock, run, impact, checks)), scene)


def read_impact(law: Law, run: Run, contact: Contact, clock: Clock) -> ImpactTruth:
    """Turn the recorded states into the realised impact."""
    arm = contact.point_m - contact.pose[law.striker, :2]
    return ImpactTruth(
        time_s=contact.step * clock.step_s,
        frame_before=contact.step // clock.steps_per_frame,
        contact_m=contact.point_m,
        normal=contact.normal,
        arm_m=float(arm[0] * contact.normal[1] - arm[1] * contact.normal[0]),
        impulse_xy_N_s=contact.impulse_N_s,
        before=contact.before,
        after=contact.after,
        mass=law.mass,
        striker=law.striker,
        struck=law.struck,
        unknowns=law.unknowns(run),
        duration_s=law.duration_s,
    )


def _hold(scene: Scene, checks: Iterable[Check]) -> tuple[Check, ...]:
    held = tuple(checks)
    failed = [f"{check.name} is {check.value:.4g} (limit {check.limit:g})" for check in held if not check.passed]
    if failed:
        raise SceneRefusedError(scene.name, failed, OUT_OF_SIGHT if "outside the picture" in str(failed) else "")
    return held


def _truth(scene: Scene, camera: Camera, seed: int, found: tuple[Clock, Run, ImpactTruth, tuple[Check, ...]]) -> Truth:
    clock, run, impact, checks = found
    xy_m, names = place(scene, run.pose), tuple(marker.name for marker in scene.markers())
    return Truth(
        scene=scene.name,
        parameters=asdict(scene),
        camera=camera,
        time_s=clock.frame_s,
        bodies=scene.bodies,
        pose=run.pose,
        points=names,
        xy_m=xy_m,
        leg_angle_rad=_vector_angle(scene, run),
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
        declared=scene.declared(),
    )


def _vector_angle(scene: Scene, run: Run) -> FloatArray:
    """Return the angle of the scene's vector in every frame, or nothing where it has none."""
    if scene.vector is None:
        return np.zeros(0)
    tail, head = (next(m for m in scene.markers() if m.name == end) for end in scene.vector)
    x, y = np.array(head.local_m) - np.array(tail.local_m)
    return math.atan2(y, x) + run.pose[:, scene.bodies.index(head.body), 2]
