"""How often honest students come under suspicion, and how many copies are found: whole classes, simulated.

    python benchmarks/integrity.py [--classes 12] [--students 300] [--files 60] [--assignment NAME] [--workers 2]

Each student has a variant of their own, and every ten classes have others; half of the tables are tracked (noise of
0.02 px in each coordinate), half clicked by hand (1 px). An honest class holds no copy. A copied class holds for each
kind of copy some students who hand in a table that was made of a classmate's. The last line tells what comparing one
class costs.

Signs that lie in the files need no simulated classes: workbooks are really written, filled by different students, in
part saved by LibreOffice where that is installed, and read back. None may have links to another workbook, another
student's code, or another one's content.
"""

from __future__ import annotations

import argparse
import hashlib
import shutil
import subprocess
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from support.students import desk_of, scales_of, submission_of, table, tables_of

from assignments.load import load_assignment
from assignments.variants import draw_variant, given_values
from assignments.workbook import fill_workbook, write_workbook
from grader.integrity import LINKS, HandedIn, compare
from grader.read import ReadRequest, read_workbook
from grader.read.locate import claims_of, find_submission
from vml_course.executors import each_done, open_executor

COPIES = 5  # of each kind, in a copied class


@dataclass(frozen=True)
class Order:
    """One class."""

    assignment: str
    students: int
    seed: int
    is_copied: bool = False


def secret_of(seed):
    """Return the secret that variants are drawn with: drawing them costs most, so that ten classes have the same."""
    return hashlib.sha256(f"course {seed // 10}".encode()).digest()


@lru_cache(maxsize=1)
def desks(name, students, secret):
    assignment = load_assignment(name)
    return [desk_of(assignment, secret, f"s{k}") for k in range(students)]


def handed_in(desk, pid, columns):
    return HandedIn(pid, submission_of(desk, {}, columns), desk.key)


def own_table(desk, rng):
    noise_px = float(rng.choice((0.02, 1.0)))
    (xy_px,) = tables_of(desk, noise_px, 1, rng)
    (px_per_m,) = scales_of(desk, noise_px, 1, rng)
    columns = table(desk, xy_px, px_per_m)
    return {name: np.round(column, 4 if noise_px == 1.0 else 6) for name, column in columns.items()}


def changed(columns, rng, jitter_px=0.0, scale=1.0, shift=0.0, lag=0):
    """Return a copy that somebody tried to make their own."""
    made = {}
    for name, column in columns.items():
        is_place = name.endswith("_m")
        noise = jitter_px / 500 * rng.standard_normal(len(column)) if is_place else 0.0
        made[name] = scale * column + shift + noise if is_place else column + (lag if name == "frame" else 0)
    return made


KINDS = {
    "as it is": {},
    "jitter 0.1 px": {"jitter_px": 0.1},
    "jitter 0.5 px": {"jitter_px": 0.5},
    "jitter 1 px": {"jitter_px": 1.0},
    "another scale and origin": {"scale": 1.07, "shift": 0.35},
    "frames counted from 5": {"lag": 5},
    "all of it": {"jitter_px": 0.5, "scale": 0.96, "shift": -0.2, "lag": 3},
}


def run(order):
    """Return what was found in one class: (kind of copy or "", method) by number, and the processor's seconds."""
    rng = np.random.default_rng([order.seed, order.is_copied])
    all_desks = desks(order.assignment, order.students, secret_of(order.seed))
    tables = [own_table(desk, rng) for desk in all_desks]
    kind_of = {}
    if order.is_copied:
        for number, (kind, how) in enumerate((kind, how) for kind, how in KINDS.items() for _ in range(COPIES)):
            copier, giver = 2 * number, 2 * number + 1
            tables[copier] = changed(tables[giver], rng, **how)
            kind_of[f"s{copier}"] = (kind, f"s{giver}")
    handed = [
        handed_in(desk, f"s{k}", columns) for k, (desk, columns) in enumerate(zip(all_desks, tables, strict=True))
    ]
    began = time.process_time()
    found = compare(handed)
    cpu_s = time.process_time() - began
    told = Counter()
    for item in found:
        copied = next((kind_of[p] for p in (item.pid, item.other) if p in kind_of), ("", ""))
        is_pair = {item.pid, item.other} >= {copied[1]} and copied[0]
        told[copied[0] if is_pair else "", item.method] += 1
    return told, cpu_s


