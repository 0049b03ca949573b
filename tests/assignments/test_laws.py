"""Laws of the textbooks: what the scene promises, units, mirrors and swapped bodies; mistakes against plain numbers."""

from __future__ import annotations

import dataclasses
import math
from functools import cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assignments.load import assignment_ids, load_assignment
from assignments.mistakes import ImpactNumbers
from assignments.pinned_body import has_moved, is_possible, told, ways
from assignments.slips import slips_of_mass, slips_of_rate
from assignments.textbook import every_mistake, textbook, textbook_of
from assignments.textbook.ballistic_pendulum import PendulumNumbers
from assignments.textbook.free_rod import RodNumbers
from assignments.textbook.hammer_block import HammerNumbers
from assignments.textbook.spin_bounce import BounceNumbers
from assignments.textbook.two_pucks import PuckNumbers, _component
from assignments.theory import Met, Mistake, Textbook, along, by_code, promised, unknown, value_of
from assignments.variants import draw_variant
from vml_course.errors import InputError, UnknownNameError
from vml_course.model.truth import Realised

SECRET = bytes(range(32))
SCALE = 500.0
CLOSED = 1e-9  # relative: a closed form keeps its parameters

factors = st.floats(0.1, 10.0)
scenes = st.sampled_from(assignment_ids())


@cache
def parameters_of(name: str) -> tuple[str, dict[str, float]]:
    assignment = load_assignment(name)
    return assignment.scene, dict(draw_variant(assignment, SECRET, "s1").parameters)


def met_of(name: str) -> tuple[Textbook, Met]:
    """An assignment's textbook and the impact that its first variant promises."""
    scene, parameters = parameters_of(name)
    return textbook_of(scene), promised(scene, parameters)


def numbers_of(name: str):
    book, met = met_of(name)
    return dataclasses.replace(book.numbers_of(met), S=SCALE)


def concluded(name: str, numbers) -> dict[tuple[str, int], float]:
    """Every conclusion in every right way, by its id and the number of the way."""
    items = met_of(name)[0].concluded
    return {(item.id, k): value_of(formula, numbers) for item in items for k, formula in enumerate(item.formulas)}


def times(numbers, factor_of):
    """Each field times the factor that a function gives for its name."""
    values = {field.name: getattr(numbers, field.name) for field in dataclasses.fields(numbers)}
    return dataclasses.replace(numbers, **{name: value * factor_of(name) for name, value in values.items()})


# ---------------------------------------------------------------- what the scene promises

PARAMETERS = {
    "e": "restitution",
    "I": "inertia_kg_m2",
    "mu": "friction",
    "v1": "pellet_speed_m_s",
    "M": "puck_a_mass_kg",
}


@pytest.mark.parametrize("name", assignment_ids())
def test_every_right_way_leads_to_what_the_scene_promises(name: str) -> None:
    book, met = met_of(name)
    for (quantity, _), value in concluded(name, numbers_of(name)).items():
        parameter = PARAMETERS.get(quantity)
        expected = met.parameters[parameter] if parameter else book.true(quantity, met)
        assert value == pytest.approx(expected, rel=CLOSED), quantity


@pytest.mark.parametrize("name", assignment_ids())
def test_a_promised_impact_can_be_asked_about(name: str) -> None:
    book, numbers = met_of(name)[0], numbers_of(name)
    assert book.is_possible(numbers)
    assert book.unfit(numbers) == ""


@settings(deadline=None, max_examples=40)
@given(st.floats(0.5, 2.0))
def test_a_pendulum_keeps_angular_momentum_in_the_hit_and_energy_in_the_rise(factor: float) -> None:
    n = dataclasses.replace(numbers_of("ballistic-pendulum"), v=9.0 * factor, theta=0.3 * factor)
    assert (n.I + n.m * n.d**2) * n.omega2 == pytest.approx(n.m * n.v * n.d)
    risen = 0.5 * (n.I_by_energy + n.m * n.d**2) * n.omega2**2
    assert risen == pytest.approx((n.M * n.c + n.m * n.d) * n.g * (1 - math.cos(n.theta)))
    assert n.loss + 0.5 * (n.I + n.inside) * n.omega2**2 == pytest.approx(n.brought)


# ---------------------------------------------------------------- units

