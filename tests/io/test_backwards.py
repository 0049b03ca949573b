"""Reading a video backwards gives the pictures that reading forwards does, in a bounded room."""

from fractions import Fraction

import av
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.errors import FrameRangeError
from vml_course.io import backwards
from vml_course.io.backwards import frames_backwards, pieces
from vml_course.io.index import index_video
from vml_course.io.video import frames_of, write_video
from vml_course.model.frame import Picture

COUNT, WIDTH, HEIGHT = 61, 96, 64
ROOM = 7 * WIDTH * HEIGHT


def pictures():
    grey = np.full((HEIGHT // 2, WIDTH // 2), 128, np.uint8)
    rng = np.random.default_rng(3)
    base = rng.integers(0, 255, (HEIGHT, WIDTH), dtype=np.uint8)
    return (Picture(np.roll(base, 2 * k, axis=1), grey, grey) for k in range(COUNT))


@pytest.fixture(scope="module", params=["clip.mp4", "clip.avi", "clip.ts", "open.mkv"])
def index(request, tmp_path_factory):
    """MP4 with few key pictures, AVI with all, a file that cannot be sought in, and an open GOP."""
    path = tmp_path_factory.mktemp("back") / request.param
    if path.suffix in {".mp4", ".avi"}:
        write_video(path, pictures(), 30.0)
    else:
        _write(path, {"x264-params": "open-gop=1:keyint=12:bframes=3"} if path.suffix == ".mkv" else {})
    return index_video(path)


def _write(path, options):
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=Fraction(30), options={"crf": "10", **options})
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        for one in pictures():
            container.mux(stream.encode(av.VideoFrame.from_ndarray(one.luma, format="gray").reformat(format="yuv420p")))
        container.mux(stream.encode(None))


@pytest.mark.parametrize(("start", "end", "step"), [(0, None, 1), (5, 44, 1), (3, 60, 4), (17, 17, 1)])
def test_backwards_is_forwards_reversed(index, start, end, step):
    forwards = list(frames_of(index, start, end, step))
    back = list(frames_backwards(index, start, end, step, ROOM))
    assert [f.index for f in back] == [f.index for f in reversed(forwards)]
    assert [f.time_s for f in back] == [f.time_s for f in reversed(forwards)]
    assert all(np.array_equal(a.luma, b.luma) for a, b in zip(back, reversed(forwards), strict=True))


def test_a_range_outside_the_video_is_refused_at_once(index):
    with pytest.raises(FrameRangeError, match="start: expected a frame of"):
        frames_backwards(index, COUNT, None, 1)


@given(st.integers(0, 50), st.integers(1, 60), st.integers(1, 5), st.lists(st.integers(0, 400)), st.integers(1, 20))
def test_pieces_hold_every_picture_once_and_never_more_than_fit(start, count, step, keys, longest):
    wanted = range(start, start + count * step, step)
    found = list(pieces(wanted, sorted(set(keys)), longest))
    assert [number for piece in found for number in reversed(piece)] == list(reversed(wanted))
    assert max(map(len, found)) <= longest


def test_no_more_pictures_are_held_than_the_room_has(index, monkeypatch):
    asked = []

    def watched(index, start, end, step):
        asked.append(len(range(start, end + 1, step)))
        return frames_of(index, start, end, step)

    monkeypatch.setattr(backwards, "frames_of", watched)
    assert len(list(frames_backwards(index, 0, None, 1, ROOM))) == COUNT
    assert max(asked[1:]) <= 7  # the first call only checks the range
