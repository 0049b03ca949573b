"""What a person may have to know of a workbook beside what it says; `grader.flags` has the words."""

from __future__ import annotations

from enum import StrEnum


class Flag(StrEnum):
    """Something about a workbook or its table that is not an answer."""

    MACROS = "macros"
    LINKS = "links"
    FORMULA_TO_OTHER_WORKBOOK = "formula-to-other-workbook"
    HIDDEN_SHEET = "hidden-sheet"
    FAR_CELLS = "far-cells"
    ZIPPED = "zipped"
    DATE_SYSTEM_1904 = "date-system-1904"
    UNNAMED_POINTS = "unnamed-points"
    COLUMNS_TWICE = "columns-twice"
    TEXT_IN_TRACKING = "text-in-tracking"
    DATES_IN_TRACKING = "dates-in-tracking"
    ERRORS_IN_TRACKING = "errors-in-tracking"
    UNCACHED_IN_TRACKING = "uncached-in-tracking"
