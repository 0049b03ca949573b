"""Words that workbook and handout share."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from assignments.model import Question
from vml_course.synth.scene import Scene, scene_class


def split_symbol(symbol: str) -> tuple[str, str]:
    """Split a symbol into its letter and its subscript.

    >>> split_symbol("v_f1"), split_symbol("e")
    (('v', 'f1'), ('e', ''))
    """
    letter, _, below = symbol.partition("_")
    return letter, below


_BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def symbol_text(symbol: str) -> str:
    """Return a symbol as plain text comes nearest to print: digits below the line, letters as they are.

    >>> symbol_text("ω_1"), symbol_text("v_f1"), symbol_text("e")
    ('ω₁', 'v_f1', 'e')
    """
    letter, below = split_symbol(symbol)
    return letter + below.translate(_BELOW) if below.isdigit() else symbol


def tolerance_text(question: Question) -> str:
    """Say how near an answer must come for full points."""
    relative = f"within {question.tolerance * 100:g} %"
    return f"{relative} or {question.floor:g} {question.unit}".rstrip() if question.floor else relative


def tracking_columns(points: Iterable[str]) -> tuple[str, ...]:
    """Return the header of the tracking sheet: unit in every name, metres, y up."""
    return ("frame", "t_s", *(f"{point}_{axis}_m" for point in points for axis in "xy"))


def names_in(scene: str, questions: Iterable[Question] = ()) -> Mapping[str, str]:
    """Return what sentences about an impact fill in: names of the scene's bodies and points, symbols of questions.

    `body` and `struck` are the bodies, `striker` the point that strikes, `pivot` where the body is held, `arm` the
    letter of the contact's arm; each also with a capital letter. Another word stands for itself.

    >>> names_in("soccer_kick")["striker"], names_in("swinging_door")["arm"]
    ('foot', 'a')
    """
    kind = scene_class(scene)
    if not issubclass(kind, Scene):
        return _Words()
    usual = kind()
    declared, is_apart = usual.declared(), "a" in usual.given()
    body, struck = kind.bodies[0], kind.bodies[-1]
    striker = body if is_apart else str(declared.get("striker", body))
    words = {"body": body, "struck": struck, "striker": striker, "pivot": str(declared.get("knee", "pivot"))}
    words |= {name.capitalize(): word.capitalize() for name, word in words.items()}
    symbols = {question.id: symbol_text(question.symbol) for question in questions}
    return _Words({**words, "arm": "a" if is_apart else "L", **symbols})


def vector_of(scene: str) -> tuple[str, str, str] | None:
    """Return the vector whose angle is measured: the name of its body, and the points from and to; None without one.

    >>> vector_of("soccer_kick")
    ('leg', 'knee', 'foot')
    """
    kind = scene_class(scene)
    if not issubclass(kind, Scene) or kind.vector is None:
        return None
    return kind.bodies[0], *kind.vector


class _Words(dict[str, str]):
    def __missing__(self, word: str) -> str:
        return word


def filled(sentence: str, names: Mapping[str, str]) -> str:
    """Return a sentence with its words in braces filled in.

    >>> filled("The {striker} moves with {v_f2}.", names_in("soccer_kick"))
    'The foot moves with v_f2.'
    """
    return sentence.format_map(names)
