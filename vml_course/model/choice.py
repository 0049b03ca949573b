"""A setting that is a word, declared once: default, the words there are, meaning; the sister of `quantity`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from typing import Any

from vml_course.errors import UnknownNameError


@dataclass(frozen=True, slots=True)
class Choice:
    """What is declared of one word."""

    name: str
    default: str
    words: tuple[str, ...]
    about: str


def choice(default: str, words: Iterable[str], *, about: str = "") -> Any:
    """Declare a dataclass field that is one of some words.

    Parameters
    ----------
    default : str
        One of the words.
    words : iterable of str
    about : str
        One phrase that a student understands.
    """
    return field(default=default, metadata={"choice": {"words": tuple(words), "about": about}})


def choices_of(record: Any) -> dict[str, Choice]:
    """Return the words of a dataclass (or of its instance) by field name, in declared order."""
    return {
        item.name: Choice(name=item.name, default=str(item.default), **item.metadata["choice"])
        for item in fields(record)
        if "choice" in item.metadata
    }


def check_choices(record: Any) -> None:
    """Check every word of an instance; call it from `__post_init__`.

    Raises
    ------
    UnknownNameError
    """
    for name, declared in choices_of(record).items():
        if getattr(record, name) not in declared.words:
            raise UnknownNameError(name, getattr(record, name), declared.words)
