"""Practice: a variant with its truth, for students who want to check their method. No course, nothing secret."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from assignments.fairness import allowance
from assignments.model import NOBODY, Assignment, Question
from assignments.release import INSIDE, OUT, Order, Release, make
from assignments.workplace import working_folder
from vml_course.errors import FileFormatError, OutOfRangeError
from vml_course.io.files import making_folder

SOLUTION = "solution.txt"
TRUTH = ("truth.json", "truth.csv")
MOST = 2**31 - 1


@dataclass(frozen=True)
class Practice:
    """What was made: where, and the files by name."""

    folder: Path
    files: tuple[str, ...]


def make_practice(assignment: Assignment, folder: Path, seed: int = 1) -> Practice:
    """Make a variant that everybody may see through: the student's files, the truth and the solution.

    Parameters
    ----------
    assignment : Assignment
    folder : Path
        New or empty.
    seed : int
        Another number gives another variant; none of them is a student's, for no course's secret is in it.

    Raises
    ------
    FileFormatError
        When the folder holds something.
    OutOfRangeError
        When the seed is out of range.
    NoVariantError
    """
    if not 0 <= seed <= MOST:
        raise OutOfRangeError("seed", 0, MOST, "", seed)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise FileFormatError(str(folder), "a new or empty folder", "something in it", "Choose another one with -o.")
    secret = hashlib.sha256(f"practice {seed}".encode()).digest()
    with making_folder(folder), working_folder(folder.parent) as work:
        made = make(Order(assignment, secret, NOBODY), work)
        (work / OUT / SOLUTION).write_text(solution_text(assignment, made), encoding="utf-8", newline="\n")
        for name in TRUTH:
            (work / INSIDE / name).rename(work / OUT / name)
        names = sorted(path.name for path in (work / OUT).iterdir())
        for name in names:
            (work / OUT / name).rename(folder / name)
    return Practice(folder, tuple(names))


def solution_text(assignment: Assignment, made: Release) -> str:
    """Return the true answers, what the reference measured in this very video, and what would be accepted."""
    rows = [_row(question, made) for question in assignment.questions]
    head = ("", "true", "unit", "the reference measured", "accepted")
    widths = [max(len(row[k]) for row in [head, *rows]) for k in range(len(head))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in [head, *rows]]
    frame, time_s = made.key.truth["frame_before"], made.key.truth["t_impact_s"]
    return "\n".join(
        [
            f"{assignment.title}: practice, with its truth",
            "",
            "This variant belongs to nobody: a workbook of it cannot be handed in.",
            "",
            *(line.rstrip() for line in lines),
            "",
            f"Last frame before the impact: {frame:.0f}. Time of the impact: {time_s:.5f} s.",
            "The true path of every point, frame by frame: truth.csv. Everything else that is true: truth.json.",
            "",
        ]
    )


def _row(question: Question, made: Release) -> tuple[str, str, str, str, str]:
    true, key = made.key.values[question.id], made.key
    found = (
        f"{key.measured[question.id]:.5g} ± {key.expected_sd[question.id]:.2g}" if question.id in key.measured else "–"
    )
    allowed = allowance(question, true)
    accepted = f"{true - allowed:.5g} to {true + allowed:.5g}"
    return f"{question.label} {question.symbol}", f"{true:.5g}", question.unit, found, accepted
