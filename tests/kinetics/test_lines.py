import numpy as np
import pytest

from vml_course.errors import InputError, TooFewFramesError, UnknownNameError
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.lines import solve_by_lines

GIVEN = {"m": 0.5, "L": 0.56}


@pytest.mark.parametrize("mirror", [False, True])
def test_straight_lines_come_within_a_fifth_of_a_percent_of_an_exact_kick(kick, mirror):
    found = solve_by_lines(kick(mirror=mirror), GIVEN)
    assert found.value("e") == pytest.approx(0.73, rel=2e-3)
    assert found.value("I") == pytest.approx(1.88, rel=2e-3)
    assert found.value("omega1") == pytest.approx((-1 if mirror else 1) * 26.786, rel=1e-3)
    assert found.value("v_f1") > 0
    assert found.method == "lines"


def test_spread_at_a_tenth_of_a_pixel_is_one_percent_of_i(kick, with_noise):
    """Closed form for 20 ms a side: I 1.06 %; the told uncertainty covers it."""
    rng, motion = np.random.default_rng(11), kick()
    found = [solve_by_lines(with_noise(motion, rng), GIVEN) for _ in range(200)]
    for symbol, truth, sd in (("e", 0.73, 0.21), ("I", 1.88, 1.06)):
        errors = np.array([solution.value(symbol) for solution in found]) / truth - 1
        told = np.array([solution.estimates[symbol].sd for solution in found]) / truth
        assert 100 * np.std(errors) == pytest.approx(sd, rel=0.2)
        assert 0.88 <= np.mean(np.abs(errors) < 1.96 * told) <= 0.985


def test_a_driven_leg_misleads_the_lines(kick):
    assert solve_by_lines(kick(drive=10.6), GIVEN).value("I") == pytest.approx(1.88 * 1.068, rel=0.01)


def test_without_a_knee_there_are_no_lines(kick):
    with pytest.raises(UnknownNameError):
        solve_by_lines(kick(), GIVEN, ImpactOptions(knee="hip"))


def test_a_missing_mass_is_asked_for(kick):
    with pytest.raises(InputError, match="-g m="):
        solve_by_lines(kick(), {"L": 0.56})


def test_too_few_frames_are_refused(kick):
    with pytest.raises(TooFewFramesError):
        solve_by_lines(kick(impact_s=0.005), GIVEN)
