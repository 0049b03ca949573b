"""Decoding the next pictures while this one is being tracked."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

Item = TypeVar("Item")
_END = object()


@contextmanager
def prefetched(items: Iterable[Item], depth: int = 4) -> Iterator[Iterator[Item]]:
    """Take items from an iterable in a thread of its own, at most `depth` ahead.

    An error of the iterable is raised where its item would have come. Leaving the block early stops the
    thread after the item it is working on and closes the iterable there, in the thread that ran it.
    """
    ahead: queue.Queue[object] = queue.Queue(maxsize=depth)
    stopped = threading.Event()
    thread = threading.Thread(target=_fill, args=(items, ahead, stopped), name="prefetch", daemon=True)
    thread.start()
    try:
        yield _drain(ahead)
    finally:
        stopped.set()
        while thread.is_alive():
            _empty(ahead)
            thread.join(0.01)


class _Failure:
    def __init__(self, error: BaseException) -> None:
        self.error = error


def _fill(items: Iterable[Item], ahead: queue.Queue[object], stopped: threading.Event) -> None:
    iterator = iter(items)
    try:
        for item in iterator:
            ahead.put(item)
            if stopped.is_set():
                break
        ahead.put(_END)
    except BaseException as error:  # noqa: BLE001 - it is raised again where the items are used
        ahead.put(_Failure(error))
    finally:
        close = getattr(iterator, "close", None)
        if close is not None:
            close()


def _drain(ahead: queue.Queue[object]) -> Iterator[Item]:
    while True:
        item = ahead.get()
        if item is _END:
            return
        if isinstance(item, _Failure):
            raise item.error
        yield item  # type: ignore[misc] # the queue holds items, one end and failures


def _empty(ahead: queue.Queue[object]) -> None:
    try:
        while True:
            ahead.get_nowait()
    except queue.Empty:
        return