SPEED, RATE, PLAIN = (1, -1, 0), (0, -1, 0), (0, 0, 0)
INERTIA, ENERGY = (2, 0, 1), (2, -2, 1)
UNITS = {
    **dict.fromkeys(["v", "v1", "v2", "u1", "u2", "w1", "w2", "g2"], SPEED),
    **dict.fromkeys([f"{body}{side}{axis}" for body in "ab" for side in "12" for axis in "xy"], SPEED),
    **dict.fromkeys(["omega1", "omega2"], RATE),
    **dict.fromkeys(["m", "M"], (0, 0, 1)),
    **dict.fromkeys(["L", "D", "R", "b", "c", "d", "mark"], (1, 0, 0)),
    **dict.fromkeys(["a", "g"], (1, -2, 0)),
    **dict.fromkeys(["theta", "tilt_rad", "k", "own_phi"], PLAIN),
    "S": (-1, 0, 0),
}
CONCLUDED_UNITS = {"I": INERTIA, "loss": ENERGY, "v1": SPEED, "s2": SPEED, "M": (0, 0, 1)}


@settings(deadline=None, max_examples=40)
@given(scenes, st.tuples(factors, factors, factors))
def test_a_conclusion_changes_with_the_units_as_its_dimension_says(name: str, units) -> None:
    def factor(powers) -> float:
        return math.prod(unit**power for unit, power in zip(units, powers, strict=True))

    numbers = numbers_of(name)
    scaled = concluded(name, times(numbers, lambda field: factor(UNITS[field])))
    for (quantity, way), value in concluded(name, numbers).items():
        expected = value * factor(CONCLUDED_UNITS.get(quantity, PLAIN))
        assert scaled[quantity, way] == pytest.approx(expected, rel=1e-6), quantity


# ---------------------------------------------------------------- mirrors and swapped bodies

MIRRORED = {
    "soccer-kick": ({"v1", "v2", "u1", "u2", "omega1", "omega2"}, set()),
    "bat-and-ball": ({"v1", "v2", "u1", "u2", "omega1", "omega2"}, set()),
    "swinging-door": ({"v1", "v2", "u1", "u2", "omega1", "omega2"}, set()),
    "spinning-ball": ({"w1", "w2", "omega1", "omega2"}, {"s2"}),
    "struck-rod": ({"b", "omega2"}, set()),
    "two-pucks": ({"a1y", "a2y", "b1y", "b2y"}, {"phi"}),
}
"""Fields whose sign is another one in the mirror, and conclusions that change their sign with them."""


@pytest.mark.parametrize("name", MIRRORED)
def test_in_the_mirror_conclusions_are_the_same_but_for_directions(name: str) -> None:
    fields, turned = MIRRORED[name]
    mirrored = concluded(name, times(numbers_of(name), lambda field: -1.0 if field in fields else 1.0))
    for (quantity, way), value in concluded(name, numbers_of(name)).items():
        assert mirrored[quantity, way] == pytest.approx(-value if quantity in turned else value), quantity


@settings(deadline=None, max_examples=40)
@given(st.sampled_from(["soccer-kick", "bat-and-ball", "swinging-door"]), st.floats(-30.0, 30.0))
def test_restitution_is_the_same_for_both_bodies_and_every_observer(name: str, moving: float) -> None:
    n = numbers_of(name)
    swapped = dataclasses.replace(n, v1=n.u1, v2=n.u2, u1=n.v1, u2=n.v2)
    passed = dataclasses.replace(n, v1=n.v1 + moving, v2=n.v2 + moving, u1=n.u1 + moving, u2=n.u2 + moving)
    assert swapped.e == pytest.approx(n.e)
    assert passed.e == pytest.approx(n.e, rel=1e-6)
    assert pytest.approx(n.I, rel=1e-6) == passed.I


