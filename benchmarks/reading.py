"""What reading workbooks costs, isolation included, and how soon hostile files are refused.

    python benchmarks/reading.py [--files 100] [--hostile]

Seconds are those of the processor (this process and the reading one), not of the clock. A machine that does other
things too counts them higher; the row of openpyxl's lean mode, measured in turns with ours, shows by how much: on an
idle machine it needs 0.057 s for such a file. Typical: 600 rows by 12 columns of tracking, 2 400 formulas.
"""

from __future__ import annotations

import argparse
import io
import random
import resource
import statistics
import sys
import tempfile
import time
import warnings
from pathlib import Path

import openpyxl

from assignments.load import load_assignment
from assignments.model import Variant
from assignments.workbook import fill_workbook, write_workbook
from grader.read import Reader, ReadRequest, UnreadableError, read_workbook

sys.path.insert(0, str(Path(__file__).parents[1] / "tests/grader/read"))
import corpus

TARGET_FILES_PER_S, TARGET_REFUSAL_S = 10.0, 0.050
IDLE_OPENPYXL_S = 0.057
COLUMNS = [f"{point}_{axis}_m" for point in ("foot", "knee", "ball") for axis in "xy"]


def typical(seed: int) -> bytes:
    """A workbook as students hand it in: answers, 600 rows of positions, formulas with their values."""
    rng = random.Random(seed)  # noqa: S311 - no secret
    header = ["frame", "t_s", *COLUMNS, "vx", "vy", "v", "ax"]
    rows = [
        [i, i / 480, *(rng.gauss(0, 1) for _ in COLUMNS)]
        + [(f"(C{i + 3}-C{i + 2})*480/2+0*D{i + 2}", rng.gauss(0, 9)) for _ in range(4)]
        for i in range(600)
    ]
    answers = [[f"Quantity {i}", f"q{i}", rng.gauss(0, 9), "m/s"] for i in range(12)]
    meta = [["assignment", "soccer-kick"], ["variant_code", f"CODE{seed}"]]
    dialect = corpus.Dialect()
    dialect.dimension = ""
    return dialect.write({"README": [["hello"]], "Tracking": [header, *rows], "Answers": answers, "_meta": meta})


def ours(folder: Path) -> bytes:
    """The course's own workbook, filled, small."""
    assignment = load_assignment("soccer-kick")
    variant = Variant("soccer-kick", "pupil", "CODE1", {}, {}, {}, 1, 0, "1")
    write_workbook(folder / "a.xlsx", assignment, variant, {given.id: 1.0 for given in assignment.givens})
    table = {name: [0.001 * i for i in range(60)] for name in ("frame", "t_s", *COLUMNS)}
    fill_workbook(folder / "a.xlsx", folder / "b.xlsx", {}, {}, table)
    return (folder / "b.xlsx").read_bytes()


def children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def cpu_s(call) -> float:
    before = time.process_time()
    call()
    return time.process_time() - before


def lean_openpyxl(data: bytes) -> None:
    book = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
    for sheet in book.worksheets:
        for _ in sheet.iter_rows():
            pass


def speed(count: int) -> None:
    files = [typical(seed) for seed in range(count)]
    peers = files[: max(count // 8, 1)]
    other = [cpu_s(lambda data=data: lean_openpyxl(data)) for data in peers]
    plain = [cpu_s(lambda data=data: read_workbook(ReadRequest("w.xlsx", data))) for data in files]
    before = children_s()
    with Reader() as reader:
        parent = sum(cpu_s(lambda data=data: reader.read(ReadRequest("w.xlsx", data))) for data in files)
    whole = (parent + children_s() - before) / count
    other += [cpu_s(lambda data=data: lean_openpyxl(data)) for data in peers]
    peer = statistics.median(other)
    print(f"{count} typical workbooks of {statistics.mean(map(len, files)) / 1000:.0f} kB, processor seconds a file")
    here = statistics.median(plain)
    print(f"  in this process        {here:.4f}   = {here / peer:.2f} of openpyxl's")
    print(f"  isolated, all counted  {whole:.4f}   = {whole / peer:.2f} of openpyxl's")
    print(f"                                  = {1 / whole:.1f} a second (target {TARGET_FILES_PER_S:g})")
    print(f"  openpyxl, lean         {peer:.4f}   = {IDLE_OPENPYXL_S / peer:.2f} of idle speed")
    at_idle = whole * IDLE_OPENPYXL_S / peer
    print(f"  at idle speed          {at_idle:.4f}   = {1 / at_idle:.1f} a second")


def refusals(good: bytes) -> None:
    print(f"hostile files: processor seconds until refused (target {TARGET_REFUSAL_S:g}), best of 5")
    for name, (make, _) in corpus.HOSTILE.items():
        data = make(good)
        best = min(cpu_s(lambda data=data: refuse(data)) for _ in range(5))
        print(f"  {best:.4f} {'ok  ' if best < TARGET_REFUSAL_S else 'SLOW'} {len(data) / 1e6:6.2f} MB  {name}")


def refuse(data: bytes) -> None:
    try:
        read_workbook(ReadRequest("w.xlsx", data))
    except UnreadableError:
        return
    raise AssertionError("a hostile file was read")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--files", type=int, default=100)
    parser.add_argument("--hostile", action="store_true", help="hostile files only")
    options = parser.parse_args()
    warnings.filterwarnings("ignore", message="Duplicate name")
    if not options.hostile:
        speed(options.files)
    with tempfile.TemporaryDirectory() as folder:
        refusals(ours(Path(folder)))
