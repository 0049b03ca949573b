"""Track points through a clip, and turn pixels and frames into metres and seconds."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from vml_course.errors import InputError, UnknownNameError
from vml_course.io.source import Source
from vml_course.kinetics.calibrate import calibrate, relative_scale_sd
from vml_course.kinetics.vectors import vector_series
from vml_course.model.frame import Frame
from vml_course.model.motion import Calibration, VectorSeries
from vml_course.model.track import Seed, Sighting, Track
from vml_course.model.tracked import Tracked
from vml_course.track.blocks import check_block_fits
from vml_course.track.interpolate import WAYS, interpolated
from vml_course.track.places import Places
from vml_course.track.run import run_both_ways
from vml_course.track.tracker import make_tracker
from vml_course.track.virtual import VirtualPoint, check_virtual
from vml_course.usecases.cut_clip import warnings_of
from vml_course.usecases.find_shutter import find_shutter, noted, settled
from vml_course.usecases.reel import Reel, Way, open_reel
from vml_course.usecases.retrack import fill_before_marks, with_virtuals
from vml_course.usecases.track_warnings import track_warnings

__all__ = ["TrackRequest", "Tracked", "VectorRequest", "track_clip"]

Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True)
class VectorRequest:
    """A vector between two tracked points."""

    name: str
    tail: str
    head: str


@dataclass(frozen=True)
class TrackRequest:
    """What to track, where, and in which units.

    Attributes
    ----------
    video : Path
        A video, a folder of pictures, or a clip with its note: then frames and times are those of the source.
    seeds : tuple of Seed
        Where the points are: in the first picture, or in the frame that a seed names (numbered as in the track).
    marks : tuple of Seed
        Places given by hand in further frames: the track goes through them.
    start, end, step : int
        Pictures of the file, `end` inclusive (None: the last).
    fps : float or None
        Frames per second when recorded; None takes the file's.
    stick_px : (x1, y1, x2, y2) or None
        Two points of known distance; None stays in pixels.
    length_m : float or None
        That distance; `length_text` is what was typed.
    origin_px : (float, float) or None
        Where the world's origin is seen; None: the centre of the bottom-left pixel.
    axis_angle_rad : float
        Angle of the x axis from the picture's horizontal, counter-clockwise.
    virtuals : tuple of VirtualPoint
        Points carried by tracked ones; without a frame they are seen where their first carrier is placed.
    finds_shutter : bool
        Whether the open share of the shutter is found in the clip (method `dic`); it takes the place of a setting.
    fill : "linear", "quadratic" or None
        How gaps are filled, of all points; None leaves them.
    vectors : tuple of VectorRequest
        Between tracked and virtual points.
    method : str
        Name of a tracker; `settings` are its own, such as `block`.
    """

    video: Path
    seeds: tuple[Seed, ...]
    start: int = 0
    end: int | None = None
    step: int = 1
    fps: float | None = None
    stick_px: tuple[float, ...] | None = None
    length_m: float | None = None
    length_text: str = ""
    origin_px: tuple[float, float] | None = None
    axis_angle_rad: float = 0.0
    vectors: tuple[VectorRequest, ...] = ()
    method: str = "dic"
    settings: Mapping[str, float] = field(default_factory=dict)
    marks: tuple[Seed, ...] = ()
    virtuals: tuple[VirtualPoint, ...] = ()
    fill: str | None = None
    finds_shutter: bool = False


def track_clip(request: TrackRequest, progress: Progress | None = None) -> Tracked:
    """Track every point of a request from its first picture to its last.

    Raises
    ------
    FileMissingError, VideoError, FrameRangeError
        When the pictures cannot be read.
    UnknownNameError, InputError, SeedError
        When the request does not fit together, or a point cannot be followed from where it was placed.
    """
    check_request(request)
    reel = open_reel(request)
    calibration = _calibration(request, reel.source)
    way = _way(request, reel)
    found = find_shutter(request, reel) if request.finds_shutter else None
    tracker = make_tracker(request.method, **settled(request, found))
    places, on_frame = Places(request.seeds, request.marks), _counter(way.total, progress)
    track = run_both_ways(tracker, way.onwards, way.back, places, fps=reel.steady_fps, on_frame=on_frame)
    track = _filled(request, with_virtuals(request, fill_before_marks(reel, tracker, places, track)))
    return _tracked(request, reel.source, noted(track, found), calibration, reel.fps)


def _filled(request: TrackRequest, track: Track) -> Track:
    if request.fill is not None:
        for point in track.points:
            track = interpolated(track, point, request.fill)
    return track


def check_request(request: TrackRequest) -> None:
    """Refuse what cannot work before any picture is decoded.

    Raises
    ------
    UnknownNameError, InputError
    """
    points = _check_points(request)
    _check_names("vector", [vector.name for vector in request.vectors])
    for vector in request.vectors:
        for end in (vector.tail, vector.head):
            if end not in points:
                raise UnknownNameError(f"vector {vector.name}", end, points)
        if vector.tail == vector.head:
            raise InputError(f"vector {vector.name}", "two different points", f"{vector.tail} twice")
    if request.finds_shutter and request.method != "dic":
        raise InputError("shutter", "method dic, which alone knows of motion blur", request.method)
    if not math.isfinite(request.axis_angle_rad):
        raise InputError("axis angle", "a number of degrees", request.axis_angle_rad)
    make_tracker(request.method, **request.settings)


def _check_points(request: TrackRequest) -> list[str]:
    tracked = [seed.name for seed in request.seeds]
    points = tracked + [virtual.name for virtual in request.virtuals]
    _check_names("point", points)
    Places(request.seeds, request.marks)
    for virtual in request.virtuals:
        check_virtual(virtual, tracked)
    if request.fill is not None and request.fill not in WAYS:
        raise UnknownNameError("fill", request.fill, WAYS)
    return points


def check_video(request: TrackRequest) -> None:
    """Refuse a video that cannot be opened, and a range, a scale or a point that does not fit it.

    Raises
    ------
    FileMissingError, VideoError, FrameRangeError, InputError, SeedError
    """
    check_request(request)
    reel = open_reel(request)
    _way(request, reel)
    _calibration(request, reel.source)
    block = int(make_tracker(request.method, **request.settings).settings["block"])
    for seed in request.seeds:
        check_block_fits(reel.source.info.shape, seed.name, (seed.x_px, seed.y_px), block)


def _way(request: TrackRequest, reel: Reel) -> Way:
    Places(request.seeds, request.marks).from_frame(reel.first_frame)  # refuses a mark on a seed
    for kind, places in (("mark", request.marks), ("virtual", request.virtuals)):
        for place in places:
            if place.frame is not None:
                reel.row(f"{kind} {place.name}", place.frame)
    return reel.way(request.seeds)


def _check_names(kind: str, names: Sequence[str]) -> None:
    doubled = [name for place, name in enumerate(names) if name in names[:place]]
    if doubled:
        raise InputError(kind, "each name once", f"{doubled[0]} twice")
    if not all(name.strip() for name in names):
        raise InputError(kind, "a name", "none")


def _calibration(request: TrackRequest, source: Source) -> Calibration | None:
    if request.stick_px is None or request.length_m is None:
        return None
    width, height = source.info.width_px, source.info.height_px
    for x, y in (request.stick_px[:2], request.stick_px[2:]):
        if not (-0.5 <= x <= width - 0.5 and -0.5 <= y <= height - 0.5):
            raise InputError("scale", f"two points in the picture ({width} x {height} px)", f"({x:g}, {y:g})")
    return calibrate(
        request.stick_px,
        request.length_m,
        origin_px=_origin(request, source),
        axis_angle_rad=request.axis_angle_rad,
        length_text=request.length_text or f"{request.length_m:g} m",
    )


def _origin(request: TrackRequest, source: Source) -> tuple[float, float]:
    return request.origin_px or (0.0, float(source.info.height_px - 1))


def _counter(total: int, progress: Progress | None) -> Callable[[Frame, Sighting], None] | None:
    if progress is None:
        return None
    done = iter(range(1, total + 1))

    def count(frame: Frame, sighting: Sighting) -> None:
        del frame, sighting
        progress(next(done), total)

    return count


def _tracked(
    request: TrackRequest, source: Source, track: Track, calibration: Calibration | None, fps: float
) -> Tracked:
    axes = calibration or Calibration(1.0, _origin(request, source), request.axis_angle_rad)  # 1 px = 1 unit
    stamps = "time stamps of the file" if source.is_variable_rate else "frame number / fps"
    return Tracked(
        track=track,
        info=source.info,
        calibration=calibration,
        motion=calibration.apply(track) if calibration else None,
        vectors=tuple(_vector(vector, track, axes) for vector in request.vectors),
        fps=fps,
        video=source.name,
        sha256=source.sha256,
        time_base=f"{stamps}, 0 at the first frame",
        scale_relative_sd=relative_scale_sd(calibration.stick_px) if calibration and calibration.stick_px else None,
        warnings=(*warnings_of(source), *track_warnings(request, track)),
        path=source.path,
        first_picture=request.start,
        picture_step=request.step,
    )


def _vector(vector: VectorRequest, track: Track, axes: Calibration) -> VectorSeries:
    tail, head = (axes.to_m(track.xy_px[:, track.point_index(end)]) for end in (vector.tail, vector.head))
    return vector_series(vector.name, vector.tail, vector.head, tail, head)
