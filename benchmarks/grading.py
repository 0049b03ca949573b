"""What grading a class costs: reading in a limited process, judging, gradebook, feedback page. CPU seconds a student.

python benchmarks/grading.py [--students 60] [--assignment soccer-kick] [--workers 1 2]

Nobody is filmed: variants are simulated, tables are the true paths with 0.3 px of noise, as a student's tracker leaves
them; answers are the true ones to four digits. The peer is what openpyxl takes to read the same files twice (values,
and formulas), which is the least that a grader on that library has to do. Starting processes is counted.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import tempfile
import time
from pathlib import Path

import numpy as np
from openpyxl import load_workbook

from assignments.course import new_course, open_course
from assignments.film import foresee
from assignments.key import answer_key
from assignments.load import load_assignment
from assignments.variants import draw_variant, given_values
from assignments.workbook import fill_workbook, write_workbook
from grader.gradebook import Gradebook
from grader.grading import Wanted, grade_files
from grader.read.worker import _shared_reader

NOISE_PX = 0.3


def main() -> None:
    """Make a class, grade it with each number of workers, print what it cost."""
    wanted = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wanted.add_argument("--students", type=int, default=60)
    wanted.add_argument("--assignment", default="soccer-kick")
    wanted.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    asked = wanted.parse_args()
    with tempfile.TemporaryDirectory(prefix="vml-grading-") as place:
        course, files = hand_in(Path(place), asked.assignment, asked.students)
        size = sum(file.stat().st_size for file in files) / len(files)
        print(f"{len(files)} workbooks of {size / 1e3:.0f} kB, {os.cpu_count()} cores")
        start_s = time.process_time()
        for file in files[:20]:
            for computed in (True, False):
                load_workbook(file, data_only=computed)
        peer_s = (time.process_time() - start_s) / min(20, len(files))
        print(f"reading twice with openpyxl: {peer_s:.3f} CPU s a workbook")
        print("| workers | wall s | CPU s a student | of the peer | points |\n|---:|---:|---:|---:|---|")
        for workers in asked.workers:
            again = course.folder.with_name(f"again-{workers}")
            shutil.copytree(course.folder, again)
            graded, wall_s, cpu_s = measured(again, files, workers)
            each_s = cpu_s / len(files)
            points = sorted({f"{one.points:g} of {one.out_of:g}" for one in graded})
            print(f"| {workers} | {wall_s:.1f} | {each_s:.3f} | {each_s / peer_s:.2f} | {', '.join(points[:4])} |")


def measured(folder: Path, files: list[Path], workers: int):
    """Grade in a fresh course; return the result, wall time and processor time with all that was started."""
    course, before, start_s = open_course(folder), _cpu_s(), time.monotonic()
    graded = grade_files(course, files, Wanted(workers=workers))
    _shared_reader(os.getpid()).close()  # so that its time is counted
    return graded, time.monotonic() - start_s, _cpu_s() - before


def _cpu_s() -> float:
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


def hand_in(folder: Path, assignment_id: str, students: int):
    """Make a course whose students have all handed in."""
    course, assignment = new_course(folder / "course"), load_assignment(assignment_id)
    returned, rng = folder / "returned", np.random.default_rng(1)
    returned.mkdir()
    with Gradebook.open(course) as book:
        for number in range(students):
            variant = draw_variant(assignment, course.secret, f"pupil{number:04}")
            truth = foresee(variant)
            key = answer_key(assignment, variant, truth, None, f"{number:064x}")
            book.keep_key(variant, key)
            empty, filled = folder / "empty.xlsx", returned / f"{number:04}.xlsx"
            write_workbook(empty, assignment, variant, given_values(assignment, variant))
            answers = {name: float(f"{value:.4g}") for name, value in key.values.items()}
            units = {question.id: question.unit for question in assignment.questions if question.unit}
            fill_workbook(empty, filled, answers, units, _table(key, assignment.points, rng))
    return course, sorted(returned.iterdir())


def _table(key, points, rng):
    scale = key.truth["px_per_m"]
    columns = {"frame": key.frame.tolist(), "t_s": key.time_s.tolist()}
    for name in points:
        xy_px = key.xy_px[:, key.points.index(name)] + rng.normal(0, NOISE_PX, (len(key.frame), 2))
        x_m = (xy_px[:, 0] - key.truth["origin_x_px"]) / scale
        y_m = (key.truth["origin_y_px"] - xy_px[:, 1]) / scale
        columns |= {f"{name}_x_m": x_m.tolist(), f"{name}_y_m": y_m.tolist()}
    return columns


if __name__ == "__main__":
    main()
