"""The autograder's zip, unpacked into an empty folder that plays /autograder, and run as Gradescope runs it."""

from __future__ import annotations

import json
import os
import re
import shutil
import stat
import subprocess
import sys
import zipfile
from dataclasses import replace
from datetime import UTC, datetime
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from assignments.course import Course, new_course
from assignments.load import load_assignment
from assignments.terms import Calendar, Late, Terms
from assignments.variants import signature_of
from assignments.workbook import fill_workbook, write_workbook
from grader.autograder.attempts import Past, past_attempts, with_this
from grader.autograder.run import Pack, graded
from grader.autograder.truth import from_bytes
from grader.autograder.wheels import NEEDED, distributions, wheels_in
from grader.exports.gradescope import packed_files, write
from grader.filling.job import Job
from grader.gradebook import Gradebook
from grader.roster import Enrolled
from vml_course.errors import FileMissingError

PEOPLE = (("Ana Example", "Ana@Example.org"), ("Ben Example", "ben@example.org"), ("No Address", ""))
TOTAL = load_assignment("soccer-kick").total_points


@pytest.fixture(scope="session")
def autograder_course(tmp_path_factory, kit) -> Course:
    course = new_course(tmp_path_factory.mktemp("gradescope") / "course", "Dynamics")
    with Gradebook.open(course) as book:
        arrivals = book.take_in([Enrolled(name, email) for name, email in PEOPLE])
        for i, arrival in enumerate(arrivals):
            pid, code = arrival.student.pid, f"CODE{i}"
            variant = kit.variant_of(signature_of(course.secret, "soccer-kick", code), code, pid)
            book.keep_key(variant, kit.key_of(kit.impact(e=0.6 + 0.1 * i), code=code, student=pid))
    return course


def job_of(course: Course, **changes) -> Job:
    with Gradebook.open(course) as book:
        return Job(course, load_assignment("soccer-kick"), book.students(), **changes)


def workbook_bytes(course: Course, kit, folder: Path, i: int = 0, signature: str = "", **changes) -> bytes:
    assignment, code = load_assignment("soccer-kick"), f"CODE{i}"
    signature = signature or signature_of(course.secret, "soccer-kick", code)
    empty, filled = folder / "empty.xlsx", folder / "made.xlsx"
    write_workbook(empty, assignment, kit.variant_of(signature, code), {g.id: 1.0 for g in assignment.givens})
    numbers = kit.impact(e=0.6 + 0.1 * i)
    answers = {**kit.rounded(kit.true_values(numbers)), **changes}
    units = {q.id: q.unit for q in assignment.questions if q.unit}
    fill_workbook(empty, filled, answers, units, kit.table_of(kit.trajectory_m(numbers)))
    data = filled.read_bytes()
    filled.unlink()
    empty.unlink()
    return data


@pytest.fixture(scope="session")
def right(autograder_course, kit, tmp_path_factory) -> bytes:
    return workbook_bytes(autograder_course, kit, tmp_path_factory.mktemp("right"))


@pytest.fixture(scope="session")
def unsigned(autograder_course, kit, tmp_path_factory) -> bytes:
    return workbook_bytes(autograder_course, kit, tmp_path_factory.mktemp("unsigned"), signature="0" * 64)


def metadata(*emails: str, previous=(), created="2026-05-01T10:00:00.000000-07:00") -> dict:
    users = [{"id": k, "email": email, "name": "Somebody"} for k, email in enumerate(emails)]
    about = {"id": 1, "course_id": 2, "due_date": "2026-05-02T10:00:00-07:00", "late_due_date": None, "title": "Kick"}
    return {
        "id": 123, "created_at": created, "assignment": {**about, "total_points": "20.0"}, "users": users,
        "submission_method": "upload", "previous_submissions": list(previous),
    }  # fmt: skip


# ---------------------------------------------------------------- the zip


@pytest.fixture(scope="session")
def wheels(tmp_path_factory) -> Path:
    """Files with the names of wheels: what is in them matters to the real run only."""
    folder = tmp_path_factory.mktemp("wheels")
    for name in NEEDED:
        (folder / f"{name.replace('-', '_')}-1.0-py3-none-any.whl").write_bytes(b"wheel")
    return folder


