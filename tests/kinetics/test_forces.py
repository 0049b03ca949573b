import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.errors import OutOfRangeError
from vml_course.kinetics.forces import (
    PinnedRod,
    centre_of_percussion,
    energy_balance,
    forces_of,
    inverse_dynamics,
    mean_force,
    pin_impulse,
)
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model
from vml_course.kinetics.pinned import after_impact

positive = st.floats(0.05, 3.0)


@given(e=st.floats(0, 1), inertia=positive, m=positive, mass=positive, c=st.floats(0.05, 1), omega1=st.floats(1, 30))
def test_the_pin_feels_nothing_at_the_centre_of_percussion(e, inertia, m, mass, c, omega1):
    arm = centre_of_percussion(inertia, mass, c)
    after = after_impact(e, inertia, m, arm, omega1, 0.0)
    assert pin_impulse(after.impulse, mass, c, omega1, after.omega2) == pytest.approx(
        0.0, abs=1e-9 * (1 + after.impulse)
    )
    near = after_impact(e, inertia, m, 0.5 * arm, omega1, 0.0)
    far = after_impact(e, inertia, m, 1.5 * arm, omega1, 0.0)
    assert pin_impulse(near.impulse, mass, c, omega1, near.omega2) > 0
    assert pin_impulse(far.impulse, mass, c, omega1, far.omega2) < 0


@given(
    e=st.floats(0, 1), inertia=positive, m=positive, arm=st.floats(0.1, 1), omega1=st.floats(1, 30), u1=st.floats(-9, 0)
)
def test_the_energy_balance_is_the_loss_of_the_closed_form(e, inertia, m, arm, omega1, u1):
    after = after_impact(e, inertia, m, arm, omega1, u1)
    found = energy_balance(inertia, m, omega1, after.omega2, u1, after.u2)
    assert found.loss == pytest.approx(after.loss, rel=1e-6, abs=1e-7)
    assert 0 <= found.loss_share + 1e-9 <= 1 + 1e-9


@pytest.mark.parametrize("contact_s", [0.0, -0.01, 0.2])
def test_a_contact_time_that_cannot_be_is_refused(contact_s):
    with pytest.raises(OutOfRangeError, match="contact time"):
        mean_force(12.0, contact_s)


def test_inverse_dynamics_of_a_free_swing_needs_no_torque_and_does_no_work():
    """A pendulum in closed form at one instant: alpha = -M g c cos(angle) / I."""
    rod = PinnedRod(2.0, 0.4, 0.5)
    angle = np.linspace(-np.pi, 0, 9)
    alpha = -rod.mass_kg * 9.81 * rod.centre_m * np.cos(angle) / rod.inertia_kg_m2
    found = inverse_dynamics(rod, angle, np.full(9, 3.0), alpha)
    np.testing.assert_allclose(found.torque_n_m, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.power_w, 0.0, atol=1e-12)


@given(angle=st.floats(-4, 4), omega=st.floats(-10, 10), alpha=st.floats(-50, 50))
def test_inverse_dynamics_keeps_newtons_and_eulers_laws_about_the_centre_of_mass(angle, omega, alpha):
    """Independent: moments about G instead of the pivot, with I_G = I - M c^2."""
    rod = PinnedRod(2.0, 0.4, 0.5, 9.81)
    found = inverse_dynamics(rod, *(np.array([x]) for x in (angle, omega, alpha)))
    to_pin = -rod.centre_m * np.array([np.cos(angle), np.sin(angle)])
    pin = found.pin_n[0]
    about_centre = found.torque_n_m[0] + to_pin[0] * pin[1] - to_pin[1] * pin[0]
    assert about_centre == pytest.approx((0.5 - 2.0 * 0.16) * alpha, abs=1e-9)


@pytest.mark.parametrize("mirror", [False, True])
def test_forces_of_a_solved_kick(kick, mirror):
    found = impact_model("fixed-pivot").solve(kick(mirror=mirror), {"m": 0.5, "L": 0.56}, ImpactOptions(drive="none"))
    forces = forces_of(found, 0.010, PinnedRod(4.0, 0.25, 1.88))
    impulse = 0.5 * found.value("v_b2")
    assert forces["J"].value == pytest.approx(impulse, rel=1e-6)
    assert forces["F"].value == pytest.approx(impulse / 0.010, rel=1e-6)
    assert forces["H"].value == pytest.approx(1.88 * abs(found.value("omega1") - found.value("omega2")), rel=1e-5)
    assert forces["R"].value == pytest.approx(impulse - 4.0 * 0.25 * (15 - found.value("v_f2")) / 0.56, rel=1e-5)
    assert forces["F"].sd / forces["F"].value == pytest.approx(found.estimates["J"].sd / impulse)
