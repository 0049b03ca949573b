"""Where an assignment's handouts lie: a folder and a zip for each student, and bundles of all, on a course's shelf.

    handouts/<assignment>/<pid>/{handout.html, video.mp4, workbook.xlsx}
    handouts/<assignment>/zips/<pid>.zip            the same files; written last, it says that a student has everything
    handouts/<assignment>/bundle-moodle.zip         the same files of all; -2, -3 ... where one would be too large

Who has something is read from two listings, however large the class. To have a student's files made anew, remove
the zip.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from assignments.bundle import unzipped, zip_bytes
from assignments.course import HANDOUTS
from assignments.release import WORKBOOK
from vml_course.errors import FileMissingError, InputError
from vml_course.io.shelf import Shelf

ZIPS = "zips"
PART_BYTES = 100_000_000  # of a bundle: platforms refuse larger files, or need much memory for them

Entry = list[str]
"""A student's pseudonym, and the name of the folder in the bundle."""

Parts = list[list[Entry]]


@dataclass(frozen=True)
class Handouts:
    """One assignment's handouts on a shelf."""

    shelf: Shelf
    assignment_id: str

    @property
    def home(self) -> str:
        """Name of the folder that holds all of them."""
        return f"{HANDOUTS}/{self.assignment_id}"

    def place(self, student: str) -> str:
        """Return where a student's folder lies, as a person is told."""
        return self.shelf.place(f"{self.home}/{student}")

    def complete(self) -> frozenset[str]:
        """Return the pseudonyms of those who have everything."""
        zips = self.shelf.names(f"{self.home}/{ZIPS}")
        return frozenset(name for name in self.shelf.names(self.home) if f"{name}.zip" in zips)

    def put(self, student: str, files: Mapping[str, bytes]) -> None:
        """Lay a student's files out, the zip last."""
        self.shelf.put_files(f"{self.home}/{student}", files, last=WORKBOOK)
        self.shelf.write(self._zip(student), zip_bytes(files))

    def put_bundle(self, names: Mapping[str, str]) -> list[str]:
        """Write the bundle of all students who have everything, in parts; return where they lie.

        Parts that would hold what they hold are left alone.

        Parameters
        ----------
        names : mapping of str to str
            The folder of each student in the bundle, by pseudonym, in an order in which newcomers come last.
        """
        complete, old = self.complete(), self._parts()
        wanted = [[pid, folder] for pid, folder in names.items() if pid in complete]
        kept = kept_parts(old, wanted)
        parts = list(kept)
        for part in self._filled(wanted[sum(map(len, kept)) :]):
            self.shelf.write(self._part(len(parts)), zip_bytes(part.files))
            parts.append(part.students)
        for surplus in range(len(parts), len(old)):
            self.shelf.write(self._part(surplus), zip_bytes({}))
        if parts != old:
            self._write_parts(parts)
        return [self.shelf.place(self._part(number)) for number in range(len(parts))]

    def open_bundle(self, students: Iterable[str]) -> None:
        """Forget the parts in which these students are, before their files are made anew."""
        again, old = set(students), self._parts()
        first = next((n for n, part in enumerate(old) if again & {pid for pid, _ in part}), len(old))
        if first < len(old):
            self._write_parts(old[:first])

    def _filled(self, wanted: Sequence[Entry]) -> Iterator[Filled]:
        part = Filled()
        for pid, folder in wanted:
            files = unzipped(self.shelf.read(self._zip(pid)))
            if part.students and part.size + sum(map(len, files.values())) > PART_BYTES:
                yield part
                part = Filled()
            part.add(pid, folder, files)
        if part.students:
            yield part

    def _parts(self) -> Parts:
        try:
            content = json.loads(self.shelf.read(self._parts_name()))
        except (FileMissingError, ValueError):
            return []
        return content if isinstance(content, list) else []

    def _write_parts(self, parts: Parts) -> None:
        self.shelf.write(self._parts_name(), (json.dumps(parts) + "\n").encode())

    def _parts_name(self) -> str:
        return f"{self.home}/bundle.json"

    def _part(self, number: int) -> str:
        return f"{self.home}/bundle-moodle{f'-{number + 1}' if number else ''}.zip"

    def _zip(self, student: str) -> str:
        return f"{self.home}/{ZIPS}/{student}.zip"


@dataclass
class Filled:
    """One part of a bundle as it fills: whose files, and the files by their place in it."""

    students: list[Entry] = field(default_factory=list)
    files: dict[str, bytes] = field(default_factory=dict)
    size: int = 0

    def add(self, pid: str, folder: str, files: Mapping[str, bytes]) -> None:
        """Add a student's files in their folder."""
        self.students.append([pid, folder])
        self.files |= {f"{folder}/{name}": data for name, data in files.items()}
        self.size += sum(map(len, files.values()))


def kept_parts(old: Parts, wanted: Sequence[Entry]) -> Parts:
    """Return the parts of a bundle that stay as they are; the last one stays only where nobody is to be added.

    >>> kept_parts([["ab"], ["cd"]], ["ab", "cd", "ef"])
    [['ab']]
    """
    kept: Parts = []
    for number, part in enumerate(old, start=1):
        start = sum(map(len, kept))
        is_last = number == len(old)
        if list(wanted[start : start + len(part)]) != part or (is_last and start + len(part) < len(wanted)):
            break
        kept.append(part)
    return kept


def check_pseudonyms(students: Iterable[str]) -> None:
    """Refuse what cannot name a folder.

    Raises
    ------
    InputError
    """
    for student in students:
        is_plain = bool(student) and all(c.isascii() and (c.isalnum() or c in "-_") for c in student)
        if not is_plain or student == ZIPS:
            raise InputError("student", "a pseudonym of letters, digits, - and _", repr(student))
