"""Are mistakes named, and are right answers left in peace: simulated submissions to every assignment.

    python benchmarks/diagnosis.py [--submissions 6000] [--right 6000] [--variants 40] [--seed 1] [--workers 2]

Every submission comes from a student of its own, who clicks or tracks the points of one of the variants (noise of 1 px
or of 0.02 px in each coordinate), fits the lines of the handout, and types three or four digits. Half of them work with
the numbers that they typed, half with all digits. One mistake is planted: one of the textbook's in a conclusion, or a
slip of unit, scale or rate in the velocities. A mistake that leaves the answer within its tolerance is drawn again,
and counted: nobody can see it.
"""

from __future__ import annotations

import argparse
from collections import Counter

from support.planted import RIGHT_KINDS, Batch, plant
from support.tables import print_right, print_told

from assignments.load import assignment_ids
from vml_course.executors import each_done, open_executor


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--submissions", type=int, default=6000)
    parser.add_argument("--right", type=int, default=6000)
    parser.add_argument("--variants", type=int, default=40, help="of each assignment")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--mistakes", action="store_true", help="Print each mistake that is not always told alone.")
    wanted = parser.parse_args()
    names = assignment_ids()
    batches = [
        Batch(name, variant, wanted.seed, _share(wanted.submissions, wanted, k), _share(wanted.right, wanted, k))
        for k, (variant, name) in enumerate((variant, name) for variant in range(wanted.variants) for name in names)
    ]
    told: Counter = Counter()
    with open_executor(wanted.workers) as executor:
        for _, future in each_done(executor, plant, batches):
            told += future.result()
    print_told(told, names, each=wanted.mistakes)
    print_right(told, names, RIGHT_KINDS)


def _share(total: int, wanted: argparse.Namespace, k: int) -> int:
    """Return how many submissions the k-th variant has, so that all add up."""
    variants = wanted.variants * len(assignment_ids())
    return total * (k + 1) // variants - total * k // variants


if __name__ == "__main__":
    main()
