"""Draw every scene: docs/gallery.png (all at their impact) and docs/<scene>.gif (3 s of slow motion each).

    python tools/gallery.py [FOLDER]

Without noise, and with an exposure of half a frame, so that one sees what moves. New scenes appear by themselves.
"""

import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import av
import av.filter
import cv2
import numpy as np

from vml_course.io.planes import bgr_of
from vml_course.model.recording import Recording
from vml_course.synth.render import render
from vml_course.synth.scene import scene_class, scene_names
from vml_course.synth.simulate import simulate

SHEET_WIDTH, TITLE_HEIGHT, COLUMNS = 640, 34, 3
GIF_WIDTH, GIF_FPS, GIF_S = 320, 12, 3
MOST_BYTES = 300_000
COLOURS = (96, 48, 24)  # tried in turn until the file is small enough
INK, PAPER = (60, 50, 46), (250, 250, 248)


def film(name):
    """Return the pictures of a scene, blue green red, and which of them shows the impact."""
    kind = scene_class(name)
    scene, camera = kind(), replace(kind.default_camera, shutter=0.5)
    truth = simulate(scene, camera, seed=7)
    return [bgr_of(picture) for picture in render(truth, Recording(noise_grey=0.0))], truth.impact.frame_before


def resized(picture, width):
    height = round(width * picture.shape[0] / picture.shape[1] / 2) * 2
    return cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA)


def tile(picture, title):
    """Return a picture with its title below."""
    small = resized(picture, SHEET_WIDTH)
    label = np.full((TITLE_HEIGHT, SHEET_WIDTH, 3), PAPER, np.uint8)
    scale = min(0.55, 0.55 * (SHEET_WIDTH - 16) / cv2.getTextSize(title, cv2.FONT_HERSHEY_SIMPLEX, 0.55, 1)[0][0])
    cv2.putText(label, title, (8, 22), cv2.FONT_HERSHEY_SIMPLEX, scale, INK, 1, cv2.LINE_AA)
    return np.vstack([small, label])


def sheet(tiles):
    """Lay tiles out in rows; the last may be short."""
    columns = min(COLUMNS, len(tiles))
    height = max(item.shape[0] for item in tiles)
    page = np.full((-(-len(tiles) // columns) * height, columns * SHEET_WIDTH, 3), PAPER, np.uint8)
    for k, item in enumerate(tiles):
        y, x = k // columns * height, k % columns * SHEET_WIDTH
        page[y : y + item.shape[0], x : x + SHEET_WIDTH] = item
    return page


def palette_graph(size, colours):
    """Return ffmpeg's own way to a good GIF: one palette of the whole clip, and no dither that would flicker."""
    graph = av.filter.Graph()
    source = graph.add_buffer(width=size[0], height=size[1], format="bgr24", time_base=Fraction(1, GIF_FPS))
    split, make = graph.add("split"), graph.add("palettegen", f"max_colors={colours}")
    use, sink = graph.add("paletteuse", "dither=none:diff_mode=rectangle"), graph.add("buffersink")
    source.link_to(split)
    split.link_to(use, 0, 0)
    split.link_to(make, 1, 0)
    make.link_to(use, 0, 1)
    use.link_to(sink)
    graph.configure()
    return graph


def write_gif(path, pictures, colours):
    size = pictures[0].shape[1], pictures[0].shape[0]
    graph = palette_graph(size, colours)
    with av.open(str(path), "w", options={"fflags": "+bitexact"}) as container:
        stream = container.add_stream("gif", rate=GIF_FPS)
        stream.width, stream.height, stream.pix_fmt = *size, "pal8"
        for number, picture in enumerate(pictures):
            frame = av.VideoFrame.from_ndarray(picture, format="bgr24")
            frame.pts, frame.time_base = number, Fraction(1, GIF_FPS)
            graph.push(frame)
        graph.push(None)
        for number in range(len(pictures)):
            frame = graph.pull()
            frame.pts, frame.time_base = number, Fraction(1, GIF_FPS)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[1] / "docs")
    tiles = []
    for name in scene_names():
        pictures, impact = film(name)
        tiles.append(tile(pictures[impact], scene_class(name).title))
        shown = np.linspace(0, len(pictures) - 1, GIF_FPS * GIF_S).round().astype(int)
        small, path = [resized(pictures[k], GIF_WIDTH) for k in shown], folder / f"{name}.gif"
        for colours in COLOURS:
            write_gif(path, small, colours)
            if path.stat().st_size <= MOST_BYTES:
                break
        print(f"{path}  {path.stat().st_size / 1000:.0f} kB")
    cv2.imwrite(str(folder / "gallery.png"), sheet(tiles), [cv2.IMWRITE_PNG_COMPRESSION, 9])
    print(f"{folder / 'gallery.png'}  {len(tiles)} scenes")


if __name__ == "__main__":
    main()
