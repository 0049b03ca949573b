"""What two workbooks have in common that two students would not have: evidence for a person, never a penalty.

Equal answers prove nothing: in a class of 300, 85 % of honest answers fit somebody else's truth too. Tracking tables
do: every student has a video of their own, and the noise of a hand or of a tracker is nobody else's.
"""

from __future__ import annotations

import itertools
import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm

from assignments.model import AnswerKey
from grader.model import Submission
from grader.residuals import CORRELATED, Residual, correlations, residual_of
from grader.trajectory import TrajectoryFit, fit_trajectory
from vml_course.model.arrays import FloatArray

NO_BOUND = 1.0
"""False-positive rate of a sign that says nothing by itself: nobody knows how many link to a file of their own."""

NEVER = 0.0
"""Of a sign that cannot come up by chance: every workbook has a code of its own."""

OWN_PX = 4.0
"""A table that lies nearer to its own video than this is its own."""

CLEARLY = 0.25
"""Another video fits only where it does so much better than the own one."""

TRIED = 5  # other videos that are fitted in full, of those that look alike
LEAST_CELLS, LEAST_SHARE = 6, 0.1
LEAST_DIGITS = 4
SELDOM = 0.03
"""None came up in 100 honest classes of 300, 4.5 million pairs of tables (`benchmarks/integrity.py --classes 100`).

So it is 95 % sure that fewer classes than this, 3 in 100, have any (the rule of three). Those classes had noise of
their own, and every ten of them variants of their own.
"""

BY_CHANCE = 0.01
"""A correlation counts where chance gives one as large in fewer classes than this."""


@dataclass(frozen=True, eq=False)
class HandedIn:
    """One student's newest workbook, with the key of their own variant."""

    pid: str
    submission: Submission
    key: AnswerKey


@dataclass(frozen=True)
class Evidence:
    """Something that a person may want to look at.

    Attributes
    ----------
    pid, other : str
        The student whose workbook shows it, and the one with whom it is shared; "" when nobody else is concerned.
    method : str
        `other-video`, `same-noise`, `same-cells`, `same-file`, `other-workbook`, and of receipts `other-student` or
        `same-bytes` (`grader.shared_files`).
    statistic : float
        A distance in px, a correlation, a share of cells ..., as `words` say.
    false_positive_rate : float
        How often at least one such sign comes up in a class of honest students: an upper limit, 0 where chance
        makes none, 1 where no limit is known.
    words : str
        What was seen, in a sentence or two.
    """

    pid: str
    other: str
    method: str
    statistic: float
    false_positive_rate: float
    words: str


@dataclass(frozen=True, eq=False)
class _Laid:
    """A table over the video that it follows best."""

    fit: TrajectoryFit | None
    whose: HandedIn


def compare(
    handed: Sequence[HandedIn],
    keys: Mapping[str, AnswerKey] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Evidence, ...]:
    """Compare everything that a class handed in.

    Parameters
    ----------
    handed : sequence of HandedIn
        One workbook a student.
    keys : mapping of str to AnswerKey, optional
        By student, also of those who handed in nothing; those of `handed` if not given.
    progress : callable, optional
        `(tables done, tables in all)`.
    """
    keys = dict(keys or {}) | {one.pid: one.key for one in handed}
    screen = _Screen(keys)
    found: list[Evidence] = []
    residuals: dict[str, Residual] = {}
    for done, one in enumerate(handed, start=1):
        laid, evidence = _laid(one, keys, screen)
        found += evidence
        residual = residual_of(laid.fit, laid.whose.key) if laid.fit is not None else None
        if residual is not None:
            residuals[one.pid] = residual
        if progress is not None:
            progress(done, len(handed))
    return (*found, *_same_noise(residuals), *_same_cells(handed), *_same_files(handed), *_flagged(handed))


# ---------------------------------------------------------------- whose video a table follows


class _Screen:
    """The true paths of all variants in one array: which of them look like a table, quickly."""

    def __init__(self, keys: Mapping[str, AnswerKey]) -> None:
        self.pids = tuple(keys)
        longest = max((len(key.frame) for key in keys.values()), default=0)
        most = max((len(key.points) for key in keys.values()), default=0)
        self._paths = np.full((len(keys), longest, most, 2), np.nan)
        for number, key in enumerate(keys.values()):
            path = key.xy_px * np.array([1.0, -1.0]) / key.truth["px_per_m"]
            self._paths[number, : path.shape[0], : path.shape[1]] = path

    def alike(self, fit: TrajectoryFit, key: AnswerKey) -> list[str]:
        """Return the students whose videos the table may follow, likeliest first."""
        columns = [key.points.index(point) for point in fit.points]
        frame = np.rint(fit.frame).astype(int)
        kept = (frame >= 0) & (frame < self._paths.shape[1])
        if not kept.any():
            return []
        others = self._paths[:, frame[kept]][:, :, columns]
        rest = _misfit(others, fit.own_m[kept])
        return [self.pids[number] for number in np.argsort(rest)[:TRIED] if np.isfinite(rest[number])]


