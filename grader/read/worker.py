"""Reading in a process of its own: whatever a file does to the reader, the batch goes on.

The process is long-lived, because starting one costs more than reading a file, and is replaced when it dies, falls
silent or has read many files. It is a plain child that speaks through its two pipes, so that it works the same
on Windows and inside a daemonic worker of a cluster. What comes back is unpickled with a short list of our own
classes: bytes that a student's file might have put there can make a cell, nothing else.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import gc
import io
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import IO

from grader.kind import Kind
from grader.read import limits
from grader.read.book import Book, ReadRequest, Sheet, read_workbook, shown_name
from grader.read.errors import OUR_TEMPLATE, ReaderFailedError, UnreadableError
from grader.read.flags import Flag

try:
    import resource
except ImportError:  # pragma: no cover - Windows
    resource = None  # type: ignore[assignment]

_COMMAND = "from grader.read.worker import serve; serve()"
_READY = b"ready"
_LENGTH_BYTES = 8
_PLAIN = {(kind.__module__, kind.__qualname__): kind for kind in (Book, Sheet, Kind, Flag)}


class Reader:
    """Reads one file after another in a limited process; use it as a context, from any number of threads.

    Parameters
    ----------
    wall_s : float
        How long a file may take.
    files_per_process : int
        After so many files the process is replaced.
    command : str
        The Python statement that the process runs.
    """

    def __init__(self, wall_s: float = limits.WALL_S, files_per_process: int = 200, *, command: str = _COMMAND) -> None:
        self._wall_s, self._files_per_process, self._command = wall_s, files_per_process, command
        self._process: subprocess.Popen[bytes] | None = None
        self._files_read = 0
        self._lock = threading.Lock()

    def __enter__(self) -> Reader:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def read(self, request: ReadRequest) -> Book:
        """Read any bytes as a workbook, as `read_workbook` does.

        A file that ends the process is tried once more in a fresh one when others had been read there before it.

        Raises
        ------
        UnreadableError
            It is no workbook, or reading it took too much memory or time.
        ReaderFailedError
            No process could be started: our failure, not the file's.
        """
        if len(request.data) > limits.FILE_BYTES:
            return read_workbook(request)  # refused by its size alone: not worth sending
        with self._lock:
            was_fresh = self._files_read == 0
            answer = self._ask(request)
            if answer is None and not was_fresh:
                answer = self._ask(request)
        if answer is None:
            raise UnreadableError(
                shown_name(request.name),
                "one that takes far more memory or time to read than a workbook should",
                OUR_TEMPLATE,
            )
        if isinstance(answer, Book):
            return answer
        raise UnreadableError(*answer)

    def close(self) -> None:
        """End the process."""
        process, self._process, self._files_read = self._process, None, 0
        if process is not None:
            process.kill()
            process.communicate()

    def _ask(self, request: ReadRequest) -> Book | tuple[str, str, str] | None:
        """Return what the process says of a file; None when it died or said nothing in time."""
        process = self._process or self._start()
        self._files_read += 1
        answer = _unpickled(self._within(self._wall_s, process, lambda: _exchange(process, pickle.dumps(request))))
        if answer is None or self._files_read >= self._files_per_process:
            self.close()
        return answer

    def _start(self) -> subprocess.Popen[bytes]:
        self._process = process = subprocess.Popen(  # noqa: S603 - our own statement, no word of it is a user's
            [sys.executable, "-P", "-c", self._command],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=_environment(),
        )
        if self._within(limits.START_S, process, lambda: _received(_pipe(process.stdout))) != _READY:
            self.close()
            raise ReaderFailedError
        return process

    @staticmethod
    def _within(seconds: float, process: subprocess.Popen[bytes], ask: Callable[[], bytes | None]) -> bytes | None:
        """Ask, and kill the process when it has not answered in time: its pipes then end, on every system."""
        alarm = threading.Timer(seconds, process.kill)
        alarm.daemon = True
        alarm.start()
        try:
            return ask()
        finally:
            alarm.cancel()


@functools.cache
def _shared_reader(process: int) -> Reader:
    """Return the reader of a process; one that was forked may not speak through its parent's pipes."""
    reader = Reader()
    atexit.register(_close_own, reader, process)
    return reader


