"""What a tracker is, and which ones exist.

A tracker is its settings: a frozen record. It looks at one picture at a time and keeps nothing; what it
must remember it hands back, so that tracking can be paused, resumed, tested with two pictures.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from typing import Any, ClassVar, Protocol, TypeGuard, TypeVar, runtime_checkable

from vml_course.errors import UnknownNameError
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma
from vml_course.model.quantity import quantities_of
from vml_course.model.track import Sighting
from vml_course.track import trackers

State = TypeVar("State")


class Tracker(Protocol[State]):
    """One way of following points from picture to picture.

    Rules that every tracker keeps (a test runs over all of them): a point that is not found is NaN with
    status `lost`, never a copy of an older place; the first sighting is the seeds themselves; the same
    pictures give the same numbers; neither state nor picture is changed.
    """

    name: ClassVar[str]
    title: ClassVar[str]

    @property
    def settings(self) -> Mapping[str, str | int | float]:
        """How it tracks, as written into the track's file."""
        ...

    def start(self, luma: Luma, seeds_px: FloatArray) -> tuple[State, Sighting]:
        """Learn the points, shape (p, 2), px, from the first picture.

        Raises
        ------
        SeedError
            When a point cannot be followed from here; its name reads `seed 1`, `seed 2` ...
        """
        ...

    def step(self, state: State, luma: Luma) -> tuple[State, Sighting]:
        """Find the points in the next picture."""
        ...


@runtime_checkable
class Placeable(Protocol[State]):
    """A tracker that can be told where its points are, and keeps its references; others start anew there."""

    def place(self, state: State, luma: Luma, points_px: FloatArray) -> tuple[State, Sighting]:
        """Go on from where the points, shape (p, 2), px, are said to be in this picture.

        The sighting is these places, `manual`; its ZNCC is NaN where the reference is not seen.
        """
        ...


def is_placeable(tracker: Tracker[Any]) -> TypeGuard[Placeable[Any]]:
    """Whether a tracker keeps its references when it is told where the points are."""
    return isinstance(tracker, Placeable)


def tracker_names() -> tuple[str, ...]:
    """Return the names of all methods, the default first."""
    found = {module.name for module in pkgutil.iter_modules(trackers.__path__)}
    return tuple(sorted(found, key=lambda name: (name != "dic", name)))


def tracker_class(name: str) -> type[Any]:
    """Return the class of a method.

    Raises
    ------
    UnknownNameError
    """
    if name not in tracker_names():
        raise UnknownNameError("method", name, tracker_names())
    method: type[Any] = importlib.import_module(f"{trackers.__name__}.{name}").METHOD
    return method


def make_tracker(name: str, **settings: float) -> Tracker[Any]:
    """Return a tracker with its settings, such as `make_tracker("dic", block=40)`.

    Raises
    ------
    UnknownNameError
        When there is no such method or setting.
    InputError
        When a setting is out of its range.
    """
    method = tracker_class(name)
    known = tuple(quantities_of(method))
    for setting in settings:
        if setting not in known:
            raise UnknownNameError("setting", setting, known)
    tracker: Tracker[Any] = method(**settings)
    return tracker
