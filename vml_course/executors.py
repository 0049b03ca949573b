"""Who does the work: this process, several, or a cluster, behind one interface.

Only `submit(fn, one_record)` is used, with a module-level `fn` and a small frozen record, so that the
same call runs here, in processes or on a cluster. The result comes back small, too.
"""

from __future__ import annotations

import multiprocessing
import os
import queue
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from itertools import islice
from typing import Any, Self, TypeVar

from vml_course.errors import InputError, PackageMissingError, WorkerDiedError

TRIES = 3  # of a task whose worker dies
PATIENCE_S = 10.0  # until a scheduler has answered
AHEAD = 2  # tasks for each worker that are under way or wait: one to do, one at hand
LOCAL, ANY_PORT = "local:", "127.0.0.1:0"

Record = TypeVar("Record")


class Crew(Executor):
    """An executor that knows how many tasks it should be given at once."""

    @property
    def most_under_way(self) -> int:
        """How many tasks keep every worker busy; more would only take memory."""
        return 1

    def __exit__(self, kind: object, *_: object) -> None:
        """Let tasks that run end; where something went wrong outside, those that wait are not begun."""
        self.shutdown(wait=True, cancel_futures=kind is not None)


class SerialExecutor(Crew):
    """Runs each task at once in this process; a failing task fails its own future only."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run `fn` now and return its finished future."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - it belongs to the future, as in every executor
            future.set_exception(error)
        return future


class ProcessesExecutor(Crew):
    """Workers that are processes, each with a queue of its own.

    When one dies it is known which task it died of, and no other task is disturbed: that task is tried again in a
    fresh process, `TRIES` times at most. Processes are spawned, not forked: the same on Windows, macOS and
    Linux, and safe beside threads.
    """

    def __init__(self, workers: int) -> None:
        self._workers = workers
        self._threads = ThreadPoolExecutor(workers)
        self._idle: queue.SimpleQueue[ProcessPoolExecutor] = queue.SimpleQueue()
        for _ in range(workers):
            self._idle.put(_one_process())

    @property
    def most_under_way(self) -> int:
        """Return enough for every process to find its next task waiting."""
        return AHEAD * self._workers

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run `fn` in the next process that is free."""
        return self._threads.submit(self._run, fn, args, kwargs)

    def _run(self, fn: Callable[..., Any], args: Any, kwargs: Any) -> Any:
        for _ in range(TRIES):
            process = self._idle.get()
            try:
                return process.submit(fn, *args, **kwargs).result()
            except BrokenProcessPool:
                process.shutdown(wait=False)
                process = _one_process()
            finally:
                self._idle.put(process)
        raise WorkerDiedError(TRIES)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: FBT001, FBT002 - as inherited
        """End the processes when their tasks are done."""
        self._threads.shutdown(wait=wait, cancel_futures=cancel_futures)
        while not self._idle.empty():
            self._idle.get().shutdown(wait=wait)


class ClusterExecutor(Crew):
    """Workers of a dask cluster; a task whose worker dies is given to another by the scheduler."""

    def __init__(self, address: str) -> None:
        distributed = _distributed()
        self._cluster = _local_cluster(distributed, address) if address.startswith(LOCAL) else None
        try:
            self._client = distributed.Client(self._cluster or address, timeout=PATIENCE_S)
        except (OSError, ValueError, TypeError) as error:
            expected = "the address of a dask scheduler, such as tcp://10.0.0.5:8786, or local:4"
            raise InputError("cluster", expected, repr(address), f"({error})") from error
        self._executor = self._client.get_executor(pure=False)

    @property
    def most_under_way(self) -> int:
        """Return what keeps the workers busy that are there now; a cluster grows and shrinks."""
        threads: dict[str, int] = self._client.nthreads()
        return AHEAD * max(1, sum(threads.values()))

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run `fn` on the cluster."""
        future: Future[Any] = self._executor.submit(fn, *args, **kwargs)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: FBT001, FBT002 - as inherited
        """Leave the cluster; one that was started here ends."""
        self._executor.shutdown(wait=wait and not cancel_futures)
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()

    def __enter__(self) -> Self:
        return self


def open_executor(workers: int = 1, cluster: str = "") -> Crew:
    """Return an executor for `workers` processes, or for a cluster; 1 worker stays in this process.

    Parameters
    ----------
    workers : int
    cluster : str
        Address of a dask scheduler; `local:N` starts one on this machine, with N worker processes.

    Raises
    ------
    InputError
        When `workers` is less than 1, or no scheduler answers.
    PackageMissingError
        When a cluster is asked for and dask is not installed.
    """
    if cluster:
        return ClusterExecutor(cluster)
    if workers < 1:
        raise InputError("workers", "1 or more", workers)
    return SerialExecutor() if workers == 1 else ProcessesExecutor(workers)


def each_done(
    executor: Crew, fn: Callable[[Record], Any], records: Iterable[Record]
) -> Iterator[tuple[Record, Future[Any]]]:
    """Yield each record with its finished future, whichever is first.

    Only so many are under way as keep the workers busy: ten thousand orders cost no more memory than ten.
    """
    waiting = iter(records)
    under_way: dict[Future[Any], Record] = {}
    while True:
        for record in islice(waiting, max(0, executor.most_under_way - len(under_way))):
            under_way[executor.submit(fn, record)] = record
        if not under_way:
            return
        for future in wait(under_way, return_when=FIRST_COMPLETED).done:
            yield under_way.pop(future), future


# ---------------------------------------------------------------- worker processes


def _one_process() -> ProcessPoolExecutor:
    return ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn"), initializer=_begin_work)


def _begin_work() -> None:
    """Leave Ctrl-C to the parent, and end when it does: one that was killed cannot tell its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, name="end-with-parent", daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


# ---------------------------------------------------------------- cluster


def _distributed() -> Any:
    try:
        import distributed  # noqa: PLC0415 - only who asks for a cluster needs it
    except ImportError as error:
        raise PackageMissingError("cluster", "distributed", "pip install vml-course[cluster]") from error
    return distributed


def _local_cluster(distributed: Any, address: str) -> Any:
    """Start a cluster on this machine that nobody else can reach."""
    count = address.removeprefix(LOCAL)
    if not (count.isascii() and count.isdecimal() and 1 <= int(count) <= 512):
        raise InputError("cluster", "local:N with 1 to 512 workers", repr(address))
    return distributed.LocalCluster(
        n_workers=int(count),
        threads_per_worker=1,
        processes=True,
        protocol="tcp",
        host="127.0.0.1",
        dashboard_address=None,
        scheduler_kwargs={"dashboard_address": ANY_PORT},  # it answers over HTTP all the same, and never where all hear
        worker_dashboard_address=ANY_PORT,
        silence_logs=50,
    )
