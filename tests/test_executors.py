import os

import pytest

from vml_course.errors import InputError
from vml_course.executors import open_executor


def double(number):
    return 2 * number


def fail(number):
    raise ValueError(number)


def process_id(_):
    return os.getpid()


@pytest.mark.parametrize("workers", [1, 2])
def test_every_executor_gives_the_same_answers(workers):
    with open_executor(workers) as pool:
        assert [future.result() for future in [pool.submit(double, n) for n in range(4)]] == [0, 2, 4, 6]


def test_one_worker_stays_in_this_process_and_two_do_not():
    with open_executor(1) as here, open_executor(2) as there:
        assert here.submit(process_id, 0).result() == os.getpid()
        assert there.submit(process_id, 0).result() != os.getpid()


def test_a_failing_task_fails_its_own_future_only():
    with open_executor(1) as pool:
        bad, good = pool.submit(fail, 1), pool.submit(double, 1)
    assert good.result() == 2
    with pytest.raises(ValueError, match="1"):
        bad.result()


def test_no_worker_is_refused():
    with pytest.raises(InputError, match="workers: expected 1 or more, got 0"):
        open_executor(0)
