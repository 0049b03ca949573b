"""What a student reads: one self-contained HTML page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

from markupsafe import Markup

from assignments.model import AnswerKey, Assignment, Question
from assignments.terms import Terms
from grader.advice import next_steps
from grader.charts import CurveChart, PointsChart, curve_chart
from grader.checks import explanation_of
from grader.class_page import class_page
from grader.counting import Standing, standing
from grader.curves import curves_of, points_chart
from grader.frame import ImpactFrame
from grader.ledger import Row
from grader.levels import levels_of
from grader.model import Answer, Finding, Grade, Submission
from grader.page import Verdict, earned_text, number, points_text, prose, symbol, template, unit_text, verdict
from grader.stated import Stated, state
from grader.trajectory import TrajectoryFit, fit_trajectory

__all__ = ["Report", "class_page", "feedback_page", "points_text", "verdict"]


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
    """What a student's page is made of.

    Attributes
    ----------
    show_truth : bool
        Whether true values, the true curves and the true points are shown.
    adjustments : tuple of str
        What a person decided, in words.
    row : Row, optional
        What counts of all attempts, after lateness and decisions; without it the page shows this attempt alone.
    terms : Terms
        With the student's extensions.
    due : str
        The due date in words, "" when there is none.
    closes : str
        A sentence on the last moment to hand in, "" when there is none.
    is_over : bool
        Whether the last moment to hand in has passed.
    frame : ImpactFrame, optional
        The picture of the impact, from `grader.frame.impact_frame`.
    """

    assignment: Assignment
    submission: Submission
    key: AnswerKey
    grade: Grade
    attempt: int = 1
    show_truth: bool = True
    adjustments: tuple[str, ...] = ()
    row: Row | None = None
    terms: Terms = field(default_factory=Terms)
    due: str = ""
    closes: str = ""
    is_over: bool = False
    frame: ImpactFrame | None = None


def feedback_page(report: Report) -> str:
    """Return one student's page.

    With `show_truth` off, neither true values nor the true curve nor the true points appear.
    """
    grade = report.grade
    fit = _fit(report)
    points, out_of, is_provisional = _total(report)
    return template("feedback.html.j2").render(
        title=f"{report.assignment.title}: feedback",
        assignment=report.assignment,
        prose=partial(prose, symbols=[question.symbol for question in report.assignment.questions]),
        pid=report.key.student,
        attempt=report.attempt,
        points=points_text(points, is_provisional=is_provisional),
        out_of=points_text(out_of),
        share=points / out_of if out_of else 0.0,
        needs_person=(report.row.status if report.row else grade.status) != "ok",
        empty=grade.reasons[0] if grade.status == "empty" else "",
        adjustments=report.adjustments,
        standing=standing_of(report).sentences,
        levels=[(level, earned_text(level.findings)) for level in levels_of(grade, report.assignment)],
        hints=hints_of(report),
        steps=steps_of(report),
        groups=[_group(report, title, questions) for title, questions in report.assignment.question_groups().items()],
        show_truth=report.show_truth,
        never_true=report.terms.true_values == "never",
        tracking=[_finding(f) for f in grade.of("tracking")],
        charts=_charts(report, fit) if fit and report.show_truth else (),
        picture=_picture(report, fit),
        curve_note=_curve_note(fit) if fit and report.show_truth else "",
        has_table=bool(report.submission.tracking),
    )


def _total(report: Report) -> tuple[float, float, bool]:
    """Return points, of how many, and whether a person may still lower them."""
    counts = report.row or report.grade
    return counts.points, counts.out_of, counts.is_provisional


def standing_of(report: Report) -> Standing:
    """Say where the student stands."""
    return standing(report.row, report.terms, report.due, report.closes, is_over=report.is_over)


def steps_of(report: Report) -> tuple[Markup, ...]:
    """Return what to do next."""
    may_hand_in = standing_of(report).may_hand_in
    return next_steps(report.grade, report.assignment, may_hand_in=may_hand_in, show_truth=report.show_truth)


def hints_of(report: Report) -> list[tuple[Markup, str]]:
    """Return each hint once, with the cells that it is about, as symbols."""
    symbols = {question.id: symbol(question.symbol) for question in report.assignment.questions}
    hints: dict[str, dict[Markup, None]] = {}
    for diagnosis in report.grade.diagnosis:
        about_ = (symbols.get(id_, Markup("Tracking table")) for id_ in diagnosis.ids or (diagnosis.subject,))
        hints.setdefault(diagnosis.hint, {}).update(dict.fromkeys(about_))
    return [(Markup(", ").join(cells), hint) for hint, cells in hints.items()]


# ---------------------------------------------------------------- question by question


def _group(report: Report, title: str, questions: Sequence[Question]) -> Group:
    checks = dict.fromkeys(question.check for question in questions)
    return Group(
        title=title.capitalize(),
        points=earned_text(f for q in questions for f in report.grade.of(q.id)),
        lines=tuple(line_of(report, question) for question in questions),
        explanations=tuple((check.replace("_", " ").capitalize(), explanation_of(check)) for check in checks),
    )


def line_of(report: Report, question: Question) -> Line:
    """Return what is said of one question; true value and band are "" where they are hidden."""
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
        points=earned_text(findings),
        verdict=verdict(findings),
        findings=tuple(_finding(finding) for finding in findings if finding.message),
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


# ---------------------------------------------------------------- the tracking table


def _fit(report: Report) -> TrajectoryFit | None:
    """Lay the table over the truth again, as late as the check found it to be; None where nothing is drawn with it."""
    if not report.show_truth and report.frame is None:
        return None
    found = (finding.numbers.get("lag_frames") for finding in report.grade.findings if finding.aspect == "table")
    return fit_trajectory(report.submission.tracking, report.key, next(found, None))


def _charts(report: Report, fit: TrajectoryFit) -> tuple[CurveChart, ...]:
    charts = (curve_chart(curve) for curve in curves_of(fit, report.key, report.assignment))
    return tuple(chart for chart in charts if chart is not None)


def _picture(report: Report, fit: TrajectoryFit | None) -> PointsChart | None:
    if report.frame is None:
        return None
    return points_chart(report.frame, fit, report.key, show_truth=report.show_truth)


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
