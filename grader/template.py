"""Where the workbook that we hand out has its answer cells, for a copy whose names and labels were lost."""

from __future__ import annotations

from collections.abc import Mapping

from assignments.model import Assignment
from assignments.sheets import ANSWERS

_FIRST_ROW = 5


def template_cells(assignment: Assignment) -> Mapping[str, str]:
    """Return sheet and address of each answer by question id, such as `Answers!C7`."""
    cells, row = {}, _FIRST_ROW
    for questions in assignment.question_groups().values():
        for question in questions:
            row += 1
            cells[question.id] = f"{ANSWERS}!C{row}"
        row += 1
    return cells
