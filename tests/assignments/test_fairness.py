"""How sharply a variant can be measured is known before it is rendered, and the same for ever."""

from __future__ import annotations

import pytest

import assignments.fairness
from assignments.errors import NoVariantError, UnfairError
from assignments.fairness import Prediction, allowance, conclusions, fair_variant, hold_fair, predict
from assignments.load import assignment_ids, load_assignment
from assignments.variants import draw_variant

KICK = load_assignment("soccer-kick")
SECRET = bytes(range(32))


def test_a_prediction_is_the_same_every_time() -> None:
    variant = draw_variant(KICK, SECRET, "s1")
    assert predict(KICK, variant) == predict(KICK, variant)
    assert predict(KICK, variant).sd["I"] == pytest.approx(0.0050 * predict(KICK, variant).value["I"], rel=0.05)


@pytest.mark.parametrize("name", assignment_ids())
def test_every_assignment_of_the_catalogue_gives_fair_variants(name: str) -> None:
    assignment = load_assignment(name)
    fair = fair_variant(assignment, SECRET, "s1")
    assert set(fair.prediction.sd) == {question.id for question in conclusions(assignment)}
    hold_fair(assignment, fair.prediction)


def test_a_variant_that_is_too_hard_is_drawn_again_and_it_is_said_why(monkeypatch: pytest.MonkeyPatch) -> None:
    first = draw_variant(KICK, SECRET, "s1")

    def hard_at_first(_assignment: object, variant: object) -> Prediction:
        return Prediction({"I": 1.0}, {"I": 0.1 if variant == first else 0.001})

    monkeypatch.setattr(assignments.fairness, "predict", hard_at_first)
    fair = fair_variant(KICK, SECRET, "s1")
    assert fair.variant == draw_variant(KICK, SECRET, "s1", first=first.redraws + 1)
    why = "I: expected to be known to a standard deviation of at most 0.0125, got 0.1."
    assert fair.refused == (f"draw {first.redraws}: {why}",)


def test_where_nothing_is_fair_the_last_reasons_are_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(assignments.fairness, "predict", lambda *_: Prediction({"I": 1.0}, {"I": float("nan")}))
    with pytest.raises(NoVariantError, match="I: expected to be known to a standard deviation of at most"):
        fair_variant(KICK, SECRET, "s1")


def test_the_limit_is_a_share_of_what_is_allowed() -> None:
    hold_fair(KICK, Prediction({"e": 0.8}, {"e": 0.25 * 0.02 * 0.8}))
    with pytest.raises(UnfairError):
        hold_fair(KICK, Prediction({"e": 0.8}, {"e": 0.26 * 0.02 * 0.8}))


def test_what_is_allowed_never_falls_below_the_floor() -> None:
    at_rest = KICK.question("v_b1")
    assert at_rest.floor > 0
    assert allowance(at_rest, 0.0) == at_rest.floor
