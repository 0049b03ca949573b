"""The look ahead: cost, fairness and likeness of a class, by arithmetic that can be checked."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import assignments.plan
from assignments.costs import Cost, keep_cost, kept_cost
from assignments.fairness import Fair, Prediction
from assignments.load import load_assignment
from assignments.model import Variant
from assignments.plan import chances_to_fit, make_plan, spread
from assignments.plan_plot import draw_plan
from vml_course.chart.svg import to_svg
from vml_course.errors import InputError

KICK = load_assignment("soccer-kick")
SECRET = bytes(range(32))
EACH = Cost(2, {"film": 3.0, "track": 1.0}, 1_000_000)


def _fair(e: float, inertia: float, student: str = "s") -> Fair:
    variant = Variant("soccer-kick", student, student, {}, {}, {}, 1, 3, "1")
    return Fair(variant, Prediction({"e": e, "I": inertia}, {"e": 0.001 * e, "I": 0.005 * inertia}), ())


def _grid(_assignment: object, _secret: bytes, student: str) -> Fair:
    number = sum(student.encode()) % 7
    return _fair(0.4 + 0.05 * number, 0.5 + 0.1 * number, student)


def test_two_equal_variants_fit_as_often_as_an_honest_answer_is_right() -> None:
    """Within twice the standard deviation, in both conclusions: 0.9545 squared."""
    fits = chances_to_fit(KICK, [_fair(0.6, 0.8), _fair(0.6, 0.8)])
    assert fits == pytest.approx([0.9545**2] * 2, abs=1e-4)


def test_variants_that_differ_in_one_conclusion_can_be_told_apart() -> None:
    assert chances_to_fit(KICK, [_fair(0.6, 0.8), _fair(0.6, 1.6)]) == pytest.approx([0, 0], abs=1e-9)


def test_the_chance_agrees_with_dice() -> None:
    rng, n = np.random.default_rng(5), 200_000
    one, other = _fair(0.600, 0.80), _fair(0.606, 0.83)
    answers = {q: one.prediction.value[q] * (1 + t / 2 * rng.standard_normal(n)) for q, t in (("e", 0.02), ("I", 0.05))}
    fit = np.ones(n, dtype=bool)
    for q, t in (("e", 0.02), ("I", 0.05)):
        fit &= np.abs(answers[q] - other.prediction.value[q]) <= t * other.prediction.value[q]
    assert chances_to_fit(KICK, [one, other])[0] == pytest.approx(fit.mean(), abs=0.005)


def test_a_plan_multiplies_what_was_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(assignments.plan, "fair_variant", _grid)
    plan = make_plan(KICK, SECRET, [f"s{n}" for n in range(300)], EACH)
    assert (plan.students, len(plan.looked_at)) == (300, 100)
    assert plan.cpu_s == pytest.approx(300 * 2.0)
    assert plan.disk_bytes == pytest.approx(3 * 300 * 500_000)
    assert plan.redraws == 3
    assert [sharp.symbol for sharp in plan.sharpness] == ["e", "I"]
    assert plan.sharpness[0].quartiles == pytest.approx([0.05] * 5)  # 0.1 % of 2 %
    assert plan.distinguishable == pytest.approx(7, rel=0.25)  # seven different variants were drawn
    assert plan.fits_another > 0.99


def test_a_small_class_is_compared_with_made_up_students(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(assignments.plan, "fair_variant", _grid)
    plan = make_plan(KICK, SECRET, ["s1"], EACH)
    assert plan.looked_at == ("s1",)
    assert plan.distinguishable == pytest.approx(7, rel=0.25)
    assert plan.fits_another == 0


def test_the_plan_names_variants_that_are_drawn_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(assignments.plan, "fair_variant", lambda *a: replace(_grid(*a), refused=("draw 0: too hard",)))
    assert make_plan(KICK, SECRET, ["s1", "s2"], EACH).unfair == dict.fromkeys(("s1", "s2"), ("draw 0: too hard",))


def test_the_plot_has_a_dot_for_each_variant_and_each_conclusion(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(assignments.plan, "fair_variant", _grid)
    svg = to_svg(draw_plan(make_plan(KICK, SECRET, [f"s{n}" for n in range(9)], EACH)))
    assert svg.count("<circle") == 18
    assert "9 variants of a class of 9" in svg


def test_nobody_is_no_class() -> None:
    with pytest.raises(InputError, match="students: expected a class of one or more"):
        make_plan(KICK, SECRET, [], EACH)


def test_some_of_a_list_are_spread_over_it() -> None:
    assert spread("abc", 5) == ["a", "b", "c"]
    assert spread(range(1000), 4) == [0, 250, 500, 750]


def test_costs_add_up_over_runs_and_a_spoilt_file_tells_nothing(tmp_path) -> None:
    path = tmp_path / "cost.json"
    keep_cost(path, EACH)
    keep_cost(path, Cost(1, {"film": 1.0, "write": 0.5}, 10))
    assert kept_cost(path) == Cost(3, {"film": 4.0, "track": 1.0, "write": 0.5}, 1_000_010)
    path.write_text("{", encoding="utf-8")
    assert kept_cost(path) == Cost()