def _close_own(reader: Reader, process: int) -> None:
    if os.getpid() == process:
        reader.close()


def read_isolated(request: ReadRequest) -> Book:
    """Read a workbook in the one reading process that this process keeps.

    Raises
    ------
    UnreadableError, ReaderFailedError
    """
    return _shared_reader(os.getpid()).read(request)


# ---------------------------------------------------------------- messages


def _pipe(stream: IO[bytes] | None) -> IO[bytes]:
    return stream  # type: ignore[return-value]  # both pipes were asked for


def _exchange(process: subprocess.Popen[bytes], message: bytes) -> bytes | None:
    try:
        _send(_pipe(process.stdin), message)
    except OSError:  # it died while it listened
        return None
    return _received(_pipe(process.stdout))


def _send(stream: IO[bytes], message: bytes) -> None:
    stream.write(len(message).to_bytes(_LENGTH_BYTES, "little") + message)
    stream.flush()


def _received(stream: IO[bytes]) -> bytes | None:
    """Return the next message whole; None when the pipe ends."""
    length = stream.read(_LENGTH_BYTES)
    if len(length) < _LENGTH_BYTES:
        return None
    wanted = int.from_bytes(length, "little")
    message = stream.read(wanted) if wanted <= limits.ANSWER_BYTES else b""
    return message if len(message) == wanted else None


class _PlainUnpickler(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> object:
        if (module, name) not in _PLAIN:
            raise pickle.UnpicklingError
        return _PLAIN[module, name]


def _unpickled(content: bytes | None) -> Book | tuple[str, str, str] | None:
    """Return an answer; None when there is none, or none of ours: then the process is as good as dead."""
    if content is None:
        return None
    try:
        answer = _PlainUnpickler(io.BytesIO(content)).load()
    except Exception:  # noqa: BLE001 - damaged pickles raise nearly anything
        return None
    return answer if isinstance(answer, Book | tuple) else None


# ---------------------------------------------------------------- inside the process


def serve() -> None:
    """Answer requests until the pipe ends."""
    requests, answers = sys.stdin.buffer, sys.stdout.buffer
    limit_process()
    gc.disable()  # a workbook is many small objects without circles; what is left ends with the process
    _send(answers, _READY)
    while (message := _received(requests)) is not None:
        limit_cpu(limits.CPU_S)
        _send(answers, pickle.dumps(_answer(pickle.loads(message))))  # noqa: S301 - from our own parent


def _answer(request: ReadRequest) -> Book | tuple[str, str, str]:
    try:
        return read_workbook(request)
    except UnreadableError as error:
        return error.name, str(error.got), error.hint


def _environment() -> dict[str, str]:
    """Let the process find the packages where this one does, and keep numpy from reserving memory for threads."""
    paths = os.pathsep.join(path or "." for path in sys.path)
    return {**os.environ, "PYTHONPATH": paths, "OPENBLAS_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}


def limit_process() -> None:
    """Limit the memory of this process, and let it write no file; where the system knows no limits, do nothing."""
    _limit("RLIMIT_AS", limits.MEMORY_BYTES)
    _limit("RLIMIT_FSIZE", 0)
    _limit("RLIMIT_CORE", 0)


def limit_cpu(seconds: float) -> None:
    """Let this process work for so long from now on."""
    used = sum(os.times()[:2])
    _limit("RLIMIT_CPU", int(used + seconds) + 1, is_soft=True)


def _limit(name: str, value: int, *, is_soft: bool = False) -> None:
    if resource is None:
        return
    which = getattr(resource, name)
    hard = resource.getrlimit(which)[1]
    most = value if hard == resource.RLIM_INFINITY else min(value, hard)
    with contextlib.suppress(ValueError, OSError):  # a system may know the limit and not grant it
        resource.setrlimit(which, (most, hard if is_soft else most))
