"""The main job on a sample course: hand out, measure as students would, hand in, grade.

Nothing is faked: every kick is simulated and rendered, every video is decoded and tracked again from the
file that was handed out, and only the *mistakes* of the sample students are planted.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from assignments.course import Course, new_course
from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.release import WORKBOOK
from assignments.usecases import HandedOut
from assignments.workbook import fill_workbook
from grader.gradebook import Gradebook
from grader.grading import FEEDBACK, Graded, Wanted, grade_files
from grader.handing_out import hand_out_to
from vml_course.errors import InputError
from vml_course.kinetics.lines import solve_by_lines
from vml_course.model.track import Seed
from vml_course.model.tracked import Tracked
from vml_course.usecases.export_track import export_track
from vml_course.usecases.track_clip import TrackRequest, VectorRequest, track_clip

ASSIGNMENT = "soccer-kick"
MARKER = ".vml-demo"
NAMES = ("Ana", "Ben", "Chi", "Dana", "Emre", "Fei", "Gita", "Hugo", "Iris", "Jun", "Kofi", "Lena")
MOST_STUDENTS = 60
LEG = (VectorRequest("leg", "knee", "foot"),)
EXPORTS = ("track.xlsx", "track.csv", "track.mat")

Answers = Mapping[str, float]
Say = Callable[[str, float], None]


@dataclass(frozen=True)
class Persona:
    """A sample student: what they do, and what becomes of right answers in their hands (given px/m)."""

    story: str
    spoil: Callable[[Answers, float], Answers]


def _right(answers: Answers, _px_per_m: float) -> Answers:
    return answers


def _turns_restitution_over(answers: Answers, _px_per_m: float) -> Answers:
    return {**answers, "e": round(1.0 / answers["e"], 3)}


def _forgets_calibration(answers: Answers, px_per_m: float) -> Answers:
    speeds = {name: round(answers[name] * px_per_m, 1) for name in ("v_f1", "v_f2", "v_b1", "v_b2")}
    return {**answers, **speeds, "px_per_m": 1.0}


PERSONAS = (
    Persona("measures and computes rightly", _right),
    Persona("turns the formula of e upside down", _turns_restitution_over),
    Persona("forgets the calibration", _forgets_calibration),
)


@dataclass(frozen=True)
class DemoResult:
    """Where to look.

    Attributes
    ----------
    course : Path
    stories : mapping of str to str
        What each sample student does, by pseudonym.
    graded : tuple of Graded
    """

    course: Path
    stories: Mapping[str, str]
    graded: tuple[Graded, ...]

    @property
    def class_page(self) -> Path:
        """The instructor's page."""
        return self.course / FEEDBACK / ASSIGNMENT / "class.html"


def run_demo(folder: Path, students: int, workers: int, say: Say) -> DemoResult:
    """Run the whole pipeline in `folder` for `students` sample students.

    Parameters
    ----------
    folder : Path
        A new folder, or that of an earlier demo, which is replaced.
    students : int
        1 to 60.
    workers : int
        Processes for handing out.
    say : callable
        `(what is being done, share of the whole from 0 to 1)`.

    Raises
    ------
    InputError
        When the folder holds something else, the number of students is out of range, or a student could
        not be given a variant.
    """
    course = _sample_course(folder, students)
    title = "simulate, render, and solve before release"
    say(title, 0.0)
    handed = hand_out_to(
        course, ASSIGNMENT, workers=workers, progress=lambda done, total: say(title, 0.5 * done / total)
    ).results
    assignment, returned = load_assignment(ASSIGNMENT), []
    for number, item in enumerate(handed):
        if item.status == "failed":
            raise InputError(item.student, "a variant that can be handed out", item.reason)
        persona = PERSONAS[number % len(PERSONAS)]
        say(f"student {number + 1} {persona.story}", 0.5 + 0.45 * number / len(handed))
        returned.append(_hand_in(course, assignment, item, persona))
    say("grade", 0.97)
    graded = grade_files(course, returned, Wanted(show_truth=True))
    stories = {item.student: PERSONAS[number % len(PERSONAS)].story for number, item in enumerate(handed)}
    return DemoResult(course.folder, stories, tuple(graded))


