"""See an assignment as a student and as an instructor before it is handed out: one made-up variant, complete."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from assignments.model import Assignment
from assignments.release import OUT, Order, make
from assignments.solution import write_solution
from assignments.workplace import working_folder
from vml_course.io.files import making_folder

SOLUTION = "solution.html"
_SECRET = b"a preview keeps no secret"


@dataclass(frozen=True)
class Preview:
    """What was made: the files, and why variants before this one were drawn again."""

    folder: Path
    files: tuple[str, ...]
    redraws: int
    refused: tuple[str, ...]


def preview(assignment: Assignment, folder: Path, number: int = 1) -> Preview:
    """Make video, workbook, handout and the instructor's solution of one variant.

    Parameters
    ----------
    assignment : Assignment
    folder : Path
        Made when missing; files of an earlier preview are replaced.
    number : int
        Another number is another variant.

    Raises
    ------
    NoVariantError
        When no variant can be drawn, filmed and measured.
    """
    with making_folder(folder), working_folder(folder) as work:
        made = make(Order(assignment, _SECRET, f"preview-{number}"), work)
        out = work / OUT
        write_solution(out / SOLUTION, assignment, made.key)
        names = sorted(path.name for path in out.iterdir())
        for name in names:
            (out / name).replace(folder / name)
    return Preview(folder, tuple(names), made.variant.redraws, made.refused)
