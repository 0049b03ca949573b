"""Hold every assignment of the catalogue to what it promises: variants can be drawn, filmed and measured.

    python benchmarks/catalogue.py [--draws 200] [--released 3] [ASSIGNMENT ...]

Draws are counted for so many students of a fixed secret; of some of them the video is really rendered, decoded,
tracked and solved, and what was measured is compared with the truth, as a part of the student's tolerance.
"""

from __future__ import annotations

import argparse
import statistics

from assignments.load import assignment_ids, load_assignment
from assignments.release import Order, release
from assignments.variants import draw_variant

SECRET = bytes(range(32))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("assignments", nargs="*", default=assignment_ids())
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--released", type=int, default=3)
    wanted = parser.parse_args()
    print("| assignment | draws accepted | redraws, mean | most | refused when filmed | error / tolerance, largest |")
    print("|---|---:|---:|---:|---:|---|")
    for name in wanted.assignments:
        assignment = load_assignment(name)
        redraws = [draw_variant(assignment, SECRET, f"s{k}").redraws for k in range(wanted.draws)]
        refused, shares = measured(assignment, wanted.released)
        accepted = len(redraws) / (len(redraws) + sum(redraws))
        said = ", ".join(f"{symbol} {max(found):.2f}" for symbol, found in shares.items())
        print(
            f"| {name} | {accepted:.0%} | {statistics.fmean(redraws):.1f} | {max(redraws)} | "
            f"{len(refused)} of {wanted.released + len(refused)} | {said} |",
            flush=True,
        )
        for reason in refused:
            print(f"<!-- {name}: {reason} -->")


def measured(assignment, count):
    """Return why variants were refused, and the error of each number that the solver gives, in tolerances."""
    refused, shares = [], {}
    for number in range(count):
        made = release(Order(assignment, SECRET, f"s{number}"))
        refused += made.refused
        for question in assignment.questions:
            if question.id in made.key.measured:
                allowed = max(question.tolerance * abs(made.key.values[question.id]), question.floor)
                off = abs(made.key.measured[question.id] - made.key.values[question.id])
                shares.setdefault(question.id, []).append(off / allowed)
    return refused, shares


if __name__ == "__main__":
    main()