@pytest.fixture(scope="session")
def packed(autograder_course, wheels, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("packed") / "autograder.zip"
    lines = write(job_of(autograder_course, wheels=wheels), path)
    assert [line.status for line in lines] == ["filled", "filled", "skipped"]
    assert "no e-mail address" in lines[2].reason
    return path


def test_files_stand_at_the_root_with_unix_line_ends_and_may_be_executed(packed) -> None:
    with zipfile.ZipFile(packed) as archive:
        for name in ("setup.sh", "run_autograder"):
            data, mode = archive.read(name), archive.getinfo(name).external_attr >> 16
            assert data.startswith(b"#!/usr/bin/env bash\n")
            assert b"\r" not in data
            assert stat.S_IMODE(mode) == 0o755
        assert stat.S_IMODE(archive.getinfo("truth.json").external_attr >> 16) == 0o600
        assert sum(name.startswith("wheels/") for name in archive.namelist()) == len(NEEDED)


def test_no_name_no_address_and_no_secret_is_in_the_zip(packed, autograder_course) -> None:
    with zipfile.ZipFile(packed) as archive:
        for name in archive.namelist():
            if not name.startswith("lib/"):
                found = re.search(rb"ana@|ben@|Ana Ex|Ben Ex", archive.read(name), re.IGNORECASE)
                assert found is None, name
        everything = b"".join(archive.read(name) for name in archive.namelist())
    assert autograder_course.secret not in everything
    assert autograder_course.secret.hex().encode() not in everything


def test_addresses_are_found_in_any_case_and_others_are_not(packed) -> None:
    with zipfile.ZipFile(packed) as archive:
        truth = from_bytes(archive.read("truth.json"))
    assert truth.of_address("ANA@example.ORG ").key.code == "CODE0"
    assert truth.of_address("eve@example.org") is None
    assert truth.of_address("") is None


def test_a_missing_wheel_is_named(wheels, tmp_path) -> None:
    shutil.copytree(wheels, tmp_path / "w")
    (tmp_path / "w" / "numpy-1.0-py3-none-any.whl").unlink()
    with pytest.raises(FileMissingError, match="none of numpy"):
        wheels_in(tmp_path / "w")


def test_what_the_autograder_imports_is_among_the_wheels() -> None:
    """Packages that others only look for, if they are there, are not needed."""
    command = "import sys, grader.autograder.run; print(*sorted({name.partition('.')[0] for name in sys.modules}))"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path or "." for path in sys.path)}
    done = subprocess.run([sys.executable, "-c", command], env=environment, capture_output=True, text=True, check=True)
    known = packages_distributions()
    found = distributions(package for name in done.stdout.split() for package in known.get(name, ()))
    looked_for = {"coverage", "pyyaml", "charset-normalizer", "setuptools", "vml-course"}
    assert found - looked_for <= distributions(NEEDED)


# ---------------------------------------------------------------- a run, from an empty folder


def unpack(packed: Path, root: Path) -> None:
    """Unpack as Gradescope does: with modes."""
    with zipfile.ZipFile(packed) as archive:
        for member in archive.infolist():
            place = Path(archive.extract(member, root / "source"))
            place.chmod(stat.S_IMODE(member.external_attr >> 16))
    shutil.copy(root / "source" / "run_autograder", root)
    (root / "submission").mkdir()


def run_in(root: Path, said: dict, files: dict[str, bytes], **environment: str) -> subprocess.CompletedProcess[str]:
    shutil.rmtree(root / "submission")
    for name, data in files.items():
        path = root / "submission" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    (root / "submission").mkdir(exist_ok=True)
    (root / "results" / "results.json").unlink(missing_ok=True)
    (root / "submission_metadata.json").write_text(json.dumps(said), encoding="utf-8")
    clean = {name: value for name, value in os.environ.items() if name not in {"PYTHONPATH", "PYTHONHOME"}}
    return subprocess.run(
        [str(root / "run_autograder")], env={**clean, "ROOT": str(root), **environment}, cwd=root, capture_output=True,
        text=True, check=False,
    )  # fmt: skip


