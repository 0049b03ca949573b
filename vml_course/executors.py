"""Who does the work: this process, or several, behind one interface.

Only `submit(fn, one_record)` is used, with a module-level `fn` and a small frozen record, so that the
same call runs here, in processes or on a cluster.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from typing import Any

from vml_course.errors import InputError


class SerialExecutor(Executor):
    """Runs each task at once in this process; a failing task fails its own future only."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run `fn` now and return its finished future."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - it belongs to the future, as in every executor
            future.set_exception(error)
        return future


def open_executor(workers: int) -> Executor:
    """Return an executor for `workers` processes; 1 stays in this process.

    Processes are spawned, not forked: the same on Windows, macOS and Linux, and safe beside threads.

    Raises
    ------
    InputError
        When `workers` is less than 1.
    """
    if workers < 1:
        raise InputError("workers", "1 or more", workers)
    if workers == 1:
        return SerialExecutor()
    return ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"))
