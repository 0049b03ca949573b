"""From a sheet to its truth: where its points are under every load, and whether all is what it says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from importlib.metadata import version

import numpy as np

from vml_course.errors import InputError, SceneRefusedError
from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.strained import StrainTruth
from vml_course.model.truth import Check, Truth
from vml_course.synth.props.target import SMALLEST_TARGET_PX
from vml_course.synth.shake import wander
from vml_course.synth.sheet import Sheet

STEP_M = 1e-6  # of the numerical gradient
BACK_PX = 1e-4
STRAIN = 1e-9
MARGIN_PX = SMALLEST_TARGET_PX + 2.0


def load_sheet(sheet: Sheet, camera: Camera, seed: int) -> Truth:
    """Return what happens to a sheet as a camera sees it.

    Raises
    ------
    InputError
        When the shutter is open for a time: a sheet is filmed by flash.
    SceneRefusedError
        When a check fails.
    """
    for name in ("shutter", "rolling_shutter"):
        if getattr(camera, name):
            raise InputError(name, f"0 in {sheet.name}, which is filmed by flash", f"{getattr(camera, name):g}")
    time_s = sheet.frame_s(camera.fps)
    load, points_m = sheet.history(time_s), np.array(list(sheet.points_m().values()))
    xy_m = sheet.place(points_m, load[:, None])
    strain = StrainTruth(load, sheet.whole_gradient(points_m, load), sheet.looked_for())
    checks = (
        *_field_checks(sheet, points_m),
        *_history_checks(strain, xy_m),
        *sheet.own_checks(),
        *_picture_checks(sheet, camera, xy_m),
    )
    failed = [f"{check.name} is {check.value:.3g} (limit {check.limit:g})" for check in checks if not check.passed]
    if failed:
        raise SceneRefusedError(sheet.name, failed, what="strain")
    return Truth(
        scene=sheet.name,
        parameters=asdict(sheet),
        camera=camera,
        time_s=time_s,
        bodies=sheet.bodies,
        pose=sheet.rigid_pose(load),
        points=tuple(sheet.points_m()),
        xy_m=xy_m,
        leg_angle_rad=np.zeros(0),
        marks_m=sheet.marks_m(),
        impact=None,
        checks=checks,
        versions={"vml_course": version("vml-course")},
        model=sheet.model,
        given=sheet.given(),
        seed=seed,
        offset_px=wander(seed, camera.shake_px, time_s),
        strain=strain,
    )


def _field_checks(sheet: Sheet, points_m: FloatArray) -> Iterator[Check]:
    """Yield that the stated gradient is the displacement's, and that the way back leads back."""
    stated, found = sheet.gradient(points_m), differences(sheet, points_m)
    scale = float(np.abs(stated).max())
    yield Check(
        "gradient against differences of the field, relative", float(np.abs(stated - found).max()) / scale, 1e-6
    )
    back = sheet.place(sheet.origin_of(points_m, 1.0), 1.0) - points_m
    yield Check("way back from the strained place, m", float(np.abs(back).max()), STRAIN)


def differences(sheet: Sheet, xy_m: FloatArray, step_m: float = STEP_M) -> FloatArray:
    """Return the gradient of a sheet's field by central differences, shape (..., 2) -> (..., 2, 2)."""
    columns = [
        (sheet.displacement_m(xy_m + step) - sheet.displacement_m(xy_m - step)) / (2 * step_m)
        for step in step_m * np.eye(2)
    ]
    return np.stack(columns, axis=-1)


def _history_checks(strain: StrainTruth, xy_m: FloatArray) -> Iterator[Check]:
    """Yield that the load begins and ends with nothing and is once complete."""
    yield Check("load of the first frame", float(abs(strain.load[0])), 0.0)
    yield Check("full load against the most of all frames", 1.0 - float(strain.load.max()), STRAIN)
    gone = np.abs(xy_m[strain.load == 0.0] - xy_m[0]).max()
    yield Check("displacement without load, m", float(gone), STRAIN)


def _picture_checks(sheet: Sheet, camera: Camera, xy_m: FloatArray) -> Iterator[Check]:
    """Yield how far points and marks are outside the picture."""
    last, sway = np.array(camera.size_px) - 1.0, 3.0 * camera.shake_px
    marks = np.array(list(sheet.marks_m().values()))[None]
    names = (*sheet.points_m(), *sheet.marks_m())
    places = np.concatenate([xy_m, np.broadcast_to(marks, (len(xy_m), *marks.shape[1:]))], axis=1)
    seen, margin = camera.to_px(places), MARGIN_PX + sway
    for k, name in enumerate(names):
        beyond = max(0.0, float((margin - seen[:, k]).max()), float((seen[:, k] + margin - last).max()))
        yield Check(f"{name} outside the picture, px", beyond, 0.0)
