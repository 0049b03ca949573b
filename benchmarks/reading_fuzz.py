"""Broken workbooks, thousands of them: what they end as, and the slowest one.

    python benchmarks/reading_fuzz.py [--mutants 10000] [--seed 0]

Mutants of the course's own workbook and of a dialect with everything in it: bytes, headers, cuts, markup, parts. Ends
with 1 when an error came through that is no polite sentence, or when one mutant kept the processor busy for a second.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from pathlib import Path

from assignments.load import load_assignment
from grader.read import ReadRequest, UnreadableError, read_workbook
from grader.read.locate import find_submission

sys.path.insert(0, str(Path(__file__).parents[1] / "tests/grader/read"))
import corpus
import mutants
import reading

BUSY_S = 1.0


def sources() -> list[bytes]:
    with tempfile.TemporaryDirectory() as folder:
        own = reading.ours(Path(folder))
    table = [["frame", "t_s", "ball_x_m", "ball_y_m"], *([i, i / 480, ("A1", 0.1), 0.2] for i in range(40))]
    meta = [["assignment", "soccer-kick"], ["variant_code", "CODE1"]]
    names = {"ans_e": "Answers!$B$1", "unit_I": "Answers!$C$2"}
    rows = [["e", 0.7], ["I", "1,9", "kg m^2"], ["v_f1", True]]
    return [
        own,
        *(
            make().write({"Answers": rows, "Tracking": table, "_meta": meta}, names)
            for make in corpus.DIALECTS.values()
        ),
    ]


def main(count: int, seed: int) -> int:
    assignment = load_assignment("soccer-kick")
    files = sources()
    ends: Counter[str] = Counter()
    slowest, failed = 0.0, 0
    for number, good in enumerate(files):
        share = count // 2 if number == 0 else -(-count // 2 // (len(files) - 1))
        for data in mutants.mutants(good, share, seed + number):
            before = time.process_time()
            try:
                book = read_workbook(ReadRequest("w.xlsx", data))
                find_submission(book, assignment.questions, {}, assignment.points)
                ends["read as a submission"] += 1
            except UnreadableError as error:
                ends[re.sub(r"[0-9.]+", "N", str(error.got))] += 1
            except Exception:  # noqa: BLE001 - what must not happen
                failed += 1
                traceback.print_exc()
            slowest = max(slowest, time.process_time() - before)
    for what, times in ends.most_common():
        print(f"{times:7}  {what}")
    print(
        f"{sum(ends.values()) + failed} mutants, {failed} uncaught errors, slowest {slowest * 1000:.0f} ms of processor"
    )
    return int(failed > 0 or slowest > BUSY_S)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mutants", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    warnings.filterwarnings("ignore", message="Duplicate name")
    sys.exit(main(options.mutants, options.seed))
