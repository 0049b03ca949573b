"""A body about a fixed axis and a ball: a kick, a bat, a door (Beer & Johnston, *Dynamics*, "Eccentric impact").

I (omega1 - omega2) = m L (u2 - u1),   e = (u2 - v2) / (v1 - u1),   v = omega L
"""

from __future__ import annotations

from assignments.mistakes import MISTAKES, ImpactNumbers
from assignments.pinned_body import CONCLUDED, FACTS, MEASURED, is_possible, told, ways
from assignments.theory import Mistake, Textbook

# The tracked mark and the contact have different arms: of a door that a ball hits.
_MARK = (
    Mistake(
        "E26",
        "e",
        "speed of the tracked mark instead of that of the point that is hit",
        lambda n: (n.u2 - n.v2 * n.mark / n.L) / (n.v1 * n.mark / n.L - n.u1),
        "It looks as if the speed of the mark at distance L was used. The ball meets the body at the distance {arm}.",
    ),
    Mistake(
        "I31",
        "I",
        "distance of the tracked mark instead of the arm of the contact",
        lambda n: n.I * n.mark / n.L,
        "The arm looks like L, the distance of the mark. The impulse acts at the distance {arm} from the {pivot}.",
    ),
)

TEXTBOOK = Textbook(
    model="fixed-pivot",
    numbers=ImpactNumbers,
    measured=MEASURED,
    concluded=CONCLUDED,
    mistakes={**MISTAKES, **{mistake.code: mistake for mistake in _MARK}},
    is_possible=is_possible,
    told=told,
    ways=ways,
    facts=FACTS,
)
