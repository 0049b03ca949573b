"""The reader's flags in words: for the student, and for the person who looks at what could not be judged."""

from __future__ import annotations

from collections.abc import Mapping

from grader.read.flags import Flag

FOR_STUDENT: Mapping[Flag, str] = {
    Flag.MACROS: "The workbook holds macros; they are not run, and a person will see that.",
    Flag.LINKS: "The workbook refers to another one; a person will see that.",
    Flag.FORMULA_TO_OTHER_WORKBOOK: "A formula refers to another workbook; a person will see that.",
    Flag.HIDDEN_SHEET: "A hidden sheet is not read.",
    Flag.FAR_CELLS: "Cells far to the right or below are not read.",
    Flag.ZIPPED: "The workbook came packed; hand it in unpacked.",
    Flag.DATE_SYSTEM_1904: "The workbook counts days from 1904; dates in it may look shifted.",
    Flag.UNNAMED_POINTS: "Points of the tracking table have names that are not the assignment's; name its columns as "
    "the sheet Tracking came to you.",
    Flag.COLUMNS_TWICE: "Two columns of the tracking table are called the same and differ; the first one counts.",
    Flag.TEXT_IN_TRACKING: "Some cells of the tracking table hold text; they count as empty.",
    Flag.DATES_IN_TRACKING: "Some cells of the tracking table are dates; set their format to Number and paste again.",
    Flag.ERRORS_IN_TRACKING: "Some cells of the tracking table end in an error; they count as empty.",
    Flag.UNCACHED_IN_TRACKING: "Formulas of the tracking table were never worked out: open the workbook in Excel, "
    "press Ctrl+Alt+F9 and save.",
}

FOR_PERSON: Mapping[Flag, str] = {
    Flag.MACROS: "The workbook carries macros.",
    Flag.LINKS: "The workbook has links to other files.",
    Flag.FORMULA_TO_OTHER_WORKBOOK: "A formula points to another workbook.",
    Flag.HIDDEN_SHEET: "The workbook has a hidden sheet that is not ours.",
}
"""Flags for which a person looks at a workbook whatever it says."""

FOR_PERSON_OF_TABLE: Mapping[Flag, str] = {
    Flag.UNNAMED_POINTS: "Points of the tracking table have names that are not the assignment's.",
    Flag.COLUMNS_TWICE: "Two columns of the tracking table are called the same and differ.",
    Flag.TEXT_IN_TRACKING: "Cells of the tracking table hold text.",
    Flag.DATES_IN_TRACKING: "Cells of the tracking table are dates.",
    Flag.ERRORS_IN_TRACKING: "Cells of the tracking table end in an error.",
    Flag.UNCACHED_IN_TRACKING: "Formulas of the tracking table were never worked out.",
}
"""Flags of the table: where it is found right all the same, nobody has to look."""

HARMLESS = frozenset({Flag.FAR_CELLS, Flag.ZIPPED, Flag.DATE_SYSTEM_1904})
"""What no judgement depends on: the student alone is told."""
