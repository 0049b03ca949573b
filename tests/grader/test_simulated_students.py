"""A small, seeded run of `benchmarks/diagnosis.py`: planted mistakes are told, right answers are left in peace."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import pytest

from assignments.load import assignment_ids

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
SEED = 20270401
RATIOS = {"e", "mu", "phi", "s2"}


@pytest.fixture(scope="module")
def told():
    """What was said, by (kind, assignment, quantity or noise, mistake or what happened, how it ended)."""
    sys.path.insert(0, str(BENCHMARKS))
    try:
        from support.planted import Batch, plant  # noqa: PLC0415
    finally:
        sys.path.remove(str(BENCHMARKS))
    batches = [Batch(name, variant, SEED, 40, 6) for name in assignment_ids() for variant in range(2)]
    return sum(map(plant, batches), Counter())


def ends(told, kind, belongs=lambda _: True):
    found = Counter()
    for key, count in told.items():
        if key[0] == kind and belongs(key[2]):
            found[key[4]] += count
    return found


@pytest.mark.parametrize(("belongs", "least"), [(RATIOS.__contains__, 0.95), (lambda q: q not in RATIOS, 0.94)])
def test_planted_mistakes_are_told_alone(told, belongs, least):
    found = ends(told, "planted", belongs)
    assert found.total() > 200
    assert found["unique"] >= least * found.total(), found
    assert found["wrong"] <= 0.01 * found.total(), found


def test_slips_of_unit_scale_and_rate_are_told(told):
    found = ends(told, "slip")
    assert found["unique"] >= 0.85 * found.total(), found
    assert found["wrong"] <= 0.01 * found.total(), found


def test_right_submissions_are_never_told_a_mistake_and_never_wrong(told):
    happened = Counter()
    for key, count in told.items():
        if key[0] == "right":
            happened[key[3]] += count
    assert happened["all"] == 6 * 2 * len(assignment_ids())
    assert happened["told"] == happened["formula"] == happened["value"] == 0


def test_tracked_submissions_earn_everything_and_need_nobody(told):
    counts = Counter({key[3]: 0 for key in told})
    for key, count in told.items():
        if key[0] == "right" and key[2] == 0.02:
            counts[key[3]] += count
    assert counts["measured"] == counts["review"] == 0
    assert counts["points"] >= 100 * 19.9 * counts["all"]
