"""Where an assignment's handouts lie: a folder and a zip for each student, whole or not at all.

<home>/<pid>/{video.mp4, workbook.xlsx, handout.html}
<home>/zips/<pid>.zip           the same files
<home>/bundle-moodle.zip        the same files of all
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from assignments.bundle import BUNDLE, write_bundle, zip_bytes
from assignments.release import HANDOUT, WORKBOOK
from vml_course.errors import InputError
from vml_course.io.files import replacing

ZIPS = "zips"
RESERVED = {ZIPS}


@dataclass(frozen=True)
class Shelf:
    """The folder of an assignment's handouts."""

    home: Path

    def folder(self, student: str) -> Path:
        """Return a student's folder."""
        return self.home / student

    def zip(self, student: str) -> Path:
        """Return a student's zip."""
        return self.home / ZIPS / f"{student}.zip"

    def holds(self, student: str) -> bool:
        """Tell whether a student's folder holds everything: it takes its name last of all."""
        return is_complete(self.folder(student))

    def put(self, student: str, files: Mapping[str, bytes], work: Path) -> None:
        """Lay a student's files out, the zip first; `work` is a folder beside, for what is not complete yet."""
        self._write_zip(student, files)
        new, folder = work / f"new-{student}", self.folder(student)
        new.mkdir()
        for name, data in files.items():
            (new / name).write_bytes(data)
        if folder.exists():  # what an interrupted run may have left
            folder.rename(work / f"old-{student}")
        new.rename(folder)

    def mend(self, student: str) -> None:
        """Make the zip of a complete folder where there is none."""
        if not self.zip(student).is_file():
            files = {path.name: path.read_bytes() for path in self.folder(student).iterdir() if path.is_file()}
            self._write_zip(student, files)

    def bundle(self, names: Mapping[str, str]) -> Path | None:
        """Write the bundle of all students that are named and have something; None where nobody has.

        Parameters
        ----------
        names : mapping of str to str
            The folder of each student in the bundle, by pseudonym.
        """
        zips = {folder: self.zip(pid) for pid, folder in names.items() if self.zip(pid).is_file()}
        if not zips:
            return None
        write_bundle(self.home / BUNDLE, zips)
        return self.home / BUNDLE

    def _write_zip(self, student: str, files: Mapping[str, bytes]) -> None:
        self.zip(student).parent.mkdir(parents=True, exist_ok=True)
        with replacing(self.zip(student)) as temporary:
            temporary.write_bytes(zip_bytes(files))


def is_complete(folder: Path) -> bool:
    """Tell whether a student's folder holds everything."""
    return all((folder / name).is_file() for name in (WORKBOOK, HANDOUT)) and any(folder.glob("video.*"))


def check_pseudonyms(students: Iterable[str]) -> None:
    """Refuse what cannot name a folder.

    Raises
    ------
    InputError
    """
    for student in students:
        is_plain = bool(student) and all(c.isascii() and (c.isalnum() or c in "-_") for c in student)
        if not is_plain or student in RESERVED:
            raise InputError("student", "a pseudonym of letters, digits, - and _", repr(student))
