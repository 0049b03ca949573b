"""Hold the whole chain to the truth: render known impacts, track them, solve them, compare with a budget.

Every case is seeded and fixed, so that the same program gives the same figures. What is compared runs through the
files: a rendered video is encoded, opened, tracked from the true places in its first picture, and solved.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import numpy as np

from vml_course.errors import VmlError
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model, model_names
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Calibration
from vml_course.model.quantity import quantities_of
from vml_course.model.recording import Recording
from vml_course.model.solution import ImpactSolution
from vml_course.model.track import Seed, Track
from vml_course.model.truth import Truth
from vml_course.synth.scene import scene_class, scene_names
from vml_course.track.tracker import tracker_class, tracker_names
from vml_course.usecases.budget import Limits, limits_of
from vml_course.usecases.make_video import MadeVideo, make_video
from vml_course.usecases.track_clip import TrackRequest, track_clip

SEED = 20
WITHIN_95 = 1.96
MAIN_SCENE = "soccer_kick"
QUICK = (("clean", "dic"), ("compressed", "dic"), ("compressed", "flow"), ("compressed", "block"), ("blurred", "dic"))
LIMITED = {"omega_error_pct": "omega1", "restitution_error_pct": "e", "inertia_error_pct": "I"}
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Condition:
    """One way of filming: camera fields and a recording."""

    name: str
    recording: Recording
    camera: Mapping[str, float] = field(default_factory=dict)


CONDITIONS = (
    Condition("clean", Recording(crf=0, noise_grey=1.0)),
    Condition("noisy", Recording(crf=0, noise_grey=4.0)),
    Condition("compressed", Recording(crf=18, noise_grey=2.0)),
    Condition("blurred", Recording(crf=18, noise_grey=2.0), {"fps": 240.0, "shutter": 0.9}),
)


@dataclass(frozen=True)
class Case:
    """A scene, how it is filmed, and by which method it is tracked."""

    scene: str
    condition: Condition
    method: str

    @property
    def name(self) -> str:
        """The row of the budget: `scene/condition/method`."""
        return f"{self.scene}/{self.condition.name}/{self.method}"

    @property
    def is_quick(self) -> bool:
        """Whether it is among the main cases: several of the paper's kick, one of every other scene."""
        how = self.condition.name, self.method
        return how in QUICK if self.scene == MAIN_SCENE else how == ("compressed", "dic")


@dataclass(frozen=True)
class Score:
    """How far a case is off the truth; units as in `Limits`, NaN where there is no such figure.

    Attributes
    ----------
    rms_px : mapping of str to float
        Of every point, over the pictures in which it was found.
    error_pct : mapping of str to float
        Of the striker's angular velocity `omega1` and of each unknown of the scene, by symbol.
    coverage_pct : float
        Share of coordinates within 1.96 of their sigma.
    note : str
        Why there is no solution, "" when there is one.
    """

    case: str
    rms_px: Mapping[str, float]
    lost_pictures: int
    coverage_pct: float
    worst_time_error_ms: float
    error_pct: Mapping[str, float]
    note: str = ""

    @property
    def worst_rms_px(self) -> float:
        """Of the worst point."""
        return float(np.max(list(self.rms_px.values())))

    @property
    def omega_error_pct(self) -> float:
        """Of the striker's angular velocity before the impact."""
        return self.error_pct.get("omega1", float("nan"))

    @property
    def restitution_error_pct(self) -> float:
        """Of e."""
        return self.error_pct.get("e", float("nan"))

    @property
    def inertia_error_pct(self) -> float:
        """Of I."""
        return self.error_pct.get("I", float("nan"))

    @property
    def other_error_pct(self) -> float:
        """Of the worst of all other unknowns."""
        others = [error for symbol, error in self.error_pct.items() if symbol not in LIMITED.values()]
        return float(np.max(others)) if others else float("nan")


@dataclass(frozen=True)
class Verdict:
    """A score, its limits, and the names of those that it breaks."""

    score: Score
    limits: Limits
    broken: tuple[str, ...]


def cases(*, quick: bool = False) -> list[Case]:
    """Return the matrix: every scene that can be solved, condition and method, or the quick part of it.

    A scene is left out as long as there is no model of its impact, a condition as long as the camera does not
    know its fields.
    """
    known = set(quantities_of(scene_class(scene_names()[0]).default_camera))
    conditions = [condition for condition in CONDITIONS if set(condition.camera) <= known]
    solvable = [name for name in scene_names() if scene_class(name).model in model_names()]
    matrix = [Case(s, c, m) for s in solvable for c in conditions for m in tracker_names()]
    return [case for case in matrix if not quick or case.is_quick]


