"""Benchmarks that nobody runs every day still begin."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("script", sorted((ROOT / "benchmarks").glob("*.py")), ids=lambda path: path.stem)
def test_a_benchmark_says_how_it_is_run(script: Path) -> None:
    command = [sys.executable, str(script), "--help"]
    path = {**os.environ, "PYTHONPATH": str(ROOT)}
    said = subprocess.run(command, cwd=ROOT, env=path, capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stderr
    assert f"python benchmarks/{script.name}" in said.stdout
