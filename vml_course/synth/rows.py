"""A shutter that rolls: each row is exposed a little later than the one above.

A frame's time is that of the middle of its picture. A point is seen where it is when its own row is exposed,
and which row that is depends on where it is: a fixed point, found by iteration.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from vml_course.errors import SceneRefusedError
from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.truth import Truth
from vml_course.synth.exposure import count_instants
from vml_course.synth.honesty import place
from vml_course.synth.path import fine_path
from vml_course.synth.scene import Scene
from vml_course.synth.shake import wander
from vml_course.synth.sprite import Sprite

FASTEST = 0.5
ROUNDS = 40
ROUGH_INSTANTS = 17


def row_exposures(truth: Truth, scene: Scene, sprites: Sequence[Sprite]) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield what each exposure sees at its k instants, for each row of the picture or once for all.

    Returns
    -------
    float array, shape (k, h, b, 3) or (k, 1, b, 3)
        Where the bodies are in the pixels of a square camera: px, px, rad.
    float array, shape (k, h, 2) or (k, 1, 2)
        How far the rows of the picture are shifted.
    """
    camera = truth.camera
    if not (camera.shutter or camera.rolling_shutter):
        for pose, offset_px in zip(truth.pose, truth.offset_px, strict=True):
            yield _in_square_px(camera, pose[None, None]), offset_px[None, None]
        return
    path = fine_path(scene, camera.fps)
    delay_s = np.asarray(camera.row_delay_s(np.arange(camera.height_px))) if camera.rolling_shutter else np.zeros(1)
    for time_s in truth.time_s:
        rough = path.at(time_s + camera.exposure_s * np.linspace(-0.5, 0.5, ROUGH_INSTANTS))
        count = count_instants(sprites, _in_square_px(camera, rough), camera.longest_stretch) if camera.shutter else 1
        middles = camera.exposure_s * ((np.arange(count) + 0.5) / count - 0.5)
        times = time_s + middles[:, None] + delay_s
        pose = path.at(times.ravel()).reshape(*times.shape, -1, 3)
        yield _in_square_px(camera, pose), wander(truth.seed, camera.shake_px, times)


def with_rows(truth: Truth, scene: Scene) -> Truth:
    """Add to a truth when each point's row is exposed, and where points and marks are seen then.

    Raises
    ------
    SceneRefusedError
        When a point may outrun the rows, so that it is seen in several or in none.
    """
    camera = truth.camera
    if not camera.rolling_shutter:
        return truth
    path, marks_m = fine_path(scene, camera.fps), np.array(list(truth.marks_m.values()))
    _check_pace(truth, camera.to_px(place(scene, path.pose))[..., 1], path.step_s)

    def points_px(time_s: FloatArray) -> FloatArray:
        """Each point at its own time, shape (n, p) -> (n, p, 2)."""
        columns = [place(scene, path.at(column))[:, k] for k, column in enumerate(time_s.T)]
        return camera.to_px(np.stack(columns, axis=1)) + wander(truth.seed, camera.shake_px, time_s)

    def marks_px(time_s: FloatArray) -> FloatArray:
        return camera.to_px(marks_m) + wander(truth.seed, camera.shake_px, time_s)

    row_time_s, row_xy_px = _meet_rows(truth, points_px, len(truth.points))
    _, row_marks_px = _meet_rows(truth, marks_px, len(marks_m))
    return replace(truth, row_time_s=row_time_s, row_xy_px=row_xy_px, row_marks_px=row_marks_px)


def _check_pace(truth: Truth, y_px: FloatArray, step_s: float) -> None:
    """Refuse points that move along the picture half as fast as the rows are exposed, or faster."""
    delay_s = np.asarray(truth.camera.row_delay_s(y_px))
    pace = float(np.abs(np.diff(delay_s, axis=0)).max()) / step_s
    if pace > FASTEST:
        raise SceneRefusedError(
            truth.scene, [f"speed of a point over that of the rolling shutter is {pace:.3g} (limit {FASTEST:g})"]
        )


def _meet_rows(truth: Truth, seen_px: Callable[[FloatArray], FloatArray], count: int) -> tuple[FloatArray, FloatArray]:
    """Return when the rows of points are exposed, and where the points are then; each round halves the error."""
    time_s = np.repeat(truth.time_s[:, None], count, axis=1)
    for _ in range(ROUNDS):
        time_s = truth.time_s[:, None] + truth.camera.row_delay_s(seen_px(time_s)[..., 1])
    return time_s, seen_px(time_s)


def _in_square_px(camera: Camera, pose: FloatArray) -> FloatArray:
    """Turn poses in metres, shape (..., 3), into a square camera's pixels."""
    return np.concatenate([camera.to_square_px(pose[..., :2]), pose[..., 2:]], axis=-1)