def _misfit(others: FloatArray, own: FloatArray) -> FloatArray:
    """Return the root mean square distance of one table from many paths after one scale and one shift each."""
    seen: NDArray[np.bool_] = np.asarray(np.isfinite(others + own).all(axis=3))
    count = np.maximum(seen.sum(axis=(1, 2)), 1)[:, None, None, None]
    a, b = np.where(seen[..., None], own, 0.0), np.where(seen[..., None], others, 0.0)
    a0 = np.where(seen[..., None], a - a.sum(axis=(1, 2), keepdims=True) / count, 0.0)
    b0 = np.where(seen[..., None], b - b.sum(axis=(1, 2), keepdims=True) / count, 0.0)
    spread = (a0**2).sum(axis=(1, 2, 3))
    scale = (a0 * b0).sum(axis=(1, 2, 3)) / np.where(spread > 0, spread, np.inf)
    rest = ((scale[:, None, None, None] * a0 - b0) ** 2).sum(axis=(1, 2, 3)) / count[:, 0, 0, 0]
    return np.asarray(np.where(seen.sum(axis=(1, 2)) >= 20, np.sqrt(rest), np.inf))


def _laid(one: HandedIn, keys: Mapping[str, AnswerKey], screen: _Screen) -> tuple[_Laid, list[Evidence]]:
    own = fit_trajectory(one.submission.tracking, one.key)
    if own is None or own.rms_px <= OWN_PX:
        return _Laid(own, one), []
    best, whose = own, one
    for pid in screen.alike(own, one.key):
        fit = fit_trajectory(one.submission.tracking, keys[pid]) if pid != one.pid else None
        if fit is not None and fit.rms_px < best.rms_px:
            best, whose = fit, HandedIn(pid, one.submission, keys[pid])
    if whose is one or best.rms_px > min(OWN_PX, CLEARLY * own.rms_px):
        return _Laid(own, one), []
    words = (
        f"The tracking table lies {best.rms_px:.2g} px from the path in the video of {whose.pid}, "
        f"and {own.rms_px:.0f} px from that in the student's own video."
    )
    return _Laid(best, whose), [Evidence(one.pid, whose.pid, "other-video", best.rms_px, SELDOM, words)]


# ---------------------------------------------------------------- what two tables share


def _same_noise(residuals: Mapping[str, Residual]) -> Iterator[Evidence]:
    """Yield pairs whose points miss the true paths in the same way, frame by frame."""
    pids, pairs = tuple(residuals), math.comb(len(residuals), 2)
    rho, count = correlations(tuple(residuals.values()))
    for one, other in zip(*np.nonzero(np.triu(rho >= CORRELATED, k=1)), strict=True):
        degrees = count[one, other] - 3.0
        z = math.atanh(min(rho[one, other], 1 - 1e-12)) * math.sqrt(degrees) if degrees > 0 else 0.0
        rate = min(1.0, pairs * float(norm.sf(z)))
        if rate <= BY_CHANCE:
            words = (
                f"Frame by frame both tables miss the true path in the same way: correlation {rho[one, other]:.2f}. "
                "Tables of different videos reach 0.3; one video tracked twice by the same program may reach this too."
            )
            yield Evidence(pids[other], pids[one], "same-noise", float(rho[one, other]), SELDOM, words)


def _same_cells(handed: Sequence[HandedIn]) -> Iterator[Evidence]:
    """Yield pairs of tables that have positions in common, digit by digit."""
    owners: dict[tuple[float, float], set[int]] = defaultdict(set)
    sizes = []
    for number, one in enumerate(handed):
        positions = set(_positions(one.submission.tracking))
        sizes.append(len(positions))
        for position in positions:
            owners[position].add(number)
    common: dict[tuple[int, int], int] = defaultdict(int)
    for numbers in owners.values():
        for pair in itertools.combinations(sorted(numbers), 2):
            common[pair] += 1
    for (a, b), count in sorted(common.items()):
        share = count / min(sizes[a], sizes[b])
        if count >= LEAST_CELLS and share >= LEAST_SHARE:
            words = f"{count} positions of the tracking table ({share:.0%}) are equal in every digit, x and y together."
            yield Evidence(handed[b].pid, handed[a].pid, "same-cells", share, SELDOM, words)


def _positions(tracking: Mapping[str, FloatArray]) -> Iterator[tuple[float, float]]:
    """Yield the positions that have enough digits to be one's own."""
    for name, column in tracking.items():
        other = tracking.get(name.replace("_x_", "_y_")) if "_x_" in name else None
        if other is not None:
            yield from (
                (x, y)
                for x, y in zip(column.tolist(), other.tolist(), strict=True)
                if _has_digits(x) and _has_digits(y)
            )


def _has_digits(value: float) -> bool:
    return math.isfinite(value) and len(f"{abs(value):.12g}".replace(".", "").strip("0")) >= LEAST_DIGITS


# ---------------------------------------------------------------- the files


def _same_files(handed: Sequence[HandedIn]) -> Iterator[Evidence]:
    for what, hash_of in (("file", _file_hash), ("content of the workbook", _content_hash)):
        groups: dict[str, list[str]] = defaultdict(list)
        for one in handed:
            groups[hash_of(one.submission)].append(one.pid)
        for sha256, pids in groups.items():
            if sha256:
                words = f"The {what} is the same, byte by byte."
                yield from (Evidence(pid, pids[0], "same-file", 1.0, SELDOM, words) for pid in pids[1:])


def _file_hash(submission: Submission) -> str:
    return submission.file_sha256


def _content_hash(submission: Submission) -> str:
    return submission.content_sha256 if submission.tracking else ""  # answers alone prove nothing


LINKS = {
    "links": "The workbook has links to another file.",
    "formula-to-other-workbook": "A formula points to another workbook.",
}


def _flagged(handed: Sequence[HandedIn]) -> Iterator[Evidence]:
    for one in handed:
        for flag in one.submission.flags:
            if flag in LINKS:
                words = f"{LINKS[flag]} It may be a file of the student's own."
                yield Evidence(one.pid, "", "other-workbook", 1.0, NO_BOUND, words)
