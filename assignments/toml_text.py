"""The text of a TOML file, and what is wrong with it in a person's words."""

from __future__ import annotations

import datetime as dt
import re
import tomllib
from collections.abc import Mapping
from typing import Any

from vml_course.errors import InputError

_PLACE = re.compile(r"(?P<reason>.*) \(at (?:line (?P<line>\d+), column (?P<column>\d+)|end of document)\)", re.DOTALL)
_KEYS = re.compile(r"\(((?:'[^']*',? ?)+)\)")
_LONGEST_LINE, _LONGEST_VALUE = 60, 120


class TomlError(InputError):
    """A text is no TOML, or not in UTF-8."""

    def __init__(self, name: str, got: str, hint: str) -> None:
        super().__init__(name, "TOML in UTF-8", got, hint)


def text_of(data: bytes, name: str) -> str:
    """Decode a TOML file, with or without the mark that Windows puts before UTF-8; `name` is for messages.

    Raises
    ------
    TomlError
    """
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise TomlError(name, f"other bytes at line {line}", "Save the file with the encoding UTF-8.") from error


def content_of(text: str, name: str) -> dict[str, Any]:
    """Return what a TOML file says.

    Raises
    ------
    TomlError
        It shows the line where the parser stopped, and gives its reason.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _explained(str(error), text, name) from error


def shown(value: object) -> str:
    """Return a value as a TOML file has it, on one line and cut where it is long.

    >>> shown({"due": dt.datetime(2027, 5, 2, 23, 59), "attempts": 3})
    '{ due = 2027-05-02T23:59:00, attempts = 3 }'
    """
    text = _as_written(value)
    return text if len(text) <= _LONGEST_VALUE else f"{text[: _LONGEST_VALUE - 1]}…"


def _as_written(value: object) -> str:
    if isinstance(value, dt.date | dt.time):  # a datetime is a date
        return value.isoformat()
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_as_written(one)}' for key, one in value.items())} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_as_written, value))}]"
    return repr(value)


def _explained(said: str, text: str, name: str) -> TomlError:
    """Show the line where the parser stopped, the last one that is written on where it came to the end."""
    found = _PLACE.fullmatch(said)
    reason = _KEYS.sub(lambda keys: ".".join(re.findall(r"'([^']*)'", keys[1])), found["reason"] if found else said)
    reason = reason.replace(r"character '\n'", "end of the line")
    lines = text.split("\n")
    last = max((number for number, line in enumerate(lines, start=1) if line.strip()), default=1)
    line = min(int(found["line"]), last) if found and found["line"] else last
    at = f" (column {found['column']})" if found and found["column"] and line == int(found["line"]) else ""
    got = f"{lines[line - 1].strip()[:_LONGEST_LINE]!r} at line {line}"
    return TomlError(name, got, f"The reason: {reason[:1].lower()}{reason[1:]}{at}.")
