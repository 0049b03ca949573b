"""What learning platforms take back: one file a platform, each with a function `write` and its record `EXPORT`.

To add a platform, add a file; nothing else names it.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

from vml_course.errors import UnknownNameError

if TYPE_CHECKING:  # the names are for the help, which starts without gradebook and numbers
    from grader.filling.job import Export


def export_names() -> tuple[str, ...]:
    """Return the names of the exports, as they are typed: `moodle-feedback`; none of them is imported."""
    return tuple(sorted(module.name.replace("_", "-") for module in iter_modules(__path__)))


@cache
def exports() -> dict[str, Export]:
    """Return the exports by name."""
    modules = {name: import_module(f"{__name__}.{name.replace('-', '_')}") for name in export_names()}
    return {name: module.EXPORT for name, module in modules.items()}


def export_to(name: str) -> Export:
    """Return the export to a platform.

    Raises
    ------
    UnknownNameError
    """
    if name not in export_names():
        raise UnknownNameError("--to", name, export_names())
    return exports()[name]