def _sample_course(folder: Path, students: int) -> Course:
    if not 1 <= students <= MOST_STUDENTS:
        raise InputError("students", f"1 to {MOST_STUDENTS} sample students", students)
    if folder.exists() and not (folder / MARKER).is_file():
        hint = "Choose another one with --out, or remove it."
        raise InputError(str(folder), "a new folder or one of an earlier demo", "something else", hint)
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)
    (folder / MARKER).write_text("The next `vml demo` replaces this folder.\n", encoding="utf-8")
    course = new_course(folder, "Sample course")
    people = (f"{NAMES[n % len(NAMES)]} Example {n // len(NAMES) + 1}" for n in range(students))
    rows = "".join(f"{name},student{n}@example.org\n" for n, name in enumerate(people, start=1))
    course.roster.write_text("name,email\n" + rows, encoding="utf-8")
    return course


def _hand_in(course: Course, assignment: Assignment, item: HandedOut, persona: Persona) -> Path:
    """Measure a student's own video and type the answers into a copy of their workbook."""
    with Gradebook.open(course) as gradebook:
        key = gradebook.key_of(assignment.id, item.student)
    desk = course.folder / "students" / item.student
    desk.mkdir(parents=True)
    tracked = _measure(Path(item.place), desk, key)
    answers = persona.spoil(_right_answers(tracked, key), key.truth["px_per_m"])
    units = {question.id: question.unit for question in assignment.questions}
    returned = course.folder / "returned" / f"{item.student}.xlsx"
    returned.parent.mkdir(exist_ok=True)
    fill_workbook(Path(item.place) / WORKBOOK, returned, answers, units, _table(tracked, assignment.points))
    return returned


def _measure(handed: Path, desk: Path, key: AnswerKey) -> Tracked:
    """Track the video from its file; the clicks are the true places to the whole pixel, as a mouse gives them."""
    (video,) = handed.glob("video.*")
    seeds = tuple(Seed(name, *map(round, xy)) for name, xy in zip(key.points, key.xy_px[0].tolist(), strict=True))
    bar = tuple(float(round(key.truth[f"stick_{end}_px"])) for end in ("x1", "y1", "x2", "y2"))
    request = TrackRequest(video=video, seeds=seeds, stick_px=bar, length_m=1.0, fps=key.truth["fps"], vectors=LEG)
    tracked = track_clip(request)
    export_track(tracked, [desk / name for name in EXPORTS], overlay=desk / "overlay.mp4")
    return tracked


def _right_answers(tracked: Tracked, key: AnswerKey) -> Answers:
    """Return what a careful student reports: the straight-line method, four digits."""
    if tracked.motion is None or tracked.calibration is None:  # a scale was given
        raise InputError("scale", "a calibrated clip", "pixels only")
    found = solve_by_lines(tracked.motion, {"m": key.given["m"], "L": key.given["L"]})
    values = {symbol: found.value(symbol) for symbol in key.values if symbol in found.estimates}
    values |= {"px_per_m": tracked.calibration.px_per_m, "fps": tracked.fps}
    return {name: round(float(f"{value:.4g}"), 4) for name, value in values.items()}


def _table(tracked: Tracked, points: Sequence[str]) -> dict[str, Sequence[float]]:
    track, motion = tracked.track, tracked.motion
    columns: dict[str, Sequence[float]] = {"frame": track.frame.tolist(), "t_s": track.time_s.tolist()}
    for name in points:
        if motion is not None:
            columns |= {f"{name}_{axis}_m": motion.of(name)[:, k].tolist() for k, axis in enumerate("xy")}
    return columns
