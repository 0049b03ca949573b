"""Working folders of runs that were killed go at the next start; those of living runs stay."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from assignments.workplace import sweep, workplace_prefix


@pytest.mark.skipif(os.name != "posix", reason="asks for a process by its number")
def test_only_left_over_folders_are_removed(tmp_path: Path) -> None:
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    dead, alive = tmp_path / f"{workplace_prefix(ended.pid)}x", tmp_path / f"{workplace_prefix()}x"
    elsewhere, old, other = tmp_path / ".making-00000000-1-x", tmp_path / ".making-abc", tmp_path / "handouts"
    for folder in (dead, alive, elsewhere, old, other):
        (folder / "work").mkdir(parents=True)
    os.utime(old, (1e9, 1e9))
    os.utime(other, (1e9, 1e9))
    sweep(tmp_path)
    assert {folder.name for folder in tmp_path.iterdir()} == {alive.name, elsewhere.name, other.name}
