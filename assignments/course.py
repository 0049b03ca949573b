"""A course is a folder: its settings, its secret, its roster; handouts, gradebook and feedback come to lie beside them.

The folder may lie in an object store (`s3://bucket/dynamics`). Then the store holds what is handed out and handed in,
and what must stay private, the secret and the gradebook, lies in a folder of this machine, the course's *home*.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from dataclasses import dataclass, field, replace
from pathlib import Path

from pydantic import ValidationError

from assignments.course_file import CourseFile
from assignments.errors import CourseError
from assignments.load import named_mistakes
from assignments.locate import line_of
from assignments.secret import SECRET_FILE, read_secret, write_secret
from assignments.terms import Calendar, Extension
from assignments.toml_text import TomlError, content_of, text_of
from vml_course.errors import FileMissingError
from vml_course.io.shelf import FolderShelf, Shelf, open_shelf

COURSE_FILE, ROSTER_FILE, HANDOUTS = "course.toml", "roster.csv", "handouts"
HOME_VARIABLE = "VML_HOME"
"""Names the folder that holds the homes of courses in object stores; `.vml` in the user's own folder otherwise."""

_TITLE = re.compile(r"[^\x00-\x1f\x7f]{1,200}")

_IGNORED = """\
# Never to be committed: the secret that all numbers are drawn from, answers and grades, names.
/.secret
/gradebook*
/handouts/
/.making-*/
/inbox/
/submissions/
/feedback/
/frames/
/exports/
/roster.csv
"""

_SAMPLE_ROSTER = """\
name,email
Ana Example,ana@example.org
Ben Example,ben@example.org
Chi Example,chi@example.org
"""

_SAMPLE_SETTINGS = """\
# term = "Spring 2027"
# time_zone = "Europe/Berlin"     # of the dates below; UTC when not given
# gradebook = "postgresql+psycopg://user@host/dynamics"     # a file in this folder when not given

# [assignment.soccer-kick]
# opens = 2027-04-12T08:00:00
# due = 2027-04-26T23:59:00
# closes = 2027-05-03T23:59:00    # later work is kept, not graded; pages then show true values
# attempts = 3                    # different contents; 0 is any number
# counts = "best"                 # or newest, first, mean
# true_values = "never"           # on students' pages; when over if not given, or always
# late = { rule = "linear", share = 0.1, per_hours = 24, grace_minutes = 15, cap = 0.5 }

# [[extension]]                   # names stay out: students go by their pseudonyms
# student = "k3m9x2ab"
# assignment = "soccer-kick"      # all assignments when not given
# hours = 48
# reason = "ill from 20 to 23 April"
"""


@dataclass(frozen=True)
class Course:
    """A course that was opened; printing it does not show the secret.

    Attributes
    ----------
    folder : Path
        The folder of this machine: secret, gradebook, names, what handing out cost.
    shelf : Shelf
        Where everything else lies; the same folder unless the course is in an object store.
    gradebook_url : str
        SQLAlchemy's URL of the gradebook, "" for a file in `folder`.
    """

    folder: Path
    title: str
    secret: bytes = field(repr=False)
    shelf: Shelf = field(compare=False)
    term: str = ""
    calendar: Calendar = field(default_factory=Calendar)
    gradebook_url: str = field(default="", repr=False)  # it may hold a password

    @property
    def roster(self) -> Path:
        """The list of students, `name,email`, in the folder of this machine: it holds names."""
        return self.folder / ROSTER_FILE

    @property
    def assignments(self) -> Path:
        """The instructor's own assignments, one folder each, where there are any."""
        return self.folder / "assignments"

    def handouts(self, assignment_id: str) -> Path:
        """Return the folder of an assignment's handouts, where the course is a folder of this machine."""
        return self.folder / HANDOUTS / assignment_id


def new_course(place: str | Path, title: str = "") -> Course:
    """Make a course with a secret of its own and a roster to fill in.

    What is already in the folder stays as it is.

    Parameters
    ----------
    place : str or Path
        A folder, or the URL of a folder in an object store.
    title : str

    Raises
    ------
    CourseError
        When there is a course already, or the title is no single line.
    """
    shelf, home = open_shelf(place), home_of(place)
    title = title or Path(shelf.place()).resolve().name
    if not _TITLE.fullmatch(title):
        raise CourseError("title", "one line of 1 to 200 characters", repr(title[:60]))
    if shelf.exists(COURSE_FILE) or (home / SECRET_FILE).exists():
        found = COURSE_FILE if shelf.exists(COURSE_FILE) else SECRET_FILE
        raise CourseError(str(place), "a folder without a course", f"{found} in it", "Choose another folder.")
    blocking = next((path for path in (home, *home.parents) if path.is_file()), None)
    if blocking is not None:
        raise CourseError(str(blocking), "a folder, or a name that is still free", "a file", "Choose another name.")
    home.mkdir(parents=True, exist_ok=True, mode=0o777 if _is_folder(shelf) else 0o700)
    write_secret(home / SECRET_FILE)
    _write_new(home / ".gitignore", _IGNORED)
    _write_new(home / ROSTER_FILE, _SAMPLE_ROSTER)
    shelf.write(COURSE_FILE, f"title = {json.dumps(title, ensure_ascii=False)}\n{_SAMPLE_SETTINGS}".encode())
    return open_course(place)


