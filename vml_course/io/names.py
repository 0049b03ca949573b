"""Names of points and vectors as column names: valid in MATLAB, pandas and Excel tables."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

LONGEST = 31  # leaves room for the suffixes below MATLAB's 63 characters

# In a workbook `_x41_` stands for the letter with that number: such a name would come back changed.
_ESCAPE = re.compile(r"_(?=[xX][0-9A-Fa-f]+(_|$))")


def identifiers(names: Iterable[str]) -> dict[str, str]:
    """Map each name to letters, digits and underscores, unlike every other even when case is ignored.

    >>> identifiers(["ball", "left foot", "Fuß", "2nd", "BALL"])
    {'ball': 'ball', 'left foot': 'left_foot', 'Fuß': 'Fuss', '2nd': 'P2nd', 'BALL': 'BALL_2'}
    """
    taken: set[str] = set()
    mapped: dict[str, str] = {}
    for name in names:
        stem, mapped[name], number = _plain(name), _plain(name), 1
        while mapped[name].lower() in taken:
            number += 1
            mapped[name] = f"{stem}_{number}"
        taken.add(mapped[name].lower())
    return mapped


def _plain(name: str) -> str:
    ascii_name = unicodedata.normalize("NFKD", name.replace("ß", "ss")).encode("ascii", "ignore").decode()
    plain = re.sub(r"[^A-Za-z0-9]+", "_", ascii_name).strip("_") or "P"
    plain = _ESCAPE.sub("", plain)
    return (plain if plain[0].isalpha() else f"P{plain}")[:LONGEST]
