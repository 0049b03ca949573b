"""Checks: one file each, found by its name; a check's docstring is what the student reads.

A check is one function of the file's own name, `(asked: Asked) -> tuple[Finding, ...]`. To add one, add a file
here and name it in an assignment's `check = "..."`.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable
from functools import cache

from grader.model import Asked, Finding
from vml_course.errors import UnknownNameError

Check = Callable[[Asked], tuple[Finding, ...]]


@cache
def check_names() -> tuple[str, ...]:
    """Return the names of all checks."""
    return tuple(sorted(module.name for module in pkgutil.iter_modules(__path__)))


@cache
def check_named(name: str) -> Check:
    """Return a check.

    Raises
    ------
    UnknownNameError
    """
    if name not in check_names():
        raise UnknownNameError("check", name, check_names())
    check: Check = getattr(importlib.import_module(f"{__name__}.{name}"), name)
    return check


def explanation_of(name: str) -> str:
    """Return what the student reads about a check."""
    return " ".join((inspect.getdoc(check_named(name)) or "").split())
