"""What a scene calls its bodies and points, and what the numbers of its formulas are called."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from assignments.model import Question
from assignments.textbook import textbook_of
from assignments.words import symbol_text
from vml_course.synth.scene import Scene, scene_class


def names_in(scene: str, questions: Iterable[Question] = ()) -> Mapping[str, str]:
    """Return what sentences about an impact fill in: names of the scene's bodies and points, symbols of questions.

    `body` and `struck` are the bodies, `striker` the point that strikes, `pivot` where the body is held, `arm` the
    letter of the contact's arm; each also with a capital letter. Another word stands for itself.

    >>> names_in("soccer_kick")["striker"], names_in("swinging_door")["arm"]
    ('foot', 'a')
    """
    kind = scene_class(scene)
    if not issubclass(kind, Scene):
        return Words()
    usual = kind()
    declared, is_apart = usual.declared(), "a" in usual.given()
    body, struck = kind.bodies[0], kind.bodies[-1]
    striker = body if is_apart else str(declared.get("striker", body))
    words = {"body": body, "struck": struck, "striker": striker, "pivot": str(declared.get("knee", "pivot"))}
    words |= {name.capitalize(): word.capitalize() for name, word in words.items()}
    symbols = {question.id: symbol_text(question.symbol) for question in questions}
    return Words({**words, "arm": "a" if is_apart else "L", **(of_every_id(scene, symbols) if symbols else {})})


def of_every_id(scene: str, texts: Mapping[str, str]) -> dict[str, str]:
    """Return texts of questions under the ids of all measured numbers: of the same number, or 0 where a body rests."""
    book = textbook_of(scene)
    by_field = {item.field: texts[item.id] for item in book.measured if item.id in texts}
    resting = dict.fromkeys(book.resting(texts), "0")
    same = {item.id: {**resting, **by_field}.get(item.field, item.id) for item in book.measured}
    return {**same, **texts}


def vector_of(scene: str) -> tuple[str, str, str] | None:
    """Return the vector whose angle is measured: the name of its body, and the points from and to; None without one.

    >>> vector_of("soccer_kick")
    ('leg', 'knee', 'foot')
    """
    kind = scene_class(scene)
    if not issubclass(kind, Scene) or kind.vector is None:
        return None
    return kind.bodies[0], *kind.vector


class Words(dict[str, str]):
    """Texts by name; a name without one stands for itself."""

    def __missing__(self, word: str) -> str:
        return word


def filled(sentence: str, names: Mapping[str, str]) -> str:
    """Return a sentence with its words in braces filled in.

    >>> filled("The {striker} moves with {v_f2}.", names_in("soccer_kick"))
    'The foot moves with v_f2.'
    """
    return sentence.format_map(names)
