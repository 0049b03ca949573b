"""Planes of a decoded picture: luma as it is stored, colours as full-range Y'CbCr 4:2:0."""

from __future__ import annotations

from typing import Any

import av
import cv2
import numpy as np
from av.video.reformatter import ColorRange, Colorspace
from numpy.typing import NDArray

from vml_course.model.frame import Luma, Picture

JPEG_RANGE, UNKNOWN_RANGE = 2, 0
GREYS = ("gray", "ya", "mono")  # ya: with transparency


def luma_of(frame: av.VideoFrame) -> Luma:
    """Return the luma plane, shape (height, width), upright; 8-bit planes are copied, not converted.

    Deeper planes are rounded to 8 bits; pictures without luma (RGB, palettes) become grey by BT.601. The range is left
    as it is: in most videos luma runs from 16 to 235, which matching does not notice.
    """
    if not frame.format.components[0].is_luma or frame.format.has_palette:
        grey = cv2.cvtColor(frame.to_ndarray(format="bgr24"), cv2.COLOR_BGR2GRAY)
        return upright(np.asarray(grey, dtype=np.uint8), frame.rotation)
    return upright(_plane(_with_luma_plane(frame), 0), frame.rotation)


def _with_luma_plane(frame: av.VideoFrame) -> av.VideoFrame:
    """Unpack a frame whose luma is mixed with other samples, which leaves it what it is."""
    name = frame.format.name
    if frame.format.is_planar or (name.startswith("gray") and frame.format.components[0].bits <= 16):
        return frame
    return frame.reformat(format="gray" if name.startswith(GREYS) else "yuv422p")


def _plane(frame: av.VideoFrame, number: int) -> Luma:
    """Copy one plane out of the frame, because the view dies with it; lines are wider than the picture."""
    component = frame.format.components[number]
    plane = frame.planes[component.plane]
    name = frame.format.name
    dtype = np.dtype("u1") if component.bits == 8 else np.dtype(">u2" if name.endswith("be") else "<u2")
    lines = np.frombuffer(memoryview(plane), dtype=np.uint8).reshape(-1, plane.line_size)
    view = lines[: plane.height, : plane.width * dtype.itemsize].view(dtype)
    if component.bits == 8:
        return np.array(view, dtype=np.uint8)
    is_high = name.startswith(("p0", "p2", "p4"))  # P010 and its kin fill 16-bit words from the top
    shift = 8 if is_high else component.bits - 8
    rounded = (view.astype(np.uint32) + (1 << (shift - 1))) >> shift
    return np.asarray(np.minimum(rounded, 255), dtype=np.uint8)


def picture_of(frame: av.VideoFrame) -> Picture:
    """Return a picture for the encoders: full range, 4:2:0, upright, an odd last line or column left out."""
    rotation = frame.rotation
    full = frame.reformat(
        format="yuvj420p",
        src_color_range=ColorRange.JPEG if _is_full(frame) else ColorRange.MPEG,
        dst_color_range=ColorRange.JPEG,
        dst_colorspace=Colorspace.ITU601,
    )
    luma, blue, red = (upright(_plane(full, number), rotation) for number in range(3))
    height, width = luma.shape[0] // 2 * 2, luma.shape[1] // 2 * 2
    half = np.s_[: height // 2, : width // 2]
    return Picture(
        np.ascontiguousarray(luma[:height, :width]), np.ascontiguousarray(blue[half]), np.ascontiguousarray(red[half])
    )


def _is_full(frame: av.VideoFrame) -> bool:
    """Whether black is 0 and white 255; grey files that do not say so mean it."""
    name, said = frame.format.name, frame.color_range
    if frame.format.is_rgb or frame.format.has_palette or name.startswith("yuvj"):
        return True
    return bool(said == JPEG_RANGE or (said == UNKNOWN_RANGE and name.startswith(GREYS)))


def upright(plane: NDArray[np.uint8], rotation_deg: float) -> NDArray[np.uint8]:
    """Turn a plane counter-clockwise by the file's rotation, as players do (phones held upright).

    >>> upright(np.array([[1, 2], [3, 4]], dtype=np.uint8), 90).tolist()
    [[2, 4], [1, 3]]
    """
    quarters = round(rotation_deg / 90) % 4
    return np.ascontiguousarray(np.rot90(plane, quarters)) if quarters else plane


def upright_shape(frame: av.VideoFrame) -> tuple[int, int]:
    """Return height and width of a picture as it is shown."""
    shape = frame.height, frame.width
    return (shape[1], shape[0]) if round(frame.rotation / 90) % 2 else shape


def bgr_of(picture: Picture) -> NDArray[np.uint8]:
    """Return a picture as blue, green, red: shape (height, width, 3)."""
    height, width = picture.luma.shape
    red, blue = (
        cv2.resize(plane, (width, height), interpolation=cv2.INTER_LINEAR) for plane in (picture.red, picture.blue)
    )
    ycrcb = np.dstack([picture.luma, red, blue])
    return np.asarray(cv2.cvtColor(ycrcb, cv2.COLOR_YCrCb2BGR), dtype=np.uint8)


def picture_from_bgr(bgr: NDArray[np.uint8]) -> Picture:
    """Return the planes (BT.601, full range) of a blue, green, red image of even size."""
    ycrcb: Any = cv2.cvtColor(bgr, cv2.COLOR_BGR2YCrCb)
    luma, red, blue = (np.ascontiguousarray(ycrcb[..., channel]) for channel in range(3))
    half = (luma.shape[1] // 2, luma.shape[0] // 2)
    red, blue = (np.asarray(cv2.resize(plane, half, interpolation=cv2.INTER_AREA), np.uint8) for plane in (red, blue))
    return Picture(luma, blue, red)