def files_of(name, students, seed, folder):
    """Write and fill the workbooks of some honest students; return their codes, in the order of the files."""
    assignment, rng, codes = load_assignment(name), np.random.default_rng(9), []
    for number, desk in enumerate(desks(name, students, secret_of(seed))):
        variant = draw_variant(assignment, secret_of(seed), f"s{number}")
        empty, filled = folder / "empty.xlsx", folder / f"{number:04}.xlsx"
        write_workbook(empty, assignment, variant, given_values(assignment, variant))
        columns = {name: column.tolist() for name, column in own_table(desk, rng).items()}
        answers = {name: float(f"{value:.4g}") for name, value in desk.key.values.items()}
        fill_workbook(empty, filled, answers, {q.id: q.unit for q in assignment.questions if q.unit}, columns)
        empty.unlink()
        codes.append(variant.code)
    return codes


def saved_by_libreoffice(folder):
    """Save every other workbook once more with another program, in its place; return how many."""
    program, chosen = shutil.which("soffice"), sorted(folder.glob("*.xlsx"))[::2]
    if program is None:
        return 0
    command = [program, f"-env:UserInstallation={(folder / 'home').as_uri()}", "--headless", "--convert-to", "xlsx"]
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([*command, "--outdir", out, *map(str, chosen)], check=True, capture_output=True)
        return len([shutil.move(path, folder / path.name) for path in Path(out).glob("*.xlsx")])


def print_files(name, students, seed):
    """Print how many honest workbooks have a sign that lies in the file."""
    assignment = load_assignment(name)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        codes, resaved = files_of(name, students, seed, folder), saved_by_libreoffice(folder)
        books = [read_workbook(ReadRequest(path.name, path.read_bytes())) for path in sorted(folder.glob("*.xlsx"))]
    handed = [find_submission(book, assignment.questions) for book in books]
    linked = sum(bool(set(one.flags) & set(LINKS)) for one in handed)
    strangers = sum(claims_of(book).code != code for book, code in zip(books, codes, strict=True))
    twins = sum(len(handed) - len({hash_of(one) for one in handed}) for hash_of in HASHES)
    print(
        f"\n{len(handed)} honest workbooks as files, {resaved} saved by LibreOffice: {linked} with links to another",
        end="",
    )
    print(f" workbook, {strangers} with another student's code, {twins} equal to another one.")


HASHES = (lambda one: one.file_sha256, lambda one: one.content_sha256)


def print_copied(order):
    """Print how many copies are found, and by which sign; return what comparing cost."""
    told, cpu_s = run(order)
    methods = ("other-video", "same-noise", "same-cells")
    print("\n| copy | copies | " + " | ".join(methods) + " |")
    print("|---|---:|" + "---:|" * len(methods))
    for kind in KINDS:
        print(f"| {kind} | {COPIES} | " + " | ".join(str(told[kind, method]) for method in methods) + " |")
    print("| honest ones beside them | | " + " | ".join(str(told["", method]) for method in methods) + " |")
    return cpu_s


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--classes", type=int, default=12)
    parser.add_argument("--students", type=int, default=300)
    parser.add_argument("--assignment", default="swinging-door")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--files", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0)
    wanted = parser.parse_args()
    least = 2 * COPIES * len(KINDS)
    if wanted.students < least:
        parser.error(f"--students: at least {least}, so that every copier has a classmate to copy from")
    honest = [Order(wanted.assignment, wanted.students, wanted.seed + k) for k in range(wanted.classes)]
    suspected, spoilt, seconds = Counter(), 0, []
    with open_executor(wanted.workers) as executor:
        for _, future in each_done(executor, run, honest):
            told, cpu_s = future.result()
            suspected += told
            spoilt += bool(told)
            seconds.append(cpu_s)
    pairs = wanted.classes * wanted.students * (wanted.students - 1) // 2
    print(
        f"{wanted.classes} honest classes of {wanted.students}, {pairs:.2g} pairs: {spoilt} with a suspicion", end=" "
    )
    limit = min(1.0, 3 / wanted.classes)  # the rule of three
    print(f"({dict(suspected)}). Where there was none, 95 % sure: in fewer than {limit:.1%} of classes.")
    if wanted.files:
        print_files(wanted.assignment, wanted.files, wanted.seed)
    cpu_s = print_copied(Order(wanted.assignment, wanted.students, wanted.seed, is_copied=True))
    print(
        f"\nComparing {wanted.students} tables: {np.median(seconds):.1f} s of one processor, with copies {cpu_s:.1f} s."
    )


if __name__ == "__main__":
    main()
