"""Typed text made straight: one minus sign, one kind of space, plain digits, no invisible characters."""

from __future__ import annotations

import re
import unicodedata

from vml_course.errors import NumberError

LONGEST_TEXT = 200

_MINUS = dict.fromkeys(map(ord, "−–‐‑﹣－"), "-")
_FULL_WIDTH = {code: chr(code - 0xFEE0) for code in range(0xFF01, 0xFF5F)}
_TIMES = dict.fromkeys(map(ord, "⋅×∙•"), "·")
_RAISED_DIGITS = "⁰¹²³⁴⁵⁶⁷⁸⁹"
_RAISED = {
    **{ord(raised): str(digit) for digit, raised in enumerate(_RAISED_DIGITS)},
    ord("⁻"): "-",
    ord("⁺"): "+",
}
_TABLE = {**_FULL_WIDTH, **_MINUS, **_TIMES, ord("º"): "°", ord("∕"): "/", ord("⁄"): "/", ord("µ"): "μ"}


def straighten(text: str, name: str) -> str:
    """Return `text` with typographic variants replaced; `(a ± b) u` becomes `a u ± b u`.

    Raises
    ------
    NumberError
        When it is not a text, or longer than any number with a unit.
    """
    if not isinstance(text, str):
        raise NumberError(name, "a number as text", repr(text)[:40])
    if len(text) > LONGEST_TEXT:
        raise NumberError(name, f"a number of at most {LONGEST_TEXT} characters", f"{len(text)} characters")
    straight = "".join(map(_plain, text.translate(_TABLE)))
    straight = re.sub(f"[{_RAISED_DIGITS}⁻⁺]+", lambda run: "^" + run[0].translate(_RAISED), straight)
    straight = straight.replace("+/-", "±").replace("+-", "±").strip()
    return re.sub(r"\A\(([^()±]*)±([^()±]*)\)([^()±]*)\Z", r"\1\3±\2\3", straight)


def shown(text: str) -> str:
    """Return what was typed in quotes, short and on one line, for messages."""
    return repr(text if len(text) <= 40 else text[:37] + "...")


def _plain(character: str) -> str:
    category = unicodedata.category(character)
    if category == "Cf":
        return ""
    return " " if category in {"Zs", "Zl", "Zp"} or character in "\t\r\n" else character
