"""Where a person has placed points: each point's seed, and further marks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from typing import NamedTuple

import numpy as np

from vml_course.errors import FrameRangeError, InputError
from vml_course.model.track import Seed


class Group(NamedTuple):
    """Points that can be tracked together: seeded in one picture. A marked point goes alone."""

    columns: tuple[int, ...]
    seeds: tuple[Seed, ...]
    marks: Mapping[int, Seed]

    @property
    def frame(self) -> int | None:
        """Where they are seeded; None: in the first picture that comes."""
        return self.seeds[0].frame


@dataclass(frozen=True, slots=True)
class Places:
    """The points to be tracked.

    Attributes
    ----------
    seeds : tuple of Seed
        One a point; without a frame it is placed in the first picture.
    marks : tuple of Seed
        Where points are in further pictures, with their frames.

    Raises
    ------
    InputError
        When there is no seed, a name comes twice, a point is placed twice in one picture, or a mark names no point,
        no frame or no place.
    """

    seeds: tuple[Seed, ...]
    marks: tuple[Seed, ...] = ()

    def __post_init__(self) -> None:
        names = [seed.name for seed in self.seeds]
        if not names:
            raise InputError("seeds", "at least one point", "none")
        if twice := [name for name, count in Counter(names).items() if count > 1]:
            raise InputError("seeds", "every point's name once", f"{twice[0]!r} twice")
        for mark in self.marks:
            _check_mark(mark, names)
        placed = Counter((one.name, one.frame) for one in chain(self.seeds, self.marks))
        for (name, frame), count in placed.items():
            if count > 1:
                raise InputError(name, "one place in a frame", f"{count} in frame {frame}")

    @property
    def names(self) -> tuple[str, ...]:
        """The points, in the order of their seeds."""
        return tuple(seed.name for seed in self.seeds)

    @property
    def is_first_only(self) -> bool:
        """Whether all points are placed in the first picture that comes."""
        return all(seed.frame is None for seed in self.seeds)

    def from_frame(self, first: int) -> Places:
        """Return the same places, those without a frame in frame `first`."""
        seeds = (replace(seed, frame=first) if seed.frame is None else seed for seed in self.seeds)
        return Places(tuple(seeds), self.marks)

    def groups(self) -> Iterator[Group]:
        """Yield which points can be tracked together."""
        marked = {mark.name for mark in self.marks}
        alike: dict[object, list[int]] = {}
        for column, seed in enumerate(self.seeds):
            alike.setdefault(seed.name if seed.name in marked else seed.frame, []).append(column)
        for columns in alike.values():
            seeds = tuple(self.seeds[column] for column in columns)
            own = {mark.frame: mark for mark in self.marks if mark.name == seeds[0].name and mark.frame is not None}
            yield Group(tuple(columns), seeds, own)

    def check_frames(self, frames: set[int]) -> None:
        """Refuse places in frames that are not there.

        Raises
        ------
        FrameRangeError
        """
        for place in chain(self.seeds, self.marks):
            if place.frame is not None and place.frame not in frames:
                raise FrameRangeError(place.name, f"a frame of the clip, {min(frames)} to {max(frames)}", place.frame)


def seed_at(name: str, xy_px: object, frame: int | None = None) -> Seed:
    """Return a place from an array, shape (2,), px."""
    x, y = np.asarray(xy_px, dtype=np.float64).tolist()
    return Seed(name, x, y, frame)


def _check_mark(mark: Seed, names: list[str]) -> None:
    if mark.name not in names:
        raise InputError(f"mark {mark.name}", f"one of the points {', '.join(names)}", repr(mark.name))
    if mark.frame is None:
        raise InputError(f"mark {mark.name}", "the frame that it is in", "none")
    if not np.isfinite([mark.x_px, mark.y_px]).all():
        raise InputError(f"mark {mark.name}", "a place in px", f"({mark.x_px:g}, {mark.y_px:g})")
