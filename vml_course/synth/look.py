"""How a scene looks: a still background and one sprite a body.

A scene says what happens. Its own file may draw it, too, by a function `look(scene, camera, seed)`; of the scenes that
are handed out, the file of their name in `synth/looks` does, so that whoever needs the physics alone loads no drawing.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from vml_course.model.camera import Camera
from vml_course.synth import looks
from vml_course.synth.canvas import Canvas
from vml_course.synth.scene import AnyScene
from vml_course.synth.sprite import Sprite


@dataclass(frozen=True, eq=False)
class Look:
    """What the renderer needs.

    Attributes
    ----------
    background : Canvas
        Drawn at the camera's own scale, opaque.
    sprites : mapping of str to Sprite
        By body; later ones are drawn over earlier ones.
    """

    background: Canvas
    sprites: Mapping[str, Sprite]


def look_of(scene: AnyScene, camera: Camera, seed: int) -> Any:
    """Draw a scene; return a `Look`, of a body that is strained a `strained.StrainedLook`."""
    return _drawer(type(scene))(scene, camera, seed)


@cache
def _drawer(kind: type[AnyScene]) -> Callable[[AnyScene, Camera, int], Any]:
    """Return what draws a scene: its own file, the one of its name, or what draws the scene that it is made from."""
    drawn = {module.name for module in iter_modules(looks.__path__)}
    for base in kind.__mro__:
        own, name = getattr(sys.modules[base.__module__], "look", None), base.__dict__.get("name", "")
        if own is not None:
            return own  # type: ignore[no-any-return]
        if name in drawn:
            return import_module(f"{looks.__name__}.{name}").look  # type: ignore[no-any-return]
    raise NotImplementedError(f"{kind.__name__}: expected a function `look` in its file or in synth/looks, got none")
