"""One student's video, made and then really measured: what is released can be solved.

Runs in a worker: a module-level function of one small frozen record. What was made comes back as bytes (half a
megabyte for a kick), so that a worker needs neither the course's folder nor a file system in common.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assignments.errors import NotMeasuredError, NoVariantError
from assignments.fairness import allowance, conclusions, fair_variant, hold_fair, precision, solve
from assignments.film import film
from assignments.handout import FirstPicture, render_handout, write_handout
from assignments.impact_frame import ImpactFrame, cut_for, index_of
from assignments.key import answer_key, stick_px, true_value
from assignments.model import AnswerKey, Assignment, Variant
from assignments.variants import given_values
from assignments.workbook import write_workbook
from assignments.workplace import working_folder
from vml_course.errors import VmlError
from vml_course.io.files import sha256_of
from vml_course.io.video import bgr_of, read_frames, read_pictures
from vml_course.model.solution import ImpactSolution
from vml_course.model.track import Seed, Track
from vml_course.model.truth import Truth
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker
from vml_course.usecases.make_video import MadeVideo

TRIES = 10  # variants that are rendered at most for one student
BLOCK_PX = 60
RELEASE_SHARE = 0.5  # of the tolerance that the student is held to
WORKBOOK, HANDOUT = "workbook.xlsx", "handout.html"
OUT, INSIDE = "out", "inside"  # what is handed out, and the truth beside the video: never in one folder


@dataclass(frozen=True)
class Order:
    """What is to be made, for whom, and from which secret; printing it does not show the secret."""

    assignment: Assignment
    secret: bytes = field(repr=False)
    student: str
    terms: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Release:
    """What was made: the variant, its key, and why earlier variants were not released.

    Attributes
    ----------
    files : mapping of str to bytes
        What the student gets, by name.
    impact : ImpactFrame or None
        The picture of the impact for later pages; no student gets it.
    cpu_s : mapping of str to float
        Seconds of processor time by stage: draw, film, track, solve, write. Rejected variants are in it.
    """

    variant: Variant
    key: AnswerKey
    refused: tuple[str, ...]
    files: Mapping[str, bytes] = field(default_factory=dict)
    cpu_s: Mapping[str, float] = field(default_factory=dict)
    impact: ImpactFrame | None = None


def release(order: Order) -> Release:
    """Draw, render, measure; draw again until the measurement agrees; return what the student gets.

    Raises
    ------
    NoVariantError
        When none of `TRIES` variants can be measured well enough.
    """
    with working_folder() as folder:
        return make(order, folder)


def make(order: Order, folder: Path) -> Release:
    """Do as `release`, and leave the files in `folder`: those of the student in `out`, the truth in `inside`.

    Raises
    ------
    NoVariantError
    """
    clock, refused, first = Clock(), list[str](), 0
    for _ in range(TRIES):
        with clock.running("draw"):
            fair = fair_variant(order.assignment, order.secret, order.student, first=first)
        refused += fair.refused
        first = fair.variant.redraws + 1
        try:
            made, measured = _film_and_measure(order.assignment, fair.variant, folder / INSIDE, clock)
        except VmlError as error:
            refused.append(f"draw {fair.variant.redraws}: {error}")
            continue
        key = answer_key(order.assignment, fair.variant, made.truth, measured, sha256_of(made.video))
        with clock.running("write"):
            files, impact = _write(order, fair.variant, made, key, folder / OUT)
        return Release(fair.variant, key, tuple(refused), files, clock.cpu_s, impact)
    raise NoVariantError(order.assignment.id, TRIES, refused[-3:])


def track_points(video: Path, truth: Truth, assignment: Assignment) -> Track:
    """Track a video from its file as a careful student does; only the first clicks come from the truth.

    Raises
    ------
    VmlError
    """
    seeds = [Seed(point, *truth.point_px(point)) for point in assignment.points]
    return run(make_tracker("dic", block=BLOCK_PX), read_frames(video), seeds, fps=truth.camera.fps)


class Clock:
    """Adds up processor time by stage; that of all threads, waiting not counted."""

    def __init__(self) -> None:
        self.cpu_s: dict[str, float] = {}

    @contextmanager
    def running(self, stage: str) -> Iterator[None]:
        """Count a block to a stage."""
        start_s = time.process_time()
        try:
            yield
        finally:
            self.cpu_s[stage] = self.cpu_s.get(stage, 0.0) + time.process_time() - start_s


def _film_and_measure(
    assignment: Assignment, variant: Variant, folder: Path, clock: Clock
) -> tuple[MadeVideo, ImpactSolution]:
    with clock.running("film"):
        made = film(variant, folder)
    with clock.running("track"):
        track = track_points(made.video, made.truth, assignment)
    with clock.running("solve"):
        measured = solve(track, made.truth, assignment, variant)
    _hold(assignment, made.truth, measured)
    return made, measured


def _hold(assignment: Assignment, truth: Truth, measured: ImpactSolution) -> None:
    """Check that every conclusion comes back within a share of the student's tolerance, as sharply as for others."""
    for question in conclusions(assignment):
        if question.id in measured.estimates:
            true, found = true_value(question.id, truth), measured.value(question.id)
            allowed = RELEASE_SHARE * allowance(question, true)
            if not abs(found - true) <= allowed:
                raise NotMeasuredError(question.id, true, found, allowed)
    hold_fair(assignment, precision(assignment, truth, measured))


def _pictures(video: Path, key: AnswerKey) -> tuple[NDArray[np.uint8], ImpactFrame | None]:
    """Return the first picture, blue, green, red, and that of the impact, in one pass."""
    index = index_of(key) or 0
    read = read_pictures(video, 0, index, max(index, 1))
    pictures = {frame.index: bgr_of(frame.picture) for frame in read}
    return pictures[0], cut_for(key, pictures[index], index)


def _write(
    order: Order, variant: Variant, made: MadeVideo, key: AnswerKey, out: Path
) -> tuple[dict[str, bytes], ImpactFrame | None]:
    assignment, truth = order.assignment, made.truth
    given = given_values(assignment, variant)
    still, impact = _pictures(made.video, key)
    points_px = {point: truth.point_px(point) for point in assignment.points}
    picture = FirstPicture(still, points_px, stick_px(truth, assignment))
    html = render_handout(assignment, variant, given, picture, video=made.video.name, terms=order.terms)
    out.mkdir()
    write_workbook(out / WORKBOOK, assignment, variant, given)
    write_handout(out / HANDOUT, html)
    made.video.rename(out / made.video.name)
    return {path.name: path.read_bytes() for path in sorted(out.iterdir())}, impact