@settings(deadline=None, max_examples=40)
@given(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0))
def test_pucks_are_the_same_for_every_observer_and_swapped(x: float, y: float) -> None:
    n = numbers_of("two-pucks")
    fields = [f"{body}{side}" for body in "ab" for side in "12"]
    moved = {f"{f}{axis}": getattr(n, f"{f}{axis}") + by for f in fields for axis, by in (("x", x), ("y", y))}
    swapped = {f"{'ba'['ab'.index(f[0])]}{f[1]}{axis}": getattr(n, f"{f}{axis}") for f in fields for axis in "xy"}
    for other in (dataclasses.replace(n, **moved), dataclasses.replace(n, **swapped)):
        assert other.e == pytest.approx(n.e, rel=1e-6)
        assert other.approach == pytest.approx(n.approach, rel=1e-6)
    assert pytest.approx(n.M, rel=1e-6) == dataclasses.replace(n, **moved).M
    assert pytest.approx(n.m**2 / n.M, rel=1e-6) == dataclasses.replace(n, **swapped).M


# ---------------------------------------------------------------- mistakes against plain numbers

PUCKS = PuckNumbers(a1x=5.0, a1y=0.0, a2x=3.0, a2y=-4.0, b1x=0.0, b1y=0.0, b2x=6.0, b2y=8.0, m=2.0)  # M = 6
BOUNCE = BounceNumbers(u1=-4.0, u2=3.0, w1=6.0, w2=4.0, omega1=10.0, omega2=-5.0, m=1.0, R=0.2, k=0.4)
PENDULUM = PendulumNumbers(v=10.0, omega2=2.0, theta=math.pi / 3, m=0.1, M=0.9, d=0.5, c=0.4, g=10.0)
ROD = RodNumbers(u1=4.0, u2=1.0, g2=2.0, omega2=-5.0, m=0.5, M=0.75, b=0.2, L=0.6)
SLOWED = dataclasses.replace(PUCKS, a2x=1.0, a2y=0.0)
HAMMER = HammerNumbers(v1=2, v2=1, u1=0, u2=2, omega1=4, omega2=2, m=2.0, L=0.5, a=3.0, g=10.0)

