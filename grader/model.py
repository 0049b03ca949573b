"""The words of grading: what came in, what was judged, what it adds up to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from assignments.model import AnswerKey, Question
from grader.kind import Kind
from grader.read.flags import Flag
from grader.tracked import FromTable
from vml_course.model.arrays import FloatArray, set_frozen


@dataclass(frozen=True)
class Answer:
    """One answer cell as it was found.

    Attributes
    ----------
    kind : Kind
    number : float or None
        The cell's number, when it has one (a date keeps its serial number).
    text : str
        What is written: the text itself, or the number in its shortest form.
    unit_text : str
        What the unit cell says, "" when nothing.
    where : str
        Sheet and address, such as `Answers!C7`.
    found_by : str
        `name`, `label` or `address`: how the cell was found; "" when it was not.
    read_as : str
        The text with the decimal point meant, where only one of two readings is plausible.
    """

    kind: Kind = Kind.BLANK
    number: float | None = None
    text: str = ""
    unit_text: str = ""
    where: str = ""
    found_by: str = ""
    read_as: str = ""


@dataclass(frozen=True, eq=False)
class Submission:
    """One workbook that came in, reduced to plain values.

    Attributes
    ----------
    name : str
        File name, for messages only.
    assignment_id, code : str
        What the workbook itself says it belongs to.
    answers : mapping of str to Answer
        By question id.
    tracking : mapping of str to float array, shape (n,)
        Columns of the tracking table by their heading; NaN where empty.
    flags : tuple of Flag
        What a person should know.
    file_sha256, content_sha256 : str
        Of the bytes, and of the answers and the table alone.
    """

    name: str
    assignment_id: str
    code: str
    answers: Mapping[str, Answer]
    tracking: Mapping[str, FloatArray]
    flags: tuple[Flag, ...] = ()
    file_sha256: str = ""
    content_sha256: str = ""

    def __post_init__(self) -> None:
        columns = {name: np.array(values, dtype=np.float64) for name, values in self.tracking.items()}
        for column in columns.values():
            column.setflags(write=False)
        set_frozen(self, tracking=columns)

    def answer(self, question_id: str) -> Answer:
        """Return an answer; a blank one when the cell was not found."""
        return self.answers.get(question_id, Answer())


class Outcome(StrEnum):
    """How a judgement ended; UNSURE costs no points and reaches a person."""

    RIGHT = "right"
    PARTIAL = "partial"
    WRONG = "wrong"
    UNSURE = "unsure"


UNSURE_ABOUT = "Unsure about "
"""How the reason begins that names unsure questions."""

_SEVERITY = (Outcome.UNSURE, Outcome.WRONG, Outcome.PARTIAL, Outcome.RIGHT)


def overall(outcomes: Iterable[Outcome], points: float, out_of: float) -> Outcome:
    """Return how a question ended as a whole: its worst aspect, softened to PARTIAL when much was earned."""
    worst = min(outcomes, key=_SEVERITY.index, default=Outcome.UNSURE)
    earned_much = out_of > 0 and points >= 0.4 * out_of
    return Outcome.PARTIAL if worst is Outcome.WRONG and earned_much else worst


@dataclass(frozen=True)
class Finding:
    """One judgement on one aspect of one question.

    Attributes
    ----------
    question_id : str
        The question, or the name of a check that belongs to none (`tracking`).
    aspect : str
        `unit`, `value`, `formula` or `table`.
    outcome : Outcome
    points, out_of : float
    message : str
        What the student reads; it holds no true value.
    numbers : mapping of str to float
        Facts behind the message: `value`, `truth`, `tolerance`, `from_own` ... SI units.
    mistake : str
        Code of a mistake that explains it, "" when none does.
    carried : bool
        Right in itself, but on top of an error that was already counted where it arose.
    """

    question_id: str
    aspect: str
    outcome: Outcome
    points: float
    out_of: float
    message: str
    numbers: Mapping[str, float] = field(default_factory=dict)
    mistake: str = ""
    carried: bool = False


@dataclass(frozen=True)
class Diagnosis:
    """A mistake that explains what is written, worded as a hint.

    Attributes
    ----------
    subject : str
        What it is about: a question id, or `velocities`, `angular velocities`, `tracking`.
    codes : tuple of str
        One code when it is the only explanation, several when the numbers cannot tell them apart.
    hint : str
        What the student reads.
    basis : str
        `own` (from the student's own numbers) or `truth`.
    ids : tuple of str
        The questions whose cells carry it, `tracking` for the table.
    """

    subject: str
    codes: tuple[str, ...]
    hint: str
    basis: str
    ids: tuple[str, ...] = ()

    @property
    def is_unique(self) -> bool:
        """Whether one mistake alone explains it."""
        return len(self.codes) == 1


@dataclass(frozen=True)
class Grade:
    """The result of one submission; a pure function of submission, key and assignment.

    `status` is `ok`, `review` when a person should look, or `empty` when no question was answered; `decided` holds the
    questions that a person decided about.
    """

    findings: tuple[Finding, ...]
    points: float
    out_of: float
    status: str
    diagnosis: tuple[Diagnosis, ...] = ()
    reasons: tuple[str, ...] = ()
    decided: frozenset[str] = frozenset()

    @property
    def is_provisional(self) -> bool:
        """Whether points are counted that a person has still to confirm."""
        return any(finding.outcome is Outcome.UNSURE and finding.out_of > 0 for finding in self.findings)

    def of(self, question_id: str) -> tuple[Finding, ...]:
        """Return the findings of one question, in the order they were made."""
        return tuple(finding for finding in self.findings if finding.question_id == question_id)


@dataclass(frozen=True)
class Factor:
    """All numbers of one kind are off by one factor that has a name.

    `codes` lists every mistake with this factor; `ids` the questions that carry it.
    """

    codes: tuple[str, ...]
    value: float
    ids: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Asked:
    """What a check is given.

    Attributes
    ----------
    submission, key, question
        What was written, what is true, what was asked.
    charged : frozenset of str
        Questions whose value has already cost points; errors that come from them cost nothing again.
    carried : frozenset of str
        Questions whose value is right but for such an error.
    factors : tuple of Factor
        Common factors found in the velocities and angular velocities.
    questions : mapping of str to Question
        All questions of the assignment, to read the numbers that an answer is built from.
    table : FromTable
        The tracking table over the truth, and what the reference method makes of it.
    """

    submission: Submission
    key: AnswerKey
    question: Question
    charged: frozenset[str] = frozenset()
    factors: tuple[Factor, ...] = ()
    questions: Mapping[str, Question] = field(default_factory=dict)
    table: FromTable = field(default_factory=FromTable)
    carried: frozenset[str] = frozenset()