def check_contract(results: dict) -> None:
    """Everything that Gradescope demands of a results.json, and nothing that it does not know."""
    known = {
        "score", "execution_time", "output", "output_format", "test_output_format", "test_name_format", "visibility",
        "stdout_visibility", "extra_data", "tests", "leaderboard",
    }  # fmt: skip
    of_test = {
        "score", "max_score", "status", "name", "name_format", "number", "output", "output_format", "tags",
        "visibility", "extra_data",
    }  # fmt: skip
    formats, visible = (
        {"text", "html", "simple_format", "md", "ansi"},
        {"visible", "hidden", "after_due_date", "after_published"},
    )
    assert set(results) <= known
    assert isinstance(results["score"], int | float)
    assert results["visibility"] in visible
    assert results["stdout_visibility"] == "hidden"
    assert {results[name] for name in known & set(results) if name.endswith("_format")} <= formats
    for test in results["tests"]:
        assert set(test) <= of_test
        assert test["visibility"] in visible
        assert test["output_format"] in formats
        assert test.get("status", "passed") in {"passed", "failed"}
        assert ("score" in test) == ("max_score" in test)
        assert "<script" not in test["output"]


def test_the_autograder_runs_from_an_empty_folder(packed, right, tmp_path) -> None:
    """With the packages of this environment in place of the wheels, which the long test installs."""
    unpack(packed, tmp_path)
    done = run_in(tmp_path, metadata("ANA@EXAMPLE.ORG"), {"lab.xlsx": right}, PYTHON=sys.executable)
    assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "results" / "results.json").read_text(encoding="utf-8"))
    check_contract(results)
    assert results["score"] == TOTAL
    assert done.stdout == ""
    done = run_in(tmp_path, metadata("ana@example.org"), {"lab.xlsx": b"no workbook"}, PYTHON=sys.executable)
    assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "results" / "results.json").read_text(encoding="utf-8"))
    check_contract(results)
    assert results["score"] == 0


NOT_NEEDED = (
    "cv2", "numba", "llvmlite", "av", "pandas", "sqlalchemy", "alembic", "jinja2", "typer", "rich", "fsspec", "dask",
    "distributed", "PIL",
)  # fmt: skip
GRADE_WITHOUT = """
import sys
sys.modules.update(dict.fromkeys(sys.argv[2:]))  # None: importing it fails
from assignments.textbook import textbook_of
from grader.autograder.run import main
from vml_course.kinetics.models import impact_model
from vml_course.synth.scene import impact_scene_names, scene_class
for name in impact_scene_names():
    textbook_of(name), impact_model(scene_class(name).model)
main(sys.argv[1:2])
"""


def test_grading_imports_nothing_that_draws_films_or_keeps_a_gradebook(packed, right, tmp_path) -> None:
    """In a fresh interpreter that refuses them: of every kind of impact what is needed, and one submission graded."""
    unpack(packed, tmp_path)
    (tmp_path / "submission" / "lab.xlsx").write_bytes(right)
    (tmp_path / "submission_metadata.json").write_text(json.dumps(metadata("ana@example.org")), encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "source" / "lib")}
    command = [sys.executable, "-c", GRADE_WITHOUT, str(tmp_path), *NOT_NEEDED]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "results" / "results.json").read_text(encoding="utf-8"))
    assert results["score"] == TOTAL
    assert not {"opencv-python-headless", "numba", "llvmlite", "av"} & distributions(NEEDED)


