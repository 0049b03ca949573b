"""A grade as Gradescope shows it: `results.json`.

Gradescope cleans the HTML that it shows; ours is paragraphs and lists, and every text in it is escaped.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from markupsafe import Markup, escape

from assignments.model import Assignment
from grader.grade import TRACKING
from grader.model import Finding, Grade, Outcome

VISIBLE, AFTER_DUE = "visible", "after_due_date"


def refused(reason: str, extra: Mapping[str, Any]) -> dict[str, Any]:
    """Return the results of a submission that cannot be graded: no points, and what to do."""
    return _results(0.0, [_paragraph(reason), _paragraph("Nothing was graded. You can hand in again.")], (), extra)


def results_of(
    grade: Grade,
    assignment: Assignment,
    score: float,
    said: Sequence[str],
    extra: Mapping[str, Any],
    *,
    visibility: str,
) -> dict[str, Any]:
    """Return the results of a graded submission.

    Parameters
    ----------
    score : float
        What counts: after lateness and earlier attempts.
    said : sequence of str
        What the student reads first, whatever is hidden.
    visibility : str
        Of everything that tells right from wrong.
    """
    tests = [test for test in _tests(grade, assignment) if test is not None]
    hints = [_item(diagnosis.hint) for diagnosis in grade.diagnosis]
    if hints:
        tests.append(_told("Where to look", "hints", _list(hints)))
    shown = [{**test, "visibility": visibility} for test in tests]
    return _results(score, [_paragraph(text) for text in said], shown, extra)


def _results(
    score: float, output: Iterable[Markup], tests: Sequence[Mapping[str, Any]], extra: Mapping[str, Any]
) -> dict[str, Any]:
    return {
        "score": round(score, 2),
        "output": str(Markup("").join(output)),
        "output_format": "html",
        "test_output_format": "html",
        "test_name_format": "text",
        "visibility": VISIBLE,
        "stdout_visibility": "hidden",
        "extra_data": dict(extra),
        "tests": list(tests),
    }


def _tests(grade: Grade, assignment: Assignment) -> Iterable[dict[str, Any] | None]:
    for number, question in enumerate(assignment.questions, start=1):
        yield _test(grade.of(question.id), question.label, question.id, str(number))
    if not any(question.check == TRACKING.check for question in assignment.questions):
        yield _test(grade.of(TRACKING.id), TRACKING.label, TRACKING.id, str(len(assignment.questions) + 1))


def _test(findings: Sequence[Finding], name: str, tag: str, number: str) -> dict[str, Any] | None:
    if not findings:
        return None
    points, out_of = sum(f.points for f in findings), sum(f.out_of for f in findings)
    is_lacking = points < out_of - 1e-9 or any(f.outcome is Outcome.WRONG and not f.carried for f in findings)
    return {
        **_told(name, tag, _list([_item(f"{f.aspect.capitalize()}. {f.message}") for f in findings])),
        "number": number,
        "score": round(points, 2),
        "max_score": round(out_of, 2),
        "status": "failed" if is_lacking else "passed",
    }


def _told(name: str, tag: str, output: Markup) -> dict[str, Any]:
    return {"name": name, "output": str(output), "output_format": "html", "tags": [tag], "extra_data": {}}


def _paragraph(text: str) -> Markup:
    return Markup("<p>{}</p>").format(escape(text))


def _item(text: str) -> Markup:
    return Markup("<li>{}</li>").format(escape(text))


def _list(items: Iterable[Markup]) -> Markup:
    return Markup("<ul>{}</ul>").format(Markup("").join(items))
