"""Students without a video: what they click scatters, and goes through the lines that their handout asks for.

Each student's points are the true ones with noise in every coordinate; velocities are slopes of straight lines, or of
parabolas where the handout says so, on each side of the impact. Nothing is rendered.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from assignments.film import foresee
from assignments.key import answer_key
from assignments.names import vector_of
from assignments.textbook import textbook_of
from assignments.theory import value_of
from assignments.variants import draw_variant
from grader.model import Answer, Kind, Submission
from vml_course.errors import SceneRefusedError

CLICK_PX = 0.5  # of each end of the scale bar
WINDOWS_S = {
    "soccer-kick": 0.020, "bat-and-ball": 0.020, "ballistic-pendulum": 0.020, "hammer-and-block": 0.040,
    "swinging-door": 0.040, "struck-rod": 0.100, "two-pucks": 0.100, "spinning-ball": 0.060,
}  # fmt: skip
"""Over how much time each side of the impact the handout lets a line be fitted."""


@dataclass(frozen=True, eq=False)
class Desk:
    """An assignment with one variant of it."""

    assignment: object
    key: object
    truth: object

    @property
    def book(self):
        return textbook_of(self.assignment.scene)

    @property
    def asked(self):
        return {question.id: question for question in self.assignment.questions}


def desk_of(assignment, secret, student):
    """Draw a variant that can be filmed and return it with its key; the precision of the reference is not known."""
    first = 0
    while True:
        variant = draw_variant(assignment, secret, student, first=first)
        try:
            truth = foresee(variant)
            break
        except SceneRefusedError:  # drawn again, as for a handout
            first = variant.redraws + 1
    return Desk(assignment, answer_key(assignment, variant, truth, None, "0" * 64), truth)


def tables_of(desk, noise_px, count, rng):
    """Return the positions of `count` students in px, shape (count, n, p, 2)."""
    exact = desk.key.xy_px[:, [desk.key.points.index(point) for point in desk.assignment.points]]
    return exact + noise_px * rng.standard_normal((count, *exact.shape))


def table(desk, xy_px, px_per_m):
    """Return one student's table in metres, y up, as the reader gives it."""
    columns = {"frame": desk.key.frame.astype(float), "t_s": desk.key.time_s}
    for number, point in enumerate(desk.assignment.points):
        columns[f"{point}_x_m"] = xy_px[:, number, 0] / px_per_m
        columns[f"{point}_y_m"] = -xy_px[:, number, 1] / px_per_m
    return columns


def measured(desk, xy_px, px_per_m):
    """Return what students measure on their points, each an array over students, by question."""
    xy_m = xy_px * np.array([1.0, -1.0]) / px_per_m[:, None, None, None]
    exact = tables_of(desk, 0.0, 1, np.random.default_rng(0)) * np.array([1.0, -1.0]) / desk.key.truth["px_per_m"]
    values = {}
    for question in desk.asked:
        if question in MEASURES:
            raw, clean = (MEASURES[question](Lines(desk, points)) for points in (xy_m, exact))
            true = desk.key.values[question]
            values[question] = raw * (-1.0 if clean[0] * true < 0 else 1.0)  # signs are looked up, not measured
    values["px_per_m"] = px_per_m
    values["fps"] = np.full(len(px_per_m), desk.key.values["fps"])
    return values


class Lines:
    """Slopes at the impact, each side by itself."""

    def __init__(self, desk, xy_m):
        self.desk, self.xy_m = desk, xy_m
        self.given = desk.key.given
        self.time_s = desk.key.time_s - desk.key.truth["t_impact_s"]
        self.window_s = WINDOWS_S[desk.assignment.id]

    def point(self, name):
        return self.xy_m[:, :, self.desk.assignment.points.index(name)]

    @property
    def struck(self):
        return self.point(str(self.desk.truth.declared["struck"]))

    def fit(self, paths, side, degree=1, window_s=None):
        """Return coefficients at the impact, constant term first; paths of shape (students, n)."""
        t, window = self.time_s, window_s or self.window_s
        kept = (t > 0) & (t <= window) if side == 2 else (t < 0) & (t >= -window)
        if kept.sum() < degree + 3:
            kept = t > 0 if side == 2 else t < 0
        powers = np.vander(t[kept], degree + 1, increasing=True)
        return np.linalg.pinv(powers) @ paths[:, kept].T

    def slope(self, paths, side, degree=1, window_s=None):
        return self.fit(paths, side, degree, window_s)[1]

    def rate(self, side, tail="", head=""):
        if not tail:
            tail, head = vector_of(self.desk.assignment.scene)[1:]
        across = self.point(head) - self.point(tail)
        return self.slope(np.unwrap(np.arctan2(across[..., 1], across[..., 0]), axis=1), side)

    def along(self, path, side, degree=1, window_s=None):
        """Return the speed of a path along the normal of the impact."""
        normal = np.array(self.desk.truth.met.normal)
        return self.slope(path @ normal, side, degree, window_s)

    def highest(self):
        """Return the largest angle: the top of a parabola through 20 pictures around it."""
        across = self.point("bob") - self.point("pivot")
        angle = np.unwrap(np.arctan2(across[..., 1], across[..., 0]), axis=1)
        angle = np.abs(angle - angle[:, self.time_s < 0].mean(axis=1, keepdims=True))
        top = int(np.argmax(angle.mean(axis=0)))
        near = slice(max(0, top - 10), top + 10)
        t = self.time_s[near] - self.time_s[top]
        c, b, a = np.linalg.pinv(np.vander(t, 3, increasing=True)) @ angle[:, near].T
        at = np.clip(np.divide(-b, 2 * a, out=np.zeros_like(a), where=a < 0), t[0], t[-1])
        return c + b * at + a * at**2


