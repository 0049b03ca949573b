"""What the instructor reads of the class: one self-contained HTML page, the only one with names."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from markupsafe import Markup

from assignments.model import Assignment
from assignments.names import names_in
from grader.charts import histogram, scatter_chart
from grader.enrolment import Student
from grader.hints import about
from grader.items import (
    Difficulty,
    Evidence,
    Item,
    Precision,
    difficulty_of,
    items_of,
    mean_share,
    precision_of,
    tracking_px,
)
from grader.ledger import Row
from grader.model import Outcome
from grader.page import Verdict, number, points_text, symbol, template, unit_text, verdict_of

LOW_SHARE = 0.4
"""Who scored less may need help."""


@dataclass(frozen=True)
class Concern:
    """Somebody, or a file, to look at and why; `page` is the student's page, "" when there is none."""

    who: str
    why: str
    page: str = ""


def class_page(
    assignment: Assignment,
    rows: Sequence[Row],
    unreadable: Sequence[tuple[str, str]] = (),
    students: Sequence[Student] = (),
    evidence: Mapping[str, Evidence] | None = None,
) -> str:
    """Return the instructor's page.

    Parameters
    ----------
    assignment : Assignment
    rows : sequence of Row
        Effective grades.
    unreadable : sequence of (file, reason)
    students : sequence of Student
        The whole class: who handed in nothing is listed.
    evidence : mapping of str to Evidence, optional
        By pseudonym; without it precision and difficulty are left out.
    """
    evidence = evidence or {}
    graded = [evidence[row.student.pid] for row in rows if row.student.pid in evidence]
    difficulty = difficulty_of(assignment, rows, evidence)
    mean = mean_share(rows)
    return template("class.html.j2").render(
        title=f"{assignment.title}: class",
        assignment=assignment,
        rows=rows,
        columns=[(q.id, symbol(q.symbol), q.label) for q in assignment.questions],
        cells={row.student.pid: {q.id: _cell(row, q.id) for q in assignment.questions} for row in rows},
        mean="–" if mean is None else f"{100 * mean:.0f} %",
        concerns=list(_concerns(rows, unreadable)),
        missing=_missing(rows, students),
        several=[row for row in rows if row.attempts > 1 or row.late_share > 0],
        adjusted=[row for row in rows if row.adjustments],
        low=[row for row in rows if row.out_of and row.points < LOW_SHARE * row.out_of],
        bars=histogram([row.points / row.out_of for row in rows if row.out_of]),
        items=[_item_line(item) for item in items_of(assignment, rows, evidence)],
        mistakes=_mistakes(assignment, rows),
        precision=[_precision_line(item) for item in precision_of(assignment, graded)],
        tracking=_tracking_words(tracking_px(graded)),
        difficulty=difficulty,
        scatter=_scatter(difficulty),
        variants=_variants(difficulty, rows),
        points_text=points_text,
    )


def _concerns(rows: Sequence[Row], unreadable: Sequence[tuple[str, str]]) -> Iterator[Concern]:
    for row in rows:
        reasons = list(row.reasons) if row.status != "ok" else []
        if row.attempt in row.ignored:
            reasons.append("No attempt counts: too late.")
        if reasons or row.status != "ok":
            yield Concern(_name(row.student), " ".join(reasons), f"{row.student.pid}.html")
    for file, reason in unreadable:
        yield Concern(file, reason.removeprefix(f"{file}: "))


def _name(student: Student) -> str:
    return student.name or student.pid


def _missing(rows: Sequence[Row], students: Sequence[Student]) -> list[Student]:
    graded = {row.student.pid for row in rows}
    return [student for student in students if student.pid not in graded]


def _cell(row: Row, question_id: str) -> Verdict:
    return verdict_of(row.outcomes.get(question_id, Outcome.UNSURE))


def _mistakes(assignment: Assignment, rows: Sequence[Row]) -> list[tuple[str, str, int]]:
    names = names_in(assignment.scene, assignment.questions)
    counted = Counter(code for row in rows for code in row.mistakes)
    return [(code, about(code, names), count) for code, count in counted.most_common()]


# ---------------------------------------------------------------- lines of tables


def _item_line(item: Item) -> tuple[Markup, str, str, str, str]:
    facility = "–" if item.facility is None else f"{100 * item.facility:.0f} %"
    discrimination = "–" if item.discrimination is None else number(round(item.discrimination, 2))
    right = f"{item.right} of {item.answered}"
    return symbol(item.question.symbol), item.question.label, right, facility, discrimination


def _precision_line(item: Precision) -> tuple[Markup, str, str, str, int]:
    unit = "%" if item.is_relative else unit_text(item.question.unit)
    factor = 100 if item.is_relative else 1
    predicted, reached = (f"{number(factor * sd, 2)} {unit}".strip() for sd in (item.predicted, item.reached))
    times = f"{number(item.reached / item.predicted, 2)}" if item.predicted > 0 else "–"
    return symbol(item.question.symbol), predicted, reached, times, item.students


def _tracking_words(distances_px: Sequence[float]) -> str:
    if not distances_px:
        return ""
    middle, most = number(median(distances_px), 2), number(distances_px[-1], 2)
    return (
        f"Tracking tables ({len(distances_px)}): {middle} px from the true trajectory in the median, {most} px at most."
    )


def _scatter(difficulty: Difficulty) -> object:
    if not difficulty.pids:
        return None
    x_label = "predicted sd of the least certain conclusion (%)"
    return scatter_chart(difficulty.sd_percent, difficulty.score_percent, x_label, "score before lateness (%)")


def _variants(difficulty: Difficulty, rows: Sequence[Row]) -> list[tuple[str, str, str]]:
    """Return student, predicted sd and score, the least certain first."""
    names = {row.student.pid: _name(row.student) for row in rows}
    found = zip(difficulty.pids, difficulty.sd_percent, difficulty.score_percent, strict=True)
    by_sd = sorted(found, key=lambda line: -line[1])
    return [(names[pid], f"{number(sd, 2)} %", f"{score:.0f} %") for pid, sd, score in by_sd]
