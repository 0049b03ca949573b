"""A pellet embeds in a pendulum at rest (e = 0): angular momentum in the hit, energy in the rise.

Hibbeler, *Dynamics*, 19.3; Beer & Johnston, *Dynamics*, "Conservation of angular momentum". With the pellet's mass m
and the arm d of its line about the pivot, the pendulum's mass M, its centre of mass at c, its inertia I about the
pivot:

    m v1 d = (I + m d^2) w2,     1/2 (I + m d^2) w2^2 = (M c + m d) g (1 - cos theta_max)

Energy is lost in the hit; it is kept in the rise. The whole swing is fitted, not the highest point alone: its angular
acceleration -p sin(theta), p = (M c + m d) g / (I + m d^2), holds the same energy.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, final

import numpy as np

from vml_course.errors import NoImpactError, OutOfRangeError
from vml_course.kinetics.arc import fit_arc
from vml_course.kinetics.clear_frames import ClearFrames, Seen, frames_about
from vml_course.kinetics.impact_model import ImpactOptions, check_given
from vml_course.kinetics.joint import Fit, Problem, Watched, fit
from vml_course.kinetics.paths import Path, Place, Symbols, flying, size, swing_angle
from vml_course.kinetics.pinned_problem import mark_at, towards_mark
from vml_course.kinetics.solved import DOUBT_SD, Solving, joint_solution
from vml_course.kinetics.straight import fit_line
from vml_course.kinetics.vectors import unwrapped
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution

RISE_S = 0.5  # of the swing after the hit that is fitted, where the clip has it


@final
class BallisticPendulum:
    """The impact model "ballistic-pendulum"."""

    name = "ballistic-pendulum"
    title = "A pellet that embeds in a pendulum"
    given: Mapping[str, str] = {"m": "mass", "d": "length", "M": "mass", "c": "length"}
    optional: Mapping[str, str] = {}
    usual = ImpactOptions(striker="bob", struck="pellet", knee="pivot", flight="always")

    def predict(self, parameters: Mapping[str, float], before: Mapping[str, float]) -> dict[str, float]:
        """Return the state after the hit and the height of the swing, in closed form.

        Parameters
        ----------
        parameters : mapping
            `I` (kg m^2, pendulum about the pivot), `m`, `M` (kg), `d`, `c` (m), and `g` (m/s^2; 9.81 if absent).
        before : mapping
            `v1` (m/s), the pellet's speed.

        Returns
        -------
        after : dict
            `omega2` (rad/s), `J` (N s, what the pellet gave away), `loss` (J), `theta_max` (rad; pi when it goes over).

        >>> pendulum = {"I": 0.99, "m": 0.01, "M": 2.0, "d": 1.0, "c": 0.5, "g": 10.0}
        >>> after = MODEL.predict(pendulum, {"v1": 200.0})
        >>> round(after["omega2"], 9), round(after["loss"], 9), round(math.degrees(after["theta_max"]), 2)
        (2.0, 198.0, 36.68)
        """
        inertia, ball, body, arm, centre = (parameters[symbol] for symbol in ("I", "m", "M", "d", "c"))
        whole, v1 = inertia + ball * arm**2, before["v1"]
        omega2 = ball * v1 * arm / whole
        pull = (body * centre + ball * arm) * parameters.get("g", 9.81) / whole
        return {
            "omega2": omega2,
            "J": ball * (v1 - omega2 * arm),
            "loss": 0.5 * ball * v1**2 - 0.5 * whole * omega2**2,
            "theta_max": math.acos(max(1.0 - omega2**2 / (2.0 * pull), -1.0)),
        }

    def solve(self, motion: Motion, given: Mapping[str, float], options: ImpactOptions | None = None) -> ImpactSolution:
        """Return the pendulum's I and the pellet's v1, from the paths of a mark on the pendulum and of the pellet.

        The estimates hold momentum and energy at once; the figures hold I by either road, and v1 by the swing alone.

        Parameters
        ----------
        motion : Motion
            Metres, y up. The pendulum hangs at rest before.
        given : mapping of str to float
            `m` pellet and `M` pendulum mass in kg; `d` arm of the pellet's line and `c` of the centre of mass in m.
        options : ImpactOptions, optional
            `striker` the mark on the pendulum, `struck` the pellet, `knee` a mark at the pivot.

        Raises
        ------
        InputError, NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError
        """
        options = options or self.usual
        check_given(given, self.given)
        if options.gravity_m_s2 <= 0:
            raise OutOfRangeError("gravity", 0.1, 30.0, "m/s^2", options.gravity_m_s2)
        frames = _frames(motion, options)
        known = {**{symbol: given[symbol] for symbol in self.given}, "g": options.gravity_m_s2}
        free = fit(_problem(motion, known, options, frames))
        roads = free.derive(_two_roads)
        start = dict(zip(free.problem.start, free.x, strict=True)) | dict(
            zip(("I", "v1"), roads.values[1:3], strict=True)
        )
        found = fit(_tied_problem(free.problem, start))
        solving = Solving(self.name, motion, given, options, frames)
        sds = np.sqrt(np.diag(roads.noise))
        figures = dict(zip(roads.names, roads.values, strict=True)) | {"v1_pellet_m_s": float(size(*_velocity(free)))}
        figures |= {f"{name}_sd_random": sd for name, sd in zip(roads.names, sds, strict=True)}
        figures |= {"pivot_x_m": found["kx"], "pivot_y_m": found["ky"], "mark_radius_m": found["r"]}
        return joint_solution(solving, found, _outcome, figures, _notes(figures, solving))


def _frames(motion: Motion, options: ImpactOptions) -> ClearFrames:
    """Find the impact by the pendulum; where it starts too slowly for its noise, by the pellet, which stops at once.

    The pellet comes second: it need not be seen any more once it is inside, and a tracker may lose it there and jump.
    """
    is_seen = np.asarray(np.isfinite(motion.of(options.striker)).all(axis=1))
    window = options.window_s, max(options.window_s, RISE_S)
    gravity = np.array(options.gravity_xy_m_s2) if options.flight == "always" else None
    try:
        return frames_about(motion, options.striker, is_seen, (None, None), window)
    except NoImpactError as not_by_pendulum:
        try:
            return frames_about(motion, options.struck, is_seen, (gravity, None), window)
        except NoImpactError:
            raise not_by_pendulum from None


def _problem(motion: Motion, known: Mapping[str, float], options: ImpactOptions, frames: ClearFrames) -> Problem:
    """Return the fit without momentum or energy: rate w2 and pull p of the swing, velocity of the pellet, apart."""
    bob, pellet = frames.seen(motion, options.striker), frames.seen(motion, options.struck, sides=("before",))
    gravity = np.array(options.gravity_xy_m_s2) if options.flight == "always" else np.zeros(2)
    line = fit_line(pellet.time_s, pellet.xy_m)
    names = ("bx", "by", "b1x", "b1y")
    start = {"t": 0.0, **_swing_start(bob, mark_at(motion, options.knee), known)}
    start |= dict(zip(names, map(float, [*line.position(0.0), *line.slope]), strict=True))
    pellet_path = flying("b", gravity, np.zeros(2))
    stays = {"b2x": np.zeros((1, 1)), "b2y": np.zeros((1, 1))}
    watched = (
        Watched(options.striker, bob, _bob_path),
        Watched(options.struck, pellet, lambda u, s, after: pellet_path({**u, **stays}, s, after)),
    )
    return Problem(start, known, watched)


def _swing_start(bob: Seen, knee_m: Any, known: Mapping[str, float]) -> dict[str, float]:
    arc = towards_mark(bob, fit_arc(bob.xy_m), knee_m)
    order, angle = np.argsort(bob.time_s), np.empty(len(bob.time_s))
    angle[order] = unwrapped(np.arctan2(*(bob.xy_m - arc.centre_m)[order].T[::-1]))
    early = bob.is_after & (bob.time_s < np.sort(bob.time_s[bob.is_after])[:10].max())
    rate = fit_line(bob.time_s[early], angle[early, None]).slope[0]
    values = *arc.centre_m, arc.radius_m, angle[~bob.is_after].mean(), rate, known["g"] / known["c"]
    return dict(zip(("kx", "ky", "r", "theta", "w2", "p"), map(float, values), strict=True))


def _bob_path(u: Symbols, s: Any, is_after: Any) -> Place:
    """Return the mark's path: at rest where the pendulum hangs, then a swing about that angle."""
    hanging = {**u, "w1": np.zeros_like(u["w2"])}
    swing = swing_angle(hanging, s, is_after, u["theta"] + 0.5 * math.pi)  # cos(x - 90 deg) = sin x
    angle = np.where(is_after, swing, u["theta"])
    return Place(u["kx"] + u["r"] * np.cos(angle), u["ky"] + u["r"] * np.sin(angle))


