"""How learning platforms name the files in their downloads: one file a platform, each with one function `recognise`.

To add a platform, add a file; nothing else names it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from grader.lms.named import Named
from vml_course.errors import UnknownNameError

AUTO = "auto"


@cache
def platforms() -> dict[str, Callable[[str], Named | None]]:
    """Return what recognises the names of each platform."""
    modules = sorted(m.name for m in iter_modules(__path__) if m.name != "named")
    return {name: import_module(f"{__name__}.{name}").recognise for name in modules}


def recognise(path: str, platform: str = AUTO) -> Named | None:
    """Return what a file's name in a download says, None when it says nothing.

    Parameters
    ----------
    path : str
        With slashes, relative to the download.
    platform : str
        One of `platforms`, or "auto": the first that knows the name.

    Raises
    ------
    UnknownNameError
        When there is no such platform.
    """
    known = platforms()
    if platform != AUTO and platform not in known:
        raise UnknownNameError("lms", platform, (AUTO, *known))
    asked = known.values() if platform == AUTO else (known[platform],)
    found = (one(path) for one in asked)
    return next((named for named in found if named is not None), None)
