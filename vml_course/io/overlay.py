"""The clip with everything that was measured drawn over it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from pathlib import Path

import cv2
import numpy as np

from vml_course.errors import VideoError
from vml_course.io.drawing import BLUE, LIGHT_BLUE, MARKS, RED, WHITE, YELLOW, Colour, Image, Pen, Point
from vml_course.io.encode import write_video
from vml_course.io.planes import bgr_of, picture_from_bgr
from vml_course.io.source import open_source
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Picture
from vml_course.model.motion import VectorSeries
from vml_course.model.track import Status
from vml_course.model.tracked import Tracked

Progress = Callable[[int, int], None]
PLAYBACK_FPS = 30.0
TRAIL_FRAMES = 90
SMALLEST_HEIGHT = 540  # smaller pictures are enlarged by a whole number, so that texts can be read
QUALITY_CRF = 18
NAMED = ((Status.MANUAL, "by hand", WHITE), (Status.INTERP, "filled in", WHITE), (Status.LOST, "lost", RED))


@dataclass(frozen=True, eq=False)
class Scenery:
    """What stays the same through the clip."""

    tracked: Tracked
    zoom: int
    size: float
    speed: str
    turn: float

    def place(self, xy_px: FloatArray) -> FloatArray:
        """Map places in the source picture to the drawn one; pixel centres stay pixel centres."""
        return np.asarray((xy_px + 0.5) * self.zoom - 0.5)


def write_overlay(
    path: Path, tracked: Tracked, *, playback_fps: float = PLAYBACK_FPS, progress: Progress | None = None
) -> int:
    """Write marks, trails, blocks, vectors, time and scale over the clip; return the number of pictures.

    Parameters
    ----------
    path : Path
        Ends in `.avi` (MJPEG) or `.mp4` (H.264).
    tracked : Tracked
        One picture is written for each row of its track.
    playback_fps : float
        Rate at which the overlay plays; the slow-down is written on it.

    Raises
    ------
    VideoError
        When the video cannot be read again, or is not known.
    """
    if tracked.path is None:
        raise VideoError(tracked.video or "video", "the file that was tracked", "no path")
    return write_video(path, _pictures(tracked, playback_fps, progress), playback_fps, QUALITY_CRF)


def _pictures(tracked: Tracked, playback_fps: float, progress: Progress | None) -> Iterator[Picture]:
    total = len(tracked.track.frame)
    first, step = tracked.first_picture, tracked.picture_step
    source = open_source(tracked.path) if tracked.path else None
    if source is None:
        return
    scenery = None
    for row, one in enumerate(source.pictures(first, first + (total - 1) * step, step)):
        image = bgr_of(one.picture)
        scenery = scenery or _scenery(tracked, image.shape[0], playback_fps)
        yield picture_from_bgr(draw_row(image, scenery, row))
        if progress:
            progress(row + 1, total)


def _scenery(tracked: Tracked, height: int, playback_fps: float) -> Scenery:
    zoom = max(1, ceil(SMALLEST_HEIGHT / height))
    turn = tracked.calibration.axis_angle_rad if tracked.calibration else 0.0
    speed = speed_text(playback_fps * tracked.picture_step / tracked.fps)
    return Scenery(tracked, zoom, height * zoom / 720, speed, turn)


def speed_text(ratio: float) -> str:
    """Say how the overlay's time runs against the real one.

    >>> speed_text(30 / 480), speed_text(1.0), speed_text(2.5), speed_text(30 / 26.777)
    ('1/16 speed', 'real speed', '2.5x speed', '1.12x speed')
    """
    if abs(ratio - 1) < 0.005:
        return "real speed"
    if ratio > 1:
        return f"{ratio:.3g}x speed"
    inverse = Fraction(1 / ratio).limit_denominator(10)
    return f"1/{float(inverse):.3g} speed"


def draw_row(image: Image, scenery: Scenery, row: int) -> Image:
    """Draw one row of the track over its picture."""
    if scenery.zoom > 1:
        size = (image.shape[1] * scenery.zoom, image.shape[0] * scenery.zoom)
        image = np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_CUBIC), dtype=np.uint8)
    pen = Pen(image, scenery.size)
    for number in range(len(scenery.tracked.track.points)):
        _draw_trail(pen, scenery, row, number)
    for vector in scenery.tracked.vectors:
        _draw_vector(pen, scenery, row, vector)
    for number, name in enumerate(scenery.tracked.track.points):
        _draw_point(pen, scenery, row, number, name)
    _draw_clock(pen, scenery, row)
    _draw_scale(pen, scenery)
    return image


def _draw_trail(pen: Pen, scenery: Scenery, row: int, number: int) -> None:
    path = scenery.place(scenery.tracked.track.xy_px[max(row - TRAIL_FRAMES, 0) : row + 1, number])
    colour = MARKS[number % len(MARKS)]
    breaks = np.flatnonzero(np.isnan(path[:, 0]))
    for piece in np.split(path, breaks):
        seen = piece[np.isfinite(piece[:, 0])]
        if len(seen) > 1:
            pen.plain_line([(x, y) for x, y in seen.tolist()], colour, 2)


def _draw_point(pen: Pen, scenery: Scenery, row: int, number: int, name: str) -> None:
    track = scenery.tracked.track
    at, colour = _point(scenery.place(track.xy_px[row, number])), MARKS[number % len(MARKS)]
    if at is None:
        return
    status = Status(int(track.status[row, number]))
    has_block = status is Status.AUTO or bool(np.isfinite(track.gradient[row, number]).all())
    side = float(track.settings.get("block", 0)) * scenery.zoom if has_block else 0.0
    corners = block_corners(at, side, track.gradient[row, number])
    if side:
        pen.line(corners, colour, 1.5, is_closed=True)
    _draw_mark(pen, at, colour, status)
    top = min(y for _, y in corners) - 6 * pen.size
    pen.text(name, (at[0] + 12 * pen.size, min(top, at[1] - 16 * pen.size)), colour)


def _draw_mark(pen: Pen, at: Point, colour: Colour, status: Status) -> None:
    """Draw a cross where a point was tracked, a diamond about it where it was put by hand, rings where reckoned."""
    if status is Status.MANUAL:
        pen.diamond(at, colour)
    if status in {Status.INTERP, Status.VIRTUAL}:
        pen.ring(at, colour, 9)
    if status is Status.VIRTUAL:
        pen.ring(at, colour, 14)
    if status in {Status.AUTO, Status.MANUAL}:
        pen.cross(at, colour)


def block_corners(at: Point, side: float, gradient: FloatArray) -> list[Point]:
    """Return the corners of a square block after its affine deformation: a parallelogram about the point."""
    u_x, u_y, v_x, v_y = np.nan_to_num(gradient)
    deformation = np.array([[1 + u_x, u_y], [v_x, 1 + v_y]])
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * side / 2
    corners = square @ deformation.T + np.asarray(at)
    return [(float(x), float(y)) for x, y in corners]


def _draw_vector(pen: Pen, scenery: Scenery, row: int, vector: VectorSeries) -> None:
    track = scenery.tracked.track
    tail, head = (_point(scenery.place(track.xy_px[row, track.point_index(end)])) for end in (vector.tail, vector.head))
    if tail is None or head is None:
        return
    angle = float(vector.angle_rad[row])
    reach = 70 * pen.size
    along = (tail[0] + reach * np.cos(scenery.turn), tail[1] - reach * np.sin(scenery.turn))
    pen.arrow(tail, head, BLUE, 3.5)
    pen.arrow(tail, along, YELLOW, 2.5)
    sweep = (angle + np.pi) % (2 * np.pi) - np.pi
    pen.arc(tail, 0.6 * reach, scenery.turn, sweep, WHITE)


def _draw_clock(pen: Pen, scenery: Scenery, row: int) -> None:
    track = scenery.tracked.track
    lines = [(f"frame {track.frame[row]}   t = {track.time_s[row]:.4f} s", WHITE), (scenery.speed, WHITE)]
    angles = [(vector.name, np.degrees(vector.angle_rad[row])) for vector in scenery.tracked.vectors]
    lines += [(f"{name} {angle:.1f} deg", LIGHT_BLUE) for name, angle in angles if np.isfinite(angle)]
    for status, words, colour in NAMED:
        names = [name for name, code in zip(track.points, track.status[row], strict=True) if code == status]
        if names:
            lines.append((f"{words}: {', '.join(names)}", colour))
    gap = round(10 * pen.size)
    widest = max(pen.text_size(words)[0] for words, _ in [*lines, ("frame 0000   t = 0.0000 s", WHITE)])
    tall = round(30 * pen.size)
    pen.shade(gap, gap, widest + 2 * gap, tall * len(lines) + gap)
    for number, (words, colour) in enumerate(lines):
        pen.text(words, (2 * gap, gap + tall * (number + 1) - round(3 * pen.size)), colour)


def _draw_scale(pen: Pen, scenery: Scenery) -> None:
    calibration = scenery.tracked.calibration
    px_per_unit = (calibration.px_per_m if calibration else 1.0) * scenery.zoom
    width, height = pen.image.shape[1], pen.image.shape[0]
    length = round_length(0.22 * width / px_per_unit)
    words = f"{length:g} m" if calibration else f"{length:g} px"
    left, right, y = 24 * pen.size, 24 * pen.size + length * px_per_unit, height - 26 * pen.size
    tick = 7 * pen.size
    pen.shade(round(10 * pen.size), round(y - 44 * pen.size), round(right + 4 * pen.size), round(60 * pen.size))
    pen.line([(left, y - tick), (left, y), (right, y), (right, y - tick)], WHITE, 2)
    pen.text(words, (0.5 * (left + right) - 0.5 * pen.text_size(words)[0], y - 12 * pen.size), WHITE)


def round_length(longest: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20 ... (or 0.5, 0.2 ...) that is not longer.

    >>> round_length(0.7), round_length(199), round_length(0.021)
    (0.5, 100.0, 0.02)
    """
    power = 10.0 ** np.floor(np.log10(longest))
    return float(max(factor * power for factor in (1, 2, 5) if factor * power <= longest * 1.000001))


def _point(xy: FloatArray) -> Point | None:
    return (float(xy[0]), float(xy[1])) if np.isfinite(xy).all() else None