PLAIN_VALUES = [
    (PUCKS, "PE2", 3 / 5), (PUCKS, "PE3", 5 / 5), (PUCKS, "PE4", 10 / 3), (PUCKS, "PE5", (10 + 1.8 - 3.2) / 3),
    (PUCKS, "PE6", (10 - 1.8 + 3.2) / 5), (PUCKS, "PM4", 20 / -1.4), (PUCKS, "PM5", 20 / 3), (PUCKS, "PM6", 12 / 8),
    (PUCKS, "PM7", 12 / -1), (PUCKS, "PA1", math.atan2(6, 8)), (PUCKS, "PA2", math.atan2(-4, 3)),
    (PUCKS, "PA4", math.degrees(math.atan2(8, 6))), (PUCKS, "PA5", math.atan2(8, 6) + math.atan2(4, 3)),
    (SLOWED, "PM2", 20 / 4), (SLOWED, "PM3", 200 / 24),
    (SLOWED, "PE10", (20 / 2.4 * 1 + 200) / (20 / 2.4 * 25)),
    (BOUNCE, "SE3", 5 / math.sqrt(52)), (BOUNCE, "SE4", 4 / 6), (BOUNCE, "SE6", 3 / 8),
    (BOUNCE, "SE5", (9 + 16 + 0.4 * 1) / (16 + 36 + 0.4 * 4)), (BOUNCE, "SM1", 4 / 3), (BOUNCE, "SM1b", 6 / 4),
    (BOUNCE, "SM2", 2 / 4), (BOUNCE, "SM2b", 2 / 3), (BOUNCE, "SM3", 2 / 1), (BOUNCE, "SM5", 3 / 7),
    (BOUNCE, "SM5b", 1.5 / 7), (dataclasses.replace(BOUNCE, k=0.6), "SM5c", 1.2 / 7), (BOUNCE, "SM6", 5 / 7),
    (BOUNCE, "SM8", 10 / 7), (BOUNCE, "SS1", 4.0), (BOUNCE, "SS2", 5.0), (BOUNCE, "SS3", 2.0), (BOUNCE, "SS5", 8.0),
    (BOUNCE, "SS4", 4 - math.degrees(1)), (BOUNCE, "SS6", -1.0), (BOUNCE, "SS7", -1.0),
    (PENDULUM, "BI1", 0.25), (PENDULUM, "BI1b", 0.275), (PENDULUM, "BI2", 0.475), (PENDULUM, "BI3", 2.475),
    (PENDULUM, "BI4", 0.175), (PENDULUM, "BI5", 0.1), (PENDULUM, "BI6", 0.144), (PENDULUM, "BI7", 225.0),
    (PENDULUM, "BI8", 2.475), (PENDULUM, "BI9d", math.radians(0.25)), (PENDULUM, "BI9r", 0.25 * math.pi / 30),
    (PENDULUM, "BV1", math.sqrt(41)), (PENDULUM, "BV2", 41 * 36 / 41), (PENDULUM, "BV3", 50.0),
    (PENDULUM, "BV4", 41 * math.sqrt(3)), (PENDULUM, "BV4b", 41.0), (PENDULUM, "BV5", 20.5), (PENDULUM, "BV6", 1.0),
    (PENDULUM, "BV7", 10.0), (PENDULUM, "BV7b", 10 * math.sqrt(5)), (PENDULUM, "BV8", 41 * (1 - math.cos(60)) * 2),
    (PENDULUM, "BL1", 5.0), (PENDULUM, "BL2", 0.5), (PENDULUM, "BL3", 9.0), (PENDULUM, "BL4", 0.9),
    (PENDULUM, "BL6", 4.5), (PENDULUM, "BL7", 5 - 0.5 * 0.225 * 4),
    (ROD, "RE2", 1 / 4), (ROD, "RE3", 0.0), (ROD, "RE4", -1 / 4), (ROD, "RE5", 1 / 4), (ROD, "RE6", 1.0),
    (ROD, "RE7", 2.5 / 4), (ROD, "RE8", (1 + math.degrees(1)) / 4), (ROD, "RE10", 6 / 4), (ROD, "RE11", 0.0),
    (ROD, "RI1", 0.3), (ROD, "RI2", 0.012), (ROD, "RI3", 0.09), (ROD, "RI4", 0.0225), (ROD, "RI5", 0.08),
    (ROD, "RI6", 0.1), (ROD, "RI7", 0.09), (ROD, "RI7b", 0.03), (ROD, "RI8", 4.5 / 25), (ROD, "RI10", 0.04),
    (ROD, "RI12", 0.02), (ROD, "RI13", 0.03), (ROD, "RI13b", 0.12), (ROD, "RI6g", 60.0), (ROD, "RI6lb", 0.132277),
    (ROD, "RI6w", 0.5886), (ROD, "RI9d", math.radians(0.06)), (ROD, "RI9r", 0.06 * math.pi / 30),
    (HAMMER, "HM1", 3.0), (HAMMER, "HM2", 10 / 3), (HAMMER, "HM3", 0.15), (HAMMER, "HM4", 0.6), (HAMMER, "HM6", 6.0),
    (HAMMER, "HM7", 0.6), (HAMMER, "HM7b", 0.15), (HAMMER, "HM8", 0.984252), (HAMMER, "HM9", 0.2),
]  # fmt: skip


@pytest.mark.parametrize(("numbers", "code", "expected"), PLAIN_VALUES, ids=[row[1] for row in PLAIN_VALUES])
def test_a_mistake_leads_to_the_number_that_is_worked_out_by_hand(numbers, code: str, expected: float) -> None:
    assert every_mistake()[code].value(numbers) == pytest.approx(expected, rel=1e-5)


def test_mistakes_that_only_turn_a_sign_or_a_fraction_do_so() -> None:
    turned = [(PUCKS, "PE9", PUCKS.e), (PUCKS, "PM8", PUCKS.M), (PUCKS, "PA3", PUCKS.phi), (BOUNCE, "SE2", BOUNCE.e)]
    turned += [(BOUNCE, "SM7", BOUNCE.mu), (PENDULUM, "BL5", PENDULUM.loss), (ROD, "RE9", ROD.e), (ROD, "RI11", ROD.I)]
    turned += [(HAMMER, "HM5", HAMMER.mu)]
    over = [(PUCKS, "PE1", PUCKS.e), (BOUNCE, "SE1", BOUNCE.e), (BOUNCE, "SM4", BOUNCE.mu), (ROD, "RE1", ROD.e)]
    assert [every_mistake()[code].value(n) for n, code, _ in turned] == [-right for *_, right in turned]
    assert [every_mistake()[code].value(n) for n, code, _ in over] == [1 / right for *_, right in over]
    assert every_mistake()["PM1"].value(PUCKS) == pytest.approx(PUCKS.m**2 / PUCKS.M)