def _tied(u: Symbols) -> dict[str, Any]:
    """Add what momentum and energy say: rate and pull of the swing, and the pellet's velocity along its direction."""
    whole = u["I"] + u["m"] * u["d"] ** 2
    rate, pull = u["m"] * u["v1"] * u["d"] / whole, (u["M"] * u["c"] + u["m"] * u["d"]) * u["g"] / whole
    along = {"b1x": u["v1"] * np.cos(u["way"]), "b1y": u["v1"] * np.sin(u["way"])}
    return {**u, **along, "w2": u["turn"] * rate, "p": pull}


def _tied_problem(free: Problem, start: Mapping[str, float]) -> Problem:
    """Return the fit in which momentum and energy hold: unknown I and v1 instead of w2, p and the pellet's velocity."""
    kept = {name: value for name, value in start.items() if name not in {"w2", "p", "b1x", "b1y"}}
    kept["way"] = math.atan2(start["b1y"], start["b1x"])
    known = {**free.given, "turn": math.copysign(1.0, start["w2"])}

    def tied(path: Path) -> Path:
        return lambda u, s, is_after: path(_tied(u), s, is_after)

    return Problem(kept, known, tuple(Watched(point.name, point.seen, tied(point.path)) for point in free.watched))


def _two_roads(u: Symbols) -> dict[str, Any]:
    """Return I by momentum, I by energy, and v1 by the swing alone."""
    inside, rate = u["m"] * u["d"] ** 2, np.sign(np.real(u["w2"])) * u["w2"]
    by_momentum = u["m"] * size(u["b1x"], u["b1y"]) * u["d"] / rate - inside
    by_energy = (u["M"] * u["c"] + u["m"] * u["d"]) * u["g"] / u["p"] - inside
    by_swing = (by_energy + inside) * rate / (u["m"] * u["d"])
    return {"I_by_momentum": by_momentum, "I_by_energy": by_energy, "v1_by_swing_m_s": by_swing}


