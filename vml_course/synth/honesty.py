"""Is a simulated impact what its parameters promise? Every answer is a figure with a limit.

A clip whose figures miss a limit is refused: students are graded against these numbers.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.truth import Check, ImpactTruth
from vml_course.synth.clock import Clock
from vml_course.synth.closed_form import pair_mass, pinned_impact, pinned_loss, swing
from vml_course.synth.scene import Scene
from vml_course.synth.stage import GRAVITY_M_S2, PinnedStrike
from vml_course.synth.stepping import Contact, Run

RELATIVE = 1e-3
FRAME_PX = 0.05
WINDOW_S = 0.04


def impact_checks(scene: Scene, impact: ImpactTruth, run: Run) -> Iterator[Check]:
    """Yield what can be said of the impact itself: realised against nominal and against the closed form."""
    strike = scene.strike()
    I, m, a = strike.inertia_kg_m2, strike.ball_mass_kg, strike.arm_m  # noqa: E741, N806 - textbook letters
    J, w2, u2 = pinned_impact(I, m, a, strike.restitution, strike.omega_before_rad_s, 0.0)  # noqa: N806
    pairs = {
        "restitution from states": (impact.restitution, strike.restitution),
        "restitution from impulse": (impact.restitution_by_impulse, strike.restitution),
        "inertia from states": (impact.inertia_kg_m2, I),
        "inertia from impulse": (impact.inertia_by_impulse_kg_m2, I),
        "impulse against closed form": (impact.impulse_N_s, J),
        "omega before against nominal": (impact.omega_before_rad_s, strike.omega_before_rad_s),
        "omega after against closed form": (impact.omega_after_rad_s, w2),
        "ball speed after against closed form": (float(impact.struck_after_m_s @ impact.normal), u2),
        "lever arm": (impact.arm_m, a),
    }
    for name, (real, nominal) in pairs.items():
        yield Check(name, _relative(real, nominal), RELATIVE)
    tilt = math.atan2(impact.normal[1], impact.normal[0]) - math.atan2(strike.normal[1], strike.normal[0])
    yield Check("normal direction, rad", abs(tilt), RELATIVE)
    yield Check("impulse after the first contact step, relative", run.later_impulse_N_s / abs(J), 1e-9)


def contact_checks(run: Run) -> Iterator[Check]:
    """Yield the counts: one contact between striker and ball, none of anything else."""
    yield Check("contacts of striker and ball beside the first", float(abs(run.episodes - 1)), 0.0)
    yield Check("contacts of other bodies", float(run.other_contacts), 0.0)


def energy_checks(scene: Scene, contact: Contact, start: tuple[float, float], run: Run) -> Iterator[Check]:
    """Yield that the impact creates no energy, loses what the closed form says, and that nothing else does."""
    strike, scale = scene.strike(), _kinetic(scene.strike(), contact.before.omega_rad_s, contact.before.ball_m_s)
    loss = scale - _kinetic(strike, contact.after.omega_rad_s, contact.after.ball_m_s)
    mu = pair_mass(strike.inertia_kg_m2, strike.ball_mass_kg, strike.arm_m)
    lost = pinned_loss(mu, strike.restitution, strike.arm_m * strike.omega_before_rad_s)
    ball_y = run.pose[-1, 1, 1] - run.pose[0, 1, 1]
    end = strike.energy(run.end.angle_rad, run.end.omega_rad_s) + strike.ball_mass_kg * (
        0.5 * float(np.dot(run.end.ball_m_s, run.end.ball_m_s)) + GRAVITY_M_S2 * float(ball_y)
    )
    yield Check("energy created by the impact, relative", max(0.0, -loss / scale), 1e-9)
    yield Check("energy lost against closed form, of all energy", abs(loss - lost) / scale, RELATIVE)
    yield Check("energy balance of the clip, of all energy", abs(strike.energy(*start) - end - lost) / scale, RELATIVE)


def frame_checks(scene: Scene, camera: Camera, clock: Clock, pose: FloatArray) -> Iterator[Check]:
    """Yield how far the frames' positions lie from the closed form, and whether the bodies stay in the picture."""
    strike = scene.strike()
    ideal = ideal_pose(strike, clock)
    reach = max(math.hypot(*marker.local_m) for marker in scene.markers())
    shift = np.hypot(*np.moveaxis(pose[..., :2] - ideal[..., :2], -1, 0)).max()
    turn = np.abs(pose[:, 0, 2] - ideal[:, 0, 2]).max() * reach
    yield Check("frame positions against closed form, px", float(max(shift, turn) * camera.px_per_m), FRAME_PX)
    near = np.abs(clock.since_impact_s) <= WINDOW_S + 1e-9
    near[0] = True  # tracking starts there
    yield Check("bodies outside the picture, px", _outside_px(scene, camera, pose[near]), 0.0)
    marks = camera.to_px(np.array(list(scene.marks_m().values())))
    yield Check("scale marks outside the picture, px", _beyond_px(camera, marks, 0.0), 0.0)


def ideal_pose(strike: PinnedStrike, clock: Clock) -> FloatArray:
    """Return the poses by closed form and Runge-Kutta, without pymunk: shape (n, 2, 3)."""
    _, w2, u2 = pinned_impact(
        strike.inertia_kg_m2, strike.ball_mass_kg, strike.arm_m, strike.restitution, strike.omega_before_rad_s, 0.0
    )
    time = clock.since_impact_s
    before, after = time[: clock.frame_before + 1], time[clock.frame_before + 1 :]
    pose = np.zeros((clock.frame_count, 2, 3))
    pose[: len(before), 0, 2] = swing(
        strike.inertia_kg_m2, strike.torque, (0.0, strike.omega_before_rad_s), before[::-1]
    )[::-1, 0]
    pose[len(before) :, 0, 2] = swing(strike.inertia_kg_m2, strike.torque, (0.0, w2), after)[:, 0]
    flight = np.maximum(time, 0.0)[:, None]
    pose[:, 1, :2] = strike.ball_m + u2 * np.array(strike.normal) * flight
    pose[:, 1, 1] -= 0.5 * GRAVITY_M_S2 * flight[:, 0] ** 2
    return pose


def place(scene: Scene, pose: FloatArray) -> FloatArray:
    """Return where the markers are: poses of shape (n, b, 3) -> metres of shape (n, p, 2)."""
    places = []
    for marker in scene.markers():
        x, y, angle = pose[:, scene.bodies.index(marker.body)].T
        (along, up), c, s = marker.local_m, np.cos(angle), np.sin(angle)
        places.append(np.stack([x + c * along - s * up, y + s * along + c * up], axis=-1))
    return np.stack(places, axis=1)


def _kinetic(strike: PinnedStrike, omega: float, ball: tuple[float, float]) -> float:
    return 0.5 * strike.inertia_kg_m2 * omega**2 + 0.5 * strike.ball_mass_kg * float(np.dot(ball, ball))


def _outside_px(scene: Scene, camera: Camera, pose: FloatArray) -> float:
    seen, sway = camera.to_px(place(scene, pose)), 3.0 * camera.shake_px
    return max(
        _beyond_px(camera, seen[:, k], marker.outline_m * camera.px_per_m + sway)
        for k, marker in enumerate(scene.markers())
    )


def _beyond_px(camera: Camera, xy_px: FloatArray, margin_px: float) -> float:
    last = np.array(camera.size_px) - 1.0
    return max(0.0, float((margin_px - xy_px).max()), float((xy_px + margin_px - last).max()))


def _relative(value: float, nominal: float) -> float:
    return abs(value / nominal - 1.0)
