"""Whether the image correlation kernels are compiled already, so that a first start can say why it takes a while."""

from __future__ import annotations

from pathlib import Path

METHODS_WITH_KERNELS = ("dic",)
NOTICE = "compiling the image correlation kernels, once (about 15 s) ..."


def compile_notice(method: str) -> str:
    """Return the line to say before tracking by a method, "" when nothing has to be compiled.

    numba keeps what it compiled in files named after the function and its first line; older than the source, they
    are of no use to it.
    """
    return "" if method not in METHODS_WITH_KERNELS or _is_compiled() else NOTICE


def _is_compiled() -> bool:
    from vml_course.correlate.icgn import iterate  # numba takes a third of a second to import  # noqa: PLC0415

    source = Path(iterate.py_func.__code__.co_filename)
    kept = Path(iterate.stats.cache_path).glob(f"{source.stem}.{iterate.py_func.__name__}-*.nbi")
    return any(index.stat().st_mtime >= source.stat().st_mtime for index in kept)
