"""One file an impact model: each defines `TEXTBOOK`, found here by looking through the folder."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from functools import cache

from assignments.theory import Mistake, Textbook
from vml_course.errors import UnknownNameError
from vml_course.synth.scene import scene_class


@cache
def _textbooks() -> dict[str, Textbook]:
    modules = (importlib.import_module(f"{__name__}.{found.name}") for found in pkgutil.iter_modules(__path__))
    return {module.TEXTBOOK.model: module.TEXTBOOK for module in modules}


def textbook_names() -> tuple[str, ...]:
    """Return the impact models that there is a textbook of, sorted."""
    return tuple(sorted(_textbooks()))


def textbook(model: str) -> Textbook:
    """Return the textbook of an impact model.

    Raises
    ------
    UnknownNameError
    """
    if model not in _textbooks():
        raise UnknownNameError("model", model, textbook_names())
    return _textbooks()[model]


def textbook_of(scene: str) -> Textbook:
    """Return the textbook of a scene's impact.

    Raises
    ------
    UnknownNameError
    """
    return textbook(scene_class(scene).model)


@cache
def every_mistake() -> Mapping[str, Mistake]:
    """Return the mistakes of all textbooks by code."""
    return {code: mistake for book in _textbooks().values() for code, mistake in book.mistakes.items()}
