"""How fast clips are rendered, as a ratio to the encoder alone on the same frames in the same run.

    python benchmarks/render_speed.py [--rounds 3] [--seconds 0.2]

720p, H.264 crf 18. `whole` counts everything from the truth to the finished file; `running`
leaves out what is done once a clip (drawing the room and the bodies). The rounds of all rows take turns, and
the median is shown, so that another load on the machine falls on all alike. `work ratio` is the same in seconds
of all processors' work instead of time: what is left of the encoder's share when every processor is busy, and
steadier on a machine that does other things too. Below, the same clips by 1 and by 2 processes.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
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
    """Seconds of the whole clip, of what is done once, of the encoder alone; frames; encoder over all in work."""
    started, first, worked, pictures = time.perf_counter(), [], [], []

    def told():
        for picture in render(truth, Recording()):
            first.append(time.perf_counter())
            worked.append(time.process_time())
            pictures.append(picture)
            yield picture

    write_video(folder / "clip.mp4", told(), truth.camera.fps)
    whole, work = time.perf_counter() - started, time.process_time() - worked[0]
    once = first[0] - started
    started, again = time.perf_counter(), time.process_time()
    write_video(folder / "again.mp4", pictures, truth.camera.fps)
    alone, alone_work = time.perf_counter() - started, time.process_time() - again
    return whole, once, alone, len(pictures), alone_work / work


def make(job):
    """Render one clip into a folder of its own and return its number of frames."""
    how, seconds = job
    truth = clip(how, seconds)
    with tempfile.TemporaryDirectory() as folder:
        return write_video(Path(folder) / "clip.mp4", render(truth, Recording()), truth.camera.fps)


def by_processes(seconds, clips):
    """Print frames a second, simulation and start-up of the processes included, by 1 and 2 processes."""
    print(f"\n{clips} clips{'':<8}{'1 process 1/s':>15}{'2 processes 1/s':>17}{'gain':>7}")
    for name in ("sharp", "8 instants"):
        rates = []
        for count in (1, 2):
            with ProcessPoolExecutor(count, mp_context=get_context("spawn")) as pool:
                list(pool.map(make, [(FILMED[name], 0.08)] * count))  # starts the processes and loads the kernels
                started = time.perf_counter()
                frames = sum(pool.map(make, [(FILMED[name], seconds)] * clips))
                rates.append(frames / (time.perf_counter() - started))
        print(f"{name:<14}{rates[0]:>15.1f}{rates[1]:>17.1f}{rates[1] / rates[0]:>7.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=0.2, help="length of the clip, 0.08 to 0.2")
    parser.add_argument("--clips", type=int, default=4, help="clips of each kind for 1 and 2 processes")
    asked = parser.parse_args()
    truths = {name: clip(how, asked.seconds) for name, how in FILMED.items()}
    found = {name: [] for name in truths}
    with tempfile.TemporaryDirectory() as folder:
        measure(truths["8 instants"], Path(folder))  # compiles the kernels
        for _ in range(asked.rounds):
            for name, truth in truths.items():
                found[name].append(measure(truth, Path(folder)))
    print(f"{'720p, 480 1/s':<14}{'frames':>7}{'encoder 1/s':>13}{'running 1/s':>13}{'once s':>8}", end="")
    print(f"{'running ratio':>15}{'work ratio':>12}{'whole ratio':>13}{'target':>8}")
    for name, rows in found.items():
        frames = rows[0][3]
        encoder, running, once = (
            statistics.median(values)
            for values in (
                [frames / alone for _, _, alone, *_ in rows],
                [frames / (whole - start) for whole, start, *_ in rows],
                [start for _, start, *_ in rows],
            )
        )
        ratio = statistics.median(alone / (whole - start) for whole, start, alone, *_ in rows)
        overall = statistics.median(alone / whole for whole, _, alone, *_ in rows)
        work = statistics.median(row[4] for row in rows)
        target = f"{TARGET[name]:g}" if name in TARGET else ""
        print(
            f"{name:<14}{frames:>7}{encoder:>13.1f}{running:>13.1f}{once:>8.2f}{ratio:>15.2f}{work:>12.2f}{overall:>13.2f}{target:>8}"
        )
    by_processes(asked.seconds, asked.clips)


if __name__ == "__main__":
    main()