def test_a_mark_that_is_no_contact_has_an_arm_of_its_own() -> None:
    door = ImpactNumbers(v1=0, v2=-4, u1=-8, u2=1, omega1=0, omega2=-8, m=0.5, L=0.5, mark=0.75)
    assert every_mistake()["E26"].value(door) == pytest.approx(7 / 8)
    assert every_mistake()["I31"].value(door) == pytest.approx(1.5 * door.I)


def test_a_k_that_the_ball_has_is_no_mistake() -> None:
    assert math.isnan(every_mistake()["SM5c"].value(BOUNCE))
    assert math.isnan(every_mistake()["SM5b"].value(dataclasses.replace(BOUNCE, k=0.5)))


def test_a_ball_that_hardly_slips_after_the_bounce_cannot_be_asked_about() -> None:
    book = textbook("spin-bounce")
    slipped = [dataclasses.replace(BOUNCE, w2=w2, omega2=0.0) for w2 in (4.0, 0.81, 0.79, 0.0, -4.0)]
    assert ["slips" in book.unfit(n) for n in slipped] == [False, False, True, True, True]


# ---------------------------------------------------------------- possible and impossible numbers

DOOR = ImpactNumbers(v1=0.0, v2=-4.0, u1=-8.0, u2=0.8, omega1=0.0, omega2=-8.0, m=0.5, L=0.5)
KICK = ImpactNumbers(v1=10.0, v2=8.0, u1=0.0, u2=15.0, omega1=20.0, omega2=16.0, m=0.5, L=0.5)


@pytest.mark.parametrize(
    ("changes", "possible", "moved"),
    [
        ({}, True, True),
        ({"omega2": 20.0}, False, False),
        ({"omega2": 19.9}, False, False),
        ({"omega2": 19.7}, True, True),
        ({"u2": 0.0}, False, False),
        ({"v2": 10.0}, False, False),
        ({"u1": 10.0}, False, True),
        ({"u2": 8.0}, False, True),
        ({"u2": 7.0}, False, True),
        ({"u2": 20.0}, True, True),
        ({"u2": 20.1}, False, True),
    ],
)
def test_only_numbers_of_a_possible_impact_are_followed(changes, possible: bool, moved: bool) -> None:
    numbers = dataclasses.replace(KICK, **changes)
    assert (is_possible(numbers), has_moved(numbers)) == (possible, moved)
    assert is_possible(DOOR)


@pytest.mark.parametrize(
    ("model", "numbers", "changes"),
    [
        ("two-pucks", PUCKS, {"a1x": -5.0}),
        ("two-pucks", PUCKS, {"m": 0.0}),
        ("spin-bounce", BOUNCE, {"u1": 4.0}),
        ("spin-bounce", BOUNCE, {"u2": 5.0}),
        ("spin-bounce", BOUNCE, {"w2": 6.0}),
        ("ballistic-pendulum", PENDULUM, {"omega2": 0.0}),
        ("ballistic-pendulum", PENDULUM, {"omega2": 20.0}),
        ("ballistic-pendulum", PENDULUM, {"theta": 0.0}),
        ("ballistic-pendulum", PENDULUM, {"theta": 3.2}),
        ("free-rod", ROD, {"u2": 4.0}),
        ("free-rod", ROD, {"omega2": 0.0}),
        ("free-rod", ROD, {"g2": 0.0}),
    ],
)
def test_numbers_that_make_the_rest_easy_are_not_possible(model: str, numbers, changes) -> None:
    book = textbook(model)
    if model == "two-pucks":  # hand numbers of a wild impact: this one is possible
        numbers = dataclasses.replace(numbers, a2x=4.0, a2y=-1.0, b2x=3.0, b2y=3.0)
    assert book.is_possible(numbers)
    assert not book.is_possible(dataclasses.replace(numbers, **changes))


# ---------------------------------------------------------------- ways to read what was written

SPEEDS, RATES, BALL = {"v1": 8.0, "v2": 6.0}, {"omega1": 20.0, "omega2": 10.0}, {"u1": 0.0, "u2": 9.0}


