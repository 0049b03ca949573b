"""A file may do to the reading process whatever it can: the batch goes on."""

from __future__ import annotations

import io
import os
import pickle
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest

from grader.read import (
    BookCell,
    Reader,
    ReaderFailedError,
    ReadRequest,
    UnreadableError,
    limits,
    read_isolated,
    read_workbook,
)
from grader.read import worker as worker_module
from grader.read.book import Sheet

# A process that does as the file's first letter says, and reads every other file as usual.
STUNTS = """
import os, sys, time
from grader.read import worker
def stunt(request):
    what = request.data[:1]
    if what == b"K": os.kill(os.getpid(), 9)
    if what == b"E": sys.exit(0)
    if what == b"S": time.sleep(60)
    if what == b"M": bytearray(2 * worker.limits.MEMORY_BYTES)
    if what == b"G": worker._send(sys.stdout.buffer, b"no pickle")
    if what == b"W": open(request.data[1:].decode(), "w").write("x")
    if what == b"L": os.write(1, (2 ** 62).to_bytes(8, "little"))
    if what == b"H": os.write(1, b"abc"); sys.exit(0)
    if what == b"T": os.write(1, (99).to_bytes(8, "little")); sys.exit(0)
    return plain(request)
plain, worker.read_workbook = worker.read_workbook, stunt
worker.serve()
"""


@pytest.fixture(scope="module")
def reader():
    with Reader() as opened:
        yield opened


def test_an_isolated_reader_reads_as_the_plain_one_does(reader, good_bytes):
    request = ReadRequest("w.xlsx", good_bytes)
    assert reader.read(request) == read_workbook(request) == read_isolated(request)


def test_sheets_travel_between_processes_as_they_are(good_bytes):
    book = read_workbook(ReadRequest("w.xlsx", good_bytes))
    blank = Sheet("Blank", is_visible=False, cells={}, merges=((1, 2, 3, 4),))
    sheets = (*book.sheets, blank)
    arrived = worker_module._PlainUnpickler(io.BytesIO(pickle.dumps(sheets))).load()
    assert arrived == sheets
    assert all(isinstance(cell, BookCell) for sheet in arrived for cell in sheet.cells.values())


HEAVY = ("numpy", "pandas", "openpyxl", "assignments", "sqlalchemy")


def test_the_reading_process_starts_light():
    """It is started once for some 200 files: numpy alone would cost as much as reading ten of them."""
    script = f"import grader.read.worker, sys; sys.exit(', '.join(m for m in {HEAVY} if m in sys.modules))"
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, env=worker_module._environment(), capture_output=True, check=False)
    assert done.stderr == b"\n"


@pytest.mark.parametrize("data", [b"", b"a;b\n1;2", b"%PDF", bytes(limits.FILE_BYTES + 1)])
def test_a_refusal_comes_back_word_for_word(reader, data):
    with pytest.raises(UnreadableError) as isolated:
        reader.read(ReadRequest("w.xlsx", data))
    with pytest.raises(UnreadableError) as plain:
        read_workbook(ReadRequest("w.xlsx", data))
    assert str(isolated.value) == str(plain.value)


def test_threads_may_share_a_reader(reader, good_bytes):
    with ThreadPoolExecutor(4) as pool:
        books = list(pool.map(reader.read, [ReadRequest(f"{i}.xlsx", good_bytes) for i in range(8)]))
    assert [book.name for book in books] == [f"{i}.xlsx" for i in range(8)]


DEADLY = [
    b"E",
    b"H",
    b"T",
    b"L",
    b"G",
    pytest.param(b"K", marks=pytest.mark.skipif(sys.platform == "win32", reason="no signal 9")),
    pytest.param(b"M", marks=pytest.mark.skipif(sys.platform != "linux", reason="memory is limited on Linux only")),
]


@pytest.fixture(scope="module")
def stunt_reader():
    with Reader(command=STUNTS) as opened:
        yield opened


@pytest.mark.parametrize("data", DEADLY)
def test_a_file_that_ends_the_process_has_a_polite_line_and_the_next_is_read(stunt_reader, good_bytes, data):
    with pytest.raises(UnreadableError, match=r"^w.xlsx: expected .* more memory or time .* Type your answers into"):
        stunt_reader.read(ReadRequest("w.xlsx", data))
    assert stunt_reader.read(ReadRequest("w.xlsx", good_bytes)).name == "w.xlsx"


def test_a_silent_process_is_ended():
    with Reader(wall_s=0.5, command=STUNTS) as reader, pytest.raises(UnreadableError, match="memory or time"):
        reader.read(ReadRequest("w.xlsx", b"S"))


@pytest.mark.skipif(sys.platform == "win32", reason="Windows limits no file sizes")
def test_the_process_can_write_no_file(stunt_reader, tmp_path):
    with pytest.raises(UnreadableError):
        stunt_reader.read(ReadRequest("w.xlsx", b"W" + str(tmp_path / "out").encode()))
    assert not (tmp_path / "out").exists() or (tmp_path / "out").read_bytes() == b""


