"""An assignment from anywhere is handed out from the course, where the grader finds it again."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from assignments.adopt import adopt
from assignments.course import Course, new_course
from assignments.load import FILE, catalogue, load_assignment
from vml_course.errors import InputError, UnknownNameError


@pytest.fixture
def course(tmp_path: Path) -> Course:
    return new_course(tmp_path / "course", "Dynamics")


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    shutil.copytree(catalogue() / "two-pucks", tmp_path / "my-pucks")
    return tmp_path / "my-pucks"


def test_one_of_the_catalogue_stays_there(course: Course) -> None:
    assert adopt(course, "two-pucks").id == "two-pucks"
    assert not course.assignments.exists()


def test_one_from_elsewhere_is_copied_and_found_by_its_name(course: Course, mine: Path) -> None:
    assert adopt(course, str(mine)).folder == str((course.assignments / "my-pucks").resolve())
    shutil.rmtree(mine)
    assert load_assignment("my-pucks", course.assignments).id == "my-pucks"
    assert adopt(course, "my-pucks").id == "my-pucks"


def test_the_same_again_changes_nothing(course: Course, mine: Path) -> None:
    assert adopt(course, str(mine)) == adopt(course, str(mine))


def test_another_one_of_the_same_name_is_refused(course: Course, mine: Path) -> None:
    adopt(course, str(mine))
    file = mine / FILE
    file.write_text(file.read_text(encoding="utf-8").replace("low = 1.6", "low = 1.8"), encoding="utf-8")
    with pytest.raises(InputError, match=r"a name that .* does not have yet, got 'my-pucks'"):
        adopt(course, str(mine))


@pytest.mark.parametrize("name", ["golf", "../course", "/nowhere", "", "."])
def test_what_is_none_is_said_so(course: Course, name: str) -> None:
    with pytest.raises(UnknownNameError, match="assignment: expected one of soccer-kick"):
        adopt(course, name)
