"""How a scene looks: a still background and one sprite a body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from vml_course.synth.canvas import Canvas
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
