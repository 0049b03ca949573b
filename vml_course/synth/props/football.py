"""A football: the truncated icosahedron, seen from the side, with a fine grain for trackers."""

from __future__ import annotations

from itertools import product

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.synth.canvas import Canvas, sheet
from vml_course.synth.props.prints import Print
from vml_course.synth.shapes import disc
from vml_course.synth.sprite import OVERSAMPLE, Sprite, make_sprite
from vml_course.synth.texture import Plane

WHITE = (228.0, 228.0, 222.0)
DARK = (44.0, 46.0, 56.0)
SEAM = (120.0, 122.0, 126.0)
RIM = (70.0, 72.0, 78.0)
GOLDEN = (1 + 5**0.5) / 2
FACE_DISTANCE = {"pentagon": 2.32744, "hexagon": 2.26728}  # from the centre, in edge lengths
SEAM_WIDTH = 0.012
GRAIN_GREY = 15.0


def draw_football(radius_m: float, px_per_m: float, printed: Print) -> Sprite:
    """Draw a ball whose centre is its origin."""
    on = sheet((radius_m,) * 4, px_per_m, OVERSAMPLE)
    rim = disc(on, (0.0, 0.0), radius_m)
    on.fill(rim, WHITE)
    pentagon, seam = _panels(on, radius_m)
    on.fill(np.maximum(rim, seam), SEAM)
    on.fill(np.maximum(rim, pentagon), DARK)
    on.fill(np.maximum(rim, -(rim + 0.02 * radius_m)), RIM)
    on.lighten(printed.speckle(on, "ball", GRAIN_GREY, OVERSAMPLE), rim)
    on.lighten(_shade(on, radius_m), rim)
    return make_sprite(on)


def _panels(on: Canvas, radius_m: float) -> tuple[Plane, Plane]:
    """Return distances to the dark pentagons and to the seams.

    A line of sight meets the face whose plane it reaches first: the largest n·c/h of normal n, face
    direction c and face distance h.
    """
    faces, is_pentagon = _faces()
    across, along = np.broadcast_arrays(on.x_m / radius_m, on.y_m / radius_m)
    depth = np.sqrt(np.maximum(0.0, 1 - across**2 - along**2))
    normal = np.stack([across, along, depth], axis=-1).astype(np.float32)
    reach = normal @ faces.T.astype(np.float32)
    pentagon = reach[..., is_pentagon].max(axis=-1)
    hexagons = np.partition(reach[..., ~is_pentagon], -2, axis=-1)[..., -2:]
    edge = (hexagons[..., 1] - pentagon) * 2.3 * radius_m
    seam = (hexagons[..., 1] - hexagons[..., 0]) * 2.3 * radius_m - SEAM_WIDTH * radius_m
    return edge.astype(np.float32), seam.astype(np.float32)


def _faces() -> tuple[FloatArray, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
    """Return directions over distances of 12 pentagons (an icosahedron's corners) and 20 hexagons (its faces)."""
    rolls = [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
    corner = [np.array([0.0, s, t * GOLDEN]) for s, t in product((1, -1), repeat=2)]
    corners = np.array([c[list(roll)] for c in corner for roll in rolls])
    cube = [np.array(signs, dtype=float) for signs in product((1, -1), repeat=3)]
    side = [np.array([0.0, s / GOLDEN, t * GOLDEN]) for s, t in product((1, -1), repeat=2)]
    middles = np.array(cube + [c[list(roll)] for c in side for roll in rolls])
    # The dodecahedron of the faces is dual to the icosahedron of the corners only with its axes cycled.
    middles = middles[:, [0, 2, 1]] if not _dual(corners, middles) else middles
    tilt = _turn(0.35, 0.45)
    pentagons = corners / np.linalg.norm(corners, axis=1, keepdims=True) / FACE_DISTANCE["pentagon"]
    hexagons = middles / np.linalg.norm(middles, axis=1, keepdims=True) / FACE_DISTANCE["hexagon"]
    return np.vstack([pentagons, hexagons]) @ tilt.T, np.arange(32) < 12


def _dual(corners: FloatArray, middles: FloatArray) -> bool:
    """Tell whether each middle is equally near to three corners."""
    nearest = np.sort(middles @ corners.T, axis=1)[:, -3:]
    return bool(np.allclose(nearest, nearest[:, :1]))


def _turn(about_x: float, about_y: float) -> FloatArray:
    c, s, k, n = np.cos(about_x), np.sin(about_x), np.cos(about_y), np.sin(about_y)
    tip, yaw = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]), np.array([[k, 0, n], [0, 1, 0], [-n, 0, k]])
    return np.asarray(tip @ yaw)


def _shade(on: Canvas, radius_m: float) -> Plane:
    """Darken away from the light, which comes from the upper left."""
    across, along = on.x_m / radius_m, on.y_m / radius_m
    return np.asarray(
        -26.0 * np.clip(0.35 * across - 0.55 * along + 0.45 * (across**2 + along**2), -0.3, 1.2), np.float32
    )
