"""What a student reads, and what the instructor reads of the class: one self-contained HTML page each.

Every text that came from a workbook is hostile until the template has escaped it; there is no script.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from statistics import fmean

import jinja2
from markupsafe import Markup, escape

from assignments.model import AnswerKey, Assignment, Question
from assignments.names import names_in
from assignments.words import split_symbol
from grader.charts import CurveChart, curve_chart, histogram
from grader.checks import explanation_of
from grader.curves import curves_of
from grader.gradebook import Row, Student
from grader.hints import about
from grader.model import Answer, Finding, Grade, Outcome, Submission, overall
from grader.stated import Stated, state
from grader.trajectory import TrajectoryFit, fit_trajectory

GLYPHS = {Outcome.RIGHT: "✓", Outcome.PARTIAL: "◐", Outcome.WRONG: "✗", Outcome.UNSURE: "?"}


@dataclass(frozen=True)
class Verdict:
    """How a question ended, for the page: `mark` is a shape, `word` says the same."""

    outcome: str
    mark: str
    word: str


@dataclass(frozen=True)
class Line:
    """One question on the page."""

    label: str
    symbol: Markup
    own: str
    read_as: str
    where: str
    truth: str
    band: str
    points: str
    verdict: Verdict
    findings: tuple[tuple[Verdict, str, str], ...]


@dataclass(frozen=True)
class Group:
    """Questions of one group, with what they earned."""

    title: str
    points: str
    lines: tuple[Line, ...]
    explanations: tuple[tuple[str, str], ...]


@dataclass(frozen=True, eq=False)
class Report:
    """What a student's page is made of."""

    assignment: Assignment
    submission: Submission
    key: AnswerKey
    grade: Grade
    attempt: int = 1
    show_truth: bool = True
    adjustments: tuple[str, ...] = ()


def feedback_page(report: Report) -> str:
    """Return one student's page.

    With `show_truth` off, neither true values nor the true curve appear.
    """
    grade = report.grade
    fit = fit_trajectory(report.submission.tracking, report.key) if report.show_truth else None
    return _template("feedback.html.j2").render(
        title=f"{report.assignment.title}: feedback",
        assignment=report.assignment,
        pid=report.key.student,
        attempt=report.attempt,
        points=points_text(grade.points, is_provisional=grade.is_provisional),
        out_of=points_text(grade.out_of),
        share=grade.points / grade.out_of if grade.out_of else 0.0,
        needs_person=grade.status != "ok",
        empty=grade.reasons[0] if grade.status == "empty" else "",
        adjustments=report.adjustments,
        hints=_hints(report),
        groups=[_group(report, title, questions) for title, questions in report.assignment.question_groups().items()],
        show_truth=report.show_truth,
        tracking=[_finding(f) for f in grade.of("tracking")],
        charts=_charts(report, fit) if fit else (),
        curve_note=_curve_note(fit) if fit else "",
        has_table=bool(report.submission.tracking),
    )


def _hints(report: Report) -> list[tuple[Markup, str]]:
    """Return each hint once, with the cells that it is about, as symbols."""
    symbols = {question.id: symbol(question.symbol) for question in report.assignment.questions}
    hints: dict[str, dict[Markup, None]] = {}
    for diagnosis in report.grade.diagnosis:
        about_ = (symbols.get(id_, Markup("Tracking table")) for id_ in diagnosis.ids or (diagnosis.subject,))
        hints.setdefault(diagnosis.hint, {}).update(dict.fromkeys(about_))
    return [(Markup(", ").join(cells), hint) for hint, cells in hints.items()]


def _group(report: Report, title: str, questions: Sequence[Question]) -> Group:
    findings = [f for q in questions for f in report.grade.of(q.id)]
    checks = dict.fromkeys(question.check for question in questions)
    return Group(
        title=title.capitalize(),
        points=_points(findings),
        lines=tuple(_line(report, question) for question in questions),
        explanations=tuple((check.replace("_", " ").capitalize(), explanation_of(check)) for check in checks),
    )


def _line(report: Report, question: Question) -> Line:
    answer = report.submission.answer(question.id)
    findings = report.grade.of(question.id)
    truth, band = _truth(report, question, findings) if report.show_truth else ("", "")
    return Line(
        label=question.label,
        symbol=symbol(question.symbol),
        own=_own(answer, question),
        read_as=answer.read_as,
        where=answer.where.rpartition("!")[2],
        truth=truth,
        band=band,
        points=_points(findings),
        verdict=verdict(findings),
        findings=tuple(_finding(finding) for finding in findings),
    )


def _own(answer: Answer, question: Question) -> str:
    stated = state(answer, question)
    text = stated.text if isinstance(stated, Stated) and not answer.read_as else answer.text
    return unit_text(text[:60]) or "nothing"


def _truth(report: Report, question: Question, findings: Sequence[Finding]) -> tuple[str, str]:
    """Return the true value, and the band of full points."""
    value = report.key.values[question.id]
    tolerance = next((f.numbers["tolerance"] for f in findings if "tolerance" in f.numbers), None)
    truth = f"{number(value)} {unit_text(question.unit)}".strip()
    return truth, f"{number(value - tolerance)} to {number(value + tolerance)}" if tolerance is not None else ""


def _finding(finding: Finding) -> tuple[Verdict, str, str]:
    return verdict([finding]), finding.aspect, finding.message


