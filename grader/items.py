"""What a class's grades say about its questions and variants: facility, discrimination, precision, difficulty."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from statistics import fmean, median

import numpy as np

from assignments.model import AnswerKey, Assignment, Question
from grader.ledger import Row
from grader.model import Finding, Outcome

LEAST_STUDENTS = 8
"""A correlation over fewer students says nothing."""

_CREDIT = {Outcome.RIGHT: 1.0, Outcome.PARTIAL: 0.5, Outcome.WRONG: 0.0}
_SD_OF_MEDIAN = 1.4826  # the median distance from the centre of a normal distribution is 1/1.4826 of its sd


@dataclass(frozen=True)
class Evidence:
    """What a grade rests on, of one student.

    Attributes
    ----------
    findings : tuple of Finding
        Of the run that counts.
    values : mapping of str to float
        True answers by question.
    expected_sd : mapping of str to float
        The sd that the reference reached on the student's very video.
    """

    findings: tuple[Finding, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict)
    expected_sd: Mapping[str, float] = field(default_factory=dict)


def evidence_of(findings: Iterable[Finding], key: AnswerKey) -> Evidence:
    """Return what a grade rests on, without the key's trajectory."""
    return Evidence(tuple(findings), key.values, key.expected_sd)


# ---------------------------------------------------------------- questions


@dataclass(frozen=True)
class Item:
    """How a question did.

    Attributes
    ----------
    question : Question
    right, answered : int
        Students who were right, and of whom something is known.
    facility : float or None
        Mean part of the points that was earned, 0 to 1.
    discrimination : float or None
        Correlation with the mean of the other questions, -1 to 1; None where it cannot be told.
    """

    question: Question
    right: int
    answered: int
    facility: float | None
    discrimination: float | None


def items_of(assignment: Assignment, rows: Sequence[Row], evidence: Mapping[str, Evidence]) -> tuple[Item, ...]:
    """Return how each question did; unsure answers are left out until a person has decided."""
    ids = [question.id for question in assignment.questions]
    credit = np.array([[_credit(row, id_, evidence) for id_ in ids] for row in rows]).reshape(len(rows), len(ids))
    return tuple(_item(question, rows, credit, at) for at, question in enumerate(assignment.questions))


def _item(question: Question, rows: Sequence[Row], credit: np.ndarray, at: int) -> Item:
    own = credit[:, at]
    known = np.isfinite(own)
    return Item(
        question=question,
        right=sum(row.outcomes.get(question.id) is Outcome.RIGHT for row in rows),
        answered=int(known.sum()),
        facility=float(own[known].mean()) if known.any() else None,
        discrimination=correlation(own, _mean_of_others(credit, at)),
    )


def _mean_of_others(credit: np.ndarray, at: int) -> np.ndarray:
    others = np.delete(credit, at, axis=1)
    count = np.isfinite(others).sum(axis=1)
    return np.where(count > 0, np.nansum(others, axis=1) / np.maximum(count, 1), np.nan)


def _credit(row: Row, question_id: str, evidence: Mapping[str, Evidence]) -> float:
    """Return the part of a question's points that was earned, NaN where a person has still to look.

    What a person decided changed the outcome: it then speaks instead of the findings.
    """
    outcome = row.outcomes.get(question_id, Outcome.UNSURE)
    if outcome is Outcome.UNSURE:
        return math.nan
    found = [f for f in evidence.get(row.student.pid, Evidence()).findings if f.question_id == question_id]
    out_of = sum(finding.out_of for finding in found)
    if row.adjustments or not out_of:
        return _CREDIT[outcome]
    return sum(finding.points for finding in found) / out_of


def correlation(x: np.ndarray, y: np.ndarray) -> float | None:
    """Return Pearson's correlation over what is known of both; None with too few, or where one does not vary."""
    both = np.isfinite(x) & np.isfinite(y)
    x, y = x[both], y[both]
    if len(x) < LEAST_STUDENTS or not (_varies(x) and _varies(y)):
        return None
    return float(np.corrcoef(x, y)[0, 1])


def _varies(values: np.ndarray) -> bool:
    return bool(np.ptp(values) > 1e-6 * np.abs(values).max())


# ---------------------------------------------------------------- precision


