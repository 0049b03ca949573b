"""The room: a quiet wall and floor, a thigh that ends at the knee, a tee, and a 1 m pole on the floor."""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np

from vml_course.model.camera import Camera
from vml_course.synth.canvas import Canvas, make_canvas
from vml_course.synth.props.target import draw_pole
from vml_course.synth.shapes import Point, box, polygon, tapered
from vml_course.synth.texture import Plane, grain

WALL = (150.0, 164.0, 168.0)
DADO = (122.0, 142.0, 152.0)
SKIRTING = (92.0, 102.0, 108.0)
FLOOR = (176.0, 148.0, 112.0)
TEE = (64.0, 70.0, 78.0)
SKIN = (198.0, 150.0, 122.0)
SHORTS = (226.0, 226.0, 230.0)
TEXT = (30.0, 30.0, 32.0)
WALL_GREY = 3.0


def draw_gym(camera: Camera, seed: int, marks_m: Mapping[str, Point], tee_m: Point) -> Canvas:
    """Draw what does not move, at the camera's scale; the pivot (a knee) is the world's origin."""
    width, height = camera.size_px
    on = make_canvas((height, width), camera.px_per_m, (camera.origin_x_px, camera.origin_y_px))
    left, right = marks_m["bar_left"], marks_m["bar_right"]
    _draw_room(on, seed, left[1] + 0.07)
    _draw_tee(on, tee_m, left[1])
    draw_pole(on, left, right)
    _write(on, "1 m", (right[0] + 0.03, left[1] - 0.014))
    _draw_thigh(on, seed)
    return on


def _draw_room(on: Canvas, seed: int, floor_m: float) -> None:
    far = 100.0
    on.fill(box(on, (-far, -far), (far, far)), WALL)
    on.fill(box(on, (-far, -far), (far, floor_m + 0.62)), DADO)
    on.fill(box(on, (-far, -far), (far, floor_m + 0.03)), SKIRTING)
    on.fill(box(on, (-far, -far), (far, floor_m)), FLOOR)
    shape = (on.opacity.shape[0], on.opacity.shape[1])
    on.lighten((WALL_GREY * grain(seed, "wall", shape, 3.0)).astype(np.float32))
    on.lighten(_planks(on, floor_m))


def _planks(on: Canvas, floor_m: float) -> Plane:
    """Darken the joints between floor boards, which run along the wall."""
    depth = floor_m - on.y_m + 0.0 * on.x_m
    joint = np.abs((depth / 0.055) % 1.0 - 0.5) * 0.055 * on.samples_per_m
    return np.asarray(-14.0 * np.clip(1.5 - joint, 0.0, 1.0) * (depth > 0), np.float32)


def _draw_tee(on: Canvas, top_m: Point, floor_m: float) -> None:
    x, y = top_m
    base = floor_m - 0.014
    on = on.near((x - 0.07, base - 0.02), (x + 0.07, y + 0.02))
    stem = [(x - 0.03, base), (x + 0.03, base), (x + 0.008, y + 0.004), (x - 0.008, y + 0.004)]
    on.fill(polygon(on, stem), TEE)
    on.fill(box(on, (x - 0.03, y - 0.012), (x + 0.03, y + 0.002)), TEE)
    on.fill(box(on, (x - 0.06, base - 0.008), (x + 0.06, base + 0.006)), TEE)


def _draw_thigh(on: Canvas, seed: int) -> None:
    knee, hip = ((0.0, 0.0), 0.092), ((-0.16, 0.50), 0.13)
    on = on.near((-0.5, -0.1), (0.2, 0.8))
    thigh = tapered(on, knee, hip)
    on.fill(thigh, SKIN)
    shape = (on.opacity.shape[0], on.opacity.shape[1])
    on.lighten(6.0 * grain(seed, "thigh", shape, 1.0), thigh)
    leg_of_shorts = [(-0.27, 0.19), (0.07, 0.26), (0.12, 0.8), (-0.42, 0.8)]
    on.fill(polygon(on, leg_of_shorts), SHORTS)


def _write(on: Canvas, text: str, at_m: Point) -> None:
    """Write into the picture; letters are 4.5 cm high."""
    column = round(at_m[0] * on.samples_per_m + on.origin[0])
    row = round(on.origin[1] - at_m[1] * on.samples_per_m)
    ink = np.zeros(on.opacity.shape, np.uint8)
    size = 0.045 * on.samples_per_m / 22.0  # this face's capitals are 22 px high at scale 1
    cv2.putText(ink, text, (column, row), cv2.FONT_HERSHEY_SIMPLEX, size, 255, max(1, round(2.2 * size)), cv2.LINE_AA)
    on.fill((0.5 - ink.astype(np.float32) / 255.0) / on.samples_per_m, TEXT)
