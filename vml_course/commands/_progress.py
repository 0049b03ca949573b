"""Progress bars on standard error, shared by every command that takes its time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress(title: str) -> Iterator[Callable[[int, int], None]]:
    """Give a callback `(done, total)` that draws a bar; nothing is drawn before something is done."""
    with stages() as show:
        yield lambda done, total: show(title, done / total if total else 1.0)


@contextmanager
def stages() -> Iterator[Callable[[str, float], None]]:
    """Give a callback `(what is being done, share of the whole from 0 to 1)` that draws one bar."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskID, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    bar = Progress(*columns, console=Console(stderr=True))
    started: list[TaskID] = []

    def show(stage: str, share: float) -> None:
        if not started:
            bar.start()
            started.append(bar.add_task(stage, total=1.0))
        bar.update(started[0], description=stage, completed=share)

    try:
        yield show
    finally:
        if started:  # a bar that never began must not leave an empty line before an error
            bar.stop()
