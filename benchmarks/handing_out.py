"""What handing out costs: students a minute with 1 and 2 workers, memory, where time goes, what big classes take.

    python benchmarks/handing_out.py            # about 3 minutes
    python benchmarks/handing_out.py --long     # whether 200 students cost 20 times what 10 do, about 5 minutes

Rates begin when every worker has handed in its first student: starting Python and loading compiled kernels is told
apart. Runs with 1 and with 2 workers take turns. Seconds of processor time are those of all threads of a worker. On a
machine that does other work, too, the wall says little: the speed-up by processor time is what two free cores would
give, where one worker keeps one core busy (its share of a core is printed).
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import tempfile
import time
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import assignments.usecases
from assignments.costs import STAGES, cost_of
from assignments.course import new_course
from assignments.fairness import fair_variant, predict
from assignments.film import foresee, scene_of
from assignments.load import load_assignment
from assignments.release import Order, release
from grader.handing_out import hand_out_to
from vml_course.executors import each_done, open_executor
from vml_course.io.video import write_video
from vml_course.model.recording import Recording
from vml_course.synth.render import render

SECRET = bytes(range(32))
CORES, CLASSES = (2, 32, 320), (1_000, 10_000)
MEBIBYTE = 1024  # of the system's kibibytes


@dataclass(frozen=True)
class Weighed:
    """What one order cost a worker, and how large the worker has become."""

    release: object
    process: int
    peak_mb: float
    wall_s: float


def weigh(order):
    """Do an order, and look at this process."""
    start = time.perf_counter()
    made = release(order)
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / MEBIBYTE
    return Weighed(made, os.getpid(), peak_mb, time.perf_counter() - start)


def orders(assignment, count):
    return [Order(assignment, SECRET, f"s{n:04}") for n in range(count)]


@dataclass(frozen=True)
class Pace:
    """Students a minute once all workers work, the seconds before that, and what was made."""

    per_minute: float
    start_s: float
    weighed: list

    @property
    def cpu_s(self):
        """Processor seconds of a student, median."""
        return statistics.median(cost_of(item.release).cpu_s_each for item in self.weighed)

    @property
    def share(self):
        """Cores that a worker kept busy while it worked, median."""
        return statistics.median(cost_of(item.release).cpu_s_each / item.wall_s for item in self.weighed)


def pace(assignment, count, workers, cluster=""):
    """Make so many students' files; whatever the workers, the same ones."""
    start, stamps, weighed = time.perf_counter(), [], []
    with open_executor(workers, cluster) as executor:
        for _, future in each_done(executor, weigh, orders(assignment, count)):
            stamps.append(time.perf_counter() - start)
            weighed.append(future.result())
    first = workers - 1
    return Pace(60 * (count - workers) / (stamps[-1] - stamps[first]), stamps[first], weighed)


def taking_in(assignment, made, count):
    """Return the processor seconds that this process needs for one student whose files come from elsewhere."""
    with tempfile.TemporaryDirectory() as folder:
        course = new_course(Path(folder) / "c")
        lines = "".join(f"Student {n},s{n}@example.org\n" for n in range(count))
        course.roster.write_text("name,email\n" + lines, encoding="utf-8")

        def given(order):
            code = f"{order.student}{'X' * 12}"
            variant = replace(made.variant, student=order.student, code=code)
            return replace(made, variant=variant, key=replace(made.key, student=order.student, code=code))

        assignments.usecases.release, kept = given, assignments.usecases.release
        try:
            start = time.process_time()
            handed = hand_out_to(course, assignment.id)
            return (time.process_time() - start) / count, len(handed.failed)
        finally:
            assignments.usecases.release = kept


def film_stages(assignment, count):
    """Return the median processor seconds of simulating, drawing, and encoding a video."""
    seconds = {name: [] for name in ("simulate", "render", "encode")}
    for order in orders(assignment, count):
        variant = fair_variant(assignment, order.secret, order.student).variant
        recording = Recording(**variant.recording)
        scene_of(variant)
        clock = time.process_time
        stamps = [clock()]
        truth = replace(foresee(variant), recording=recording)
        stamps.append(clock())
        pictures = list(render(truth, recording))
        stamps.append(clock())
        with tempfile.TemporaryDirectory() as folder:
            film = Path(folder) / f"video.{recording.format}"
            write_video(film, pictures, recording.file_fps or truth.camera.fps, int(recording.crf))
        stamps.append(clock())
        for name, first, last in zip(seconds, stamps, stamps[1:], strict=False):
            seconds[name].append(last - first)
    return {name: statistics.median(values[1:]) for name, values in seconds.items()}


