"""The first start says what it is doing, the second has nothing to say."""

import os
import subprocess
import sys

import pytest

from vml_course.usecases.kernels_ready import NOTICE, compile_notice

ASK = "from vml_course.usecases.kernels_ready import compile_notice; print(compile_notice('dic'))"


def ask(cache):
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache)}
    done = subprocess.run([sys.executable, "-c", ASK], env=environment, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_an_empty_cache_is_told(tmp_path):
    assert ask(tmp_path) == NOTICE


def test_kept_kernels_are_silent_unless_the_source_is_newer(tmp_path):
    find = "from vml_course.correlate.icgn import iterate; print(iterate.stats.cache_path)"
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", find], env=environment, capture_output=True, text=True, check=True)
    folder = type(tmp_path)(done.stdout.strip())
    folder.mkdir(parents=True, exist_ok=True)
    index = folder / "icgn.iterate-1.py3.nbi"
    index.touch()
    assert ask(tmp_path) == ""
    os.utime(index, (0, 0))
    assert ask(tmp_path) == NOTICE


@pytest.mark.parametrize("method", ["flow", "block"])
def test_methods_without_kernels_are_silent(method):
    assert compile_notice(method) == ""