def _outcome(u: Symbols) -> dict[str, Any]:
    """Return what is asked, with the equations of the module."""
    u = _tied(u)
    whole, rate = u["I"] + u["m"] * u["d"] ** 2, u["turn"] * u["w2"]
    found = {"I": u["I"], "v1": u["v1"], "omega2": u["w2"], "J": u["m"] * (u["v1"] - rate * u["d"])}
    loss = 0.5 * u["m"] * u["v1"] ** 2 - 0.5 * whole * rate**2
    # cos theta_max = 1 - w2^2 / (2 p), as an angle without arccos, which takes no complex steps.
    half = rate / (2.0 * np.sqrt(u["p"]))
    highest = 2.0 * np.arctan(half / np.sqrt(np.where(np.real(half) < 1.0, 1.0 - half**2, 1e-12)))
    return {**found, "t_impact": u["t"], "loss": loss, "theta_max": highest}


def _velocity(free: Fit) -> tuple[float, float]:
    return free["b1x"], free["b1y"]


def _notes(figures: Mapping[str, float], solving: Solving) -> list[str]:
    apart = abs(figures["I_by_momentum"] - figures["I_by_energy"])
    sd = math.hypot(figures["I_by_momentum_sd_random"], figures["I_by_energy_sd_random"])
    if apart <= max(DOUBT_SD * sd, 0.02 * figures["I_by_energy"]):
        return []
    note = f"I is {figures['I_by_momentum']:.4g} kg m^2 by momentum and {figures['I_by_energy']:.4g} kg m^2 by energy"
    return [f"{note}: check m, d, M, c, the scale, and whether {solving.options.struck} stayed in"]


MODEL = BallisticPendulum()
