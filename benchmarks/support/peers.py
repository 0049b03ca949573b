"""What others do, each as a function (pictures, seeds (p, 2), block) -> places (n, p, 2), NaN where lost."""

from __future__ import annotations

from itertools import pairwise

import cv2
import numpy as np

SEARCH_PX = 40


def lucas_kanade(pictures, seeds, block):
    """OpenCV's pyramidal Lucas-Kanade from picture to picture, as its tutorial uses it."""
    at = seeds.astype(np.float32).reshape(-1, 1, 2)
    alive, found = np.ones(len(seeds), bool), [seeds]
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 30, 0.01)
    for before, now in pairwise(pictures):
        at, status, _ = cv2.calcOpticalFlowPyrLK(
            before, now, at, None, winSize=(block, block), maxLevel=3, criteria=criteria
        )
        alive &= status.ravel() == 1
        found.append(np.where(alive[:, None], at.reshape(-1, 2), np.nan))
    return np.array(found)


def match_template(pictures, seeds, block):
    """matchTemplate (TM_CCOEFF_NORMED) about the last place, a parabola along x and y, template always renewed."""
    found = [seeds]
    templates = [_cut(pictures[0], seed, block) for seed in seeds]
    for now in pictures[1:]:
        places = []
        for k, last in enumerate(found[-1]):
            place = _best(now, templates[k], last) if templates[k] is not None else np.full(2, np.nan)
            places.append(place)
            templates[k] = _cut(now, place, block) if np.isfinite(place).all() else None
        found.append(np.array(places))
    return np.array(found)


def ecc_affine(pictures, seeds, block):
    """findTransformECC, affine, Gaussian of 1 px, the first picture's block, constant velocity as first guess."""
    return np.stack([_ecc_point(pictures, seed, block) for seed in seeds], axis=1)


def _ecc_point(pictures, seed, block):
    template, (left, top) = _cut(pictures[0], seed, block), _corner(seed, block)
    middle = np.array(seed) - [left, top]  # of the tracked point, in the template
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 50, 1e-5)
    poses = [np.array([[1.0, 0, left], [0, 1.0, top]])]
    found, lost = [np.array(seed)], 0
    for now in pictures[1:]:
        guesses = [2 * poses[-1] - poses[-2]] if len(poses) > 1 and not lost else []
        pose = None
        for guess in [*guesses, poses[-1], *_coarse(template, now, poses[-1], middle)]:
            pose = _ecc(template, now, guess, criteria)
            if pose is not None:
                break
        lost = 0 if pose is not None else lost + 1
        found.append(pose[:, :2] @ middle + pose[:, 2] if pose is not None else np.full(2, np.nan))
        if pose is not None:
            poses = [poses[-1], pose]
    return np.array(found)


def _coarse(template, picture, pose, middle):
    """Where the block looks most alike: without it every point that moves in the first picture would be lost."""
    last = pose[:, :2] @ middle + pose[:, 2]
    turned = cv2.warpAffine(
        template, pose[:, :2] @ np.eye(2, 3) + [[0, 0, c] for c in middle - pose[:, :2] @ middle], template.shape
    )
    place = _best(picture, turned, last)
    if np.isfinite(place).all():
        yield np.column_stack([pose[:, :2], place - pose[:, :2] @ middle])


def _ecc(template, picture, guess, criteria):
    size, margin = template.shape[0], 30
    corners = np.array([[0, 0], [size, 0], [0, size], [size, size]]) @ guess[:, :2].T + guess[:, 2]
    x0, y0 = np.maximum(np.floor(corners.min(axis=0)).astype(int) - margin, 0)
    x1, y1 = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + margin, picture.shape[::-1])
    if x1 - x0 < size // 2 or y1 - y0 < size // 2:
        return None
    local = guess.astype(np.float32)
    local[:, 2] -= [x0, y0]
    try:
        score, local = cv2.findTransformECC(
            template, np.ascontiguousarray(picture[y0:y1, x0:x1]), local, cv2.MOTION_AFFINE, criteria, None, 1
        )
    except cv2.error:
        return None
    pose = local.astype(np.float64)
    pose[:, 2] += [x0, y0]
    return pose if score > 0.5 else None


def _corner(place, block):
    return [int(np.floor(c - 0.5 * (block - 1) + 0.5)) for c in place]


def _cut(picture, place, block):
    left, top = _corner(place, block)
    if left < 0 or top < 0 or left + block > picture.shape[1] or top + block > picture.shape[0]:
        return None
    return picture[top : top + block, left : left + block].copy()


def _best(picture, template, last):
    block = template.shape[0]
    left, top = _corner(last, block)
    offset = np.array(last) - [left, top]  # whole pixels are matched; the fraction of the last place stays lost
    x0, y0 = max(0, left - SEARCH_PX), max(0, top - SEARCH_PX)
    region = picture[y0 : top + block + SEARCH_PX, x0 : left + block + SEARCH_PX]
    if min(region.shape) < block + 2:
        return np.full(2, np.nan)
    score = cv2.matchTemplate(region, template, cv2.TM_CCOEFF_NORMED)
    _, best, _, (column, row) = cv2.minMaxLoc(score)
    if best < 0.5:
        return np.full(2, np.nan)
    fraction = parabola(score[row], column), parabola(score[:, column], row)
    return np.array([x0 + column, y0 + row]) + offset + fraction


def parabola(values, k):
    """Return how far from k the extremum of the parabola through k - 1, k, k + 1 lies; 0 at the rim."""
    if not 0 < k < len(values) - 1:
        return 0.0
    a, b, c = (float(v) for v in values[k - 1 : k + 2])
    bend = a - 2 * b + c
    return 0.5 * (a - c) / bend if bend else 0.0
