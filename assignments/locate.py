"""On which line of a TOML file a key stands: the parser knows what is wrong, but not where.

Keys are named as mistakes name them, `question.v_b2.points`: an entry of an array of tables by its id.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

_HEADER = re.compile(r"\s*\[(?P<array>\[?)\s*(?P<path>[^\[\]]+?)\s*\]")
_ENTRY = re.compile(r"""\s*(?P<key>(?:[\w-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[\w-]+|"[^"]*"|'[^']*'))*)\s*=(?!=)""")
_ID = re.compile(r"""\s*id\s*=\s*["'](?P<id>[^"']*)["']""")
_BY_PARSER = re.compile(r"at line (\d+)")


def line_of(text: str, key: str, got: str = "") -> int:
    r"""Return the line, counted from 1, of what a mistake is about.

    Parameters
    ----------
    text : str
        The file.
    key : str
        What the mistake names; where there is no such key, the nearest that holds it is taken.
    got : str
        What was found there; of several lines under the key, the first that says it.

    >>> line_of('title = "x"\n[draw.mass]\nlow = 1\n', "draw.mass.low")
    3
    """
    told = _BY_PARSER.search(got)
    if told:
        return int(told[1])
    places, lines, said = list(_places(text)), text.splitlines(), got.strip("'\"")
    for name in (f"{key}.{got.partition(':')[0]}", *_shorter(key)):  # a setting names itself: "crf: expected ..."
        under = [(path, number) for path, number in places if path == name or path.startswith(f"{name}.")]
        if under:
            saying = [(path, number) for path, number in under if said and said in lines[number - 1]]
            alike = [(path, number) for path, number in saying if path.endswith(key.rpartition(".")[2])]
            return next(iter(alike or saying or under))[1]
    return 1


def _shorter(key: str) -> Iterator[str]:
    """Yield a key, then what holds it."""
    steps = key.split(".")
    for count in range(len(steps), 0, -1):
        yield ".".join(steps[:count])


def _places(text: str) -> Iterator[tuple[str, int]]:
    """Yield the key of every line, the last one's for lines that go on with it."""
    lines = text.splitlines()
    table, path = "", ""
    for number, line in enumerate(lines, start=1):
        header, entry = _HEADER.match(line), _ENTRY.match(line)
        if header:
            table = _plain(header["path"])
            if header["array"]:
                table = f"{table}.{_id_below(lines[number:])}"
            path = table
        elif entry:
            path = f"{table}.{_plain(entry['key'])}".strip(".")
        if path and line.strip() and not line.lstrip().startswith("#"):
            yield path, number


def _plain(path: str) -> str:
    return "".join(path.split()).replace('"', "").replace("'", "")


def _id_below(lines: list[str]) -> str:
    """Return the id in the table that begins here, "" where it has none."""
    for line in lines:
        if _HEADER.match(line):
            break
        found = _ID.match(line)
        if found:
            return found["id"]
    return ""
