"""Medians of rounds that take turns, so that a busy machine slows all alike."""

from __future__ import annotations

import time
from dataclasses import dataclass
from statistics import median


@dataclass(frozen=True)
class Cost:
    """Seconds of one call: on the wall, and of all processors."""

    wall_s: float
    cpu_s: float


def cost_of(function) -> Cost:
    """Measure one call."""
    wall, cpu = time.perf_counter(), time.process_time()
    function()
    return Cost(time.perf_counter() - wall, time.process_time() - cpu)


def in_turns(functions: dict, rounds: int) -> dict[str, list[Cost]]:
    """Call each function once a round, in turn; the first call of each is not counted."""
    for function in functions.values():
        function()
    costs = {name: [] for name in functions}
    for _ in range(rounds):
        for name, function in functions.items():
            costs[name].append(cost_of(function))
    return costs


def middle(costs: list[Cost]) -> Cost:
    """Return the medians."""
    return Cost(median(cost.wall_s for cost in costs), median(cost.cpu_s for cost in costs))


def middle_ratio(costs: list[Cost], yardstick: list[Cost]) -> float:
    """Return the median of wall-time ratios, round by round."""
    return median(a.wall_s / b.wall_s for a, b in zip(costs, yardstick, strict=True))
