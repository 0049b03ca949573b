"""Solving against the truth: e and I of rendered and tracked kicks, and whether told uncertainties hold in noise.

python benchmarks/kinetics.py [--variants N] [--trials N] [--clips FOLDER]
python benchmarks/kinetics.py --scenes N     every scene with other numbers, rendered and tracked, by its own model
python benchmarks/kinetics.py --models N     what the models tell of themselves in noise, N trials each

Variants are drawn as an assignment draws them (mass, length, e, share of the rate that is lost, speed, gravity; every
other one with a tilted normal), filmed at 480 1/s with 500 px/m, H.264 crf 18 and noise 2, and tracked by `dic` from
true seeds. Tracks are kept in the folder, so that a rerun only solves. Errors are in percent of the truth.
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from support.noisy_models import print_models
from support.solved_scenes import print_scenes

from vml_course.errors import SceneRefusedError, VmlError
from vml_course.io.truth import read_truth_json
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.lines import solve_by_lines
from vml_course.kinetics.models import impact_model
from vml_course.model.camera import Camera
from vml_course.model.motion import Calibration, Motion
from vml_course.model.recording import Recording
from vml_course.model.track import Seed
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate
from vml_course.usecases.make_video import make_video
from vml_course.usecases.track_clip import TrackRequest, track_clip

RECORDING = Recording(crf=18, noise_grey=2.0)
SYMBOLS = ("e", "I")
PIXEL_M = 1 / 500
SPANS = (0.2, 0.6), (0.4, 0.7), (0.35, 0.9), (0.1, 0.4), (6.0, 18.0)  # kg, m, e, share of the rate lost, m/s
MOST_TILT_DEG = 5.0  # of every other variant; the rest strike along the foot's path, as the course's assignment does


def main() -> None:
    """Run everything and print it as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--variants", type=int, default=200)
    parser.add_argument("--trials", type=int, default=300)
    parser.add_argument("--clips", type=Path, default=Path(tempfile.gettempdir()) / "vml-bench-kinetics")
    parser.add_argument("--scenes", type=int, default=0)
    parser.add_argument("--models", type=int, default=0)
    options = parser.parse_args()
    if options.scenes:
        print_scenes(options.scenes, options.clips / "scenes")
    if options.models:
        print_models(options.models, NOISES)
    if options.scenes or options.models:
        return
    clips = [tracked(number, options.clips) for number in range(options.variants)]
    print_errors(clips)
    print_coverage(options.trials)


# ---------------------------------------------------------------- rendered and tracked


def draw(rng, tilt_deg):
    """Draw one kick that can be measured: 10 to 40 % of the rate lost, at most 1.2 rad in 40 ms."""
    while True:
        mass, length, e, lost, speed = (
            rng.uniform(*span) for span in ((0.2, 0.6), (0.4, 0.7), (0.35, 0.9), (0.1, 0.4), (6, 18))
        )
        inertia, rate = mass * length**2 * (1 + e - lost) / lost, speed / length
        if 0.1 <= inertia <= 3.0 and 9.0 <= rate <= 30.0:
            break
    return scene_class("soccer_kick")(
        restitution=e, inertia_kg_m2=inertia, ball_mass_kg=mass, leg_length_m=length, omega_before_rad_s=rate,
        ball_diameter_m=rng.uniform(0.2, 0.24), gravity_moment_N_m=rng.uniform(6, 14),
        normal_tilt_deg=tilt_deg * rng.uniform(-1, 1), impact_phase=rng.uniform(0.05, 0.95),
    )  # fmt: skip


def tracked(number, folder):
    """Return truth and motion of one variant, rendered and tracked unless the folder has it."""
    place = folder / f"{number:03d}"
    if not (place / "track.npz").exists():
        rng = np.random.default_rng([20, number])
        for _ in range(20):
            try:
                made = make_video(draw(rng, MOST_TILT_DEG * (number % 2)), Camera(), RECORDING, number, place)
                break
            except SceneRefusedError:
                continue
        seeds = tuple(Seed(name, *made.truth.point_px(name)) for name in ("foot", "knee", "ball"))
        track = track_clip(TrackRequest(made.video, seeds, method="dic")).track
        np.savez(place / "track.npz", xy=track.xy_px, sigma=track.sigma_px, time=track.time_s, frame=track.frame)
        made.video.unlink()
    kept, truth = np.load(place / "track.npz"), read_truth_json(place / "truth.json")
    camera = truth.camera
    scale = Calibration(camera.px_per_m, (camera.origin_x_px, camera.origin_y_px))
    sigma = kept["sigma"] / camera.px_per_m
    return truth, Motion(
        ("foot", "knee", "ball"), kept["frame"], kept["time"], scale.to_m(kept["xy"]), sigma, camera.px_per_m
    )


WAYS = {
    "joint, drive none": lambda motion, given: impact_model("fixed-pivot").solve(
        motion, given, ImpactOptions(drive="none")
    ),
    "joint, drive free": lambda motion, given: impact_model("fixed-pivot").solve(motion, given, ImpactOptions()),
    "lines, 20 ms": solve_by_lines,
}


def parts(name, clips):
    """Lines take the impulse to be along the foot's path: variants that are and that are not so are told apart."""
    return [("", clips)] if "lines" not in name else [(", no tilt", clips[::2]), (", tilt to 5 deg", clips[1::2])]


