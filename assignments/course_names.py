"""Names in `course.toml` that nothing answers to: a misspelt one would lose a due date without a word."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from pathlib import Path

from assignments.course import COURSE_FILE, Course
from assignments.errors import CourseError
from assignments.load import FILE, known_assignments
from assignments.locate import line_of
from assignments.toml_text import text_of


def check_assignments(course: Course, arriving: str = "") -> None:
    """Refuse settings that name an assignment which does not exist; folders are listed, none is read.

    Parameters
    ----------
    course : Course
    arriving : str
        An assignment's folder that is about to be copied into the course (`assignments.adopt`): it counts as known.

    Raises
    ------
    CourseError
        With all such names in one line.
    """
    known, coming = list(known_assignments(course.assignments)), Path(arriving)
    if arriving and (coming / FILE).is_file():
        known.append(coming.resolve().name)
    terms = [name for name in course.calendar.terms or {} if name not in known]
    given = dict.fromkeys(one.assignment for one in course.calendar.extensions)
    extended = [name for name in given if name and name not in known]
    if not terms and not extended:
        return
    text, what = _text(course), "an assignment that there is"
    first, *others = (
        *(_stranger(line_of(text, f"assignment.{name}"), f"[assignment.{name}]", what, known, name) for name in terms),
        *(
            _stranger(line_of(text, "extension.assignment", name), "[[extension]] assignment", what, known, name)
            for name in extended
        ),
    )
    also = "".join(f" And {str(other).removeprefix(f'{COURSE_FILE}, ')}" for other in others)
    hint = f"{also} What it says would have no effect. Assignments of your own lie in {course.assignments}."
    raise CourseError(first.name, first.expected, first.got, hint)


def unknown_students(course: Course, pids: Iterable[str]) -> tuple[CourseError, ...]:
    """Return what is wrong with extensions for students who are none of `pids`: the class list may come later."""
    known = tuple(pids)
    strangers = dict.fromkeys(one.student for one in course.calendar.extensions if one.student not in known)
    text, what = _text(course) if strangers else "", "a pseudonym of the class list"
    hint = "It extends nothing so far. See: vml roster list."
    return tuple(
        _stranger(line_of(text, "extension.student", pid), "[[extension]] student", what, known, pid, hint)
        for pid in strangers
    )


def _text(course: Course) -> str:
    return text_of(course.shelf.read(COURSE_FILE), COURSE_FILE)


def _stranger(line: int, section: str, what: str, known: Sequence[str], got: str, hint: str = "") -> CourseError:
    near = difflib.get_close_matches(got, known, n=1, cutoff=0.5)
    expected = f"{what} (nearest: {near[0]})" if near else f"{what} ({', '.join(known[:20]) or 'none yet'})"
    return CourseError(f"{COURSE_FILE}, line {line}, {section}", expected, repr(got), hint)
