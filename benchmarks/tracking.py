"""Tracking against others, on rendered clips whose truth is known: accuracy, losses, speed, memory, start.

python benchmarks/tracking.py [--quick] [--clips FOLDER] [--out FOLDER]

Ratios and CPU times are the figures to trust: both sides of a ratio are measured in turns in the same run. --quick
leaves out the clip of 10 000 pictures. --out receives the plot (docs/ when not given).
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np
from support.clips import CALM, CASES, POINTS, decode_all, make_clip, radial_rms, to_and_fro, write_long
from support.methods import methods
from support.plot import chart
from support.timing import in_turns, middle, middle_ratio

from vml_course.model.track import Seed
from vml_course.usecases.estimate_track import estimate_track
from vml_course.usecases.track_clip import TrackRequest, track_clip

ROUNDS, SPEED_PICTURES, LONG_PICTURES = 7, 500, 10_000
HERE = Path(__file__).parent


def main() -> None:
    """Run everything and print it as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="leave out the long clip")
    parser.add_argument("--clips", type=Path, default=Path(tempfile.gettempdir()) / "vml-bench")
    parser.add_argument("--out", type=Path, default=HERE.parent / "docs")
    options = parser.parse_args()
    clips = [clip for clip in (make_clip(case, options.clips) for case in CASES) if clip is not None]
    errors = measure_errors(clips)
    print_errors(clips, errors)
    options.out.mkdir(parents=True, exist_ok=True)
    write_plot(clips, errors, options.out / "tracking-peers.svg")
    compressed = next(clip for clip in clips if clip.case.name == "compressed")
    measure_speed(compressed, write_long(compressed, SPEED_PICTURES, options.clips / "speed.mp4"))
    measure_calm(make_clip(CALM, options.clips))
    measure_start(compressed)
    measure_estimate(compressed, options.clips)
    if not options.quick:
        measure_memory(compressed, options.clips)


def settings_of(clip):
    """Our settings of a case: a blurred clip's shutter is known."""
    shutter = clip.case.camera.get("shutter")
    return {"dic": {"shutter": shutter}} if shutter else {}


def measure_errors(clips):
    """Return {(case, method): (distances (n, p), sigma (n, p) or None)}."""
    found = {}
    for clip in clips:
        pictures, truth = clip.frames(), clip.true_px
        for name, method in methods(clip.truth.camera.fps, settings_of(clip)).items():
            xy, sigma = method(pictures, truth[0])
            found[clip.case.name, name] = (xy - truth, sigma)
    return found


def print_errors(clips, errors):
    """Print RMS px a point, pictures lost, and how often the 95 % interval holds."""
    for clip in clips:
        print(f"\n### {clip.case.title} ({len(clip.truth.time_s)} pictures)\n")
        print(f"| method | {' | '.join(POINTS)} | lost of {4 * (len(clip.truth.time_s) - 1)} | within 1.96 sigma |")
        print("|---|" + "---:|" * 6)
        for (case, name), (offsets, sigma) in errors.items():
            if case != clip.case.name:
                continue
            distance = np.hypot(offsets[..., 0], offsets[..., 1])
            cells = " | ".join(f"{radial_rms(distance[1:, k]):.3f}" for k in range(4))
            print(f"| {name} | {cells} | {int(np.isnan(distance).sum())} | {coverage(offsets, sigma)} |")


def coverage(offsets, sigma):
    """Share of coordinates within their 95 % interval."""
    if sigma is None:
        return "-"
    inside = np.abs(offsets[1:]) < 1.96 * sigma[1:, :, None]
    return f"{100 * inside[np.isfinite(offsets[1:])].mean():.0f} %"


def write_plot(clips, errors, path):
    """Draw what `print_errors` says."""
    names = list(dict.fromkeys(name for _, name in errors))
    values = {}
    for clip in clips:
        for name in names:
            distance = np.hypot(*np.moveaxis(errors[clip.case.name, name][0], -1, 0))[1:]
            for k, point in enumerate(POINTS):
                lost = int(np.isnan(distance[:, k]).sum())
                values[clip.case.title, name, point] = radial_rms(distance[:, k]), lost, len(distance)
    titles = [clip.case.title for clip in clips]
    path.write_text(chart("Tracking a rendered kick: distance from the truth", titles, names, list(POINTS), values))
    print(f"\nplot: {path.name}")