def verdict(findings: Sequence[Finding]) -> Verdict:
    """Return how a question ended: its worst finding; an error that was carried on is shown as such."""
    outcome = overall((f.outcome for f in findings), sum(f.points for f in findings), sum(f.out_of for f in findings))
    if outcome is Outcome.RIGHT and any(finding.carried for finding in findings):
        return Verdict("carried", "↪", "carried on")
    return Verdict(outcome.value, GLYPHS[outcome], outcome.value)


def _points(findings: Sequence[Finding]) -> str:
    is_provisional = any(f.outcome is Outcome.UNSURE and f.out_of > 0 for f in findings)
    earned = points_text(sum(f.points for f in findings), is_provisional=is_provisional)
    return f"{earned} / {points_text(sum(f.out_of for f in findings))}"


def points_text(points: float, *, is_provisional: bool = False) -> str:
    """Return points with two decimals at most, halves rounded up; provisional ones may become fewer.

    >>> points_text(17.525), points_text(20.0), points_text(6, is_provisional=True)
    ('17.53', '20', 'up to 6')
    """
    return f"{'up to ' if is_provisional else ''}{math.floor(points * 100 + 0.5 + 1e-9) / 100:g}"


def _charts(report: Report, fit: TrajectoryFit) -> tuple[CurveChart, ...]:
    charts = (curve_chart(curve) for curve in curves_of(fit, report.key, report.assignment))
    return tuple(chart for chart in charts if chart is not None)


def _curve_note(fit: TrajectoryFit) -> str:
    """Say what was done to the table before it was drawn."""
    done = ["shifted to the true origin"]
    if abs(fit.scale_ratio - 1) > 0.005:
        done.append(f"divided by {fit.scale_ratio:.4g}, the error of its scale")
    if fit.y_down:
        done.append("turned so that y points up")
    if abs(fit.lag_frames) > 0.3:
        done.append(f"compared {abs(fit.lag_frames):.1f} frames {'earlier' if fit.lag_frames > 0 else 'later'}")
    return f"Before drawing, your table was {', '.join(done)}."


# ---------------------------------------------------------------- the class


def class_page(
    assignment: Assignment,
    rows: Sequence[Row],
    unreadable: Sequence[tuple[str, str]] = (),
    students: Sequence[Student] = (),
) -> str:
    """Return the instructor's page; it is the only page with names.

    Parameters
    ----------
    assignment : Assignment
    rows : sequence of Row
        Effective grades.
    unreadable : sequence of (file, reason)
    students : sequence of Student
        The whole class: who handed in nothing is listed.
    """
    ids = [question.id for question in assignment.questions]
    shares = [row.points / row.out_of for row in rows if row.out_of]
    mistakes = Counter(code for row in rows for code in row.mistakes)
    names = names_in(assignment.scene, assignment.questions)
    return _template("class.html.j2").render(
        title=f"{assignment.title}: class",
        assignment=assignment,
        rows=rows,
        columns=[(q.id, symbol(q.symbol), q.label) for q in assignment.questions],
        cells={row.student.pid: {i: _cell(row, i) for i in ids} for row in rows},
        mean=f"{100 * fmean(shares):.0f} %" if shares else "–",
        review=[row for row in rows if row.status != "ok"],
        missing=_missing(rows, students),
        several=[row for row in rows if row.attempts > 1],
        adjusted=[row for row in rows if row.adjustments],
        bars=histogram(shares),
        facility=[(symbol(q.symbol), q.label, _facility(rows, q.id)) for q in assignment.questions],
        mistakes=[(code, about(code, names), count) for code, count in mistakes.most_common()],
        unreadable=[(file, reason.removeprefix(f"{file}: ")) for file, reason in unreadable],
        points_text=points_text,
    )


def _missing(rows: Sequence[Row], students: Sequence[Student]) -> list[Student]:
    graded = {row.student.pid for row in rows}
    return [student for student in students if student.pid not in graded]


def _cell(row: Row, question_id: str) -> Verdict:
    outcome = row.outcomes.get(question_id, Outcome.UNSURE)
    return Verdict(outcome.value, GLYPHS[outcome], outcome.value)


def _facility(rows: Sequence[Row], question_id: str) -> str:
    found = [row.outcomes.get(question_id) for row in rows]
    return f"{sum(outcome is Outcome.RIGHT for outcome in found)} of {len(found)}"


# ---------------------------------------------------------------- words


def symbol(text: str) -> Markup:
    """Return a symbol with its subscript.

    >>> symbol("v_f1")
    Markup('v<sub>f1</sub>')
    """
    letter, below = split_symbol(text)
    return escape(letter) + (Markup("<sub>{}</sub>").format(below) if below else Markup())


def unit_text(text: str) -> str:
    """Return a text with raised digits in its unit.

    >>> unit_text("1.88 kg m^2")
    '1.88 kg m²'
    """
    return text.replace("^2", "²")


def number(value: float) -> str:
    """Return a number with four digits and a real minus sign.

    >>> number(-0.123456), number(15.0)
    ('−0.1235', '15')
    """
    text = f"{value + 0.0:.4g}"
    return ("0" if text == "-0" else text).replace("-", "−")


@cache
def _template(name: str) -> jinja2.Template:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("grader", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(name)
