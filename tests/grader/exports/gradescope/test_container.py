"""The zip unpacked into an empty folder that plays /autograder, and run as Gradescope runs it."""

from __future__ import annotations

import json
import os
import shutil
import stat
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from assignments.load import load_assignment
from grader.autograder.wheels import NEEDED, distributions
from grader.exports.gradescope import write

TOTAL = load_assignment("soccer-kick").total_points


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


def test_the_autograder_runs_from_an_empty_folder(lab, packed, right, tmp_path) -> None:
    """With the packages of this environment in place of the wheels, which the long test installs."""
    unpack(packed, tmp_path)
    done = run_in(tmp_path, lab.metadata("ANA@EXAMPLE.ORG"), {"lab.xlsx": right}, PYTHON=sys.executable)
    assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "results" / "results.json").read_text(encoding="utf-8"))
    lab.check_contract(results)
    assert results["score"] == TOTAL
    assert done.stdout == ""
    done = run_in(tmp_path, lab.metadata("ana@example.org"), {"lab.xlsx": b"no workbook"}, PYTHON=sys.executable)
    assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "results" / "results.json").read_text(encoding="utf-8"))
    lab.check_contract(results)
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


def test_grading_imports_nothing_that_draws_films_or_keeps_a_gradebook(lab, packed, right, tmp_path) -> None:
    """In a fresh interpreter that refuses them: of every kind of impact what is needed, and one submission graded."""
    unpack(packed, tmp_path)
    (tmp_path / "submission" / "lab.xlsx").write_bytes(right)
    (tmp_path / "submission_metadata.json").write_text(json.dumps(lab.metadata("ana@example.org")), encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "source" / "lib")}
    command = [sys.executable, "-c", GRADE_WITHOUT, str(tmp_path), *NOT_NEEDED]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "results" / "results.json").read_text(encoding="utf-8"))
    assert results["score"] == TOTAL
    assert not {"opencv-python-headless", "numba", "llvmlite", "av"} & distributions(NEEDED)


@pytest.mark.accuracy
def test_the_autograder_installs_without_a_network_and_runs(lab, autograder_course, right, tmp_path) -> None:
    """The real thing: wheels are fetched, packed, installed into a Python that has nothing, and used."""
    prepared = os.environ.get("VML_WHEELS")
    path, root = tmp_path / "autograder.zip", tmp_path / "autograder"
    write(lab.job_of(autograder_course, wheels=Path(prepared) if prepared else None), path)
    assert path.stat().st_size < 70e6
    unpack(path, root)
    offline = {"PIP_NO_INDEX": "1", "http_proxy": "http://127.0.0.1:9", "https_proxy": "http://127.0.0.1:9"}
    done = subprocess.run(
        [str(root / "source" / "setup.sh")], env={**os.environ, **offline, "ROOT": str(root)}, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert stat.S_IMODE((root / "source" / "truth.json").stat().st_mode) == 0o600
    done = run_in(root, lab.metadata("ana@example.org"), {"lab.xlsx": right})
    assert done.returncode == 0, done.stderr
    results = json.loads((root / "results" / "results.json").read_text(encoding="utf-8"))
    lab.check_contract(results)
    assert results["score"] == TOTAL