def open_course(place: str | Path) -> Course:
    """Open a course.

    Raises
    ------
    CourseError
        When it is no course, its settings have mistakes, or its secret is open to others.
    """
    shelf, home = open_shelf(place), home_of(place)
    settings = _settings(shelf, place)
    return Course(
        folder=home,
        title=settings.title,
        secret=read_secret(home / SECRET_FILE),
        term=settings.term or "",
        calendar=settings.calendar(),
        gradebook_url=settings.gradebook,
        shelf=shelf,
    )


def add_extension(course: Course, given: Extension) -> Course:
    """Write an extension into the course's settings and return the course with it.

    Raises
    ------
    CourseError
        When the settings would not be valid with it; they then stay as they were.
    """
    fields = {
        "student": given.student,
        "assignment": given.assignment,
        "hours": given.hours,
        "attempts": given.attempts,
        "reason": given.reason,
    }
    lines = (f"{name} = {json.dumps(value, ensure_ascii=False)}" for name, value in fields.items() if value)
    old = course.shelf.read(COURSE_FILE)
    new = old.rstrip(b"\n") + ("\n\n[[extension]]\n" + "\n".join(lines) + "\n").encode()
    settings = _understood(new, course.shelf.place(COURSE_FILE))
    course.shelf.write(COURSE_FILE, new)
    return replace(course, calendar=settings.calendar())


def has_sample_roster(course: Course) -> bool:
    """Tell whether the class list is still the sample that a new course begins with."""
    return course.roster.is_file() and course.roster.read_text(encoding="utf-8", errors="replace") == _SAMPLE_ROSTER


def home_of(place: str | Path) -> Path:
    """Return the folder of this machine that holds the private part of a course."""
    shelf = open_shelf(place)
    if isinstance(shelf, FolderShelf):
        return shelf.folder
    url = shelf.place()
    homes = Path(os.environ.get(HOME_VARIABLE) or Path.home() / ".vml")
    name = re.sub(r"[^A-Za-z0-9]+", "-", url).strip("-")[-40:]
    return homes / f"{name}-{hashlib.sha256(url.encode()).hexdigest()[:8]}"


def _is_folder(shelf: Shelf) -> bool:
    return isinstance(shelf, FolderShelf)


def _settings(shelf: Shelf, place: str | Path) -> CourseFile:
    try:
        data = shelf.read(COURSE_FILE)
    except FileMissingError:
        hint = f"Make one with: vml course new {place}"
        raise CourseError(str(place), f"a course folder with {COURSE_FILE}", "none", hint) from None
    return _understood(data, shelf.place(COURSE_FILE))


def _understood(data: bytes, path: str) -> CourseFile:
    try:
        text = text_of(data, path)
        content = content_of(text, path)
    except TomlError as error:
        raise CourseError(error.name, error.expected, error.got, error.hint) from error
    try:
        return CourseFile.model_validate(content)
    except ValidationError as error:
        first, *others = sorted(
            ((line_of(text, found.name, str(found.got)), found) for found in named_mistakes(error, content)),
            key=lambda pair: pair[0],
        )
        line, found = first
        also = "".join(f" And line {at}, {str(other).rstrip('.')}." for at, other in others)
        raise CourseError(f"{path}, line {line}, {found.name}", found.expected, found.got, found.hint + also) from error


def _write_new(path: Path, text: str) -> None:
    """Write a file that is not there yet; add missing lines to an existing `.gitignore`."""
    if not path.exists():
        path.write_text(text, encoding="utf-8", newline="\n")
    elif path.name == ".gitignore":
        old = path.read_text(encoding="utf-8")
        missing = [line for line in text.splitlines() if line not in old.splitlines()]
        path.write_text(old.rstrip("\n") + "\n" + "\n".join(missing) + "\n", encoding="utf-8", newline="\n")