def test_after_so_many_files_the_process_is_a_new_one():
    started = []
    with Reader(files_per_process=2) as reader:
        for _ in range(4):
            with pytest.raises(UnreadableError):
                reader.read(ReadRequest("w.xlsx", b"x"))
            started.append(reader._files_read)
    assert started == [1, 0, 1, 0]


def test_a_second_chance_in_a_fresh_process(monkeypatch):
    """What other files left behind is not the fault of this one."""
    reader, asked = Reader(), []

    def ask(request):
        asked.append(request.name)
        reader._files_read += 1
        return None if len(asked) < 3 else ("w", "x", "y")

    monkeypatch.setattr(reader, "_ask", ask)
    with pytest.raises(UnreadableError, match="memory or time"):
        reader.read(ReadRequest("a", b"1"))
    with pytest.raises(UnreadableError, match="got x"):
        reader.read(ReadRequest("b", b"1"))
    assert asked == ["a", "b", "b"]


def test_a_process_that_dies_between_two_files_is_replaced(good_bytes):
    with Reader() as reader:
        reader.read(ReadRequest("w.xlsx", good_bytes))
        reader._process.kill()
        reader._process.wait()
        assert reader.read(ReadRequest("w.xlsx", good_bytes)).name == "w.xlsx"


def test_a_process_that_cannot_start_is_our_failure():
    with pytest.raises(ReaderFailedError, match="cannot be started"), Reader(command="1/0") as reader:
        reader.read(ReadRequest("w.xlsx", b"x"))


def test_a_process_that_dies_says_nothing_of_its_own(capfd):
    """The traceback of a reading process is nothing that who grades should see."""
    with pytest.raises(ReaderFailedError), Reader(command="1/0") as reader:
        reader.read(ReadRequest("w.xlsx", b"x"))
    assert capfd.readouterr() == ("", "")


def test_a_reader_that_was_not_used_has_nothing_to_end():
    with Reader() as reader:
        reader.close()


def test_a_process_has_so_long_to_start_and_to_read_and_no_program_waits_for_it(monkeypatch):
    alarms = []

    class Alarm(threading.Timer):
        def start(self):
            alarms.append((self.interval, self.daemon))
            super().start()

    monkeypatch.setattr(worker_module.threading, "Timer", Alarm)
    with Reader(wall_s=77.0) as reader, pytest.raises(UnreadableError):
        reader.read(ReadRequest("w.xlsx", b"x"))
    assert alarms == [(limits.START_S, True), (77.0, True)]


def test_a_file_of_the_largest_size_is_read_in_the_process_and_a_larger_one_is_not_even_sent(monkeypatch):
    reader, sent = Reader(), []
    monkeypatch.setattr(limits, "FILE_BYTES", 3)
    monkeypatch.setattr(reader, "_ask", lambda request: sent.append(request.data) or ("w", "x", "y"))
    for data in (b"abc", b"abcd"):
        with pytest.raises(UnreadableError):
            reader.read(ReadRequest("w.xlsx", data))
    assert sent == [b"abc"]