@pytest.mark.accuracy
def test_the_autograder_installs_without_a_network_and_runs(autograder_course, right, tmp_path) -> None:
    """The real thing: wheels are fetched, packed, installed into a Python that has nothing, and used."""
    prepared = os.environ.get("VML_WHEELS")
    path, root = tmp_path / "autograder.zip", tmp_path / "autograder"
    write(job_of(autograder_course, wheels=Path(prepared) if prepared else None), path)
    assert path.stat().st_size < 70e6
    unpack(path, root)
    offline = {"PIP_NO_INDEX": "1", "http_proxy": "http://127.0.0.1:9", "https_proxy": "http://127.0.0.1:9"}
    done = subprocess.run(
        [str(root / "source" / "setup.sh")], env={**os.environ, **offline, "ROOT": str(root)}, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert stat.S_IMODE((root / "source" / "truth.json").stat().st_mode) == 0o600
    done = run_in(root, metadata("ana@example.org"), {"lab.xlsx": right})
    assert done.returncode == 0, done.stderr
    results = json.loads((root / "results" / "results.json").read_text(encoding="utf-8"))
    check_contract(results)
    assert results["score"] == TOTAL


# ---------------------------------------------------------------- what is said of a submission


@pytest.fixture(scope="session")
def pack(packed) -> Pack:
    with zipfile.ZipFile(packed) as archive:
        return Pack(load_assignment("soccer-kick"), from_bytes(archive.read("truth.json")))


def on(terms: Terms, pack: Pack) -> Pack:
    held = {pid: replace(one, terms=terms) for pid, one in pack.truth.held.items()}
    return replace(pack, truth=replace(pack.truth, held=held))


def submit(folder: Path, **files: bytes) -> Path:
    made = folder / "submission"
    shutil.rmtree(made, ignore_errors=True)
    made.mkdir()
    for name, data in files.items():
        (made / f"{name}.xlsx").write_bytes(data)
    return made


def test_verdicts_wait_for_the_due_date_unless_attempts_are_counted(pack, right, tmp_path) -> None:
    folder = submit(tmp_path, lab=right)
    waiting = graded(pack, folder, metadata("ana@example.org"))
    check_contract(waiting)
    assert {test["visibility"] for test in waiting["tests"]} == {"after_due_date"}
    counting = graded(on(Terms(attempts=3), pack), folder, metadata("ana@example.org"))
    assert {test["visibility"] for test in counting["tests"]} == {"visible"}
    assert "Attempt 1 of 3" in counting["output"]


def test_what_can_be_read_before_the_due_date_tells_nothing_of_right_and_wrong(
    pack, autograder_course, kit, right, tmp_path
) -> None:
    wrong = workbook_bytes(autograder_course, kit, tmp_path, I=0.5)
    said = [graded(pack, submit(tmp_path, lab=data), metadata("ana@example.org")) for data in (right, wrong)]
    assert said[0]["score"] > said[1]["score"]
    assert said[0]["output"] == said[1]["output"]


def test_no_true_value_is_in_the_results(pack, autograder_course, kit, tmp_path) -> None:
    wrong = workbook_bytes(autograder_course, kit, tmp_path, e=0.31, I=0.5)
    results = graded(pack, submit(tmp_path, lab=wrong), metadata("ana@example.org"))
    told = {number for test in results["tests"] for number in re.findall(r"\d+\.\d+", test["output"])}
    truth = pack.truth.of_address("ana@example.org").key.values
    assert not told & {f"{truth[name]:.{digits}g}" for name in ("e", "I") for digits in (1, 2, 3, 4)}
    failed = {test["tags"][0] for test in results["tests"] if test.get("status") == "failed"}
    assert {"e", "I"} <= failed


def test_a_group_hands_in_the_workbook_of_any_of_its_members(pack, right, tmp_path) -> None:
    folder = submit(tmp_path, lab=right)
    assert graded(pack, folder, metadata("ben@example.org", "ana@example.org"))["score"] == TOTAL
    alone = graded(pack, folder, metadata("ben@example.org"))
    assert alone["score"] == 0
    assert "another video than yours" in alone["output"]


REFUSED = {
    "an unknown student": ("eve@example.org", {"lab": b"right"}, "not on the class list"),
    "no address": ("", {"lab": b"right"}, "not on the class list"),
    "nothing": ("ana@example.org", {}, "no file"),
    "an empty file": ("ana@example.org", {"lab": b""}, "expected an Excel workbook"),
    "an old workbook": (
        "ana@example.org",
        {"lab": b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600)},
        "expected an Excel",
    ),
    "half a workbook": ("ana@example.org", {"lab": b"half"}, "expected an Excel workbook"),
    "two workbooks": ("ana@example.org", {"one": b"right", "two": b"right"}, "Expected one workbook"),
    "a stolen code": ("ana@example.org", {"lab": b"unsigned"}, "not a workbook of this course"),
}