def _ball(side):
    def speed(lines):
        scene = lines.desk.assignment.scene
        if scene == "spin_bounce":
            return lines.slope(lines.point("ball")[..., 1], side, 2)
        if scene == "hammer_block" and side == 2:
            return lines.slope(lines.struck[..., 0], side, 2, 10.0)
        if scene == "ballistic_pendulum":
            return np.hypot(*(lines.slope(lines.struck[..., axis], side, 1, 10.0) for axis in (0, 1)))
        return lines.along(lines.struck, side)

    return speed


def _puck(name, side, axis):
    return lambda lines: lines.slope(lines.point(name)[..., axis], side)


def _spin(side):
    return lambda lines: lines.rate(side, "ball", "rim") if "rim" in lines.desk.assignment.points else lines.rate(side)


MEASURES = {
    "omega1": _spin(1),
    "omega2": lambda lines: lines.rate(2, "tail", "tip") if "tip" in lines.desk.assignment.points else _spin(2)(lines),
    "v_f1": lambda lines: lines.given["L"] * lines.rate(1),
    "v_f2": lambda lines: lines.given["L"] * lines.rate(2),
    "v_c2": lambda lines: lines.given["a"] * lines.rate(2),
    "v_b1": _ball(1),
    "v_b2": _ball(2),
    "v_t1": lambda lines: lines.slope(lines.point("ball")[..., 0], 1),
    "v_t2": lambda lines: lines.slope(lines.point("ball")[..., 0], 2),
    "v_g2": lambda lines: lines.along((lines.point("tail") + lines.point("tip")) / 2, 2),
    "a_b": lambda lines: 2 * lines.fit(lines.struck[..., 0], 2, 2, 10.0)[2],
    "theta_max": Lines.highest,
    "v_a1x": _puck("puck_a", 1, 0),
    "v_a2x": _puck("puck_a", 2, 0),
    "v_a2y": _puck("puck_a", 2, 1),
    "v_b2x": _puck("puck_b", 2, 0),
    "v_b2y": _puck("puck_b", 2, 1),
}
"""How each number is measured."""


# ---------------------------------------------------------------- what is typed


def typed(value, digits):
    """Round as a person types."""
    return float(f"{value:.{digits}g}") if math.isfinite(value) else value


def numbers_of(desk, values):
    """Return written numbers as the textbook's record."""
    fields = {item.field: values[item.id] for item in desk.book.measured if item.id in values}
    first = next(iter(desk.book.complete({**desk.book.resting(desk.asked), **fields}, desk.key.given)))
    return desk.book.record(first, desk.key.given, desk.key.truth["px_per_m"])


def concluded(desk, numbers):
    """Return every conclusion that is asked for, worked out rightly."""
    return {item.id: value_of(item.formula, numbers) for item in desk.book.concluded if item.id in desk.asked}


def submission_of(desk, values, tracking=None):
    """Return a submission with these numbers in its cells, every unit given."""
    answers = {
        question: Answer(Kind.NUMBER, float(value), f"{value:.15g}", desk.asked[question].unit, "Answers!C6", "name")
        for question, value in values.items()
        if question in desk.asked and math.isfinite(value)
    }
    return Submission("w.xlsx", desk.assignment.id, desk.key.code, answers, tracking or {})


def scales_of(desk, noise_px, count, rng):
    """Return the scales that students find by clicking both ends of the bar."""
    x1, y1, x2, y2 = (desk.key.truth[f"stick_{end}_px"] for end in ("x1", "y1", "x2", "y2"))
    length_px = math.hypot(x2 - x1, y2 - y1)
    clicked = length_px + CLICK_PX * min(1.0, noise_px / 0.02 if noise_px else 0) * rng.standard_normal(count)
    return desk.key.truth["px_per_m"] * clicked / length_px
