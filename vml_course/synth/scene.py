"""What a scene is, and which scenes there are.

A scene is its parameters: a frozen record whose fields are declared once with `quantity()`. A file in
`synth/scenes` that holds one subclass of `Scene` (rigid bodies and an impact) or of `sheet.Sheet` (a body that is
strained) is a scene that exists; nothing else has to know of it.
"""

from __future__ import annotations

import importlib
import pkgutil
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import ClassVar

from vml_course.errors import UnknownNameError
from vml_course.model.camera import Camera
from vml_course.model.choice import check_choices
from vml_course.model.quantity import check_quantities, quantity
from vml_course.synth import scenes
from vml_course.synth.clock import LONGEST_STEP_S, Clock, set_clock
from vml_course.synth.law import Law


@dataclass(frozen=True)
class Marker:
    """A point that students track: on which body it sits, where, and how far its outline reaches.

    Attributes
    ----------
    name, body : str
    local_m : (float, float)
        In the body's own axes, y up.
    outline_m : float
        Radius around the point that must stay in the picture.
    """

    name: str
    body: str
    local_m: tuple[float, float]
    outline_m: float


@dataclass(frozen=True)
class AnyScene(ABC):
    """What all scenes have in common, whatever happens in them.

    Attributes
    ----------
    name : str
        What is typed: `vml render NAME`.
    title : str
        One line for a list.
    model : str
        Name of the impact model in `kinetics` that solves it; "" where there is no impact.
    story : str
        What the handout says: what is seen, what is known, what is looked for.
    unknowns : mapping of str to str
        What students look for: symbol, and what it means.
    default_camera : Camera
    """

    name: ClassVar[str]
    title: ClassVar[str]
    model: ClassVar[str] = ""
    story: ClassVar[str]
    unknowns: ClassVar[Mapping[str, str]]
    default_camera: ClassVar[Camera]

    def __post_init__(self) -> None:
        check_choices(self)
        check_quantities(self)

    @abstractmethod
    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return still points to calibrate with, in metres, y up."""

    @abstractmethod
    def given(self) -> dict[str, float]:
        """Return what the solver is told, by symbol, SI units."""


@dataclass(frozen=True)
class Scene(AnyScene):
    """Base of all scenes with an impact: say the parameters, the physics, and what is tracked.

    To add one, write a file in `synth/scenes` with one subclass: a frozen dataclass with the class
    attributes of `AnyScene` and those below, its fields by `quantity()`, and the abstract methods; and a function
    `look(scene, camera, seed)` that draws it, there or in a file of the scene's name in `synth/looks` (`look.py`).

    Attributes
    ----------
    bodies : tuple of str
        The moving bodies, striker first.
    vector : (str, str), optional
        The points from which to which the striker's angle is measured, where it turns.
    seen_s : float
        How long, either side of the impact, everything must stay in the picture.
    longest_step_s : float
        The time step is no longer than this; slow scenes may take longer ones.
    """

    bodies: ClassVar[tuple[str, ...]]
    vector: ClassVar[tuple[str, str] | None] = None
    seen_s: ClassVar[float] = 0.04
    longest_step_s: ClassVar[float] = LONGEST_STEP_S

    time_before_s: float = quantity(0.05, "s", 0.04, 0.1, about="time shown before the impact")
    time_after_s: float = quantity(0.05, "s", 0.04, 0.1, about="time shown after the impact")
    impact_phase: float = quantity(0.5, "", 0.0, 0.99, about="part of a frame interval by which the impact is late")

    def clock(self, fps: float, refine: int = 1) -> Clock:
        """Return frames and steps of the clip; `refine` divides the time step further."""
        shown_s = self.time_before_s, self.time_after_s
        return set_clock(fps, shown_s, self.impact_phase, self.longest_step_s, refine)

    @abstractmethod
    def law(self) -> Law:
        """Return the physics in numbers: what the scene promises."""

    @abstractmethod
    def markers(self) -> tuple[Marker, ...]:
        """Return the points to track."""

    def declared(self) -> dict[str, str | float | bool]:
        """Return what the solver is told beside it: fields of `kinetics.impact_model.ImpactOptions`."""
        return {}


@cache
def _registry() -> Mapping[str, type[AnyScene]]:
    modules = [
        importlib.import_module(f"{scenes.__name__}.{item.name}") for item in pkgutil.iter_modules(scenes.__path__)
    ]
    found = [
        item
        for module in modules
        for item in vars(module).values()
        if isinstance(item, type) and issubclass(item, AnyScene) and item.__module__ == module.__name__
    ]
    return {scene.name: scene for scene in sorted(found, key=lambda scene: scene.name)}


def scene_names() -> tuple[str, ...]:
    """Return the names of all scenes, sorted."""
    return tuple(_registry())


def impact_scene_names() -> tuple[str, ...]:
    """Return the names of the scenes with an impact, sorted."""
    return tuple(name for name, scene in _registry().items() if issubclass(scene, Scene))


def scene_class(name: str) -> type[AnyScene]:
    """Return the scene of a name.

    Raises
    ------
    UnknownNameError

    >>> scene_class("soccer_kick").title
    'A leg that swings about the knee kicks a football off a tee'
    """
    if name not in _registry():
        raise UnknownNameError("scene", name, scene_names())
    return _registry()[name]
