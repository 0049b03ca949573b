"""Draw the gallery of the scenes: `make gallery` writes docs/gallery.png and a slow-motion GIF a scene."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
from av.filter import Graph

from vml_course.model.frame import Picture
from vml_course.model.recording import Recording
from vml_course.model.truth import Truth
from vml_course.synth.render import render
from vml_course.synth.scene import scene_class, scene_names
from vml_course.synth.simulate import simulate

DOCS = Path(__file__).parents[1] / "docs"
TILE = (480, 270)
GIF = (320, 180)
GIF_FRAMES, GIF_FPS, GIF_COLOURS = 30, 10, 96  # three seconds
SPECKLED = 9, 3, 16  # the same of a picture full of speckle, which cannot be packed
AFTER = 12  # frames after the impact: the tile shows both bodies on their ways
SEED = 1


def main() -> None:
    """Draw everything anew."""
    tiles = []
    (DOCS / "gallery").mkdir(parents=True, exist_ok=True)
    for name in scene_names():
        kind = scene_class(name)
        truth = simulate(kind(), kind.default_camera, SEED)
        count, fps, colours = SPECKLED if truth.strain else (GIF_FRAMES, GIF_FPS, GIF_COLOURS)
        last = len(truth.time_s) - 1
        shown = {round(k * last / (count - 1)) for k in range(count)}
        frames = []
        for number, picture in enumerate(render(truth, Recording(noise_grey=0.0))):
            if number in shown:
                frames.append(cv2.resize(_bgr(picture), GIF, interpolation=cv2.INTER_AREA))
            if number == _shown_frame(truth):
                tiles.append(_titled(cv2.resize(_bgr(picture), TILE, interpolation=cv2.INTER_AREA), name))
        _write_gif(DOCS / "gallery" / f"{name}.gif", frames, fps, colours)
        print(name)
    rows = [np.hstack(tiles[k : k + 2]) for k in range(0, len(tiles) - len(tiles) % 2, 2)]
    (DOCS / "gallery.png").write_bytes(
        cv2.imencode(".png", np.vstack(rows), [cv2.IMWRITE_PNG_COMPRESSION, 9])[1].tobytes()
    )


def _shown_frame(truth: Truth) -> int:
    """Return the frame of the tile: soon after the impact, or the first at full load."""
    return int(truth.strain.load.argmax()) if truth.strain else truth.met.frame_before + AFTER


def _bgr(picture: Picture) -> np.ndarray:
    size = picture.luma.shape[1], picture.luma.shape[0]
    red, blue = (cv2.resize(plane, size, interpolation=cv2.INTER_LINEAR) for plane in (picture.red, picture.blue))
    return cv2.cvtColor(np.dstack([picture.luma, red, blue]), cv2.COLOR_YCrCb2BGR)


def _titled(tile: np.ndarray, name: str) -> np.ndarray:
    (width, height), _ = cv2.getTextSize(name, cv2.FONT_HERSHEY_SIMPLEX, 0.55, 1)
    left, base = TILE[0] - width - 16, 26
    cv2.rectangle(tile, (left - 6, base - height - 6), (left + width + 6, base + 8), (244, 244, 244), cv2.FILLED)
    cv2.putText(tile, name, (left, base), cv2.FONT_HERSHEY_SIMPLEX, 0.55, (40, 40, 40), 1, cv2.LINE_AA)
    return tile


def _write_gif(path: Path, frames: list[np.ndarray], fps: int, colours: int) -> None:
    """Write a GIF whose colours are chosen for its own frames."""
    with av.open(str(path), "w", format="gif") as file:
        stream = file.add_stream("gif", rate=fps)
        stream.width, stream.height, stream.pix_fmt = *GIF, "pal8"
        graph = Graph()
        source = graph.add_buffer(width=GIF[0], height=GIF[1], format="bgr24", time_base=Fraction(1, fps))
        split, palette = graph.add("split"), graph.add("palettegen", f"max_colors={colours}")
        use, sink = graph.add("paletteuse", "dither=none"), graph.add("buffersink")
        source.link_to(split)
        split.link_to(use, 0, 0)
        split.link_to(palette, 1, 0)
        palette.link_to(use, 0, 1)
        use.link_to(sink)
        graph.configure()
        for number, frame in enumerate(frames):
            shown = av.VideoFrame.from_ndarray(frame, format="bgr24")
            shown.pts, shown.time_base = number, Fraction(1, fps)
            source.push(shown)
        source.push(None)
        for _ in frames:
            shown = sink.pull()
            shown.pict_type = 0
            file.mux(stream.encode(shown))
        file.mux(stream.encode())


if __name__ == "__main__":
    main()
