"""Every model's prediction keeps the laws of mechanics, and is what linear equations give."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vml_course.kinetics.models import impact_model

EXACT = 1e-9
e_values, masses, lengths = st.floats(0.05, 1.0), st.floats(0.05, 5.0), st.floats(0.1, 1.5)
inertias, rates, speeds = st.floats(0.05, 5.0), st.floats(1.0, 30.0), st.floats(-10.0, 10.0)
close = pytest.approx


@settings(deadline=None)
@given(e=e_values, inertia=inertias, m=masses, arm=lengths, omega1=st.floats(-30, 30), u1=speeds)
def test_a_pinned_body_keeps_angular_momentum_about_the_pivot_and_restitution(e, inertia, m, arm, omega1, u1):
    """Two linear equations in omega2 and u2; a door at rest (omega1 = 0) and an incoming ball are among them."""
    after = impact_model("fixed-pivot").predict(
        {"e": e, "I": inertia, "m": m, "L": 2 * arm, "a": arm}, {"omega1": omega1, "u1": u1}
    )
    equations = np.array([[inertia, m * arm], [-arm, 1.0]])
    known = np.array([inertia * omega1 + m * arm * u1, e * (arm * omega1 - u1)])
    omega2, u2 = np.linalg.solve(equations, known)
    assert (after["omega2"], after["u2"]) == (close(omega2, rel=EXACT, abs=EXACT), close(u2, rel=EXACT, abs=EXACT))
    energy = 0.5 * inertia * (omega1**2 - omega2**2) + 0.5 * m * (u1**2 - u2**2)
    assert after["loss"] == close(energy, rel=1e-6, abs=1e-7)
    assert after["loss"] >= 0


@settings(deadline=None)
@given(e=e_values, m=masses, d=lengths, inertia=inertias, v=st.floats(1, 15))
def test_a_ball_rebounds_from_a_door_when_e_is_more_than_its_share(e, m, d, inertia, v):
    after = impact_model("fixed-pivot").predict(
        {"e": e, "I": inertia, "m": m, "L": d, "a": d}, {"omega1": 0.0, "u1": -v}
    )
    assert (after["u2"] > 0) == (e > m * d**2 / inertia) or e == close(m * d**2 / inertia)


@settings(deadline=None)
@given(e=e_values, big=masses, m=masses, normal=st.floats(-3, 3), v=st.tuples(speeds, speeds, speeds, speeds))
def test_pucks_keep_momentum_restitution_and_what_is_across(e, big, m, normal, v):
    before = dict(zip(("a1x", "a1y", "b1x", "b1y"), v, strict=True))
    after = impact_model("two-pucks").predict({"e": e, "M": big, "m": m, "normal": normal}, before)
    n, t = np.array([math.cos(normal), math.sin(normal)]), np.array([-math.sin(normal), math.cos(normal)])
    a1, b1, a2, b2 = np.array(v[:2]), np.array(v[2:]), *(np.array([after[f"{k}2x"], after[f"{k}2y"]]) for k in "ab")
    np.testing.assert_allclose(big * a1 + m * b1, big * a2 + m * b2, atol=1e-8)
    assert (b2 - a2) @ n == close(-e * (b1 - a1) @ n, abs=1e-8)
    assert (a2 @ t, b2 @ t) == (close(a1 @ t, abs=1e-8), close(b1 @ t, abs=1e-8))
    energy = 0.5 * big * (a1 @ a1 - a2 @ a2) + 0.5 * m * (b1 @ b1 - b2 @ b2)
    assert after["loss"] == close(energy, rel=1e-6, abs=1e-7)


@settings(deadline=None)
@given(
    e=e_values,
    inertia=inertias,
    big=masses,
    m=masses,
    b=st.floats(-1, 1),
    g1=speeds,
    u1=speeds,
    omega1=st.floats(-20, 20),
)
def test_a_free_rod_keeps_both_momenta_and_restitution(*, e, inertia, big, m, b, g1, u1, omega1):
    rod = {"e": e, "I": inertia, "M": big, "m": m, "b": b}
    after = impact_model("free-rod").predict(rod, {"g1": g1, "u1": u1, "omega1": omega1})
    equations = np.array([[big, m, 0.0], [0.0, m * b, inertia], [-1.0, 1.0, -b]])
    known = [big * g1 + m * u1, m * b * u1 + inertia * omega1, e * (g1 + b * omega1 - u1)]
    g2, u2, omega2 = np.linalg.solve(equations, known)
    for symbol, value in (("g2", g2), ("u2", u2), ("omega2", omega2)):
        assert after[symbol] == close(value, rel=1e-7, abs=1e-7)
    energy = 0.5 * big * (g1**2 - g2**2) + 0.5 * m * (u1**2 - u2**2) + 0.5 * inertia * (omega1**2 - omega2**2)
    assert after["loss"] == close(energy, rel=1e-6, abs=1e-6)


@settings(deadline=None)
@given(
    e=e_values, mu=st.floats(0.01, 2), k=st.floats(0.2, 1), radius=st.floats(0.02, 0.3), m=masses,
    u1=st.floats(-10, -1), w1=speeds, omega1=st.floats(-150, 150),
)  # fmt: skip
def test_a_bouncing_ball_keeps_angular_momentum_about_the_contact_and_coulombs_law(
    *, e, mu, k, radius, m, u1, w1, omega1
):
    ball = {"e": e, "mu": mu, "R": radius, "k": k, "m": m}
    after = impact_model("spin-bounce").predict(ball, {"u1": u1, "w1": w1, "omega1": omega1})
    moment = k * m * radius**2
    assert moment * omega1 - radius * m * w1 == close(moment * after["omega2"] - radius * m * after["w2"], abs=1e-8)
    assert abs(m * (after["w2"] - w1)) <= mu * after["J"] * (1 + EXACT) + EXACT
    slip1, slip2 = w1 + radius * omega1, after["s2"]
    assert slip1 * slip2 >= -1e-9  # friction never turns the slip round
    if abs(slip2) > 1e-6:
        assert abs(m * (after["w2"] - w1)) == close(mu * after["J"])
    assert after["loss"] >= -1e-9


@settings(deadline=None)
@given(inertia=inertias, m=st.floats(0.005, 0.5), big=masses, d=lengths, c=st.floats(0.05, 1), v1=st.floats(1, 50))
def test_a_ballistic_pendulum_keeps_angular_momentum_in_the_hit_and_energy_in_the_rise(inertia, m, big, d, c, v1):
    after = impact_model("ballistic-pendulum").predict({"I": inertia, "m": m, "M": big, "d": d, "c": c}, {"v1": v1})
    whole = inertia + m * d**2
    assert m * v1 * d == close(whole * after["omega2"])
    if after["theta_max"] < 3.1:
        rise = (big * c + m * d) * 9.81 * (1 - math.cos(after["theta_max"]))
        assert 0.5 * whole * after["omega2"] ** 2 == close(rise, rel=1e-6)
    assert after["loss"] == close(0.5 * m * v1**2 - 0.5 * whole * after["omega2"] ** 2)
    assert after["J"] * d == close(inertia * after["omega2"], rel=1e-6)


def test_a_hammers_block_slides_as_far_as_friction_work_takes_its_energy():
    hammer = {"e": 0.5, "I": 1.0, "m": 1.5, "L": 0.6, "mu": 0.3}
    after = impact_model("hammer-block").predict(hammer, {"omega1": 5.0, "u1": 0.0})
    assert 0.3 * 1.5 * 9.81 * after["slide"] == close(0.5 * 1.5 * after["u2"] ** 2)
