"""Is a simulated impact what its parameters promise? Every answer is a figure with a limit.

A clip whose figures miss a limit is refused: students are graded against these numbers. The checks hold a run
of pymunk against the closed form of its law, whatever law that is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.truth import Check, ImpactTruth
from vml_course.synth.clock import Clock
from vml_course.synth.law import Law
from vml_course.synth.run import Contact, Run
from vml_course.synth.scene import Scene

RELATIVE = 1e-3
FRAME_PX = 0.05


def contact_checks(run: Run, contact: Contact, clock: Clock) -> Iterator[Check]:
    """Yield that the two meet when they should and never again, and that nothing else meets."""
    late = abs(contact.step - clock.impact_step) * clock.step_s
    yield Check("bodies meet away from the impact, s", late, 1.5 * clock.step_s)
    yield Check("further contacts", float(run.episodes - 1), 0.0)
    yield Check("contacts of other bodies", float(run.other_contacts), 0.0)


def impact_checks(law: Law, impact: ImpactTruth, run: Run) -> Iterator[Check]:
    """Yield what can be said of the impact itself: realised against nominal and against the closed form."""
    for symbol, real in impact.unknowns.items():
        yield Check(f"{symbol} from states", _relative(real.from_states, real.nominal), RELATIVE)
        yield Check(f"{symbol} from impulse", _relative(real.from_impulse, real.nominal), RELATIVE)
    after, impulse = law.answer()
    size = float(np.hypot(*impulse))
    given = impact.impulse_xy_N_s - impulse
    yield Check("impulse against closed form", float(np.hypot(*given)) / size, RELATIVE)
    yield Check("velocities before against nominal", _off(law, impact.before, law.before), RELATIVE)
    yield Check("velocities after against closed form", _off(law, impact.after, after), RELATIVE)
    yield Check("lever arm, of the striker's reach", abs(impact.arm_m - law.arm_m) / _reach(impact), RELATIVE)
    tilt = math.atan2(impact.normal[1], impact.normal[0]) - math.atan2(law.normal[1], law.normal[0])
    yield Check("normal direction, rad", abs(math.remainder(tilt, 2 * math.pi)), RELATIVE)
    yield Check("impulse after the first contact step, relative", run.later_impulse_N_s / size, 1e-9)


def momentum_checks(law: Law, contact: Contact) -> Iterator[Check]:
    """Yield that each free body takes up the contact's impulse, and that angular momentum is kept."""
    for body, sign in ((law.striker, -1.0), (law.struck, 1.0)):
        mass = law.mass[body, 0]
        if mass and not (body == law.striker == law.struck and sign < 0):
            gained = mass * (contact.after[body, :2] - contact.before[body, :2])
            off = float(np.hypot(*(gained - sign * contact.impulse_N_s)))
            name = "second" if sign > 0 else "first"
            yield Check(f"momentum of the {name} body", off / float(np.hypot(*contact.impulse_N_s)), RELATIVE)
    before, after = (angular_momenta(law, contact.pose, rate) for rate in (contact.before, contact.after))
    kept = abs(float(after.sum() - before.sum())) / float(np.abs(before).sum())
    yield Check("angular momentum kept", kept, RELATIVE)


def angular_momenta(law: Law, pose: FloatArray, rate: FloatArray) -> FloatArray:
    """Return spin and orbital angular momentum of each body about the law's point, kg m²/s, shape (2, b)."""
    arm = pose[:, :2] - law.about_m
    orbital = law.mass[:, 0] * (arm[:, 0] * rate[:, 1] - arm[:, 1] * rate[:, 0])
    return np.array([law.mass[:, 2] * rate[:, 2], orbital])


def energy_checks(law: Law, contact: Contact, run: Run) -> Iterator[Check]:
    """Yield that the impact creates no energy, loses what the closed form says, and that nothing else does."""
    scale = law.kinetic(contact.before)
    loss, lost = scale - law.kinetic(contact.after), law.kinetic(law.before) - law.kinetic(law.answer().after)
    start = law.kinetic(run.start) + law.potential(run.pose[0], after=False)
    end = law.kinetic(run.end) + law.potential(run.pose[-1], after=True)
    yield Check("energy created by the impact, relative", max(0.0, -loss / scale), 1e-9)
    yield Check("energy lost against closed form, of all energy", abs(loss - lost) / scale, RELATIVE)
    yield Check("energy balance of the clip, of all energy", abs(start - end - lost) / scale, RELATIVE)


def frame_checks(scene: Scene, camera: Camera, clock: Clock, pose: FloatArray) -> Iterator[Check]:
    """Yield how far the frames' positions lie from the closed form, and whether the bodies stay in the picture."""
    ideal = scene.law().motion(clock.since_impact_s).pose
    shift = float(np.hypot(*np.moveaxis(place(scene, pose) - place(scene, ideal), -1, 0)).max())
    yield Check("frame positions against closed form, px", shift * camera.px_per_m, FRAME_PX)
    near = np.abs(clock.since_impact_s) <= scene.seen_s + 1e-9
    near[0] = True  # tracking starts there
    for marker, beyond in zip(scene.markers(), _outside_px(scene, camera, pose[near]), strict=True):
        yield Check(f"{marker.name} outside the picture, px", beyond, 0.0)
    marks = camera.to_px(np.array(list(scene.marks_m().values())))
    yield Check("scale marks outside the picture, px", _beyond_px(camera, marks, 0.0), 0.0)


def place(scene: Scene, pose: FloatArray) -> FloatArray:
    """Return where the markers are: poses of shape (n, b, 3) -> metres of shape (n, p, 2)."""
    places = []
    for marker in scene.markers():
        x, y, angle = pose[:, scene.bodies.index(marker.body)].T
        (along, up), c, s = marker.local_m, np.cos(angle), np.sin(angle)
        places.append(np.stack([x + c * along - s * up, y + s * along + c * up], axis=-1))
    return np.stack(places, axis=1)


def _off(law: Law, rate: FloatArray, nominal: FloatArray) -> float:
    """Return the root of the energy of a difference of velocities, as a part of that of the whole."""
    return math.sqrt(law.kinetic(rate - nominal) / law.kinetic(law.before))


def _reach(impact: ImpactTruth) -> float:
    return max(float(np.hypot(*impact.contact_m)), abs(impact.arm_m), 1e-3)


def _outside_px(scene: Scene, camera: Camera, pose: FloatArray) -> list[float]:
    seen, sway = camera.to_px(place(scene, pose)), 3.0 * camera.shake_px
    return [
        _beyond_px(camera, seen[:, k], marker.outline_m * camera.px_per_m + sway)
        for k, marker in enumerate(scene.markers())
    ]


def _beyond_px(camera: Camera, xy_px: FloatArray, margin_px: float) -> float:
    last = np.array(camera.size_px) - 1.0
    return max(0.0, float((margin_px - xy_px).max()), float((xy_px + margin_px - last).max()))


def _relative(value: float, nominal: float) -> float:
    return abs(value / nominal - 1.0) if nominal else abs(value)
