"""course.toml: what it may say, and how its mistakes are told."""

from __future__ import annotations

import datetime as dt
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assignments.course import COURSE_FILE, add_extension, new_course, open_course
from assignments.course_names import check_assignments
from assignments.errors import CourseError
from assignments.terms import Extension, Late, Terms
from assignments.toml_text import TomlError, content_of

FULL = """
title = "Dynamik, Frühjahr"
term = "spring 2027"
time_zone = "Europe/Berlin"
gradebook = "sqlite:///grades.db"

[assignment.soccer-kick]
opens = 2027-04-12T08:00:00
due = 2027-04-26T23:59:00
closes = 2027-05-03T23:59:00
attempts = 3
counts = "best"
true_values = "never"
late = { rule = "linear", share = 0.1, per_hours = 24, grace_minutes = 15, cap = 0.5 }

[assignment.two-pucks]
due = 2027-05-10T12:00:00-04:00
late = { rule = "steps", steps = [[24, 0.3], [0, 0.1]] }

[[extension]]
student = "k3m9x2ab"
assignment = "soccer-kick"
hours = 48
reason = "ill"
"""


def _course(folder: Path, text: str):
    course = new_course(folder)
    (folder / COURSE_FILE).write_text(text, encoding="utf-8")
    return course


def test_everything_that_it_may_say_is_understood(tmp_path: Path) -> None:
    _course(tmp_path, FULL)
    course = open_course(tmp_path)
    kick, pucks = (course.calendar.terms_of(name) for name in ("soccer-kick", "two-pucks"))
    assert (course.title, course.term, course.gradebook_url) == (
        "Dynamik, Frühjahr",
        "spring 2027",
        "sqlite:///grades.db",
    )
    assert kick.due == dt.datetime(2027, 4, 26, 21, 59, tzinfo=dt.UTC)  # local time of the course
    assert pucks.due == dt.datetime(2027, 5, 10, 16, 0, tzinfo=dt.UTC)  # its own zone
    assert (kick.attempts, kick.counts, kick.late) == (3, "best", Late("linear", 0.1, 24, (), 15, 0.5))
    assert (kick.true_values, pucks.true_values) == ("never", "when over")
    assert pucks.late.steps == ((0.0, 0.1), (24.0, 0.3))
    assert course.calendar.terms_of("soccer-kick", "k3m9x2ab").due == kick.due + dt.timedelta(hours=48)


def test_a_new_course_says_nothing_of_dates_and_shows_how(tmp_path: Path) -> None:
    course = new_course(tmp_path / "c")
    assert course.calendar.terms_of("soccer-kick") == Terms()
    text = (tmp_path / "c" / COURSE_FILE).read_text(encoding="utf-8")
    shown = re.sub("^# ", "", text.partition("\n")[2], flags=re.MULTILINE)
    _course(tmp_path / "d", f'title = "x"\n{shown}')
    assert open_course(tmp_path / "d").calendar.terms_of("soccer-kick").attempts == 3


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("titel = 1", "titel: expected no such key"),
        ('time_zone = "Middle-earth/Shire"', 'time_zone: expected a zone such as "Europe/Berlin"'),
        ('time_zone = ""', 'time_zone: expected a zone such as "Europe/Berlin"'),
        ("[assignment.kick]\ndue = 2027-04-26", "due: expected a date with a time, such as 2027-04-26T23:59:00"),
        ('[assignment.kick]\ndue = "soon"', "due: expected a valid datetime"),
        ("[assignment.kick]\nattempts = -1", "attempts: expected greater than or equal to 0, got -1"),
        ('[assignment.kick]\ncounts = "worst"', "counts: expected 'newest', 'best', 'first' or 'mean'"),
        ("[assignment.kick]\ncloses = 2027-05-01T00:00:00", "a due date beside late or closes"),
        (
            "[assignment.kick]\ndue = 2027-05-02T00:00:00\ncloses = 2027-05-01T00:00:00",
            "opens before due, due before closes, got { due = 2027-05-02T00:00:00, closes = 2027-05-01T00:00:00 }.",
        ),
        ("[assignment.kick]\ndone = 2027-05-02T23:59:00", "no such key, got 2027-05-02T23:59:00. Is it misspelt?"),
        (
            "[assignment.kick]\ndue 2027-05-02",
            "got 'due 2027-05-02' at line 3. The reason: expected '=' after a key in a key/value pair (column 5).",
        ),
        ("[assignment.kick]\n[assignment.kick]", "at line 3. The reason: cannot declare assignment.kick twice"),
        ("a = [1,\n\n", "got 'a = [1,' at line 2. The reason: invalid value."),
        ('term = "Spring\n', "got 'term = \"Spring' at line 2. The reason: illegal end of the line (column 15)."),
        (
            '[assignment.kick]\ndue = 2027-05-02T00:00:00\nlate = { rule = "fixed" }',
            'a share above 0 for the rule "fixed"',
        ),
        ('[assignment.kick]\ndue = 2027-05-02T00:00:00\nlate = { rule = "steps" }', "steps = [[hours, share], ...]"),
        ('[[extension]]\nstudent = "a b"\nreason = "x"\nhours = 1', "extension.0.student"),
        ('[[extension]]\nstudent = "ab"\nhours = 1', "extension.0.reason: expected a value, got none"),
        ('[[extension]]\nstudent = "ab"\nreason = "x"', "hours or attempts above 0"),
    ],
)
def test_a_mistake_is_one_line_with_its_key(tmp_path: Path, text: str, words: str) -> None:
    _course(tmp_path, f'title = "x"\n{text}\n')
    with pytest.raises(CourseError) as caught:
        open_course(tmp_path)
    assert words in str(caught.value)
    assert COURSE_FILE in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_in_another_encoding_says_on_which_line_that_shows(tmp_path: Path) -> None:
    _course(tmp_path, "")
    (tmp_path / COURSE_FILE).write_bytes('title = "x"\nterm = "Frühjahr"\n'.encode("cp1252"))
    with pytest.raises(CourseError, match=r"got other bytes at line 2\. Save the file with the encoding UTF-8\."):
        open_course(tmp_path)


