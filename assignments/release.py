"""One student's video, made and then really measured: what is released can be solved.

Runs in a worker process: a module-level function of one small frozen record, with files as its result.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from assignments.errors import NotMeasuredError, NoVariantError
from assignments.handout import FirstPicture, render_handout, write_handout
from assignments.key import answer_key, stick_px, true_value
from assignments.model import AnswerKey, Assignment, Variant
from assignments.variants import draw_variant, given_values
from assignments.workbook import write_workbook
from vml_course.errors import VmlError
from vml_course.io.files import sha256_of
from vml_course.io.video import bgr_of, read_frames, read_pictures
from vml_course.kinetics.calibrate import calibrate
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model
from vml_course.model.camera import Camera
from vml_course.model.recording import Recording
from vml_course.model.solution import ImpactSolution
from vml_course.model.track import Seed
from vml_course.model.truth import Truth
from vml_course.synth.scene import scene_class
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker
from vml_course.usecases.make_video import make_video

TRIES = 10  # variants that are rendered at most for one student
BLOCK_PX = 60
RELEASE_SHARE = 0.5  # of the tolerance that the student is held to
WORKBOOK, HANDOUT = "workbook.xlsx", "handout.html"


@dataclass(frozen=True)
class Order:
    """What is to be made: for whom, from which secret, into which two folders.

    Attributes
    ----------
    work : str
        For what stays here: the truth beside the video.
    out : str
        For what is handed out.
    """

    assignment: Assignment
    secret: bytes
    student: str
    work: str
    out: str
    due: str = ""


@dataclass(frozen=True, eq=False)
class Release:
    """What was made: the variant, its key, and why earlier variants were not released."""

    variant: Variant
    key: AnswerKey
    refused: tuple[str, ...]


def release(order: Order) -> Release:
    """Draw, render, measure; draw again until the measurement agrees; then write what the student gets.

    Raises
    ------
    NoVariantError
        When none of `TRIES` variants can be measured well enough.
    """
    refused: list[str] = []
    for variant in _variants(order):
        try:
            truth, measured, video = _film_and_measure(order, variant)
            _hold(order.assignment, truth, measured)
        except VmlError as error:
            refused.append(f"draw {variant.redraws}: {error}")
            continue
        key = answer_key(order.assignment, variant, truth, measured, sha256_of(video))
        _write(order, variant, truth, video)
        return Release(variant, key, tuple(refused))
    raise NoVariantError(order.assignment.id, TRIES, refused[-3:])


def measure(video: Path, truth: Truth, assignment: Assignment, stick_m: float) -> ImpactSolution:
    """Measure a video from its file as a careful student does; only the first clicks come from the truth.

    Parameters
    ----------
    video : Path
    truth : Truth
    assignment : Assignment
    stick_m : float
        The known length that the student is told.

    Raises
    ------
    VmlError
        When the points are lost or no impact is found.
    """
    seeds = [Seed(point, *truth.point_px(point)) for point in assignment.points]
    track = run(make_tracker("dic", block=BLOCK_PX), read_frames(video), seeds, fps=truth.camera.fps)
    options: dict[str, Any] = {**truth.declared, **assignment.solve}
    motion = calibrate(stick_px(truth, assignment), stick_m).apply(track)
    return impact_model(assignment.model).solve(motion, truth.given, ImpactOptions(**options))


def _variants(order: Order) -> Iterator[Variant]:
    first = 0
    for _ in range(TRIES):
        variant = draw_variant(order.assignment, order.secret, order.student, first=first)
        yield variant
        first = variant.redraws + 1


def _film_and_measure(order: Order, variant: Variant) -> tuple[Truth, ImpactSolution, Path]:
    settings: dict[str, Any] = {**variant.parameters, **order.assignment.words}
    scene = scene_class(order.assignment.scene)(**settings)
    recording: dict[str, Any] = dict(variant.recording)
    made = make_video(scene, Camera(**variant.camera), Recording(**recording), variant.seed, Path(order.work))
    stick_m = given_values(order.assignment, variant)[order.assignment.stick.given]
    return made.truth, measure(made.video, made.truth, order.assignment, stick_m), made.video


def _hold(assignment: Assignment, truth: Truth, measured: ImpactSolution) -> None:
    """Check that every conclusion comes back within a share of the student's tolerance."""
    for question in assignment.questions:
        if question.group == "conclusion" and question.id in measured.estimates:
            true, found = true_value(question.id, truth), measured.value(question.id)
            allowed = question.tolerance * RELEASE_SHARE
            if not abs(found - true) <= allowed * abs(true):
                raise NotMeasuredError(question.id, true, found, allowed)


def _write(order: Order, variant: Variant, truth: Truth, video: Path) -> None:
    out, assignment = Path(order.out), order.assignment
    given = given_values(assignment, variant)
    first = next(iter(read_pictures(video, end=0)))
    points_px = {point: truth.point_px(point) for point in assignment.points}
    picture = FirstPicture(bgr_of(first.picture), points_px, stick_px(truth, assignment))
    html = render_handout(assignment, variant, given, picture, video=video.name, due=order.due)
    write_workbook(out / WORKBOOK, assignment, variant, given)
    write_handout(out / HANDOUT, html)
    video.rename(out / video.name)
