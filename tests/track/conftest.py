"""Clips of a moving speckle body, in memory."""

from __future__ import annotations

import numpy as np
import pytest

from vml_course.model.frame import Frame


@pytest.fixture(scope="session")
def clip_of(speckle, camera_of):
    """Frames of the speckle body in the given poses (linear part, shift), with noise."""

    def make(poses, noise_grey=1.0, retouch=None):
        frames = []
        for k, (linear, shift) in enumerate(poses):
            picture = speckle.picture(linear, shift)
            if retouch is not None:
                picture = retouch(k, picture)
            frames.append(Frame(k, k / 480, camera_of(picture, noise_grey, k)))
        return frames

    return make


@pytest.fixture(scope="session")
def error_of(speckle):
    """Distance, px, of each tracked place from where the point really is: (n, p)."""

    def compare(track, poses, points):
        truth = np.stack([[speckle.moved(point, *pose) for point in points] for pose in poses])
        return np.hypot(*np.moveaxis(track.xy_px - truth, -1, 0))

    return compare