def validate(
    rows: dict[str, dict[str, float]], matrix: Sequence[Case], progress: Progress | None = None
) -> list[Verdict]:
    """Run cases and judge them.

    Parameters
    ----------
    rows : dict
        The budget, of `read_budget`.
    matrix : sequence of Case
        Of `cases`; a clip is rendered once for all its methods.
    progress : callable, optional
        Told after every case: how many are done, of how many.
    """
    verdicts: list[Verdict] = []
    with tempfile.TemporaryDirectory(prefix="vml-validate-") as folder:
        made: dict[tuple[str, str], MadeVideo] = {}
        for case in matrix:
            key = case.scene, case.condition.name
            if key not in made:
                made[key] = _render(case, Path(folder) / "-".join(key))
            verdicts.append(judge(run_case(case, made[key]), limits_of(rows, case.name)))
            if progress:
                progress(len(verdicts), len(matrix))
    return verdicts


def run_case(case: Case, made: MadeVideo) -> Score:
    """Track and solve one rendered clip, and compare with its truth."""
    truth = made.truth
    seeds = tuple(Seed(name, *truth.point_px(name)) for name in truth.points)
    request = TrackRequest(made.video, seeds, method=case.method, settings=_settings(case))
    track = track_clip(request).track
    try:
        solution, note = _solve(truth, track), ""
    except VmlError as error:
        solution, note = None, str(error)
    return _score(case.name, truth, track, solution, note)


def judge(score: Score, limits: Limits) -> Verdict:
    """Return which limits a score breaks; what is NaN breaks its limit."""
    broken = [limit for limit, value, most in _compared(score, limits) if np.isfinite(most) and not value <= most]
    if not score.coverage_pct >= limits.coverage_least_pct:
        broken.append("coverage_least_pct")
    return Verdict(score, limits, tuple(broken))


def _compared(score: Score, limits: Limits) -> Iterator[tuple[str, float, float]]:
    """Yield limits with what they limit; those of quantities that the scene does not have are left out."""
    has_others = bool(set(score.error_pct) - set(LIMITED.values()))
    for limit in fields(Limits):
        name, symbol = limit.name, LIMITED.get(limit.name)
        absent = (symbol and symbol not in score.error_pct) or (name == "other_error_pct" and not has_others)
        if name != "coverage_least_pct" and not absent:
            yield name, getattr(score, name), getattr(limits, name)


def _render(case: Case, folder: Path) -> MadeVideo:
    scene = scene_class(case.scene)
    camera = replace(scene.default_camera, **case.condition.camera)
    return make_video(scene(), camera, case.condition.recording, SEED, folder)


def _settings(case: Case) -> dict[str, float]:
    """Return the settings that the filming calls for: a known shutter, where the method can use it."""
    shutter = case.condition.camera.get("shutter")
    return {"shutter": shutter} if shutter and "shutter" in quantities_of(tracker_class(case.method)) else {}


def _solve(truth: Truth, track: Track) -> ImpactSolution:
    """Solve in metres, by the true scale: what is left is the error of tracking and solving."""
    camera = truth.camera
    motion = Calibration(camera.px_per_m, (camera.origin_x_px, camera.origin_y_px)).apply(track)
    model = impact_model(truth.model)
    options = ImpactOptions(**truth.declared)  # type: ignore[arg-type]
    return model.solve(motion, truth.given, options)


def _score(case: str, truth: Truth, track: Track, solution: ImpactSolution | None, note: str) -> Score:
    offset = track.xy_px - truth.xy_px[: len(track.frame)]
    found, impact = np.isfinite(offset[1:]), truth.met
    within = np.abs(offset[1:]) <= WITHIN_95 * track.sigma_px[1:, :, None]
    true = {symbol: impact.unknown(symbol) for symbol in impact.unknowns}
    if impact.omega_before_rad_s and (solution is None or "omega1" in solution.estimates):
        true["omega1"] = impact.omega_before_rad_s
    missing = len(truth.time_s) - len(track.frame)  # pictures that never came out of the file
    return Score(
        case=case,
        rms_px={name: _rms(offset[1:, k]) for k, name in enumerate(track.points)},
        lost_pictures=int(track.is_lost.sum()) + missing,
        coverage_pct=100.0 * float(within[found].mean()) if found.any() else 0.0,
        worst_time_error_ms=1e3 * float(np.abs(track.time_s - truth.time_s[: len(track.frame)]).max()),
        error_pct={symbol: _off_pct(solution, symbol, value) for symbol, value in true.items()},
        note=note,
    )


def _rms(offset_px: FloatArray) -> float:
    squares = (offset_px**2).sum(axis=-1)
    found = squares[np.isfinite(squares)]
    return float(np.sqrt(found.mean())) if found.size else float("nan")


def _off_pct(solution: ImpactSolution | None, symbol: str, true: float) -> float:
    if solution is None or symbol not in solution.estimates:
        return float("nan")
    return 100.0 * abs(solution.estimates[symbol].value / true - 1.0)
