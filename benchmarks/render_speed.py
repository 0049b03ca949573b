"""How fast clips are rendered, as a ratio to the encoder alone on the same frames in the same run.

    python benchmarks/render_speed.py [--rounds 3] [--seconds 0.2]

One process, 720p, H.264 crf 18. `whole` counts everything from the truth to the finished file; `running`
leaves out what is done once a clip (drawing the room and the bodies). The rounds of all rows take turns, and
the median is shown, so that another load on the machine falls on all alike.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from dataclasses import replace
from pathlib import Path

from vml_course.io.video import write_video
from vml_course.model.recording import Recording
from vml_course.synth.render import render
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate

TARGET = {"sharp": 0.7, "8 instants": 0.3}
FILMED = {
    "sharp": {},
    "8 instants": {"shutter": 0.15},
    "shutter 0.5": {"shutter": 0.5},
    "shutter 0.9": {"shutter": 0.9},
    "hand-held": {"shake_px": 2.0},
}


def clip(how, seconds):
    kind = scene_class("soccer_kick")
    # a slower kick stays in the picture for longer
    scene = kind(time_before_s=seconds / 2, time_after_s=seconds / 2, omega_before_rad_s=12.0)
    return simulate(scene, replace(kind.default_camera, **how), 7)


def measure(truth, folder):
    """Seconds of the clip from truth to file, of what is done once, and of the encoder alone; and how many frames."""
    started, first, pictures = time.perf_counter(), [], []

    def told():
        for picture in render(truth, Recording()):
            first.append(time.perf_counter())
            pictures.append(picture)
            yield picture

    write_video(folder / "clip.mp4", told(), truth.camera.fps)
    whole = time.perf_counter() - started
    once = first[0] - started
    started = time.perf_counter()
    write_video(folder / "again.mp4", pictures, truth.camera.fps)
    return whole, once, time.perf_counter() - started, len(pictures)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=0.2, help="length of the clip, 0.08 to 0.2")
    asked = parser.parse_args()
    truths = {name: clip(how, asked.seconds) for name, how in FILMED.items()}
    found = {name: [] for name in truths}
    with tempfile.TemporaryDirectory() as folder:
        measure(truths["8 instants"], Path(folder))  # compiles the kernels
        for _ in range(asked.rounds):
            for name, truth in truths.items():
                found[name].append(measure(truth, Path(folder)))
    print(f"{'720p, 480 1/s':<14}{'frames':>7}{'encoder 1/s':>13}{'running 1/s':>13}{'once s':>8}", end="")
    print(f"{'running ratio':>15}{'whole ratio':>13}{'target':>8}")
    for name, rows in found.items():
        frames = rows[0][3]
        encoder, running, once = (
            statistics.median(values)
            for values in (
                [frames / alone for _, _, alone, _ in rows],
                [frames / (whole - start) for whole, start, _, _ in rows],
                [start for _, start, _, _ in rows],
            )
        )
        ratio = statistics.median(alone / (whole - start) for whole, start, alone, _ in rows)
        overall = statistics.median(alone / whole for whole, _, alone, _ in rows)
        target = f"{TARGET[name]:g}" if name in TARGET else ""
        print(
            f"{name:<14}{frames:>7}{encoder:>13.1f}{running:>13.1f}{once:>8.2f}{ratio:>15.2f}{overall:>13.2f}{target:>8}"
        )


if __name__ == "__main__":
    main()
