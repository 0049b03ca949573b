"""One interface for every kind of worker: same answers, failures that stay where they belong, no worker left over."""

import os
import pickle
import signal
import subprocess
import sys
import time
from concurrent.futures import Future
from pathlib import Path

import pytest

from vml_course.errors import InputError, OutOfRangeError, PackageMissingError, VmlError, WorkerDiedError
from vml_course.executors import Crew, ProcessesExecutor, each_done, open_executor

KINDS = {"serial": (1, ""), "processes": (2, ""), "cluster": (1, "local:2")}
posix = pytest.mark.skipif(os.name != "posix", reason="ends a process by a signal")


def double(number):
    return 2 * number


def fail(number):
    raise OutOfRangeError("mass", 0.1, 1.0, "kg", number)


def process_id(_):
    return os.getpid()


def die(_):
    os.kill(os.getpid(), signal.SIGKILL)


def die_once(marker):
    if not Path(marker).exists():
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "alive"


def die_or_double(number):
    return die(number) if number == 3 else double(number)


@pytest.fixture(scope="module", params=KINDS)
def crew(request):
    if request.param == "cluster":
        pytest.importorskip("distributed")
    workers, cluster = KINDS[request.param]
    with open_executor(workers, cluster) as opened:
        yield opened


def test_every_executor_gives_the_same_answers(crew):
    assert {n: future.result() for n, future in each_done(crew, double, range(9))} == {n: 2 * n for n in range(9)}


def test_a_failing_task_fails_its_own_future_only_and_keeps_its_words_and_facts(crew):
    bad, good = crew.submit(fail, 7.0), crew.submit(double, 1)
    assert good.result() == 2
    with pytest.raises(OutOfRangeError, match=r"mass: expected 0\.1 to 1 kg, got 7 kg") as raised:
        bad.result()
    assert (raised.value.low, raised.value.unit) == (0.1, "kg")


def test_only_one_worker_stays_in_this_process(crew):
    here = crew.submit(process_id, 0).result() == os.getpid()
    assert here == (crew.most_under_way == 1)


@posix
def test_a_task_whose_worker_died_is_done_by_another(crew, tmp_path):
    if crew.most_under_way == 1:
        pytest.skip("this process would end itself")
    others = [crew.submit(double, n) for n in range(4)]
    assert crew.submit(die_once, str(tmp_path / "died")).result() == "alive"
    assert [other.result() for other in others] == [0, 2, 4, 6]


@posix
def test_a_task_that_kills_every_worker_fails_alone():
    with open_executor(2) as crew:
        ended = dict(each_done(crew, die_or_double, range(8)))
    assert {n: ended[n].result() for n in ended if n != 3} == {n: 2 * n for n in range(8) if n != 3}
    with pytest.raises(WorkerDiedError, match="its process died, 3 times of 3"):
        ended[3].result()


class Counting(Crew):
    """Finishes a task only when it is asked to hand over more than it may hold."""

    most_under_way = 3

    def __init__(self):
        self.under_way: list[Future] = []
        self.most = 0

    def submit(self, fn, /, *args, **kwargs):
        future = Future()
        self.under_way.append(future)
        self.most = max(self.most, len(self.under_way))
        if len(self.under_way) >= 3:
            self.under_way.pop(0).set_result(fn(*args))
        return future


def test_records_are_asked_for_only_as_workers_come_free():
    asked = []
    records = (asked.append(n) or n for n in range(100))
    with open_executor(1) as crew:
        for done, (_, future) in enumerate(each_done(crew, double, records), start=1):
            assert future.done()
            assert len(asked) <= done + crew.most_under_way
    counting = Counting()
    ahead = each_done(counting, double, range(1000))
    assert [next(ahead)[0] for _ in range(20)] == list(range(20))
    assert counting.most == 3


@posix
def test_workers_end_with_a_parent_that_was_killed(tmp_path):
    script = tmp_path / "parent.py"
    script.write_text(
        "import os, time\nfrom vml_course.executors import open_executor\n"
        "if __name__ == '__main__':\n"
        "    crew = open_executor(2)\n"
        "    print(crew.submit(os.getpid).result(), flush=True)\n"
        "    crew.submit(time.sleep, 100)\n    time.sleep(100)\n",
        encoding="utf-8",
    )
    with subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, text=True) as parent:
        worker = int(parent.stdout.readline())
        parent.kill()
    assert _is_gone_soon(worker)


def _is_gone_soon(process):
    for _ in range(200):
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return True
        if "\nState:\tZ" in _status(process):
            return True
        time.sleep(0.05)
    return False


def _status(process):
    path = Path(f"/proc/{process}/status")
    return path.read_text() if path.exists() else ""


def test_what_was_stopped_begins_no_further_task():
    crew = ProcessesExecutor(1)
    waiting = [crew.submit(time.sleep, 0.05) for _ in range(50)]
    with pytest.raises(KeyboardInterrupt), crew:
        raise KeyboardInterrupt
    assert any(future.cancelled() for future in waiting)


@pytest.mark.parametrize(
    ("workers", "cluster", "said"),
    [
        (0, "", "workers: expected 1 or more, got 0"),
        (1, "local:0", "cluster: expected local:N with 1 to 512 workers, got 'local:0'"),
        (1, "nonsense", "cluster: expected the address of a dask scheduler"),
        (1, "tcp://127.0.0.1:1", "cluster: expected the address of a dask scheduler"),
    ],
)
def test_what_cannot_work_is_refused(workers, cluster, said, monkeypatch):
    if cluster:
        pytest.importorskip("distributed")
        monkeypatch.setattr("vml_course.executors.PATIENCE_S", 0.5)
    with pytest.raises(InputError, match=said):
        open_executor(workers, cluster)


def test_a_cluster_without_dask_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(PackageMissingError, match=r"pip install vml-course\[cluster\]"):
        open_executor(1, "local:2")


def test_every_mistake_survives_the_way_between_processes():
    def kinds(base):
        return [base, *(each for kind in base.__subclasses__() for each in kinds(kind))]

    for kind in kinds(VmlError):
        error = kind.__new__(kind, "e: expected to be measured, got nothing.")
        error.fact = 3
        arrived = pickle.loads(pickle.dumps(error))  # noqa: S301 - made here
        assert (type(arrived), str(arrived), arrived.fact) == (kind, str(error), 3)
