"""Which column of a platform's table is the assignment's."""

from __future__ import annotations

import re
from collections.abc import Mapping

from grader.filling.cells import TextTable
from grader.filling.job import Job
from grader.roster import folded
from vml_course.errors import TableError


def chosen_column(table: TextTable, titles: Mapping[int, str], job: Job) -> int:
    """Return the column that was named, or else the one that is called as the assignment is.

    Parameters
    ----------
    titles : mapping of int to str
        What the columns that may be filled are called, without numbers and maxima.

    Raises
    ------
    TableError
        When there is none, or several.
    """
    wanted = (job.column,) if job.column else (job.assignment.title, job.assignment.id)
    words = {_plain(word) for word in wanted}
    found = [at for at, title in titles.items() if words & {_plain(title), _plain(table.get(0, at))}]
    if len(found) == 1:
        return found[0]
    headings = ", ".join(repr(table.get(0, at)) for at in found or titles) or "none that may be filled"
    raise TableError(
        table.name,
        f"one column called {' or '.join(map(repr, wanted))}",
        headings,
        "Name the one that is meant, as its heading is written: --column HEADING.",
    )


def _plain(text: str) -> str:
    """Return a heading as it is compared: an assignment's name has strokes where its title has blanks.

    >>> _plain("Soccer kick") == _plain("soccer-kick")
    True
    """
    return re.sub(r"[\s_-]+", " ", folded(text))
