"""A tracking request from words, as they are typed at the prompt."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from vml_course.errors import InputError
from vml_course.model.reading import read_quantity
from vml_course.model.track import Seed
from vml_course.track.virtual import VirtualPoint
from vml_course.usecases.track_clip import TrackRequest, VectorRequest

_WHOLE = re.compile(r"[0-9]{1,9}")
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)")


def read_request(
    video: Path,
    points: Sequence[str],
    vectors: Sequence[str],
    words: Mapping[str, str | None],
    *,
    marks: Sequence[str] = (),
    virtuals: Sequence[str] = (),
    **settled: Any,
) -> TrackRequest:
    """Return the request that the words say.

    Parameters
    ----------
    points : sequence of str
        `NAME=X,Y` or `NAME=X,Y@FRAME` each.
    marks : sequence of str
        `NAME=X,Y@FRAME` each.
    virtuals : sequence of str
        `NAME=POINT+POINT@X,Y` each.
    vectors : sequence of str
        `NAME=TAIL:HEAD` each.
    words : mapping
        `fps`, `scale` (`X1,Y1,X2,Y2=LENGTH`), `origin` (`X,Y`) and `shutter` (a share or `auto`), None where nothing
        was typed.
    **settled
        Fields of `TrackRequest` that are no words; a setting of None was not typed.

    Raises
    ------
    InputError
        One line that names the option and shows how it is written.
    """
    if not points:
        raise InputError("-p", "at least one point NAME=X,Y", "none")
    stick, length_m, length_text = read_scale(words.get("scale"))
    origin = words.get("origin")
    fps = words.get("fps")
    shutter, finds_shutter = read_shutter(words.get("shutter"))
    given = {**settled.pop("settings", {}), "shutter": shutter}
    return TrackRequest(
        video=video,
        seeds=tuple(map(read_point, points)),
        marks=tuple(map(read_mark, marks)),
        virtuals=tuple(map(read_virtual, virtuals)),
        vectors=tuple(map(read_vector, vectors)),
        stick_px=stick,
        length_m=length_m,
        length_text=length_text,
        settings={name: value for name, value in given.items() if value is not None},
        finds_shutter=finds_shutter,
        origin_px=_pair("--origin", origin) if origin is not None else None,
        fps=read_quantity(fps, "rate", "1/s", name="--fps").value if fps is not None else None,
        **settled,
    )


def read_point(text: str) -> Seed:
    """Read `NAME=X,Y`, with `@FRAME` when it is not the first one.

    >>> read_point("ball=640.5,361")
    Seed(name='ball', x_px=640.5, y_px=361.0, frame=None)
    >>> read_point("ball=640.5,361@40")
    Seed(name='ball', x_px=640.5, y_px=361.0, frame=40)
    """
    return _read_seed("-p", "a point as NAME=X,Y or NAME=X,Y@FRAME, such as ball=640.5,361", text)


def read_mark(text: str) -> Seed:
    """Read `NAME=X,Y@FRAME`: a place given by hand.

    >>> read_mark("ball=640.5,361@57")
    Seed(name='ball', x_px=640.5, y_px=361.0, frame=57)
    """
    expected = "a place by hand as NAME=X,Y@FRAME, such as ball=640.5,361@57"
    mark = _read_seed("--mark", expected, text)
    if mark.frame is None:
        raise InputError("--mark", expected, repr(text))
    return mark


def _read_seed(option: str, expected: str, text: str) -> Seed:
    name, equals, place = text.rpartition("=")
    place, at, frame = place.partition("@")
    if not equals or not name.strip() or (at and not _WHOLE.fullmatch(frame.strip())):
        raise InputError(option, expected, repr(text))
    x, y = _pair(f"{option} {name.strip()}", place)
    return Seed(name.strip(), x, y, int(frame) if at else None)


def read_virtual(text: str) -> VirtualPoint:
    """Read `NAME=POINT+POINT@X,Y`, with another `@FRAME` when it is not where the first of these points is placed.

    >>> read_virtual("knee=shin+foot@420,200")
    VirtualPoint(name='knee', of=('shin', 'foot'), x_px=420.0, y_px=200.0, frame=None)
    """
    name, equals, rest = text.partition("=")
    of, at, place = rest.partition("@")
    carriers = tuple(part.strip() for part in of.split("+"))
    if not (equals and at and name.strip() and all(carriers)):
        raise InputError("--virtual", "a point as NAME=POINT+POINT@X,Y, such as knee=shin+foot@420,200", repr(text))
    seen = _read_seed("--virtual", "a place as X,Y or X,Y@FRAME, such as 420,200", f"{name}={place}")
    return VirtualPoint(seen.name, carriers, seen.x_px, seen.y_px, seen.frame)


def read_shutter(text: str | None) -> tuple[float | None, bool]:
    """Read a share from 0 to 1, or `auto`: the share, and whether it is to be found in the clip.

    >>> read_shutter("0.5"), read_shutter("auto"), read_shutter(None)
    ((0.5, False), (None, True), (None, False))
    """
    if text is None or text.strip() == "auto":
        return None, text is not None
    if not _NUMBER.fullmatch(text.strip()):
        raise InputError("--shutter", "a share of the frame interval from 0 to 1, or auto", repr(text))
    return float(text), False


def read_vector(text: str) -> VectorRequest:
    """Read `NAME=TAIL:HEAD`.

    >>> read_vector("shin=knee:foot")
    VectorRequest(name='shin', tail='knee', head='foot')
    """
    name, equals, ends = text.partition("=")
    tail, colon, head = ends.partition(":")
    parts = [part.strip() for part in (name, tail, head)]
    if not (equals and colon and all(parts)):
        raise InputError("--vector", "a vector as NAME=TAIL:HEAD, such as shin=knee:foot", repr(text))
    return VectorRequest(*parts)


def read_scale(text: str | None) -> tuple[tuple[float, ...] | None, float | None, str]:
    """Read `X1,Y1,X2,Y2=LENGTH` into the stick's ends, its length in metres, and the length as typed.

    >>> read_scale("10,20,110,20=22 cm")
    ((10.0, 20.0, 110.0, 20.0), 0.22, '22 cm')
    """
    if text is None:
        return None, None, ""
    stick, equals, length = text.partition("=")
    ends = _numbers(stick)
    if not equals or len(ends) != 4:
        raise InputError("--scale", 'two points and a length, such as "10,20,110,20=22 cm"', repr(text))
    return ends, read_quantity(length, "length", name="--scale").value, length.strip()


def _pair(name: str, text: str) -> tuple[float, float]:
    numbers = _numbers(text)
    if len(numbers) != 2:
        raise InputError(name, "two numbers X,Y in px, such as 640.5,361", repr(text))
    return numbers[0], numbers[1]


def _numbers(text: str) -> tuple[float, ...]:
    """Return the numbers between commas; nothing when one of them is none."""
    parts = [part.strip() for part in text.split(",")]
    numbers = tuple(float(part) for part in parts if _NUMBER.fullmatch(part))
    return numbers if len(numbers) == len(parts) and all(map(math.isfinite, numbers)) else ()
