"""How a scene looks: a still background and one sprite a body.

A scene says what happens; the file of its name in `synth/looks` draws it, so that whoever needs the physics alone
loads no drawing.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass
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
    return importlib.import_module(f"{looks.__name__}.{scene.name}").look(scene, camera, seed)
