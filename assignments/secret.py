"""The secret of a course: every student's numbers are drawn from it.

Whoever reads it can compute all answers. So it is readable by its owner only, not even for a moment by others,
and a course whose secret is open or under version control is not run.
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
import stat
import subprocess
from pathlib import Path

from assignments.errors import CourseError

SECRET_FILE = ".secret"  # noqa: S105 - the name of a file
SECRET_BYTES = 32


def write_secret(path: Path) -> None:
    """Create the secret; never over an old one."""
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "w", encoding="ascii") as file:
        file.write(secrets.token_hex(SECRET_BYTES) + "\n")


def read_secret(path: Path) -> bytes:
    """Return the secret.

    Raises
    ------
    CourseError
        When it is missing, no secret, readable by others, or committed.
    """
    try:
        mode, text = path.stat().st_mode, path.read_text(encoding="ascii", errors="replace").strip()
    except OSError as error:
        hint = "Without it the variants that were handed out cannot be drawn again: restore it from a backup."
        raise CourseError(str(path), "the course's secret", error.strerror, hint) from error
    _refuse_open(path, mode)
    if not re.fullmatch(rf"[0-9a-f]{{{2 * SECRET_BYTES}}}", text):
        raise CourseError(str(path), f"{2 * SECRET_BYTES} hexadecimal digits", f"{len(text)} other characters")
    _refuse_committed(path)
    return bytes.fromhex(text)


def _refuse_open(path: Path, mode: int) -> None:
    """Refuse what others may read; where modes are not POSIX's (Windows) a user's own folder is private."""
    if os.name == "posix" and stat.S_IMODE(mode) & 0o077:
        hint = f"Who reads it can compute every answer. Run: chmod 600 {path}"
        raise CourseError(str(path), "a file that only you can read", f"mode {stat.S_IMODE(mode):03o}", hint)


def _refuse_committed(path: Path) -> None:
    """Refuse what git tracks: it is in every copy of the repository, and stays in its history."""
    if not any((folder / ".git").exists() for folder in path.resolve().parents):
        return
    git = shutil.which("git")
    if git is None:
        return
    asked = [git, "-C", str(path.parent), "log", "--all", "--oneline", "-1", "--", path.name]
    tracked = [git, "-C", str(path.parent), "ls-files", "--", path.name]
    if any(_said(command) for command in (tracked, asked)):
        hint = "Whoever has the repository can compute every answer: make a new course, outside version control."
        raise CourseError(str(path), "a secret that was never committed", "one that git knows", hint)


def _said(command: list[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=20, check=False)  # noqa: S603 - git, our path
    return done.stdout.strip() if done.returncode == 0 else ""
