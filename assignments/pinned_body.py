"""What the textbooks of bodies on a pivot share: what is measured, how one number stands for another.

`v_f` is the tracked mark's speed, `v_c` that of the point of the contact, where the two are apart.

Signs: angular velocities counter-clockwise; speeds of the striking point along its path and of the struck body along
the contact normal, positive from the striker to the struck body.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from assignments.mistakes import ImpactNumbers
from assignments.theory import Concluded, Measured, Met, Values, along


def _arm(given: Values) -> float:
    """Return the arm of the contact about the axis: `a` where the tracked mark is elsewhere, as at a door."""
    return given.get("a", given.get("L", math.nan))


def _struck(met: Met, velocity_m_s: object) -> float:
    return along(velocity_m_s, met.impact.normal)


MEASURED = (
    Measured("omega1", "omega1", lambda met: met.impact.omega_before_rad_s, may_rest=True),
    Measured("omega2", "omega2", lambda met: met.impact.omega_after_rad_s),
    Measured("v_f1", "v1", lambda met: met.impact.omega_before_rad_s * met.given["L"], may_rest=True),
    Measured("v_f2", "v2", lambda met: met.impact.omega_after_rad_s * met.given["L"]),
    Measured(
        "v_c1",
        "v1",
        lambda met: met.impact.omega_before_rad_s * _arm(met.given),
        may_rest=True,
        symbol="omega1",
        factor=_arm,
    ),
    Measured("v_c2", "v2", lambda met: met.impact.omega_after_rad_s * _arm(met.given), symbol="omega2", factor=_arm),
    Measured("v_b1", "u1", lambda met: _struck(met, met.impact.struck_before_m_s), may_rest=True),
    Measured("v_b2", "u2", lambda met: _struck(met, met.impact.struck_after_m_s)),
)

CONCLUDED = (
    Concluded("e", "({v_b2} − {v_f2}) / ({v_f1} − {v_b1})", lambda n: n.e, lambda met: met.impact.restitution),
    Concluded(
        "I",
        "{m} · {arm} · ({v_b2} − {v_b1}) / ({omega1} − {omega2})",
        lambda n: n.I,
        lambda met: met.impact.inertia_kg_m2,
    ),
)

FACTS = {"tilt_rad": lambda met: math.radians(met.parameters.get("normal_tilt_deg", 0.0))}


def told(given: Values) -> Mapping[str, float]:
    """Return what the given numbers are in the formulas; the arm of the formulas is that of the contact."""
    mark = given.get("L", math.nan) if "a" in given else math.nan
    nothing = math.nan
    return {"m": given.get("m", nothing), "L": _arm(given), "D": given.get("D", nothing), "mark": mark}


def ways(values: Values, told: Values) -> Iterator[Values]:
    """Yield the numbers as they stand, then with v = omega L in place of either."""
    if not {"u1", "u2"} <= values.keys():
        return
    has_speed, has_rate = {"v1", "v2"} <= values.keys(), {"omega1", "omega2"} <= values.keys()
    if has_speed and has_rate:
        yield dict(values)
    if has_rate:
        yield {**values, "v1": values["omega1"] * told["L"], "v2": values["omega2"] * told["L"]}
    if has_speed:
        yield {**values, "omega1": values["v1"] / told["L"], "omega2": values["v2"] / told["L"]}


def has_moved(n: ImpactNumbers) -> bool:
    """Tell whether both bodies changed their velocities."""
    return abs(n.omega1 - n.omega2) > 0.01 * abs(n.omega1) and n.u1 != n.u2 and n.v1 != n.v2


def is_possible(n: ImpactNumbers) -> bool:
    """Tell whether both bodies changed their velocities, and e is what it can be."""
    return has_moved(n) and n.v1 != n.u1 and 0 < n.e <= 1.2