def test_the_mark_that_windows_puts_before_a_text_is_no_mistake(tmp_path: Path) -> None:
    _course(tmp_path, "\ufeff" + FULL)
    course = add_extension(open_course(tmp_path), Extension("abc", "ill", attempts=1))
    assert open_course(tmp_path).calendar == course.calendar


@given(st.text(alphabet="a.=\"'[]{}\\ \n\r\u2028é1-", max_size=40))
def test_any_text_is_toml_or_one_polite_line_of_the_file(text: str) -> None:
    message = ""
    try:
        content_of(text, COURSE_FILE)
    except TomlError as error:
        message = str(error)
    said = re.search(r"at line (\d+)\. The reason: ", message)
    assert bool(said) == bool(message)
    assert "\n" not in message
    assert said is None or 1 <= int(said[1]) <= text.count("\n") + 1


def test_an_extension_is_added_to_the_file_and_the_rest_stays(tmp_path: Path) -> None:
    _course(tmp_path, FULL)
    course = add_extension(open_course(tmp_path), Extension("abc", 'moved "house"', attempts=1))
    text = (tmp_path / COURSE_FILE).read_text(encoding="utf-8")
    assert text.startswith(FULL.rstrip())
    assert course.calendar.terms_of("soccer-kick", "abc").attempts == 4
    assert open_course(tmp_path).calendar == course.calendar


def test_an_extension_that_gives_nothing_changes_nothing(tmp_path: Path) -> None:
    _course(tmp_path, FULL)
    with pytest.raises(CourseError, match="hours or attempts above 0"):
        add_extension(open_course(tmp_path), Extension("abc", "why"))
    assert (tmp_path / COURSE_FILE).read_text(encoding="utf-8") == FULL


@pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed: nothing can be committed")
@pytest.mark.parametrize("removed", [False, True])
def test_a_secret_that_was_committed_is_refused(tmp_path: Path, removed: bool) -> None:
    new_course(tmp_path / "course")

    def git(*words: str) -> None:
        who = ("-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "commit.gpgsign=false")
        subprocess.run(
            [shutil.which("git") or "git", "-C", str(tmp_path), *who, *words], check=True, capture_output=True
        )

    git("init", "-q")
    assert open_course(tmp_path / "course")
    git("add", "-f", "course/.secret")
    if removed:
        git("commit", "-qm", "oops")
        git("rm", "-q", "--cached", "course/.secret")
        git("commit", "-qm", "better")
    with pytest.raises(CourseError, match="expected a secret that was never committed, got one that git knows"):
        open_course(tmp_path / "course")


def test_a_course_in_an_object_store_keeps_secret_and_names_at_home(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setenv("VML_HOME", str(tmp_path / "home"))
    url = f"memory://{tmp_path.name}/dynamics"
    made = new_course(url, "Dynamics")
    assert made.shelf.names() == {COURSE_FILE}
    assert {path.name for path in made.folder.iterdir()} == {".secret", ".gitignore", "roster.csv"}
    assert made.folder.parent == tmp_path / "home"
    assert open_course(url) == made
    with pytest.raises(CourseError, match="a folder without a course"):
        new_course(url)


def test_two_courses_of_like_names_have_homes_of_their_own(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setenv("VML_HOME", str(tmp_path / "home"))
    one, other = new_course(f"memory://{tmp_path.name}/a-b"), new_course(f"memory://{tmp_path.name}/a/b")
    assert one.folder != other.folder
    assert one.secret != other.secret


def test_terms_of_an_assignment_that_does_not_exist_are_refused(tmp_path: Path) -> None:
    _course(tmp_path, FULL.replace("two-pucks", "two-puks"))
    with pytest.raises(CourseError) as caught:
        check_assignments(open_course(tmp_path))
    assert str(caught.value).startswith(
        "course.toml, line 16, [assignment.two-puks]: expected an assignment that there is (nearest: two-pucks), "
        "got 'two-puks'. What it says would have no effect."
    )
    own = tmp_path / "assignments" / "two-puks"
    own.mkdir(parents=True)
    with pytest.raises(CourseError, match="two-puks"):
        check_assignments(open_course(tmp_path))  # a folder without an assignment in it
    (own / "assignment.toml").touch()
    check_assignments(open_course(tmp_path))


def test_a_name_that_resembles_none_is_told_with_all_there_are(tmp_path: Path) -> None:
    _course(tmp_path, FULL.replace("two-pucks", "qqq"))
    with pytest.raises(CourseError, match=r"there is \(soccer-kick, ballistic-pendulum, .*\), got 'qqq'"):
        check_assignments(open_course(tmp_path))


def test_all_mistakes_are_told_at_once_in_the_order_of_the_file(tmp_path: Path) -> None:
    _course(tmp_path, 'title = "x"\ntime_zone = "Mars"\n[assignment.kick]\nattempts = -1\ncounts = "worst"\n')
    with pytest.raises(CourseError) as caught:
        open_course(tmp_path)
    said = str(caught.value)
    places = [
        said.index(words)
        for words in ("line 2, time_zone", "line 4, assignment.kick.attempts", "line 5, assignment.kick.counts")
    ]
    assert places == sorted(places)