def print_errors(clips):
    """Print bias, sd and the worst error of each way to solve, how often 1.96 sd hold, and the time of a clip."""
    print(f"\n### {len(clips)} rendered kicks, tracked by dic\n")
    print("| method | e: bias | sd | worst | in 95 % | I: bias | sd | worst | in 95 % | median s a clip |")
    print("|---|" + "---:|" * 9)
    groups = {f"{name}{which}": (solve, part) for name, solve in WAYS.items() for which, part in parts(name, clips)}
    for name, (solve, part) in groups.items():
        rows, inside, seconds = [], [], []
        for number, (truth, motion) in enumerate(part):
            start = time.perf_counter()
            try:
                found = solve(motion, {"m": truth.given["m"], "L": truth.given["L"]})
            except VmlError as error:
                print(f"variant {number}: {error}")
                continue
            seconds.append(time.perf_counter() - start)
            true = (truth.impact.restitution, truth.impact.inertia_kg_m2)
            rows.append([100 * (found.value(symbol) / value - 1) for symbol, value in zip(SYMBOLS, true, strict=True)])
            inside.append([
                abs(found.value(symbol) - value) < 1.96 * found.estimates[symbol].sd
                for symbol, value in zip(SYMBOLS, true, strict=True)
            ])  # fmt: skip
        rows = np.array(rows)
        cells = [
            f"{rows[:, k].mean():+.3f} | {rows[:, k].std(ddof=1):.3f} | {np.abs(rows[:, k]).max():.2f} | "
            f"{100 * np.mean(np.array(inside)[:, k]):.0f} %"
            for k in (0, 1)
        ]
        print(f"| {name} | {cells[0]} | {cells[1]} | {np.median(seconds):.3f} |")


# ---------------------------------------------------------------- noise


def white(rng, xy):
    """White noise of 0.1 px."""
    return rng.normal(scale=0.1 * PIXEL_M, size=xy.shape)


def alike(rho):
    """AR(1) noise of 0.1 px."""

    def noise(rng, xy):
        values = rng.normal(size=xy.shape)
        for i in range(1, len(values)):
            values[i] = rho * values[i - 1] + math.sqrt(1 - rho**2) * values[i]
        return 0.1 * PIXEL_M * values

    return noise


def locked(rng, xy):
    """Pixel locking of 0.05 px over white noise of 0.02 px: a systematic error that repeats with every pixel."""
    shift = rng.uniform(0, 1, size=(1, *xy.shape[1:]))
    return PIXEL_M * (0.05 * np.sin(2 * np.pi * (xy / PIXEL_M + shift)) + rng.normal(scale=0.02, size=xy.shape))


NOISES = {"white 0.1 px": white, "AR(1), 0.5": alike(0.5), "AR(1), 0.8": alike(0.8), "pixel locking": locked}


def print_coverage(trials):
    """Print how often nominal 95 % intervals hold the truth: by noise alone, and with the floor."""
    kick = scene_class("soccer_kick")
    print(f"\n### Nominal 95 % intervals, {trials} trials each, the paper's kick\n")
    print("| noise | method | e: noise alone | with floor | I: noise alone (log) | with floor | e sd | I sd |")
    print("|---|---|" + "---:|" * 6)
    options = ImpactOptions(drive="none"), ImpactOptions()
    for name, noise in NOISES.items():
        for option in options:
            rng, inside, errors = np.random.default_rng(7), [], []
            for trial in range(trials):
                if trial % 50 == 0:  # another phase of the impact between two frames
                    truth = simulate(kick(impact_phase=rng.uniform(0.05, 0.95)), kick.default_camera, 1)
                    index = [truth.point_index(point) for point in ("foot", "knee", "ball")]
                    exact = truth.xy_m[:, index]
                    sigma = np.full(exact.shape[:2], 0.1 * PIXEL_M)
                    motion = Motion(
                        ("foot", "knee", "ball"), np.arange(len(exact)), truth.time_s, exact, sigma, 1 / PIXEL_M
                    )
                noisy = replace(motion, xy_m=exact + noise(rng, exact))
                found = impact_model("fixed-pivot").solve(noisy, truth.given, option)
                true = (truth.impact.restitution, truth.impact.inertia_kg_m2)
                inside.append(held(found, true))
                errors.append([found.value(s) / value - 1 for s, value in zip(SYMBOLS, true, strict=True)])
            share, sd = 100 * np.mean(inside, axis=0), 100 * np.std(errors, axis=0)
            cells = " | ".join(f"{value:.1f} %" for value in share)
            print(f"| {name} | drive {option.drive} | {cells} | {sd[0]:.2f} % | {sd[1]:.2f} % |")


def held(found, true):
    """Return whether e and I are within 1.96 sd of the truth: by noise alone, and in all; I in logarithms."""
    (e, inertia), (sd_e, sd_i) = true, (found.figures["e_sd_random"], found.figures["I_sd_random"])
    off_e, off_i = abs(found.value("e") - e), abs(math.log(found.value("I") / inertia))
    all_e, all_i = found.estimates["e"].sd, found.estimates["I"].sd
    value = found.value("I")
    return off_e < 1.96 * sd_e, off_e < 1.96 * all_e, off_i < 1.96 * sd_i / value, off_i < 1.96 * all_i / value


if __name__ == "__main__":
    main()
