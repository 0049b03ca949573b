"""Draws a body that is strained: each pixel finds the place of the undeformed drawing that it sees.

The sheet is drawn once, before loading, as every body is (`sprite`). In a frame, a pixel looks through lens and hand at
a place of the plane (`sight`), the way back of the displacement field leads from there to a point of the sheet, and
there the drawing is read by the same splines. The optics' blur is strained along, which moves no centre.

The way back is worked out at every third pixel and interpolated by cubic splines, for fields are smooth: that leaves
less than 1e-4 px (tests/synth measure it) and takes a seventh of the time.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
from scipy.interpolate import make_interp_spline

from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.truth import Truth
from vml_course.synth.bent import Bent, halved
from vml_course.synth.canvas import Canvas
from vml_course.synth.look import look_of
from vml_course.synth.shake import shifted
from vml_course.synth.sheet import Sheet
from vml_course.synth.sight import Sight, in_halves
from vml_course.synth.spline import add_gathered
from vml_course.synth.sprite import Planes, Sprite, empty_veil, lay_veil, make_planes

EVERY_PX: Final = 3
SPLINE: Final = 3


@dataclass(frozen=True, eq=False)
class StrainedLook:
    """What the renderer needs.

    Attributes
    ----------
    background : Canvas
        Drawn at the camera's own scale, opaque.
    sheet : Sprite
        The body that is strained, before loading; its origin is the world's.
    sprites : mapping of str to Sprite
        What lies over it, by body.
    """

    background: Canvas
    sheet: Sprite
    sprites: Mapping[str, Sprite]


def draw_strained(truth: Truth, scene: Sheet) -> Iterator[Planes]:
    """Yield the pictures without noise and rounding; none may be kept."""
    sight = Sight(truth.camera)
    look: StrainedLook = look_of(scene, sight.board, truth.seed)
    strain = truth.strain
    if strain is None:
        raise ValueError("nothing is strained")
    still = sight.still(make_planes(look.background))
    shown: tuple[float, ...] = ()
    planes = still
    for load, pose, offset_px in zip(strain.load.tolist(), truth.pose, truth.offset_px, strict=True):
        if (now := (load, *offset_px.tolist())) != shown:  # while the load is held, the picture stays
            planes, shown = shifted(still, offset_px) if offset_px.any() else still.copy(), now
            _lay_sheet(planes, look.sheet, origins(scene, truth.camera, load, offset_px), truth.camera)
            for body, (x, y, turn) in zip(truth.bodies, pose, strict=True):
                at = truth.camera.to_square_px(np.array([x, y]))
                Bent(look.sprites[body], np.array([[[*at, turn]]]), sight, offset_px[None, None]).lay(planes, 0)
        yield planes


def origins(scene: Sheet, camera: Camera, load: float, offset_px: FloatArray) -> FloatArray:
    """Return which point of the sheet each pixel sees under a load while the picture is shifted.

    Returns
    -------
    float array, shape (h, w, 2)
        Where that point is before loading, in the pixels of a square camera.
    """
    (nodes_x, across), (nodes_y, down) = (_nodes(size) for size in camera.size_px)
    seen = np.stack(np.meshgrid(nodes_x, nodes_y), axis=-1)
    found = camera.to_square_px(scene.origin_of(camera.to_m(seen - offset_px), load))
    return np.stack([down @ found[..., k] @ across.T for k in (0, 1)], axis=-1)


@cache
def _nodes(length: int) -> tuple[FloatArray, FloatArray]:
    """Return places along an edge, shape (k,), and what each pixel takes of the values there, shape (length, k)."""
    nodes = np.linspace(0.0, length - 1.0, max(length // EVERY_PX, SPLINE) + 1)
    return nodes, np.asarray(make_interp_spline(nodes, np.eye(len(nodes)), k=SPLINE)(np.arange(length)))


def _lay_sheet(on: Planes, sheet: Sprite, places: FloatArray, camera: Camera) -> None:
    box = (0, 0, *camera.size_px)
    ways = sheet.ways(np.array([[[*camera.to_square_px(np.zeros(2)), 0.0]]]))
    veil, (luma, chroma) = empty_veil(box), sheet.drawings
    add_gathered(luma, ways, np.ascontiguousarray(places), veil.luma)
    add_gathered(chroma, halved(ways), in_halves(places), veil.chroma)
    lay_veil(on, veil, box)
