"""How much memory a clip takes, short and ten times as long: peak resident size of a process of its own each.

    python benchmarks/render_memory.py

The frames of one short kick are made over and over, from the truth to the encoder, so that both clips show the
same; noise is new in every frame. Peak sizes are the operating system's (`ru_maxrss`; not on Windows).
"""

from __future__ import annotations

import argparse
import itertools
import resource
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from vml_course.io.video import write_video
from vml_course.model.recording import Recording
from vml_course.synth.render import draw_frames
from vml_course.synth.scene import scene_class
from vml_course.synth.sensor import make_sensor
from vml_course.synth.simulate import simulate

FILMED = {"sharp": {}, "shutter 0.5": {"shutter": 0.5}, "rolling, bent": {"rolling_shutter": 0.5, "distortion": 0.05}}
FRAMES = (200, 2000)
SMALL = {"width_px": 640, "height_px": 360, "px_per_m": 250.0, "origin_x_px": 210.0, "origin_y_px": 100.0}


def film(how, frames):
    """Write a clip of some frames and return this process's peak size in MiB."""
    kind = scene_class("soccer_kick")
    truth = simulate(kind(), replace(kind.default_camera, **SMALL, **FILMED[how]), 7)
    sensor = make_sensor(truth, Recording())
    drawn = itertools.chain.from_iterable(draw_frames(truth) for _ in itertools.count())
    numbered = enumerate(itertools.islice(drawn, frames))
    pictures = (sensor.expose(planes, number % len(truth.time_s)) for number, planes in numbered)
    with tempfile.TemporaryDirectory() as folder:
        assert write_video(Path(folder) / "clip.mp4", pictures, truth.camera.fps) == frames
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def in_a_process(how, frames):
    """Return the peak size, MiB, of a process that films."""
    command = [sys.executable, __file__, "--film", how, "--frames", str(frames)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--film", choices=FILMED, help="film in this process and print its peak size, MiB")
    parser.add_argument("--frames", type=int, default=FRAMES[0])
    asked = parser.parse_args()
    if asked.film:
        print(film(asked.film, asked.frames))
        return
    print(f"{'640 x 360':<14}" + "".join(f"{f'{frames} frames, MiB':>20}" for frames in FRAMES) + f"{'more':>8}")
    for how in FILMED:
        short, long = (in_a_process(how, frames) for frames in FRAMES)
        print(f"{how:<14}{short:>20.0f}{long:>20.0f}{long / short - 1:>8.1%}")


if __name__ == "__main__":
    main()