def test_the_process_finds_packages_where_this_one_does(monkeypatch, tmp_path, good_bytes):
    (tmp_path / "only_here.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    with Reader(command=f"import only_here; {worker_module._COMMAND}") as reader:
        assert reader.read(ReadRequest("w.xlsx", good_bytes)).name == "w.xlsx"


def test_the_process_has_the_environment_of_this_one_and_writes_and_reserves_little(monkeypatch):
    monkeypatch.setattr(sys, "path", ["", "there"])
    monkeypatch.setattr(os, "environ", {"LANG": "C", "PYTHONPATH": "elsewhere"})
    assert worker_module._environment() == {
        "LANG": "C",
        "PYTHONPATH": f".{os.pathsep}there",
        "OPENBLAS_NUM_THREADS": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
    }


def test_only_the_process_that_started_a_reader_ends_it(good_bytes):
    """A forked child would end its parent's."""
    with Reader() as reader:
        reader.read(ReadRequest("w.xlsx", good_bytes))
        process = reader._process
        worker_module._close_own(reader, os.getpid() + 1)
        assert process.poll() is None
        worker_module._close_own(reader, os.getpid())
        assert process.poll() is not None


class Stranger:
    def __reduce__(self):
        return print, ("run",)


@pytest.mark.parametrize("answer", [Stranger(), SimpleNamespace(), 3])
def test_nothing_but_cells_is_taken_from_the_process(answer):
    assert worker_module._unpickled(pickle.dumps(answer)) is None
    assert worker_module._unpickled(b"no pickle") is None


# ---------------------------------------------------------------- messages


def stream_of(*messages: bytes) -> io.BytesIO:
    stream = io.BytesIO()
    for message in messages:
        worker_module._send(stream, message)
    stream.seek(0)
    return stream


def test_messages_arrive_whole_one_after_another():
    messages = [b"", b"a", bytes(300)]
    stream = stream_of(*messages)
    assert [worker_module._received(stream) for _ in range(4)] == [*messages, None]


def test_a_message_that_breaks_off_is_none():
    sent = stream_of(b"abc").getvalue()
    assert len(sent) == 11
    assert [worker_module._received(io.BytesIO(sent[:length])) for length in range(11)] == [None] * 11


def test_a_message_is_so_long_and_a_longer_one_is_not_even_read(monkeypatch):
    monkeypatch.setattr(limits, "ANSWER_BYTES", 3)
    assert worker_module._received(stream_of(b"abc")) == b"abc"
    longer = stream_of(b"abcd")
    assert worker_module._received(longer) is None
    assert longer.tell() == 8


# ---------------------------------------------------------------- inside the process


class FakeLimits:
    """The system's limits, without limiting the tests."""

    RLIM_INFINITY = -1
    RLIMIT_AS, RLIMIT_FSIZE, RLIMIT_CORE, RLIMIT_CPU = range(4)

    def __init__(self, *hard, refuses=None):
        self.set, self._hard, self._refuses = {}, hard or (-1,) * 4, refuses

    def getrlimit(self, which):
        return -1, self._hard[which]

    def setrlimit(self, which, pair):
        if self._refuses is not None:
            raise self._refuses
        self.set[which] = pair


@pytest.mark.parametrize(("hard", "memory"), [(-1, limits.MEMORY_BYTES), (1000, 1000)])
def test_the_process_limits_itself(monkeypatch, hard, memory):
    fake = FakeLimits(hard, -1, -1, 3600)
    monkeypatch.setattr(worker_module, "resource", fake)
    worker_module.limit_process()
    assert fake.set == {fake.RLIMIT_AS: (memory, memory), fake.RLIMIT_FSIZE: (0, 0), fake.RLIMIT_CORE: (0, 0)}
    worker_module.limit_cpu(5)
    soft, kept = fake.set[fake.RLIMIT_CPU]
    assert 5 < soft < 3600
    assert kept == 3600


def test_a_file_has_its_seconds_on_top_of_what_the_process_has_used(monkeypatch):
    fake = FakeLimits()
    monkeypatch.setattr(worker_module, "resource", fake)
    monkeypatch.setattr(worker_module.os, "times", lambda: (1.5, 2.0, 99.0, 99.0, 99.0))
    worker_module.limit_cpu(5)
    assert fake.set == {fake.RLIMIT_CPU: (9, -1)}


@pytest.mark.parametrize("fake", [FakeLimits(refuses=ValueError()), FakeLimits(refuses=OSError()), None])
def test_a_system_without_limits_reads_all_the_same(monkeypatch, fake):
    monkeypatch.setattr(worker_module, "resource", fake)
    worker_module.limit_process()


def test_the_process_answers_until_its_pipe_ends(monkeypatch, good_bytes):
    requests = stream_of(*(pickle.dumps(ReadRequest("w.xlsx", data)) for data in (good_bytes, b"")))
    answers = io.BytesIO()
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=requests))
    monkeypatch.setattr(sys, "stdout", SimpleNamespace(buffer=answers))
    monkeypatch.setattr(worker_module, "resource", FakeLimits())
    monkeypatch.setattr(worker_module.gc, "disable", lambda: None)
    worker_module.serve()
    answers.seek(0)
    assert worker_module._received(answers) == b"ready"
    assert worker_module._unpickled(worker_module._received(answers)).name == "w.xlsx"
    assert worker_module._unpickled(worker_module._received(answers))[1] == "an empty file"
    assert worker_module._received(answers) is None


def test_what_a_process_reads_goes_to_its_own_reader(good_bytes):
    read_isolated(ReadRequest("w.xlsx", good_bytes))
    assert worker_module._shared_reader(os.getpid())._process.poll() is None


# Forked in a process without threads: a fork beside threads may stop for good.
FORKS = """
import contextlib, os
from grader.read import ReadRequest, UnreadableError, worker
def answering():
    with contextlib.suppress(UnreadableError):
        worker.read_isolated(ReadRequest("w.xlsx", b""))
    return worker._shared_reader(os.getpid())._process
of_parent = answering()
if os.fork() == 0:
    print(answering().pid == of_parent.pid, flush=True)
    worker._shared_reader(os.getpid()).close()
    os._exit(0)
os.wait()
print(of_parent.poll())
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system knows no fork")
def test_a_forked_process_has_a_reader_of_its_own_and_leaves_its_parents_alone():
    """Two that speak through the same pipes would get one another's answers."""
    done = subprocess.run([sys.executable, "-c", FORKS], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "None"]