def measure_speed(clip, path):
    """Compare CPU time of matching alone, and wall time of whole runs with decoding alone."""
    pictures, seeds = clip.frames(), clip.true_px[0]
    order = to_and_fro(len(pictures), 2 * len(pictures) - 1)
    memory = [pictures[k] for k in order]
    matching = {
        name: (lambda method=method: method(memory, seeds))
        for name, method in methods(clip.truth.camera.fps, {}).items()
    }
    runs = {
        f"{name}, decoded": (lambda name=name: track_clip(request(clip, path, method=name)))
        for name in ("dic", "flow", "block")
    }
    costs = in_turns({"decode": lambda: decode_all(path), **runs}, ROUNDS)
    alone = middle(costs["decode"])
    decode_ms = 1e3 * alone.cpu_s / SPEED_PICTURES
    size_kb = path.stat().st_size / SPEED_PICTURES / 1000
    print(f"\n### Speed, 4 points of 60 x 60 px, 720p H.264, {size_kb:.0f} kB a picture\n")
    print(f"decode alone (PyAV, all threads): {decode_ms:.2f} CPU ms, {SPEED_PICTURES / alone.wall_s:.0f} pictures/s\n")
    print("| matching, pictures in memory | CPU ms a picture | pictures/s | CPU, decode = 1 |\n|---|---:|---:|---:|")
    for name, cost in {k: middle(v) for k, v in in_turns(matching, 3).items()}.items():
        ms = 1e3 * cost.cpu_s / len(memory)
        print(f"| {name} | {ms:.2f} | {len(memory) / cost.wall_s:.0f} | {ms / decode_ms:.2f} |")
    print("\n| whole run, file to track | wall, decode alone = 1 | CPU ms a picture |\n|---|---:|---:|")
    for name in runs:
        ms = 1e3 * middle(costs[name]).cpu_s / SPEED_PICTURES
        print(f"| {name} | {middle_ratio(costs[name], costs['decode']):.2f} | {ms:.2f} |")


def measure_calm(clip):
    """Compare a whole run with decoding alone where nothing is hit: the clip above has an impact in 49 pictures."""
    last = clip.truth.impact.frame_before - 1
    memory = clip.frames()[: last + 1]
    dic = methods(clip.truth.camera.fps, {})["vml dic"]
    alone = middle(in_turns({"dic": lambda: dic(memory, clip.true_px[0])}, ROUNDS)["dic"])
    costs = in_turns(
        {
            "decode": lambda: decode_all(clip.video, last),
            "dic": lambda: track_clip(request(clip, clip.video, end=last)),
        },
        ROUNDS,
    )
    print(f"\n### Speed without an impact, {len(memory)} pictures, 4 points of 60 x 60 px\n")
    per_picture = 1e3 * alone.cpu_s / len(memory)
    print(f"`dic`, pictures in memory, learning the blocks included: {per_picture:.2f} CPU ms a picture")
    print(f"from file to track: {middle_ratio(costs['dic'], costs['decode']):.2f} times decoding alone")


def request(clip, path, **more):
    """Return the request to track the four points of a clip."""
    seeds = tuple(Seed(name, *clip.truth.point_px(name)) for name in POINTS)
    return TrackRequest(path, seeds, fps=clip.truth.camera.fps, **more)


def child(clip, path, cache=None):
    """Track in a process of its own; return its facts and the seconds from its start to its first picture."""
    seeds = {name: clip.truth.point_px(name) for name in POINTS}
    environment = {**os.environ, **({"NUMBA_CACHE_DIR": str(cache)} if cache else {})}
    command = [sys.executable, str(HERE / "support" / "child.py"), str(path), json.dumps(seeds)]
    started = time.time()
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    facts = json.loads(done.stdout)
    return facts, facts["first_picture_at"] - started


def measure_start(clip):
    """Time from starting Python to the first tracked picture: with an empty cache of kernels, and after that."""
    with tempfile.TemporaryDirectory() as cache:
        first = child(clip, clip.video, cache)[1]
        later = [child(clip, clip.video, cache)[1] for _ in range(5)]
    print(f"\n### Start\n\nfirst ever: {first:.1f} s to the first tracked picture; then {median(later):.2f} s")


def measure_estimate(clip, folder):
    """Compare what the estimate says with how long tracking took, on a short and a longer clip."""
    print("\n### Estimate\n\n| clip | estimated s | took s | ratio |\n|---|---:|---:|---:|")
    for path in (clip.video, folder / "speed.mp4"):
        track_clip(request(clip, path))
        rows = []
        for _ in range(ROUNDS):
            said = estimate_track(request(clip, path))
            started = time.perf_counter()
            track_clip(request(clip, path))
            rows.append((said.seconds, time.perf_counter() - started))
        ratios = sorted(a / b for a, b in rows)
        said_s, took_s = (median(column) for column in zip(*rows, strict=True))
        spread = f"{median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})"
        print(f"| {said.frames} pictures | {said_s:.2f} | {took_s:.2f} | {spread} |")


def measure_memory(clip, folder):
    """Compare the peak of memory, and the time per picture, of a short and a very long clip."""
    print("\n### Memory and time by length of the clip\n")
    print("| pictures | peak MB | ms a picture | last tenth / second tenth | lost |")
    print("|---:|---:|---:|---:|---:|")
    for length in (SPEED_PICTURES, LONG_PICTURES):
        path = write_long(clip, length, folder / ("speed.mp4" if length == SPEED_PICTURES else "long.mp4"))
        facts, _ = child(clip, path)
        stamps = np.array(facts["stamps"])
        tenth = length // 10
        times = (stamps[-1] - stamps[-tenth]) / (stamps[2 * tenth] - stamps[tenth + 1])
        per_picture = 1e3 * (stamps[-1] - stamps[1]) / length
        print(f"| {length} | {facts['peak_mb']:.0f} | {per_picture:.2f} | {times:.2f} | {facts['lost']} |")


if __name__ == "__main__":
    main()
