"""The autograder's zip: what is in it, and what must not be."""

from __future__ import annotations

import os
import re
import shutil
import stat
import subprocess
import sys
import zipfile
from importlib.metadata import packages_distributions

import pytest

from assignments.course import new_course
from grader.autograder.truth import from_bytes
from grader.autograder.wheels import NEEDED, distributions, wheels_in
from grader.exporting import export_grades
from grader.gradebook import Gradebook
from grader.roster import Enrolled
from vml_course.errors import FileMissingError, InputError


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


def test_a_class_that_gradescope_cannot_know_gets_no_zip(tmp_path) -> None:
    course = new_course(tmp_path / "c")
    with Gradebook.open(course) as book:
        book.take_in([Enrolled("Ann", "", {"canvas_id": "901"})])
    with pytest.raises(
        InputError, match=r"expected students with a variant, got has no e-mail address.* Import a class list"
    ):
        export_grades(course, "soccer-kick", "gradescope")
    assert not list(course.folder.glob("exports/*.zip"))


def test_what_the_autograder_imports_is_among_the_wheels() -> None:
    """Packages that others only look for, if they are there, are not needed."""
    command = "import sys, grader.autograder.run; print(*sorted({name.partition('.')[0] for name in sys.modules}))"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path or "." for path in sys.path)}
    done = subprocess.run([sys.executable, "-c", command], env=environment, capture_output=True, text=True, check=True)
    known = packages_distributions()
    found = distributions(package for name in done.stdout.split() for package in known.get(name, ()))
    looked_for = {"coverage", "pyyaml", "charset-normalizer", "setuptools", "vml-course"}
    assert found - looked_for <= distributions(NEEDED)
