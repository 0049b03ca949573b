"""What the HTML pages share: how outcomes, numbers and symbols look, and where the templates come from.

Every text that came from a workbook is hostile until a template has escaped it; there is no script.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache

import jinja2
from markupsafe import Markup, escape

from assignments.words import split_symbol
from grader.model import Finding, Outcome, overall

WORDS = {Outcome.RIGHT: "right", Outcome.PARTIAL: "partly right", Outcome.WRONG: "wrong", Outcome.UNSURE: "unsure"}
GLYPHS = {Outcome.RIGHT: "✓", Outcome.PARTIAL: "◐", Outcome.WRONG: "✗", Outcome.UNSURE: "?"}


@dataclass(frozen=True)
class Verdict:
    """How a question ended, for the page: `mark` is a shape, `word` says the same."""

    outcome: str
    mark: str
    word: str


def verdict(findings: Sequence[Finding]) -> Verdict:
    """Return how a question ended: its worst finding; an error that was carried on is shown as such."""
    outcome = overall((f.outcome for f in findings), sum(f.points for f in findings), sum(f.out_of for f in findings))
    if outcome is Outcome.RIGHT and any(finding.carried for finding in findings):
        return Verdict("carried", "↪", "carried on")
    return verdict_of(outcome)


def verdict_of(outcome: Outcome) -> Verdict:
    """Return an outcome for the page."""
    return Verdict(outcome.value, GLYPHS[outcome], WORDS[outcome])


# ---------------------------------------------------------------- words


def points_text(points: float, *, is_provisional: bool = False) -> str:
    """Return points with two decimals at most, halves rounded up; provisional ones may become fewer.

    >>> points_text(17.525), points_text(20.0), points_text(6, is_provisional=True)
    ('17.53', '20', 'up to 6')
    """
    return f"{'up to ' if is_provisional else ''}{math.floor(points * 100 + 0.5 + 1e-9) / 100:g}"


def earned_text(findings: Iterable[Finding]) -> str:
    """Return what findings earned, such as `up to 3 / 4`."""
    findings = tuple(findings)
    is_provisional = any(f.outcome is Outcome.UNSURE and f.out_of > 0 for f in findings)
    earned = points_text(sum(f.points for f in findings), is_provisional=is_provisional)
    return f"{earned} / {points_text(sum(f.out_of for f in findings))}"


def symbol(text: str) -> Markup:
    """Return a symbol with its subscript.

    >>> symbol("v_f1")
    Markup('v<sub>f1</sub>')
    """
    letter, below = split_symbol(text)
    return escape(letter) + (Markup("<sub>{}</sub>").format(below) if below else Markup())


def prose(text: str, symbols: Iterable[str]) -> Markup:
    """Return a sentence with the subscripts of the symbols in it; all else is escaped.

    >>> prose("v_b2 < v_f1", ["e", "v_b2"])
    Markup('v<sub>b2</sub> &lt; v_f1')
    """
    known = [one for one in symbols if split_symbol(one)[1]]
    parts = re.split(rf"(?<!\w)({'|'.join(map(re.escape, known))})(?!\w)", text) if known else [text]
    return Markup().join(symbol(part) if part in known else escape(part) for part in parts)


def unit_text(text: str) -> str:
    """Return a text with raised digits in its unit.

    >>> unit_text("1.88 kg m^2")
    '1.88 kg m²'
    """
    return text.replace("^2", "²")


def number(value: float, digits: int = 4) -> str:
    """Return a number with four digits and a real minus sign.

    >>> number(-0.123456), number(15.0)
    ('−0.1235', '15')
    """
    text = f"{value + 0.0:.{digits}g}"
    return ("0" if text == "-0" else text).replace("-", "−")


def counted(count: int, one: str, many: str = "") -> str:
    """Return a number with its noun.

    >>> counted(1, "attempt"), counted(0, "attempt")
    ('1 attempt', '0 attempts')
    """
    return f"{count} {one if count == 1 else many or one + 's'}"


@cache
def template(name: str) -> jinja2.Template:
    """Return a template of this package; everything that it prints is escaped."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("grader", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(name)
