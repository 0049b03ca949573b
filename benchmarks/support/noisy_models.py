"""Every model on its scene's exact motion with noise added: how often nominal 95 % intervals hold the truth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model, model_names
from vml_course.model.motion import Motion
from vml_course.synth.scene import scene_class, scene_names
from vml_course.synth.simulate import simulate

PIXEL_M = 1 / 500  # what the noises of `kinetics.py` count by
PHASES = (0.2, 0.5, 0.8)  # of the impact between two frames; nearer to a frame its side is a matter of luck


def print_models(trials, noises):
    """Print how often 1.96 sd hold each unknown: by noise alone, and with the floor."""
    print(f"\n### Nominal 95 % intervals of every scene's model, {trials} trials each\n")
    print("| scene | noise | asked | bias | sd | told sd, noise alone | holds | with the floor |")
    print("|---|---|---|" + "---:|" * 5)
    for name in scene_names():
        if scene_class(name).model in model_names():
            for noise, values in noises.items():
                if "0.8" not in noise:
                    _print_row(name, noise, _trials(name, values, trials))


def _trials(name, noise, trials):
    """Return relative errors, sd of noise alone, and whole sd of each unknown, shape (trials, 3)."""
    rng, kind, rows = np.random.default_rng(8), scene_class(name), {}
    for phase in PHASES:
        truth = simulate(kind(impact_phase=phase), kind.default_camera, 1)
        exact = truth.xy_m
        sigma = np.full(exact.shape[:2], 0.1 * PIXEL_M)
        motion = Motion(truth.points, np.arange(len(exact)), truth.time_s, exact, sigma, 1 / PIXEL_M)
        model, options = impact_model(truth.model), ImpactOptions(**truth.declared)
        for _ in range(trials // len(PHASES)):
            found = model.solve(replace(motion, xy_m=exact + noise(rng, exact)), truth.given, options)
            for symbol in truth.impact.unknowns:
                true, said = truth.impact.unknown(symbol), found.estimates[symbol]
                row = np.array([said.value - true, found.figures[f"{symbol}_sd_random"], said.sd]) / true
                rows.setdefault(symbol, []).append(row)
    return rows


def _print_row(name, noise, rows):
    for symbol, values in rows.items():
        off, told, whole = np.array(values).T
        within = [100 * np.mean(np.abs(off) < 1.96 * sd) for sd in (told, whole)]
        print(
            f"| `{name}` | {noise} | {symbol} | {100 * off.mean():+.3f} % | {100 * off.std():.2f} % | "
            f"{100 * np.median(told):.2f} % | {within[0]:.1f} % | {within[1]:.1f} % |",
            flush=True,
        )
