"""From a submission and its key to a grade: a pure function."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from assignments.model import AnswerKey, Assignment, Question
from assignments.sheets import ANSWERS
from assignments.textbook import textbook_of
from assignments.words import symbol_text
from grader.checks import check_named
from grader.diagnose import diagnose_answer, diagnose_factors, needs_diagnosis
from grader.factors import find_factors
from grader.flags import FOR_PERSON, FOR_PERSON_OF_TABLE
from grader.hints import one_hint_a_cause, with_marks
from grader.kind import Kind
from grader.model import UNSURE_ABOUT, Asked, Diagnosis, Finding, Grade, Outcome, Submission
from grader.plausible import settle_readings
from grader.reference import from_table

GRADER_VERSION = "4"
"""Goes into every run; raise it when the same submission could get other points."""

TRACKING = Question("tracking", "Tracking table", "", "number", "", 0.0, "tracking", 0.0, "measurement")
"""The question behind the tracking table, for an assignment that gives it no points of its own."""


@dataclass(frozen=True)
class _Judged:
    """What has been judged so far."""

    findings: tuple[Finding, ...] = ()
    charged: frozenset[str] = frozenset()
    carried: frozenset[str] = frozenset()


def grade(submission: Submission, key: AnswerKey, assignment: Assignment) -> Grade:
    """Judge a submission.

    Questions are judged after those that they need, so that an error costs points where it arose and nowhere else.

    Parameters
    ----------
    submission : Submission
    key : AnswerKey
        Of the very variant that the workbook carries.
    assignment : Assignment

    Returns
    -------
    Grade
        Findings in the order of the questions; `status` is `review` where something is unsure.
    """
    questions = {question.id: question for question in assignment.questions}
    submission = settle_readings(submission, questions, key.values)
    factors = find_factors(submission, key, questions)
    table = from_table(submission.tracking, key, assignment)
    has_points = any(question.check == TRACKING.check for question in assignment.questions)
    judged = _Judged()
    for question in (*in_order(assignment.questions), *(() if has_points else (TRACKING,))):
        asked = Asked(submission, key, question, judged.charged, factors, questions, table, judged.carried)
        judged = _judge(judged, asked)
    diagnosis = (*diagnose_factors(factors, key, questions), *_diagnoses(submission, key, questions, judged.findings))
    findings = _named(judged.findings, diagnosis)
    return _sum_up(submission, assignment, findings, one_hint_a_cause(with_marks(diagnosis, judged.findings)))


def in_order(questions: Iterable[Question]) -> Iterator[Question]:
    """Yield questions after those they need; the order within a storey is kept, circles are broken."""
    waiting = list(questions)
    while waiting:
        open_ = {question.id for question in waiting}
        ready = [q for q in waiting if not set(q.needs) & open_ - {q.id}] or waiting[:1]
        yield from ready
        waiting = [question for question in waiting if question not in ready]


def _judge(judged: _Judged, asked: Asked) -> _Judged:
    try:
        findings = check_named(asked.question.check)(asked)
    except Exception:  # noqa: BLE001 - our own failure must never cost a student points
        message = "The grader could not judge this; a person will."
        points = asked.question.points
        findings = (Finding(asked.question.id, "value", Outcome.UNSURE, points, points, message),)
    paid = any(f.aspect == "value" and f.outcome in {Outcome.WRONG, Outcome.PARTIAL} for f in findings)
    findings = tuple(_with_reading(finding, asked) for finding in findings)
    carried = any(finding.carried for finding in findings)
    return _Judged(
        (*judged.findings, *findings),
        judged.charged | ({asked.question.id} if paid else set()),
        judged.carried | ({asked.question.id} if carried else set()),
    )


def _with_reading(finding: Finding, asked: Asked) -> Finding:
    """Say how a comma was read, once a question."""
    read_as = asked.submission.answer(asked.question.id).read_as
    if not read_as or finding.aspect != "value":
        return finding
    return replace(finding, message=f"Read as {read_as}. {finding.message}")


def _diagnoses(
    submission: Submission, key: AnswerKey, questions: dict[str, Question], findings: Iterable[Finding]
) -> Iterator[Diagnosis]:
    findings = tuple(findings)
    for quantity in (concluded.id for concluded in textbook_of(key.scene).concluded):
        outcomes = [(f.aspect, f.outcome) for f in findings if f.question_id == quantity]
        if quantity in questions and needs_diagnosis(outcomes):
            diagnosis = diagnose_answer(quantity, submission, key, questions)
            if diagnosis is not None:
                yield diagnosis


def _named(findings: Iterable[Finding], diagnosis: Iterable[Diagnosis]) -> tuple[Finding, ...]:
    """Write a mistake that alone explains an answer into the finding on its formula."""
    codes = {d.subject: d.codes[0] for d in diagnosis if d.is_unique}
    return tuple(
        replace(f, mistake=codes.get(f.question_id, f.mistake)) if f.aspect == "formula" else f for f in findings
    )


def _sum_up(
    submission: Submission, assignment: Assignment, findings: tuple[Finding, ...], diagnosis: tuple[Diagnosis, ...]
) -> Grade:
    reasons = tuple(_reasons(submission, assignment, findings))
    is_empty = all(submission.answer(question.id).kind is Kind.BLANK for question in assignment.questions)
    if is_empty:
        reasons = (_why_empty(submission, assignment), *reasons)
    return Grade(
        findings=findings,
        points=round(sum(f.points for f in findings), 6),
        out_of=round(sum(f.out_of for f in findings), 6),
        status="empty" if is_empty else "review" if reasons else "ok",
        diagnosis=diagnosis,
        reasons=reasons,
    )


def _why_empty(submission: Submission, assignment: Assignment) -> str:
    if not any(submission.answer(question.id).found_by for question in assignment.questions):
        return f'No answer cells were found: there is no sheet "{ANSWERS}" with our questions.'
    return f'No question is answered: the coloured cells of the sheet "{ANSWERS}" are empty.'


def _reasons(submission: Submission, assignment: Assignment, findings: Iterable[Finding]) -> Iterator[str]:
    """Say why a person should look, one sentence each."""
    if submission.assignment_id != assignment.id:
        yield f"The workbook says that it belongs to {submission.assignment_id[:40]!r}."
    is_right = any(f.aspect == "table" and f.outcome is Outcome.RIGHT for f in findings)
    words = FOR_PERSON if is_right else {**FOR_PERSON, **FOR_PERSON_OF_TABLE}
    yield from (words[flag] for flag in submission.flags if flag in words)
    symbols = {question.id: symbol_text(question.symbol) for question in assignment.questions}
    unsure = dict.fromkeys(symbols.get(f.question_id, f.question_id) for f in findings if f.outcome is Outcome.UNSURE)
    if unsure:
        yield f"{UNSURE_ABOUT}{', '.join(unsure)}."
