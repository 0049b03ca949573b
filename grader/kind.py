"""What cells hold: a word of its own, because the process that reads workbooks starts without numpy and our model."""

from __future__ import annotations

from enum import StrEnum


class Kind(StrEnum):
    """What a cell holds."""

    NUMBER = "number"
    TEXT = "text"
    BOOL = "bool"
    DATE = "date"
    ERROR = "error"
    UNCACHED = "uncached"  # a formula that no program has worked out yet
    BLANK = "blank"
