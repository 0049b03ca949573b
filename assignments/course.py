"""A course is a folder: its title, its secret, its roster; handouts and gradebook come to lie beside them.

The secret decides every student's numbers. Whoever reads it can compute all answers, so it is readable
by its owner only, is never put under version control, and a course whose secret is open is not run.
"""

from __future__ import annotations

import json
import os
import re
import secrets
import stat
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from assignments.errors import CourseError

COURSE_FILE, SECRET_FILE, ROSTER_FILE, HANDOUTS = "course.toml", ".secret", "roster.csv", "handouts"
SECRET_BYTES = 32
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
/roster.csv
"""

_SAMPLE_ROSTER = """\
name,email
Ana Example,ana@example.org
Ben Example,ben@example.org
Chi Example,chi@example.org
"""


@dataclass(frozen=True)
class Course:
    """A course that was opened; printing it does not show the secret."""

    folder: Path
    title: str
    secret: bytes = field(repr=False)

    @property
    def roster(self) -> Path:
        """The list of students, `name,email`."""
        return self.folder / ROSTER_FILE

    @property
    def assignments(self) -> Path:
        """The instructor's own assignments, one folder each, where there are any."""
        return self.folder / "assignments"

    def handouts(self, assignment_id: str) -> Path:
        """Return the folder of an assignment's handouts, one folder a student."""
        return self.folder / HANDOUTS / assignment_id


def new_course(folder: Path, title: str = "") -> Course:
    """Make a course folder with a secret of its own and a roster to fill in.

    What is already in the folder stays as it is.

    Raises
    ------
    CourseError
        When there is a course already, or the title is no single line.
    """
    folder = Path(folder)
    title = title or folder.resolve().name
    if not _TITLE.fullmatch(title):
        raise CourseError("title", "one line of 1 to 200 characters", repr(title[:60]))
    for name in (COURSE_FILE, SECRET_FILE):
        if (folder / name).exists():
            raise CourseError(str(folder), "a folder without a course", f"{name} in it", "Choose another folder.")
    folder.mkdir(parents=True, exist_ok=True)
    _write_secret(folder / SECRET_FILE)
    _write_new(folder / ".gitignore", _IGNORED)
    _write_new(folder / ROSTER_FILE, _SAMPLE_ROSTER)
    _write_new(folder / COURSE_FILE, f"title = {json.dumps(title, ensure_ascii=False)}\n")
    return open_course(folder)


def open_course(folder: Path) -> Course:
    """Open a course folder.

    Raises
    ------
    CourseError
        When it is no course, or others can read its secret.
    """
    folder = Path(folder)
    try:
        content = tomllib.loads((folder / COURSE_FILE).read_text(encoding="utf-8"))
    except OSError:
        hint = f"Make one with: vml course new {folder}"
        raise CourseError(str(folder), f"a course folder with {COURSE_FILE}", "none", hint) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise CourseError(str(folder / COURSE_FILE), "TOML in UTF-8", error) from error
    if not isinstance(content.get("title"), str):
        raise CourseError(str(folder / COURSE_FILE), "a title", repr(content.get("title")))
    return Course(folder, content["title"], _read_secret(folder / SECRET_FILE))


def _write_secret(path: Path) -> None:
    """Create the secret; never over an old one, never readable by others, not even for a moment."""
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "w", encoding="ascii") as file:
        file.write(secrets.token_hex(SECRET_BYTES) + "\n")


def _read_secret(path: Path) -> bytes:
    try:
        mode, text = path.stat().st_mode, path.read_text(encoding="ascii", errors="replace").strip()
    except OSError as error:
        hint = "Without it the variants that were handed out cannot be drawn again: restore it from a backup."
        raise CourseError(str(path), "the course's secret", error.strerror, hint) from error
    if os.name == "posix" and stat.S_IMODE(mode) & 0o077:
        hint = f"Who reads it can compute every answer. Run: chmod 600 {path}"
        raise CourseError(str(path), "a file that only you can read", f"mode {stat.S_IMODE(mode):03o}", hint)
    if not re.fullmatch(rf"[0-9a-f]{{{2 * SECRET_BYTES}}}", text):
        raise CourseError(str(path), f"{2 * SECRET_BYTES} hexadecimal digits", f"{len(text)} other characters")
    return bytes.fromhex(text)


def _write_new(path: Path, text: str) -> None:
    """Write a file that is not there yet; add missing lines to an existing `.gitignore`."""
    if not path.exists():
        path.write_text(text, encoding="utf-8", newline="\n")
    elif path.name == ".gitignore":
        old = path.read_text(encoding="utf-8")
        missing = [line for line in text.splitlines() if line not in old.splitlines()]
        path.write_text(old.rstrip("\n") + "\n" + "\n".join(missing) + "\n", encoding="utf-8", newline="\n")
