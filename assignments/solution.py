"""The instructor's page: what is true of one variant, worked formula by formula, with rubric and common mistakes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from assignments.handout import TEMPLATES, number_text, symbol_html, unit_text
from assignments.model import AnswerKey, Assignment, Question
from assignments.names import Words, filled, names_in, of_every_id
from assignments.textbook import textbook_of
from assignments.theory import Mistake, Numbers, Textbook
from assignments.words import symbol_text, tolerance_text
from vml_course.io.files import replacing


@dataclass(frozen=True)
class Worked:
    """A conclusion: its formula in symbols and in this variant's numbers, what it gives and what was measured."""

    question: Question
    symbols: Markup
    numbers: str
    value: str
    measured: str


@dataclass(frozen=True)
class Wrong:
    """A common mistake and what it leads to in this variant."""

    code: str
    question: Question
    about: str
    value: str


def render_solution(assignment: Assignment, key: AnswerKey) -> str:
    """Return the page as HTML; it holds every answer, so it is never handed out."""
    environment = Environment(
        loader=FileSystemLoader(str(TEMPLATES)),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(symbol=symbol_html, number=number_text, unit=unit_text, tolerance=tolerance_text)
    measured = [question for question in assignment.questions if question.group != "conclusion"]
    return environment.get_template("solution.html.j2").render(
        assignment=assignment,
        code=key.code,
        given=key.given,
        terms=(),
        measured=[(question, printed(key.values[question.id]), _found(question, key)) for question in measured],
        worked=list(_worked(assignment, key)),
        wrong=list(_wrong(assignment, key)),
    )


def _worked(assignment: Assignment, key: AnswerKey) -> Iterator[Worked]:
    names, numbers = _printed_symbols(assignment), _numbers(assignment, key)
    concluded = {item.id: item for item in textbook_of(assignment.scene).concluded}
    for question in assignment.questions:
        if question.id in concluded:
            text = concluded[question.id].text
            value = printed(key.values[question.id])
            yield Worked(question, escape(text).format_map(names), filled(text, numbers), value, _found(question, key))


def _printed_symbols(assignment: Assignment) -> Mapping[str, str]:
    symbols = {question.id: symbol_html(question.symbol) for question in assignment.questions}
    given = {item.id: symbol_html(item.symbol) for item in assignment.givens}
    arm = symbol_html(names_in(assignment.scene)["arm"])
    return {**given, "arm": arm, **of_every_id(assignment.scene, symbols)}


def _symbols(assignment: Assignment) -> Mapping[str, str]:
    given = {item.id: symbol_text(item.symbol) for item in assignment.givens}
    return Words({**given, **names_in(assignment.scene, assignment.questions)})


def _numbers(assignment: Assignment, key: AnswerKey) -> Mapping[str, str]:
    """Return what stands for each letter: true values, those below zero in parentheses."""
    arm = names_in(assignment.scene)["arm"]
    measured = {q.id: key.values[q.id] for q in assignment.questions if q.group == "measurement"}
    texts = of_every_id(assignment.scene, {name: _inside(value) for name, value in measured.items()})
    given = {symbol: _inside(value) for symbol, value in key.given.items()}
    return Words({**given, "arm": given.get(arm, arm), **texts})


def _wrong(assignment: Assignment, key: AnswerKey) -> Iterator[Wrong]:
    book, names = textbook_of(assignment.scene), _symbols(assignment)
    numbers = _record(book, key)
    asked = {question.id: question for question in assignment.questions}
    for code in assignment.separation.mistakes:
        mistake: Mistake = book.mistakes[code]
        if mistake.quantity in asked:
            value = printed(mistake.value(numbers))
            yield Wrong(code, asked[mistake.quantity], filled(mistake.about, names), value)


def _record(book: Textbook, key: AnswerKey) -> Numbers:
    known = {item.field: key.values[item.id] for item in book.measured if item.id in key.values}
    return book.record({**book.resting(key.values), **known}, key.given, key.truth["px_per_m"])


def _found(question: Question, key: AnswerKey) -> str:
    """Return what the reference measured on this video, with its standard deviation."""
    if question.id not in key.measured:
        return ""
    sd = key.expected_sd.get(question.id, math.nan)
    return printed(key.measured[question.id]) + (f" ± {sd:.1g}" if math.isfinite(sd) else "")


def printed(value: float) -> str:
    """Return a number with four digits and a real minus sign; a dash for one that there is not.

    >>> printed(-0.123456), printed(0.0), printed(float("nan"))
    ('−0.1235', '0', '–')
    """
    if not math.isfinite(value):
        return "–"
    return f"{value if abs(value) > 1e-12 else 0.0:.4g}".replace("-", "−")


def _inside(value: float) -> str:
    text = printed(value)
    return f"({text})" if text.startswith("−") else text


def write_solution(path: Path, assignment: Assignment, key: AnswerKey) -> None:
    """Write the page; whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(render_solution(assignment, key), encoding="utf-8", newline="\n")
