"""Every model gives back what a motion in closed form was made with; no motion here comes from the package."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from vml_course.errors import LengthMismatchError, NoImpactError, TooFewFramesError, UpsideDownError
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.lines import solve_by_lines
from vml_course.kinetics.models import impact_model
from vml_course.model.motion import Motion
from vml_course.usecases.solve_table import solve_motion

FPS, FRAMES, IMPACT_S = 480.0, 120, 0.1171
TIME = np.arange(FRAMES) / FPS - IMPACT_S
AFTER = TIME > 0
EXACT, PIXEL_M = 1e-6, 1 / 500
TOP = {"gravity_m_s2": 0.0, "flight": "never"}


def motion_of(**points):
    xy = np.stack(list(points.values()), axis=1)
    return Motion(tuple(points), np.arange(len(xy)), TIME[: len(xy)] + IMPACT_S, xy, np.full(xy.shape[:2], np.nan))


def noisy(motion, rng, pixels):
    xy = motion.xy_m + rng.normal(scale=pixels * PIXEL_M, size=motion.xy_m.shape)
    return replace(motion, xy_m=xy, sigma_m=np.full(xy.shape[:2], pixels * PIXEL_M))


def free(place, before, after, gravity=(0.0, 0.0)):
    place, before, after, gravity = (np.asarray(values, dtype=float) for values in (place, before, after, gravity))
    velocity = np.where(AFTER[:, None], after, before)
    return place + velocity * TIME[:, None] + 0.5 * gravity * TIME[:, None] ** 2


def circle(centre, radius, angle):
    return np.asarray(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def ode_angle(start, before, after, acceleration):
    """Angle at TIME from angle'' = acceleration(angle)."""
    angle = np.empty(FRAMES)
    for side, rate in ((~AFTER, before), (AFTER, after)):
        t = TIME[side]
        order = np.argsort(np.abs(t))
        found = solve_ivp(
            lambda _t, y: [y[1], acceleration(y[0])], (0, t[order][-1]), [start, rate], t_eval=t[order],
            rtol=1e-11, atol=1e-12, method="DOP853",
        )  # fmt: skip
        part = np.empty_like(t)
        part[order] = found.y[0]
        angle[side] = part
    return angle


def door(*, e=0.6, inertia=1.5, m=0.4, length=0.9, a=0.6, v=-8.0):
    """Seen from above, hinge at the origin, closed along +x; a ball comes from above (y) with velocity v."""
    w2, u2 = np.linalg.solve([[inertia, m * a], [-a, 1.0]], [m * a * v, -e * v])
    angle = np.where(AFTER, w2 * TIME, 0.0)
    ball = free((a, 0.05), (0.3, v), (0.3, u2))
    return motion_of(edge=circle((0, 0), length, angle), hinge=np.zeros((FRAMES, 2)), ball=ball), w2, u2


DOOR = ImpactOptions(striker="edge", knee="hinge", drive="none", window_s=0.1, **TOP)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_door_at_rest_gives_e_and_i_from_where_the_ball_meets_it(side):
    motion, w2, u2 = door()
    motion = replace(motion, xy_m=motion.xy_m * np.array([1.0, side]))
    found = impact_model("fixed-pivot").solve(motion, {"m": 0.4, "L": 0.9, "a": 0.6}, DOOR)
    assert found.value("e") == pytest.approx(0.6, rel=EXACT)
    assert found.value("I") == pytest.approx(1.5, rel=EXACT)
    assert found.value("omega2") == pytest.approx(side * w2, rel=EXACT)
    assert found.value("v_b2") == pytest.approx(u2, rel=EXACT)
    assert found.value("a") == 0.6
    assert math.isnan(found.figures["r"])
    assert found.notes == ()


def test_a_student_finds_the_door_by_lines_too():
    found = solve_by_lines(door()[0], {"m": 0.4, "L": 0.9, "a": 0.6}, DOOR)
    assert found.value("e") == pytest.approx(0.6, rel=1e-3)
    assert found.value("I") == pytest.approx(1.5, rel=1e-3)


def test_a_solution_holds_where_the_model_puts_the_points():
    motion = door()[0]
    fitted = impact_model("fixed-pivot").solve(motion, {"m": 0.4, "L": 0.9, "a": 0.6}, DOOR).fitted
    assert fitted.points == ("edge", "ball")
    seen = np.isfinite(fitted.of("edge")).all(axis=1)
    assert 90 <= seen.sum() < FRAMES
    np.testing.assert_allclose(fitted.of("edge")[seen], motion.of("edge")[seen], atol=1e-8)


def test_without_the_arm_a_door_would_be_taken_to_be_hit_at_its_edge():
    found = impact_model("fixed-pivot").solve(door()[0], {"m": 0.4, "L": 0.9}, DOOR)
    assert found.value("I") == pytest.approx(1.5 * 0.9 / 0.6, rel=1e-5)


def test_a_door_in_noise_knows_its_hinges_side_by_the_mark():
    rng, (motion, _, _) = np.random.default_rng(1), door(inertia=8.0)
    for _ in range(10):
        found = impact_model("fixed-pivot").solve(noisy(motion, rng, 0.3), {"m": 0.4, "L": 0.9, "a": 0.6}, DOOR)
        for symbol, truth in (("e", 0.6), ("I", 8.0)):
            estimate = found.estimates[symbol]
            assert estimate.value == pytest.approx(truth, abs=4 * estimate.sd)
            assert estimate.sd < 0.05 * truth


def test_a_door_whose_edge_was_typed_wrong_is_refused():
    with pytest.raises(LengthMismatchError):
        impact_model("fixed-pivot").solve(door(inertia=0.3)[0], {"m": 0.4, "L": 0.7, "a": 0.6}, DOOR)


def hammer(*, e=0.5, inertia=0.8, m=1.2, length=0.7, mu=0.3, w1=6.0, pull=12.0):
    w2, u2 = np.linalg.solve([[inertia, m * length], [-length, 1.0]], [inertia * w1, e * length * w1])
    angle = ode_angle(-math.pi / 2, w1, w2, lambda a: -pull * math.cos(a))
    until = np.clip(TIME, 0, u2 / (mu * 9.81))
    block = np.stack([0.08 + u2 * until - 0.5 * mu * 9.81 * until**2, np.full(FRAMES, -length)], axis=1)
    return motion_of(head=circle((0, 0), length, angle), pivot=np.zeros((FRAMES, 2)), block=block)


HAMMER = ImpactOptions(striker="head", struck="block", knee="pivot", flight="never", drive="none", window_s=0.1)


@pytest.mark.parametrize("mu", [0.2, 0.6])
@pytest.mark.parametrize("at_rest", [False, True])
def test_a_hammer_and_a_sliding_block_give_e_i_and_mu(mu, at_rest):
    found = impact_model("hammer-block").solve(hammer(mu=mu), {"m": 1.2, "L": 0.7}, replace(HAMMER, at_rest=at_rest))
    for symbol, truth in (("e", 0.5), ("I", 0.8), ("mu", mu)):
        assert found.value(symbol) == pytest.approx(truth, rel=EXACT)
    assert found.figures["contact_frames"] <= 1  # the block's deceleration is known only after the impact is found
    assert all("contact and" in note for note in found.notes)


def test_lines_through_a_block_that_friction_slows_say_why_they_differ():
    solved = solve_motion(hammer(), "hammer-block", {"m": 1.2, "L": 0.7}, HAMMER)
    assert any("friction slows it: its speed after is" in note for note in solved.notes)
    assert solved.lines.value("v_b2") < solved.joint.value("v_b2")


def test_a_block_that_stops_within_the_window_is_solved_too():
    motion = hammer(mu=0.9, w1=2.0, e=0.3)
    found = impact_model("hammer-block").solve(motion, {"m": 1.2, "L": 0.7}, replace(HAMMER, at_rest=True))
    assert found.value("mu") == pytest.approx(0.9, rel=1e-4)
    assert found.value("e") == pytest.approx(0.3, rel=1e-4)


def pucks(*, e=0.8, big=0.3, m=0.2, normal=0.5, a1=(2.0, 0.3), b1=(-0.4, 0.1)):
    n, a1, b1 = np.array([math.cos(normal), math.sin(normal)]), np.array(a1), np.array(b1)
    impulse = (1 + e) * (a1 - b1) @ n / (1 / big + 1 / m)
    return motion_of(
        puck_a=free((0.1, 0.2), a1, a1 - n * impulse / big),
        puck_b=free(np.array([0.1, 0.2]) + 0.08 * n, b1, b1 + n * impulse / m),
    )


PUCKS = ImpactOptions(striker="puck_a", struck="puck_b", **TOP)


@pytest.mark.parametrize("rest", [{}, {"b1": (0.0, 0.0)}])
def test_two_pucks_give_e_and_the_other_mass(rest):
    options = replace(PUCKS, at_rest=bool(rest))
    found = impact_model("two-pucks").solve(pucks(**rest), {"m": 0.2}, options)
    assert found.value("e") == pytest.approx(0.8, rel=EXACT)
    assert found.value("M") == pytest.approx(0.3, rel=EXACT)
    assert found.figures["normal_off_deg"] == pytest.approx(0.0, abs=1e-5)
    assert found.notes == ()


def test_pucks_tracked_beside_their_centres_are_told():
    motion = pucks()
    xy = motion.xy_m.copy()
    xy[:, 1] += [0.0, 0.01]
    found = impact_model("two-pucks").solve(replace(motion, xy_m=xy), {"m": 0.2}, PUCKS)
    assert found.value("e") == pytest.approx(0.8, rel=EXACT)
    assert "off the line of the centres" in found.notes[0]


def rod(*, e=0.7, inertia=0.05, big=0.8, m=0.1, b=0.2, u=4.0, turn=0.3, centre_at=0.5, drift=(0.1, -0.2), w1=0.4):
    """The ball flies along `turn` - 90 degrees, square onto the rod, which lies along `turn`."""
    n = np.array([-math.sin(turn), math.cos(turn)])
    along, drift = np.array([math.cos(turn), math.sin(turn)]), np.array(drift)
    g1, u1 = drift @ n, -u
    equations = [[big, m, 0.0], [0.0, m * b, inertia], [-1.0, 1.0, -b]]
    g2, u2, w2 = np.linalg.solve(equations, [big * g1 + m * u1, m * b * u1 + inertia * w1, e * (g1 + b * w1 - u1)])
    centre = free((0, 0), drift, drift + (g2 - g1) * n)
    angle = turn + np.where(AFTER, w2, w1) * TIME
    ball = free(b * along + 0.05 * n, u1 * n, u2 * n)
    ends = (centre + (share - centre_at) * circle((0, 0), 0.9, angle) for share in (0.0, 1.0))
    return motion_of(**dict(zip(("tail", "tip", "ball"), [*ends, ball], strict=True)))


ROD = ImpactOptions(striker="tail", striker_mark="tip", **TOP)
ROD_GIVEN = {"m": 0.1, "M": 0.8, "b": 0.2}


@pytest.mark.parametrize("values", [{}, {"turn": -2.0}, {"drift": (0.0, 0.0), "w1": 0.0}, {"b": -0.2}])
def test_a_free_rod_gives_e_and_i_about_its_centre(values):
    found = impact_model("free-rod").solve(rod(**values), ROD_GIVEN, ROD)
    assert found.value("e") == pytest.approx(0.7, rel=EXACT)
    assert found.value("I") == pytest.approx(0.05, rel=EXACT)
    assert found.figures["arm_seen_m"] == pytest.approx(0.2, rel=1e-5)
    assert found.notes == ()


def test_marks_that_are_not_alike_about_the_centre_do_no_harm():
    motion = replace(rod(centre_at=0.46), sigma_m=np.full((FRAMES, 3), 0.02 * PIXEL_M))
    found = impact_model("free-rod").solve(motion, ROD_GIVEN, ROD)
    assert found.value("e") == pytest.approx(0.7, rel=1e-3)
    assert found.value("I") == pytest.approx(0.05, rel=1e-3)


def test_an_arm_that_is_not_where_the_ball_flew_is_told():
    found = impact_model("free-rod").solve(rod(), {**ROD_GIVEN, "b": 0.25}, ROD)
    assert any("at 200 mm, b says 250 mm" in note for note in found.notes)


def bounce(*, e=0.75, mu=0.15, k=0.4, radius=0.12, u1=-4.0, w1=2.5, spin=20.0):
    slip = w1 + radius * spin
    change = -math.copysign(min(mu * (1 + e) * abs(u1), abs(slip) * k / (1 + k)), slip)
    w2, u2, spin2 = w1 + change, -e * u1, spin + change / (k * radius)
    ball = free((0.5, radius), (w1, u1), (w2, u2), (0.0, -9.81))
    angle = 0.7 + np.where(AFTER, spin2, spin) * TIME
    return motion_of(rim=ball + circle((0, 0), 0.8 * radius, angle), ball=ball), spin2


BOUNCE = ImpactOptions(striker="rim", flight="always")
BOUNCE_GIVEN = {"m": 0.3, "R": 0.12, "k": 0.4}


@pytest.mark.parametrize(("spin", "w1"), [(20.0, 2.5), (-60.0, 1.0), (90.0, -3.0)])
def test_a_ball_that_slips_gives_e_mu_and_its_spin(spin, w1):
    motion, spin2 = bounce(spin=spin, w1=w1)
    found = impact_model("spin-bounce").solve(motion, BOUNCE_GIVEN, BOUNCE)
    for symbol, truth in (("e", 0.75), ("mu", 0.15), ("omega1", spin), ("omega2", spin2)):
        assert found.value(symbol) == pytest.approx(truth, rel=EXACT)
    assert found.figures["sticks"] == 0
    assert found.notes == ()


def test_a_ball_that_sticks_says_that_mu_is_a_bound():
    motion, _ = bounce(mu=0.9)
    found = impact_model("spin-bounce").solve(motion, BOUNCE_GIVEN, BOUNCE)
    assert found.figures["sticks"] == 1
    assert found.value("e_t") == pytest.approx(0.0, abs=1e-6)
    assert found.value("mu") < 0.9
    assert "mu is at least" in found.notes[0]


def test_a_wrong_k_shows_in_the_spin():
    found = impact_model("spin-bounce").solve(bounce()[0], {**BOUNCE_GIVEN, "k": 0.6667}, BOUNCE)
    assert any("k and R say" in note for note in found.notes)


def test_a_bounce_filmed_with_y_down_is_refused():
    motion, _ = bounce()
    with pytest.raises(UpsideDownError):
        impact_model("spin-bounce").solve(replace(motion, xy_m=motion.xy_m * [1, -1]), BOUNCE_GIVEN, BOUNCE)


def pendulum(*, inertia=0.6, m=0.05, big=2.0, d=0.7, c=0.5, v1=15.0, turn=1.0):
    whole = inertia + m * d**2
    w2, pull = m * v1 * d / whole, (big * c + m * d) * 9.81 / whole
    angle = -math.pi / 2 + turn * ode_angle(0.0, 0.0, w2, lambda a: -pull * math.sin(a)) * AFTER
    pellet = free((0.0, -d), (turn * v1, 0.0), (0.0, 0.0))
    pellet[AFTER] = np.nan
    return motion_of(bob=circle((0, 0), 0.8, angle), pivot=np.zeros((FRAMES, 2)), pellet=pellet)


PENDULUM = ImpactOptions(striker="bob", struck="pellet", knee="pivot", flight="never")
PENDULUM_GIVEN = {"m": 0.05, "d": 0.7, "M": 2.0, "c": 0.5}


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_a_ballistic_pendulum_gives_i_and_v1_by_momentum_and_by_energy(turn):
    found = impact_model("ballistic-pendulum").solve(pendulum(turn=turn), PENDULUM_GIVEN, PENDULUM)
    assert found.value("I") == pytest.approx(0.6, rel=1e-5)
    assert found.value("v1") == pytest.approx(15.0, rel=1e-5)
    assert found.figures["I_by_momentum"] == pytest.approx(0.6, rel=1e-5)
    assert found.figures["I_by_energy"] == pytest.approx(0.6, rel=1e-5)
    assert found.figures["v1_by_swing_m_s"] == pytest.approx(15.0, rel=1e-5)
    assert found.value("omega2") == pytest.approx(turn * 0.05 * 15 * 0.7 / (0.6 + 0.05 * 0.49), rel=1e-5)
    assert found.notes == ()


def stuck(motion, d=0.7):
    """The same clip with the pellet tracked on: it sits straight below the pivot, and turns with the pendulum."""
    xy, bob, pellet = motion.xy_m.copy(), motion.points.index("bob"), motion.points.index("pellet")
    xy[AFTER, pellet] = d / 0.8 * xy[AFTER, bob]
    return replace(motion, xy_m=xy)


def test_the_pellet_tells_when_a_slow_pendulum_is_lost_in_a_hands_noise():
    rng = np.random.default_rng(4)
    for _ in range(8):
        clicked = noisy(stuck(pendulum()), rng, 1.0)
        found = impact_model("ballistic-pendulum").solve(clicked, PENDULUM_GIVEN, PENDULUM)
        for symbol, true in (("I", 0.6), ("v1", 15.0)):
            assert found.value(symbol) == pytest.approx(true, abs=4 * found.estimates[symbol].sd)


def test_a_pellet_that_the_tracker_loses_inside_leaves_it_to_the_pendulum():
    motion = stuck(pendulum())
    xy = motion.xy_m.copy()
    xy[90:, motion.points.index("pellet")] += 0.1 * np.arange(len(xy) - 90)[:, None]  # it is off after something else
    found = impact_model("ballistic-pendulum").solve(replace(motion, xy_m=xy), PENDULUM_GIVEN, PENDULUM)
    assert found.value("I") == pytest.approx(0.6, rel=1e-5)
    assert found.value("v1") == pytest.approx(15.0, rel=1e-5)


def test_where_neither_tells_the_pendulum_is_named():
    hidden = noisy(pendulum(), np.random.default_rng(4), 3.0)
    with pytest.raises(NoImpactError, match="bob: expected a sudden change of velocity"):
        impact_model("ballistic-pendulum").solve(hidden, PENDULUM_GIVEN, PENDULUM)


def test_a_pellet_that_is_seen_on_changes_nothing_in_a_sharp_clip():
    away, on = (
        impact_model("ballistic-pendulum").solve(motion, PENDULUM_GIVEN, PENDULUM)
        for motion in (pendulum(), stuck(pendulum()))
    )
    assert on.frame_before == away.frame_before
    for symbol in ("I", "v1"):
        assert on.value(symbol) == pytest.approx(away.value(symbol), rel=1e-6)


def test_roads_that_disagree_are_told():
    found = impact_model("ballistic-pendulum").solve(pendulum(), {**PENDULUM_GIVEN, "m": 0.06}, PENDULUM)
    assert "by momentum and" in found.notes[-1]


def test_both_roads_together_are_sharper_than_either():
    rng = np.random.default_rng(2)
    found = impact_model("ballistic-pendulum").solve(noisy(pendulum(), rng, 0.1), PENDULUM_GIVEN, PENDULUM)
    figures = found.figures
    assert figures["I_sd_random"] < min(figures["I_by_momentum_sd_random"], figures["I_by_energy_sd_random"])


CASES = {
    "door": ("fixed-pivot", lambda: door()[0], {"m": 0.4, "L": 0.9, "a": 0.6}, DOOR, {"e": 0.6, "I": 1.5}),
    "hammer": ("hammer-block", hammer, {"m": 1.2, "L": 0.7}, HAMMER, {"e": 0.5, "I": 0.8, "mu": 0.3}),
    "pucks": ("two-pucks", pucks, {"m": 0.2}, PUCKS, {"e": 0.8, "M": 0.3}),
    "rod": ("free-rod", rod, ROD_GIVEN, ROD, {"e": 0.7, "I": 0.05}),
    "bounce": ("spin-bounce", lambda: bounce()[0], BOUNCE_GIVEN, BOUNCE, {"e": 0.75, "mu": 0.15}),
    "pendulum": ("ballistic-pendulum", pendulum, PENDULUM_GIVEN, PENDULUM, {"I": 0.6, "v1": 15.0}),
}


@pytest.mark.parametrize("name", CASES)
def test_told_uncertainties_hold_what_they_say_in_noise(name):
    """White noise of 0.1 px: no bias beyond its own error, and nine of ten to all of 60 within 1.96 sd."""
    model, make, given, options, truths = CASES[name]
    rng, motion, trials = np.random.default_rng(5), make(), 60
    found = [impact_model(model).solve(noisy(motion, rng, 0.1), given, options) for _ in range(trials)]
    for symbol, truth in truths.items():
        errors = np.array([solution.value(symbol) for solution in found]) - truth
        told = np.array([solution.figures[f"{symbol}_sd_random"] for solution in found])
        assert abs(errors.mean()) < 4 * told.mean() / math.sqrt(trials) + 1e-3 * truth
        assert np.mean(np.abs(errors) < 1.96 * told) >= 0.85
        assert np.std(errors) < 1.3 * told.mean()


@pytest.mark.parametrize("name", CASES)
def test_given_uncertainties_widen_what_depends_on_them(name):
    model, make, given, options, truths = CASES[name]
    plain = impact_model(model).solve(make(), given, options)
    wider = impact_model(model).solve(make(), given, replace(options, given_sd={"m": 0.1 * given["m"]}, scale_sd=0.05))
    for symbol in truths:
        assert wider.estimates[symbol].sd >= plain.estimates[symbol].sd
    assert any(wider.estimates[symbol].sd > 1.5 * plain.estimates[symbol].sd for symbol in plain.estimates)
    np.testing.assert_allclose(np.sqrt(np.diag(wider.covariance)), [found.sd for found in wider.estimates.values()])


@pytest.mark.parametrize("name", CASES)
def test_what_never_happens_and_what_is_cut_short_is_refused(name):
    model, make, given, options, _ = CASES[name]
    motion = make()
    still = replace(motion, xy_m=np.where(AFTER[:, None, None], motion.xy_m[[0]], motion.xy_m[[0]]))
    with pytest.raises(NoImpactError):
        impact_model(model).solve(still, given, options)
    short = slice(int(np.argmax(AFTER)) - 3, None)
    cut = Motion(motion.points, motion.frame[short], motion.time_s[short], motion.xy_m[short], motion.sigma_m[short])
    with pytest.raises(TooFewFramesError):
        impact_model(model).solve(cut, given, options)
