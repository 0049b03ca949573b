"""Pictures in which a block fades before a gap, or comes back after it, are part of the gap."""

from dataclasses import replace

import numpy as np
import pytest

from vml_course.model.track import Status, Track
from vml_course.track.fading import without_fading


def track_with(zncc, status=None):
    n = len(zncc)
    zncc = np.array(zncc, float)[:, None]
    lost = np.isnan(zncc)
    return Track(
        points=("a",),
        frame=np.arange(n),
        time_s=np.arange(n) / 480,
        xy_px=np.where(lost[..., None], np.nan, np.ones((n, 1, 2))),
        sigma_px=np.where(lost, np.nan, 0.01),
        zncc=zncc,
        iterations=np.ones((n, 1)),
        status=np.where(lost, Status.LOST, Status.AUTO) if status is None else status,
        gradient=np.zeros((n, 1, 4)),
    )


LOST = float("nan")


@pytest.mark.parametrize(
    ("zncc", "lost"),
    [
        ([1, 0.97, 0.96, 0.71, LOST, LOST, 0.97], [3, 4, 5]),
        ([1, 0.97, 0.96, 0.97, LOST, 0.75, 0.7, 0.97], [4, 5, 6]),
        ([1, 0.97, 0.7, 0.97, 0.96, 0.97], []),
        ([1, 0.97, 0.7, 0.97, LOST, 0.96], [4]),
        ([1, 0.72, 0.71, 0.7, LOST, 0.72, 0.71], [4]),
    ],
    ids=["fades", "comes back", "weak alone", "weak elsewhere", "always weak"],
)
def test_weak_pictures_beside_a_gap_belong_to_it(zncc, lost):
    found = without_fading(track_with(zncc))
    assert np.flatnonzero(found.is_lost[:, 0]).tolist() == lost
    assert np.isnan(found.xy_px[lost]).all()
    assert np.isfinite(np.delete(found.xy_px, lost, axis=0)).all()


def test_a_place_by_hand_stays():
    track = track_with([1, 0.97, 0.96, 0.97, 0.7, LOST])
    by_hand = np.array(track.status)
    by_hand[4] = Status.MANUAL
    assert np.flatnonzero(without_fading(replace(track, status=by_hand)).is_lost[:, 0]).tolist() == [5]