def test_speeds_and_rates_stand_for_each_other() -> None:
    arm = {"L": 0.5}
    from_rates, from_speeds = {"v1": 10.0, "v2": 5.0}, {"omega1": 16.0, "omega2": 12.0}
    assert list(ways({**SPEEDS, **RATES, **BALL}, arm)) == [
        {**SPEEDS, **RATES, **BALL},
        {**from_rates, **RATES, **BALL},
        {**SPEEDS, **from_speeds, **BALL},
    ]
    assert list(ways({**RATES, **BALL}, arm)) == [{**from_rates, **RATES, **BALL}]
    assert list(ways({**SPEEDS, **BALL}, arm)) == [{**SPEEDS, **from_speeds, **BALL}]
    assert list(ways(BALL, arm)) == []
    assert list(ways({**SPEEDS, **RATES, "u1": 0.0}, arm)) == []


def test_the_arm_is_that_of_the_contact() -> None:
    kick = told({"m": 0.4, "L": 0.5, "D": 0.2})
    assert (kick["m"], kick["L"], kick["D"], math.isnan(kick["mark"])) == (0.4, 0.5, 0.2, True)
    door = told({"m": 0.4, "L": 0.8, "a": 0.6})
    assert (door["L"], door["mark"], math.isnan(door["D"])) == (0.6, 0.8, True)
    assert all(math.isnan(value) for value in told({}).values())
    assert math.isnan(told({"a": 0.6})["mark"])


@pytest.mark.parametrize("name", assignment_ids())
def test_written_fields_make_up_the_record_that_they_came_from(name: str) -> None:
    book, met = met_of(name)
    right = numbers_of(name)
    values = {item.field: item.true(met) for item in book.measured}
    first = next(iter(book.complete(values, met.given)))
    record = book.record(first, met.given, SCALE)
    for item in book.concluded:
        assert value_of(item.formula, record) == pytest.approx(value_of(item.formula, right))
    assert record.S == SCALE
    assert math.isnan(book.record(first, met.given).S)
    assert list(book.complete({}, met.given)) == []


def test_what_nobody_asks_for_rests() -> None:
    assert textbook("fixed-pivot").resting(["omega2", "v_c2", "v_b1", "v_b2"]) == {"omega1": 0.0, "v1": 0.0}
    assert textbook("fixed-pivot").resting(["omega1", "v_f1", "v_b1"]) == {}
    assert set(textbook("two-pucks").resting([])) == {"a1y", "b1x", "b1y"}


# ---------------------------------------------------------------- the classes themselves


def test_a_formula_that_cannot_be_worked_out_has_no_value() -> None:
    def huge(_: object) -> float:
        return 10.0**400

    bad = [lambda _: 1 / 0, lambda _: math.sqrt(-1), lambda _: math.inf, huge, lambda n: n + "x", lambda _: None]
    assert all(math.isnan(value_of(formula, 1.0)) for formula in bad)
    assert value_of(lambda n: 2 * n, 3.0) == 6.0
    assert math.isnan(Mistake("X", "e", "about", lambda n: 1 / n).value(0.0))


def test_a_conclusion_that_the_textbook_does_not_know_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UnknownNameError, match=r"conclusion: expected one of phi, e, M, got 'mu'"):
        textbook("two-pucks").conclusion("mu")
    assert textbook("two-pucks").conclusion("M").id == "M"
    assert len(textbook("two-pucks").conclusion("M").formulas) == 3


def test_a_model_without_a_textbook_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UnknownNameError, match=r"model: expected one of ballistic-pendulum, .*two-pucks, got 'golf'"):
        textbook("golf")


def test_mistakes_of_another_scene_are_left_out() -> None:
    book = textbook("fixed-pivot")
    assert {m.code for m in book.mistakes_about("I")} - {m.code for m in book.mistakes_about("I", "bat_and_ball")} == {
        "I6d",
        "I18",
        "I19",
    }
    assert {m.quantity for m in book.mistakes_about("e", "soccer_kick")} == {"e"}
    assert book.mistakes_about("I", "soccer_kick") == book.mistakes_about("I")


def test_mistakes_are_kept_by_code_in_their_order() -> None:
    one, other = (Mistake(code, "e", "about", float) for code in ("B", "A"))
    assert list(by_code(one, other).items()) == [("B", one), ("A", other)]


def test_a_scene_without_an_impact_promises_none() -> None:
    with pytest.raises(InputError, match=r"scene: expected a scene with an impact, got tensile_strip"):
        promised("tensile_strip", {})


