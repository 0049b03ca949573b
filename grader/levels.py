"""The three levels of a measurement, scored apart: was it measured, was it processed, is the conclusion right."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from assignments.model import Assignment, Question
from grader.model import Finding, Grade

CONCLUSION = "conclusion"

LEVELS: Mapping[str, str] = {
    "Measurement": "scale, frame rate, velocities and the tracking table, against the truth",
    "Processing": "formulas, worked out again from the numbers that you wrote",
    "Conclusion": "final values and their units, against the truth or what an error counted before leads to",
}
"""Each level with what belongs to it."""


@dataclass(frozen=True)
class Level:
    """One level with the findings that belong to it."""

    name: str
    about: str
    findings: tuple[Finding, ...]

    @property
    def share(self) -> float:
        """The part of the level's points that was earned, 0 to 1."""
        out_of = sum(finding.out_of for finding in self.findings)
        return sum(finding.points for finding in self.findings) / out_of if out_of else 0.0


def levels_of(grade: Grade, assignment: Assignment) -> tuple[Level, ...]:
    """Return the levels that this assignment gives points for."""
    questions = {question.id: question for question in assignment.questions}
    sorted_: dict[str, list[Finding]] = {name: [] for name in LEVELS}
    for finding in grade.findings:
        sorted_[_level_of(finding, questions.get(finding.question_id))].append(finding)
    return tuple(
        Level(name, LEVELS[name], tuple(findings))
        for name, findings in sorted_.items()
        if any(finding.out_of > 0 for finding in findings)
    )


def _level_of(finding: Finding, question: Question | None) -> str:
    if finding.aspect == "formula":
        return "Processing"
    return "Conclusion" if question is not None and question.group == CONCLUSION else "Measurement"
