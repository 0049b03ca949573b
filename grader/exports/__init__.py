"""What learning platforms take back: one file a platform, each with a function `write` and its record `EXPORT`.

To add a platform, add a file; nothing else names it.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from grader.filling.job import Export
from vml_course.errors import UnknownNameError


@cache
def exports() -> dict[str, Export]:
    """Return the exports by name, as it is typed: `moodle-feedback`."""
    names = sorted(module.name for module in iter_modules(__path__))
    return {name.replace("_", "-"): import_module(f"{__name__}.{name}").EXPORT for name in names}


def export_to(name: str) -> Export:
    """Return the export to a platform.

    Raises
    ------
    UnknownNameError
    """
    if name not in exports():
        raise UnknownNameError("--to", name, exports())
    return exports()[name]
