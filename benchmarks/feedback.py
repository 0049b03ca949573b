"""What grading and feedback cost a student, in CPU seconds, on one sample submission.

    python benchmarks/feedback.py [--assignment soccer-kick] [--repeats 30] [--students 500]

The variant is released as for a student: simulated, rendered, tracked, solved, with the picture of the impact cut from
its own video and kept. Courses that were handed out before pictures were kept decode each video once, which is told
beside it. The workbook is filled with right answers but for e, which is turned over, and with the true trajectory.
CPU seconds of this process. Reading happens in a process of its own: what it costs there is measured here, and what
handing the file over and the cells back costs here is added.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

from assignments.impact_frame import KEPT, keep_frame
from assignments.load import load_assignment
from assignments.release import WORKBOOK, Order, release
from assignments.words import tracking_columns
from assignments.workbook import fill_workbook
from grader.annotated import annotated_workbook
from grader.class_page import class_page
from grader.feedback import Report, feedback_page
from grader.frame import impact_frame
from grader.grade import grade
from grader.gradebook import Row, Student
from grader.items import evidence_of
from grader.read import ReadRequest, read_isolated, read_workbook
from grader.read.locate import find_submission
from vml_course.io.shelf import FolderShelf

SECRET = bytes(range(32))
BUDGET_S, PAGE_S, PAGE_BYTES = 0.25, 0.010, 60_000


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--assignment", default="soccer-kick")
    parser.add_argument("--repeats", type=int, default=30)
    parser.add_argument("--students", type=int, default=500)
    wanted = parser.parse_args()
    assignment = load_assignment(wanted.assignment)
    made = release(Order(assignment, SECRET, "pupil001"))
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        shelf, request = hand_out(folder, made), ReadRequest("w.xlsx", filled(folder, made, assignment))
        costs = measured(shelf, request, made.key, assignment, wanted.repeats)
    say(costs, wanted.students)
    class_costs(costs["report"], wanted.students)


def hand_out(folder, made):
    home = folder / "handouts" / made.key.assignment_id / made.key.student
    home.mkdir(parents=True)
    for name, data in made.files.items():
        (home / name).write_bytes(data)
    shelf = FolderShelf(folder)
    keep_frame(shelf, made.key, made.impact)
    return shelf


def filled(folder, made, assignment):
    """Return a workbook with the true numbers, e turned over, and the true trajectory."""
    key, source, target = made.key, folder / "empty.xlsx", folder / "filled.xlsx"
    source.write_bytes(made.files[WORKBOOK])
    answers = {q.id: float(f"{key.values[q.id]:.4g}") for q in assignment.questions}
    if answers.get("e"):
        answers["e"] = round(1 / answers["e"], 3)
    names = [name for name in assignment.points if name in key.points]
    columns = [key.frame.tolist(), key.time_s.tolist()]
    for name in names:
        xy_m = key.xy_px[:, key.points.index(name)] * [1, -1] / key.truth["px_per_m"]
        columns += xy_m.T.tolist()
    table = dict(zip(tracking_columns(names), columns, strict=True))
    fill_workbook(source, target, answers, {q.id: q.unit for q in assignment.questions}, table)
    return target.read_bytes()


def measured(shelf, request, key, assignment, repeats):
    """Return CPU seconds of each step, the least of three rounds, and what was made."""
    book = read_workbook(request)
    submission = find_submission(book, assignment.questions)
    result = grade(submission, key, assignment)
    decoded = cpu_s(lambda: forgotten(shelf, key), 3)
    report = Report(assignment, submission, key, result, frame=impact_frame(shelf, key))
    return {
        "report": report,
        "bytes": len(feedback_page(report).encode()),
        "copy_bytes": len(annotated_workbook(report, book)),
        "read": cpu_s(lambda: read_workbook(request), repeats),
        "hand over": cpu_s(lambda: read_isolated(request), repeats),
        "grade": cpu_s(lambda: grade(find_submission(book, assignment.questions), key, assignment), repeats),
        "frame decoded": decoded,
        "frame kept": cpu_s(lambda: impact_frame(shelf, key), repeats),
        "page": cpu_s(lambda: feedback_page(report), repeats),
        "copy": cpu_s(lambda: annotated_workbook(report, book), repeats),
    }


def forgotten(shelf, key):
    """Ask for the picture where none was kept; it is kept then."""
    (shelf.folder / KEPT / key.assignment_id / f"{key.student}.json").unlink()
    assert impact_frame(shelf, key) is not None


def cpu_s(job, repeats):
    """Return the CPU seconds of one call: the least mean of three rounds."""
    job()
    return min(_round(job, max(1, repeats // 3)) for _ in range(3))


def _round(job, times):
    start = time.process_time()
    for _ in range(times):
        job()
    return (time.process_time() - start) / times


def say(costs, students):
    print("| step | CPU ms a student |")
    print("|---|---:|")
    for name in ("read", "hand over", "grade", "frame decoded", "frame kept", "page", "copy"):
        print(f"| {name} | {1000 * costs[name]:.1f} |")
    usual = sum(costs[name] for name in ("read", "hand over", "grade", "frame kept", "page", "copy"))
    first = usual - costs["frame kept"] + costs["frame decoded"]
    print(f"\ngrading + feedback: {usual:.3f} CPU-s, the first time too ({BUDGET_S})")
    print(f"where no frame was kept at hand-out: {first:.3f} the first time")
    print(f"page: {costs['page'] * 1000:.1f} ms ({PAGE_S * 1000:g}), {costs['bytes']} bytes ({PAGE_BYTES})")
    print(f"copy of the workbook: {costs['copy_bytes']} bytes")
    print(f"{students} students: {students * usual:.0f} CPU-s")


def class_costs(report, students):
    """Print what the instructor's page of so many students costs."""
    rows, evidence = [], {}
    for number in range(students):
        pid, result = f"pid{number:04}", report.grade
        outcomes = {q.id: f.outcome for q in report.assignment.questions for f in result.of(q.id)}
        rows.append(
            Row(Student(pid), report.assignment.id, 1, result.points, result.out_of, "ok", "", outcomes, earned=1.0)
        )
        evidence[pid] = evidence_of(result.findings, report.key)
    page = class_page(report.assignment, rows, (), (), evidence)
    cost = cpu_s(lambda: class_page(report.assignment, rows, (), (), evidence), 3)
    print(f"class page of {students}: {cost:.2f} CPU-s, {len(page.encode()) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