@pytest.mark.parametrize(("email", "files", "words"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_graded_gets_nothing_and_a_polite_text(  # noqa: PLR0917 - what comes in, and what is said
    pack, right, unsigned, tmp_path, email, files, words
) -> None:
    stand_in = {b"right": right, b"half": right[: len(right) // 2], b"unsigned": unsigned}
    folder = submit(tmp_path, **{name: stand_in.get(data, data) for name, data in files.items()})
    results = graded(pack, folder, metadata(email))
    check_contract(results)
    assert (results["score"], results["tests"]) == (0, [])
    assert words in results["output"]
    assert "hand in again" in results["output"]


def test_an_empty_workbook_is_said_to_be_empty(pack, autograder_course, kit, tmp_path) -> None:
    nothing = dict.fromkeys(kit.true_values(kit.impact()), "")
    data = workbook_bytes(autograder_course, kit, tmp_path, **nothing)
    results = graded(pack, submit(tmp_path, lab=data), metadata("ana@example.org"))
    assert results["score"] == 0
    assert "No question is answered" in results["output"]


def test_what_nobody_can_read_reaches_a_person_and_a_known_mistake_is_a_hint(
    pack, autograder_course, kit, tmp_path
) -> None:
    unclear = workbook_bytes(autograder_course, kit, tmp_path, I="about one")
    results = graded(pack, submit(tmp_path, lab=unclear), metadata("ana@example.org"))
    assert "A person will look" in results["output"]
    upside_down = workbook_bytes(autograder_course, kit, tmp_path, e=round(1 / 0.6, 4))
    results = graded(pack, submit(tmp_path, lab=upside_down), metadata("ana@example.org"))
    check_contract(results)
    (hints,) = [test for test in results["tests"] if test["tags"] == ["hints"]]
    assert hints["visibility"] == "after_due_date"
    assert hints["output"].startswith("<ul><li>")


def test_names_of_files_are_escaped(pack, tmp_path) -> None:
    folder = submit(tmp_path, **{"<img src=x onerror=alert(1)>": b"x"})
    assert "<img" not in graded(pack, folder, metadata("ana@example.org"))["output"]


def test_links_out_of_the_submission_are_not_followed(pack, tmp_path) -> None:
    folder, secret = submit(tmp_path), tmp_path / "truth.xlsx"
    secret.write_bytes(b"the truth")
    (folder / "lab.xlsx").symlink_to(secret)
    assert "no file" in graded(pack, folder, metadata("ana@example.org"))["output"]


# ---------------------------------------------------------------- earlier attempts


def after(results: dict, said: dict) -> dict:
    """What Gradescope hands back of a run; the results of the latest only."""
    return {
        "submission_time": said["created_at"],
        "score": results["score"],
        "autograder_error": False,
        "results": results,
    }


@pytest.fixture(scope="session")
def worse(autograder_course, kit, tmp_path_factory) -> bytes:
    return workbook_bytes(autograder_course, kit, tmp_path_factory.mktemp("worse"), e=0.05, I=7.0)


def test_attempts_are_counted_and_the_one_that_the_course_names_counts(pack, right, worse, tmp_path) -> None:
    best, newest = on(Terms(attempts=2, counts="best"), pack), on(Terms(attempts=2), pack)
    said = metadata("ana@example.org")
    first = graded(best, submit(tmp_path, lab=right), said)
    again = metadata("ana@example.org", previous=[after(first, said)])
    folder = submit(tmp_path, lab=worse)
    second = graded(best, folder, again)
    assert second["score"] == TOTAL
    assert "Attempt 2 of 2" in second["output"]
    assert 0 < graded(newest, folder, again)["score"] < TOTAL


def test_an_attempt_too_many_does_not_count_and_tells_nothing(pack, right, worse, tmp_path) -> None:
    one, said = on(Terms(attempts=1), pack), metadata("ana@example.org")
    first = graded(one, submit(tmp_path, lab=worse), said)
    second = graded(one, submit(tmp_path, lab=right), metadata("ana@example.org", previous=[after(first, said)]))
    assert second["score"] == first["score"]
    assert "does not count" in second["output"]
    assert {test["visibility"] for test in second["tests"]} == {"after_due_date"}


def test_the_same_workbook_again_uses_no_attempt(pack, right, tmp_path) -> None:
    one, said = on(Terms(attempts=1), pack), metadata("ana@example.org")
    folder = submit(tmp_path, lab=right)
    first = graded(one, folder, said)
    later = metadata("ana@example.org", previous=[after(first, said)], created="2026-06-01T10:00:00+00:00")
    again = graded(one, folder, later)
    assert (again["score"], again["extra_data"]) == (first["score"], first["extra_data"])


def test_an_unreadable_file_between_uses_no_attempt_and_forgets_none(pack, right, tmp_path) -> None:
    one, said = on(Terms(attempts=2), pack), metadata("ana@example.org")
    first = graded(one, submit(tmp_path, lab=right), said)
    broken = graded(one, submit(tmp_path, lab=b"x"), metadata("ana@example.org", previous=[after(first, said)]))
    assert broken["extra_data"] == first["extra_data"]


def test_lateness_is_reckoned_from_the_submission_not_from_the_clock(pack, right, tmp_path) -> None:
    terms = Terms(due=datetime(2026, 5, 1, 16, tzinfo=UTC), late=Late("fixed", share=0.25))
    folder = submit(tmp_path, lab=right)
    late = [graded(on(terms, pack), folder, metadata("ana@example.org")) for _ in range(2)]
    assert late[0] == late[1]
    assert late[0]["score"] == 0.75 * TOTAL
    assert "25 % is taken off" in late[0]["output"]
    in_time = graded(on(terms, pack), folder, metadata("ana@example.org", created="2026-05-01T08:59:59-07:00"))
    assert in_time["score"] == TOTAL


def test_runs_that_failed_are_no_attempts_and_scores_stand_in_for_lost_results() -> None:
    earlier = [
        {"submission_time": "2026-05-01T00:00:00Z", "score": "7.0", "autograder_error": False, "results": {}},
        {"submission_time": "2026-05-02T00:00:00Z", "score": 0.0, "autograder_error": True, "results": None},
    ]
    past = past_attempts({"previous_submissions": earlier})
    assert past == (Past("2026-05-01T00:00:00Z", 7.0),)
    attempts, number = with_this(past, Past("2026-05-03T00:00:00Z", 9.0, "abc"))
    assert (len(attempts), number) == (2, 2)
    assert past_attempts({}) == ()


def test_the_terms_of_each_student_travel_along(autograder_course, wheels, tmp_path) -> None:
    steps = Late("steps", steps=((1.0, 0.1), (24.0, 0.5)))
    terms = Terms(due=datetime(2026, 5, 1, tzinfo=UTC), attempts=3, counts="mean", late=steps)
    course = replace(autograder_course, calendar=Calendar(terms={"soccer-kick": terms}))
    write(job_of(course, wheels=wheels), tmp_path / "a.zip")
    with zipfile.ZipFile(tmp_path / "a.zip") as archive:
        truth = from_bytes(archive.read("truth.json"))
    assert {one.terms for one in truth.held.values()} == {terms}


def test_an_assignment_of_the_course_itself_is_packed(autograder_course, tmp_path) -> None:
    names = {name for name, _ in packed_files(job_of(autograder_course))}
    assert {"assignment/soccer-kick/assignment.toml", "lib/grader/autograder/run.py", "python-version"} <= names
    assert not any("__pycache__" in name for name in names)


def test_scripts_of_a_windows_checkout_get_unix_line_ends(autograder_course, monkeypatch) -> None:
    monkeypatch.setattr(Path, "read_bytes", lambda path: b"#!/usr/bin/env bash\r\nexit\r\n")
    names = dict(packed_files(job_of(autograder_course)))
    assert names["setup.sh"] == names["run_autograder"] == b"#!/usr/bin/env bash\nexit\n"
