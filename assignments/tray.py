"""Where an assignment's handouts lie: a folder and a zip for each student, whole or not at all.

<home>/<pid>/{video.mp4, workbook.xlsx, handout.html}
<home>/zips/<pid>.zip           the same files
<home>/bundle-moodle.zip        the same files of all
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from assignments.bundle import BUNDLE, write_bundle, zip_bytes
from assignments.release import HANDOUT, WORKBOOK
from vml_course.errors import InputError
from vml_course.io.shelf import Shelf

ZIPS = "zips"
RESERVED = {ZIPS}


@dataclass(frozen=True)
class Tray:
    """The handouts of an assignment, on the course's shelf under `home`."""

    shelf: Shelf
    home: str

    def folder(self, student: str) -> str:
        """Return where a student's folder lies, as a person is told."""
        return self.shelf.place(self._folder(student))

    def holds(self, student: str) -> bool:
        """Tell whether a student's folder holds everything."""
        names = self.shelf.names(self._folder(student))
        return {WORKBOOK, HANDOUT} <= names and any(name.startswith("video.") for name in names)

    def put(self, student: str, files: Mapping[str, bytes]) -> None:
        """Lay a student's files out, the zip first, the workbook last of all."""
        self.shelf.write(self._zip(student), zip_bytes(files))
        self.shelf.put_files(self._folder(student), files, last=WORKBOOK)

    def mend(self, student: str) -> None:
        """Make the zip of a complete folder where there is none."""
        if not self.shelf.exists(self._zip(student)):
            folder = self._folder(student)
            files = {name: self.shelf.read(f"{folder}/{name}") for name in self.shelf.names(folder)}
            self.shelf.write(self._zip(student), zip_bytes(files))

    def bundle(self, names: Mapping[str, str]) -> str:
        """Write the bundle of all students that are named and have something; return where, "" where nobody has.

        Parameters
        ----------
        names : mapping of str to str
            The folder of each student in the bundle, by pseudonym.
        """
        made = self.shelf.names(f"{self.home}/{ZIPS}")
        zips = {folder: self._zip(pid) for pid, folder in names.items() if f"{pid}.zip" in made}
        if not zips:
            return ""
        write_bundle(self.shelf, f"{self.home}/{BUNDLE}", zips)
        return self.shelf.place(f"{self.home}/{BUNDLE}")

    def _folder(self, student: str) -> str:
        return f"{self.home}/{student}"

    def _zip(self, student: str) -> str:
        return f"{self.home}/{ZIPS}/{student}.zip"


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
