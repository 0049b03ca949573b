"""Pictures with known motion, for every room that looks at pictures; an S3 server for those that keep files."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import settings
from numpy.typing import NDArray

# CI asks the same questions every time; at a desk Hypothesis goes on looking for new ones.
settings.register_profile("ci", derandomize=True, deadline=None)
if os.environ.get("CI"):
    settings.load_profile("ci")

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Speckle:
    """A plane of Gaussian blobs that moves as one affine body; its pictures are exact, not resampled."""

    seed: int = 1
    width_px: int = 240
    height_px: int = 220
    radius_px: float = 2.0
    amplitude_grey: float = 60.0
    spread_px: float = 110.0
    blobs: Array = field(init=False)

    def __post_init__(self) -> None:
        rng = np.random.default_rng(self.seed)
        count = int(0.025 * (2 * self.spread_px) ** 2)
        places = rng.uniform(-self.spread_px, self.spread_px, (count, 2))
        heights = rng.uniform(-self.amplitude_grey, self.amplitude_grey, (count, 1))
        object.__setattr__(self, "blobs", np.hstack([places, heights]))

    @property
    def middle(self) -> Array:
        """The point about which the body turns, before it moves: px."""
        return np.array([self.width_px / 2, self.height_px / 2])

    def moved(self, point: Array, linear: Array, shift: Array) -> Array:
        """Where a point of the body goes."""
        return self.middle + shift + (np.asarray(point) - self.middle) @ np.asarray(linear).T

    def picture(self, linear: Array | None = None, shift: Array = (0.0, 0.0)) -> Array:
        """Grey levels, not rounded, of the moved body; blobs stay round (their centres move)."""
        linear = np.eye(2) if linear is None else np.asarray(linear)
        image = np.full((self.height_px, self.width_px), 128.0)
        reach = int(5 * self.radius_px) + 1
        centres = self.middle + np.asarray(shift) + self.blobs[:, :2] @ linear.T
        for (x, y), height in zip(centres, self.blobs[:, 2], strict=True):
            rows = np.arange(max(0, int(y) - reach), min(self.height_px, int(y) + reach + 2))
            columns = np.arange(max(0, int(x) - reach), min(self.width_px, int(x) + reach + 2))
            if rows.size and columns.size:
                down = np.exp(-((rows - y) ** 2) / (2 * self.radius_px**2))
                across = np.exp(-((columns - x) ** 2) / (2 * self.radius_px**2))
                image[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] += height * np.outer(down, across)
        return image


def rotation(angle_deg: float) -> Array:
    """Rotation by an angle as the picture shows it (x right, y down)."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    return np.array([[c, -s], [s, c]])


def camera(image: Array, noise_grey: float = 0.0, seed: int = 0) -> NDArray[np.uint8]:
    """What an 8-bit camera makes of grey levels; read-only, as a decoder's frames are."""
    noisy = image + np.random.default_rng(seed).normal(0.0, noise_grey, image.shape) if noise_grey else image
    luma = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
    luma.setflags(write=False)
    return luma


@pytest.fixture(scope="session")
def speckle() -> Speckle:
    return Speckle()


@pytest.fixture(scope="session")
def rotated():
    return rotation


@pytest.fixture(scope="session")
def camera_of():
    return camera


@pytest.fixture(scope="session")
def bucket() -> Iterator[str]:
    """Run an S3 server of its own on loopback and return the URL of a bucket."""
    import s3fs  # noqa: PLC0415 - most tests need no server
    from moto.server import ThreadedMotoServer  # noqa: PLC0415

    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    told = {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ACCESS_KEY_ID": "nobody",
        "AWS_SECRET_ACCESS_KEY": "nothing",
        "AWS_DEFAULT_REGION": "us-east-1",
    }
    before = {name: os.environ.get(name) for name in told}
    os.environ.update(told)
    s3fs.S3FileSystem.clear_instance_cache()
    s3fs.S3FileSystem().mkdir("course-bucket")
    yield "s3://course-bucket"
    s3fs.S3FileSystem.clear_instance_cache()
    server.stop()
    for name, value in before.items():
        if value is None:
            os.environ.pop(name)
        else:
            os.environ[name] = value
