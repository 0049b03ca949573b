"""The plan as a picture: how sharply each variant can be measured, conclusion by conclusion."""

from __future__ import annotations

from assignments.plan import Plan, Sharpness
from vml_course.chart.axes import Scale, label, nice_ticks
from vml_course.chart.shapes import BLUE, GREY, INK, PALE, RED, Dot, Drawing, Line, Shape, Words

WIDTH, LEFT, RIGHT, TOP, PANEL, GAP, BOTTOM = 640.0, 62.0, 20.0, 40.0, 150.0, 46.0, 34.0


def draw_plan(plan: Plan) -> Drawing:
    """Return one panel for each conclusion: predicted standard deviation over the true value's place in the class.

    Variants are in the order of the list. Above the red line they are drawn again.
    """
    shapes: list[Shape] = [Words((LEFT, 22), f"Predicted precision: {plan.assignment_id}", 15, is_bold=True)]
    for number, sharp in enumerate(plan.sharpness):
        shapes += _panel(sharp, TOP + number * (PANEL + GAP))
    height = TOP + len(plan.sharpness) * (PANEL + GAP) + BOTTOM
    shapes.append(Words((LEFT, height - 14), _caption(plan), 12, GREY))
    lines = [f"{s.symbol}: {s.quartiles[0]:.1%} to {s.quartiles[4]:.1%} of what is allowed" for s in plan.sharpness]
    return Drawing(WIDTH, height, tuple(shapes), f"Predicted precision of {plan.assignment_id}", "; ".join(lines))


def _caption(plan: Plan) -> str:
    return f"{len(plan.looked_at)} variants of a class of {plan.students}, in the order of the class list"


def _panel(sharp: Sharpness, top: float) -> list[Shape]:
    shares, bottom = list(sharp.sd.values()), top + 20 + PANEL - 20
    ticks = nice_ticks(0.0, 100 * max(*shares, sharp.limit), 4)
    across = Scale(0.0, max(1.0, len(shares) - 1.0), LEFT + 8, WIDTH - RIGHT - 8)
    up = Scale(ticks[0], ticks[-1], bottom, top + 20)
    words = f"sd of {sharp.symbol}, % of what is allowed for full credit"
    shapes: list[Shape] = [Words((LEFT, top + 12), words, 12)]
    for tick in ticks:
        shapes.append(Line(((LEFT, up(tick)), (WIDTH - RIGHT, up(tick))), PALE))
        shapes.append(Words((LEFT - 8, up(tick) + 4), label(tick), 11, INK, "end"))
    limit = up(100 * sharp.limit)
    shapes.append(Line(((LEFT, limit), (WIDTH - RIGHT, limit)), RED, 1.5, (6.0, 4.0)))
    shapes.append(Words((WIDTH - RIGHT, limit - 5), "drawn again above", 11, RED, "end"))
    shapes += [Dot((across(n), up(100 * share)), 3.0, BLUE) for n, share in enumerate(shares)]
    return shapes