def test_what_is_answerable_has_a_true_value() -> None:
    book, met = met_of("spinning-ball")
    assert book.answerable == ("v_b1", "v_b2", "v_t1", "v_t2", "omega1", "omega2", "e", "mu", "s2")
    assert book.true("v_b1", met) == pytest.approx(-4.288627509790391)
    with pytest.raises(KeyError):
        book.true("I", met)


def test_slips_of_a_mass_and_of_a_rate_bring_their_factors() -> None:
    mass, rate = slips_of_mass("X1", "M", lambda n: 2 * n), slips_of_rate("X2", "I", lambda n: 2 * n)
    assert [(m.code, m.quantity, m.value(1.5)) for m in mass] == [
        ("X1g", "M", 3000.0),
        ("X1lb", "M", pytest.approx(3 * 2.20462)),
        ("X1w", "M", pytest.approx(3 * 9.81)),
    ]
    assert [(m.code, m.quantity, m.value(1.5)) for m in rate] == [
        ("X2d", "I", pytest.approx(math.radians(3))),
        ("X2r", "I", pytest.approx(3 * math.pi / 30)),
    ]
    assert [
        word in m.about and word in m.hint for m, word in zip(mass, ("grams", "pounds", "weight"), strict=True)
    ] == [True] * 3
    assert ["deg/s" in rate[0].about, "minute" in rate[1].about] == [True, True]
    assert ["degrees" in rate[0].hint, "rev/min" in rate[1].hint] == [True, True]


def test_components_of_the_pucks_are_those_of_the_states() -> None:
    _, met = met_of("two-pucks")
    for body, index in (("a", met.impact.striker), ("b", met.impact.struck)):
        for side, states in (("1", met.impact.before), ("2", met.impact.after)):
            for axis in (0, 1):
                assert _component(body, side, axis)(met) == states[index, axis]


def test_an_unknown_is_the_one_that_the_impact_names() -> None:
    _, met = met_of("two-pucks")
    known = Met(
        dataclasses.replace(met.impact, unknowns={"e": Realised(0.7, 0.6, 0.5), "M": Realised(0.4, 0.3, 0.2)}),
        met.given,
        met.parameters,
    )
    assert (unknown("e")(known), unknown("M")(known)) == (0.7, 0.4)


def test_a_hammer_is_told_its_own_gravity_or_the_standard_one() -> None:
    book = textbook("hammer-block")
    assert book.record({}, {"g": 1.62}).g == 1.62
    assert book.record({}, {}).g == 9.81


def test_mistakes_count_a_ball_that_moves_before() -> None:
    """v1 = 10, u1 = -2: whatever stands for the approach adds both."""
    n = dataclasses.replace(KICK, u1=-2.0, D=0.2)
    mistakes = every_mistake()
    assert mistakes["E12"].value(n) == pytest.approx((15 - 3.28084 * 8) / (3.28084 * 10 + 2))
    assert mistakes["E12b"].value(n) == pytest.approx((3.28084 * 15 - 8) / (10 + 3.28084 * 2))
    s1, s2 = math.sin(0.4) / 0.4, math.sin(0.32) / 0.32
    assert mistakes["E17"].value(n) == pytest.approx((15 - s2 * 8) / (s1 * 10 + 2))
    inertia = 0.5 * 0.5 * 17 / 4
    assert mistakes["E9"].value(n) == pytest.approx((inertia * 256 + 0.5 * 225) / (inertia * 400 + 0.5 * 4))
    assert mistakes["I12"].value(n) == pytest.approx(0.4 * 0.5 * 0.1 * 17 / 4)


def test_masses_and_energies_of_whole_speeds() -> None:
    n = dataclasses.replace(PUCKS, a2x=2.0, a2y=0.0)
    assert every_mistake()["PM3"].value(n) == pytest.approx(200 / 21)
    assert every_mistake()["PE10"].value(n) == pytest.approx((20 / 1.8 * 4 + 200) / (20 / 1.8 * 25))


def test_a_component_along_a_direction_is_the_product_of_both() -> None:
    assert along((3.0, 4.0), (0.6, 0.8)) == pytest.approx(5.0)
    assert along((3.0, 4.0), (-0.8, 0.6)) == pytest.approx(0.0)
