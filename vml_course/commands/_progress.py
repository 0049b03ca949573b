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


@contextmanager
def counted(title: str, things: str) -> Iterator[Callable[[int, int], None]]:
    """Give a callback `(done, total)` that draws a bar with how many are done, how many a minute, and the time left.

    What was done before the first call is taken as done, not as speed.
    """
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        ProgressColumn,
        Task,
        TextColumn,
        TimeRemainingColumn,
    )
    from rich.text import Text

    class Rate(ProgressColumn):
        """Things a minute, of late."""

        def render(self, task: Task) -> Text:
            speed = task.finished_speed or task.speed
            return Text(f"{60 * speed:.3g} {things}/min" if speed else "")

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), Rate(), TimeRemainingColumn())
    bar = Progress(*columns, console=Console(stderr=True))
    task = bar.add_task(title, total=None, visible=False)

    def show(done: int, total: int) -> None:
        if bar.tasks[0].total is None:
            bar.start()
            bar.reset(task, total=total, completed=done, visible=done < total)
        else:
            bar.update(task, completed=done)

    try:
        yield show
    finally:
        if bar.tasks[0].total is not None:  # a bar that never began must not leave an empty line before an error
            bar.stop()
