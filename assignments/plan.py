"""What handing out will cost, how fair it will be, and how many answers can be told apart: before anything is made.

Of a class of more than `SAMPLE` students some are looked at, evenly spread over the list.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from assignments.costs import Cost, cost_of
from assignments.fairness import FAIR_SHARE, Fair, allowance, conclusions, fair_variant
from assignments.model import Assignment
from assignments.release import Order, release
from vml_course.errors import InputError
from vml_course.model.arrays import FloatArray

SAMPLE = 100
PEERS = 60  # variants at least that answers are compared between; a smaller class is filled up with made-up students
COPIES = 3  # of each file on the disk: folder, zip, bundle
_SAMPLE_SECRET = b"one variant, made to see what it costs"

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Sharpness:
    """How sharply one conclusion can be measured, over the variants that were looked at.

    Attributes
    ----------
    question, symbol, unit : str
    low, high : float
        Range of the true values.
    sd : mapping of str to float
        Predicted standard deviation by pseudonym, as a share of what is allowed for full credit.
    limit : float
        Share beyond which a variant is drawn again.
    """

    question: str
    symbol: str
    unit: str
    low: float
    high: float
    sd: Mapping[str, float]
    limit: float = FAIR_SHARE

    @property
    def quartiles(self) -> tuple[float, float, float, float, float]:
        """Least, lower quartile, median, upper quartile, largest of the shares."""
        least, lower, middle, upper, largest = np.quantile(list(self.sd.values()), [0, 0.25, 0.5, 0.75, 1]).tolist()
        return least, lower, middle, upper, largest


@dataclass(frozen=True)
class Plan:
    """What is to be expected of handing out to a class.

    Attributes
    ----------
    students : int
        Of the class.
    looked_at : tuple of str
        Pseudonyms of those whose variants were foreseen.
    each : Cost
        What one or more students cost, measured; the plan multiplies it.
    sharpness : tuple of Sharpness
        Of each conclusion.
    redraws : float
        Mean number of draws that were rejected, by rule or as unfair.
    unfair : mapping of str to tuple of str
        Which variants were drawn again because they would be too hard, and why.
    distinguishable : float
        How many answers can be told apart: 1 over the probability that an honest answer to one variant fits another;
        of more than can be seen in a sample, as many as can.
    fits_another : float
        Probability that an honest answer also fits the truth of somebody else in the class.
    """

    assignment_id: str
    students: int
    looked_at: tuple[str, ...]
    each: Cost
    sharpness: tuple[Sharpness, ...]
    redraws: float
    unfair: Mapping[str, tuple[str, ...]]
    distinguishable: float
    fits_another: float

    @property
    def cpu_s(self) -> float:
        """Seconds of processor time for the whole class."""
        return self.students * self.each.cpu_s_each

    @property
    def disk_bytes(self) -> float:
        """What the whole class takes on the disk."""
        return COPIES * self.students * self.each.bytes_each


def make_plan(
    assignment: Assignment, secret: bytes, students: Sequence[str], each: Cost, progress: Progress | None = None
) -> Plan:
    """Foresee the variants of a class.

    Parameters
    ----------
    assignment : Assignment
    secret : bytes
        The course's: the variants are those that will be handed out.
    students : sequence of str
        Pseudonyms.
    each : Cost
        Of earlier runs, or of `sample_cost`.
    progress : callable, optional
        Told how many variants were looked at, of how many.

    Raises
    ------
    InputError
        When there is nobody to plan for.
    NoVariantError
    """
    if not students:
        raise InputError("students", "a class of one or more", "none")
    some = spread(students, SAMPLE)
    everybody = some + [f"made up {n}" for n in range(PEERS - len(some))]  # no pseudonym has a space
    variants = list[Fair]()
    for student in everybody:
        variants.append(fair_variant(assignment, secret, student))
        if progress:
            progress(len(variants), len(everybody))
    fair = dict(zip(some, variants, strict=False))
    fits = chances_to_fit(assignment, variants)
    return Plan(
        assignment_id=assignment.id,
        students=len(students),
        looked_at=tuple(some),
        each=each,
        sharpness=sharpness(assignment, fair),
        redraws=statistics.fmean(found.variant.redraws for found in fair.values()),
        unfair={student: found.refused for student, found in fair.items() if found.refused},
        distinguishable=1.0 / max(float(fits.mean()), 1.0 / PEERS**2),
        fits_another=float(np.mean(1.0 - (1.0 - fits) ** (len(students) - 1))),
    )


def sample_cost(assignment: Assignment) -> Cost:
    """Make one variant that nobody gets, and return what it costs on this machine.

    The one before it is not counted: it compiles what others find compiled.
    """
    for student in ("warm-up", "sample"):
        cost = cost_of(release(Order(assignment, _SAMPLE_SECRET, student)))
    return cost


def spread(students: Sequence[str], most: int) -> list[str]:
    """Return at most so many of a list, evenly spread.

    >>> spread("abcdefgh", 3)
    ['a', 'c', 'f']
    """
    count = min(most, len(students))
    return [students[len(students) * n // count] for n in range(count)]


def sharpness(assignment: Assignment, fair: Mapping[str, Fair]) -> tuple[Sharpness, ...]:
    """Return of each conclusion how sharply it can be measured in these variants."""
    found = []
    for question in conclusions(assignment):
        predictions = {s: f.prediction for s, f in fair.items() if question.id in f.prediction.sd}
        if predictions:
            values = [prediction.value[question.id] for prediction in predictions.values()]
            shares = {s: p.sd[question.id] / allowance(question, p.value[question.id]) for s, p in predictions.items()}
            found.append(Sharpness(question.id, question.symbol, question.unit, min(values), max(values), shares))
    return tuple(found)


def chances_to_fit(assignment: Assignment, fair: Sequence[Fair]) -> FloatArray:
    """Return of each variant the mean probability that an honest answer to it fits another variant's truth.

    An honest answer has a standard deviation of half of what is allowed; it fits where every conclusion lies within
    what is allowed of the other's truth. Shape (n,), n at least 2.
    """
    n = len(fair)
    together = np.ones((n, n))
    for question in conclusions(assignment):
        truth = np.array([found.prediction.value.get(question.id, np.nan) for found in fair])
        if np.isfinite(truth).all():
            allowed = np.array([allowance(question, value) for value in truth])
            apart, sd = truth[:, None] - truth[None, :], allowed[:, None] / 2
            together *= ndtr((apart + allowed[None, :]) / sd) - ndtr((apart - allowed[None, :]) / sd)
    np.fill_diagonal(together, 0.0)
    fits: FloatArray = together.sum(axis=1) / (n - 1)
    return fits