@dataclass(frozen=True)
class Precision:
    """How exactly a number was measured, as parts of the true value, or in its unit where that may be zero.

    Attributes
    ----------
    question : Question
    is_relative : bool
    predicted : float
        Median of what the reference reached on the videos handed out, one sd.
    reached : float
        Sd of the students about the truth, from the median: a few slips do not count.
    students : int
    """

    question: Question
    is_relative: bool
    predicted: float
    reached: float
    students: int


def precision_of(assignment: Assignment, evidence: Iterable[Evidence]) -> tuple[Precision, ...]:
    """Return the precision of each number that something is known of."""
    evidence = tuple(evidence)
    found = (_precision(question, evidence) for question in assignment.questions)
    return tuple(item for item in found if item is not None)


def _precision(question: Question, evidence: Sequence[Evidence]) -> Precision | None:
    is_relative = all(abs(one.values.get(question.id, 0.0)) > 2 * question.floor for one in evidence)
    off, sds = list[float](), list[float]()
    for one in evidence:
        unit = abs(one.values.get(question.id, math.nan)) if is_relative else 1.0
        sd, value = one.expected_sd.get(question.id), _stated(one, question.id)
        if sd is not None and value is not None:
            off.append(abs(value - one.values[question.id]) / unit)
            sds.append(sd / unit)
    if not off:
        return None
    return Precision(question, is_relative, median(sds), _SD_OF_MEDIAN * median(off), len(off))


def _stated(one: Evidence, question_id: str) -> float | None:
    found = (f.numbers["value"] for f in one.findings if f.question_id == question_id and "value" in f.numbers)
    return next(found, None)


def tracking_px(evidence: Iterable[Evidence]) -> tuple[float, ...]:
    """Return how far each student's tracking table lies from the true trajectory, px RMS, in rising order."""
    return tuple(sorted(f.numbers["rms_px"] for one in evidence for f in one.findings if "rms_px" in f.numbers))


# ---------------------------------------------------------------- difficulty of the variants


@dataclass(frozen=True)
class Difficulty:
    """Scores over what the variants' videos allow.

    Attributes
    ----------
    pids : tuple of str
    sd_percent : tuple of float
        Predicted sd of the least certain conclusion, in percent of its true value.
    score_percent : tuple of float
    r : float or None
        Their correlation.
    """

    pids: tuple[str, ...]
    sd_percent: tuple[float, ...]
    score_percent: tuple[float, ...]
    r: float | None

    @property
    def words(self) -> str:
        """What the correlation says, for the instructor."""
        if self.r is None:
            return f"Too few students, or too much alike, to tell ({LEAST_STUDENTS} are needed)."
        if abs(self.r) < 2 / math.sqrt(len(self.pids)):
            return f"Correlation {self.r:+.2f}: no more than chance gives. The variants look equally fair."
        which = "lower" if self.r < 0 else "higher"
        return f"Correlation {self.r:+.2f}: students with less certain variants scored {which}. Look at the tolerances."


def difficulty_of(assignment: Assignment, rows: Sequence[Row], evidence: Mapping[str, Evidence]) -> Difficulty:
    """Return scores over the predicted precision of each variant; before lateness, which is no variant's fault."""
    found = []
    for row in rows:
        sd = _least_certain(assignment, evidence.get(row.student.pid, Evidence()))
        if sd is not None and row.out_of:
            found.append((row.student.pid, 100 * sd, 100 * (row.earned or row.points) / row.out_of))
    pids, sds, scores = zip(*found, strict=True) if found else ((), (), ())
    return Difficulty(pids, sds, scores, correlation(np.array(sds, dtype=float), np.array(scores, dtype=float)))


def _least_certain(assignment: Assignment, one: Evidence) -> float | None:
    concluded = [q.id for q in assignment.questions if q.needs and q.id in one.expected_sd and one.values.get(q.id)]
    return max((one.expected_sd[id_] / abs(one.values[id_]) for id_ in concluded), default=None)


def mean_share(rows: Iterable[Row]) -> float | None:
    """Return the mean score, 0 to 1, None when nothing was graded."""
    shares = [row.points / row.out_of for row in rows if row.out_of]
    return fmean(shares) if shares else None
