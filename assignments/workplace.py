"""Where handouts are made: a hidden folder whose name tells whose it is, so that a dead one can go.

A run that was killed cannot clean up after itself; the next one does.
"""

from __future__ import annotations

import datetime as dt
import os
import platform
import re
import shutil
import tempfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PREFIX = ".making-"
TOO_OLD = dt.timedelta(days=1)
_OURS = re.compile(re.escape(PREFIX) + r"(?P<machine>[0-9a-f]{8})-(?P<process>[0-9]+)-.+")


def workplace_prefix(process: int | None = None) -> str:
    """Return how the name of a working folder begins: this machine (a shared drive has several), this process."""
    return f"{PREFIX}{_machine()}-{os.getpid() if process is None else process}-"


@contextmanager
def working_folder(parent: Path | None = None) -> Iterator[Path]:
    """Give a folder that only its owner can read, gone after the block; what dead runs left beside it goes first.

    Parameters
    ----------
    parent : Path, optional
        The system's folder for temporary files when not given: a worker needs no course.
    """
    parent = parent or Path(tempfile.gettempdir())
    sweep(parent)
    with tempfile.TemporaryDirectory(prefix=workplace_prefix(), dir=parent, ignore_cleanup_errors=True) as folder:
        yield Path(folder)


def sweep(parent: Path) -> None:
    """Remove working folders whose process is gone, or in which nothing was begun for a day."""
    for folder in parent.glob(f"{PREFIX}*"):
        if folder.is_dir() and not folder.is_symlink() and _is_left_over(folder):
            shutil.rmtree(folder, ignore_errors=True)


def _is_left_over(folder: Path) -> bool:
    try:
        changed = dt.datetime.fromtimestamp(folder.stat().st_mtime, dt.UTC)
    except OSError:  # another run was quicker
        return False
    if dt.datetime.now(dt.UTC) - changed > TOO_OLD:
        return True
    owner = _OURS.fullmatch(folder.name)
    return owner is not None and owner["machine"] == _machine() and _is_gone(int(owner["process"]))


def _is_gone(process: int) -> bool:
    """Tell whether a process of this machine has ended; where asking could end it (Windows), say no."""
    if os.name != "posix":
        return False
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return True
    except OSError:
        return False
    return False


def _machine() -> str:
    return f"{zlib.crc32(platform.node().encode()):08x}"