def foreseen(weighed, assignment):
    """Return the relative differences of predicted and measured sd, median and largest, by conclusion."""
    off = {}
    for item in weighed:
        made = item.release
        for symbol, sd in predict(assignment, made.variant).sd.items():
            off.setdefault(symbol, []).append(abs(sd / made.key.expected_sd[symbol] - 1))
    return {symbol: (statistics.median(values), max(values)) for symbol, values in off.items()}


def print_speed(assignment, count, rounds):
    rates = {1: [], 2: []}
    for _ in range(rounds):
        for workers, paces in rates.items():
            found = pace(assignment, count, workers)
            paces.append(found)
            took = f"{found.cpu_s:.2f} s of processor time each, {found.share:.2f} cores a worker"
            start = f"{found.start_s:.1f} s to the first"
            print(f"  {workers} worker(s): {found.per_minute:6.1f} students/min, {took}, {start}", flush=True)
    middle = {workers: statistics.median(one.per_minute for one in found) for workers, found in rates.items()}
    cpu_s = {workers: statistics.median(one.cpu_s for one in found) for workers, found in rates.items()}
    load = f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
    print(
        f"  speed-up with 2 workers: {middle[2] / middle[1]:.2f} on the wall ({load}), "
        f"{2 * cpu_s[1] / cpu_s[2]:.2f} by processor time (asked: 1.8)"
    )
    weighed = rates[2][-1].weighed
    peaks = {item.process: item.peak_mb for item in sorted(weighed, key=lambda item: item.peak_mb)}
    print(f"  peak memory of a worker: {max(peaks.values()):.0f} MiB (asked: at most 600)")
    return rates[1][-1].weighed


def print_stages(assignment, weighed):
    costs = [cost_of(item.release) for item in weighed[1:]]
    print("Where the processor time of one student goes, median, seconds:")
    total = 0.0
    for stage in STAGES:
        seconds = statistics.median(cost.cpu_s[stage] for cost in costs)
        total += seconds
        print(f"  {stage:10}{seconds:6.2f}")
    for stage, seconds in film_stages(assignment, 6).items():
        print(f"    of film: {stage:10}{seconds:6.2f}")
    each = statistics.fmean(cost.cpu_s_each for cost in costs)
    size = statistics.fmean(cost.bytes for cost in costs)
    print(f"  together  {total:6.2f}; mean with rejected variants {each:.2f}; {size / 1e6:.2f} MB a student")
    return each, size


def print_classes(each_s, taking_s, size):
    print("What a class takes (from these figures; the workers' time, or taking in, whichever is longer):")
    print(f"  {'students':>9}{'CPU h':>8}{'GB':>7}" + "".join(f"{f'{cores} cores':>13}" for cores in CORES))
    for students in CLASSES:
        walls = [max(students * each_s / cores, students * taking_s) for cores in CORES]
        cells = "".join(f"{_span(wall):>13}" for wall in walls)
        print(f"  {students:>9}{students * each_s / 3600:>8.2f}{students * 3 * size / 1e9:>7.1f}{cells}")


def _span(seconds):
    return f"{seconds / 60:.1f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def print_growth(assignment, sizes):
    print("Processor seconds a student, by size of the class (2 workers, their start included):")
    for count in sizes:
        found = pace(assignment, count, 2)
        each = statistics.fmean(cost_of(item.release).cpu_s_each for item in found.weighed)
        again = sum(len(item.release.refused) for item in found.weighed)
        print(
            f"  {count:4} students: {each:.2f} s, {found.per_minute:6.1f}/min, {again} drawn again",
            flush=True,
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("assignment", nargs="?", default="soccer-kick")
    parser.add_argument("--students", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--long", action="store_true", help="10 and 200 students instead")
    asked = parser.parse_args()
    assignment = load_assignment(asked.assignment)
    if asked.long:
        print_growth(assignment, (10, 200))
        return
    show = partial(print, flush=True)
    show(f"{asked.assignment}: {asked.students} students")
    weighed = print_speed(assignment, asked.students, asked.rounds)
    each, size = print_stages(assignment, weighed)
    taking, failed = taking_in(assignment, weighed[-1].release, 100)
    assert not failed
    show(f"  taking a student in (key, zip, folder, bundle), in the process that hands out: {taking:.3f} s")
    for symbol, (middle, worst) in foreseen(weighed, assignment).items():
        show(f"Predicted and measured sd of {symbol} differ by {middle:.1%} (median), {worst:.1%} (most)")
    again = [why for item in weighed for why in item.release.refused]
    show(f"Drawn again after they were foreseen or measured: {len(again)} of {len(weighed) + len(again)}")
    print_classes(each, taking, size)


if __name__ == "__main__":
    main()
