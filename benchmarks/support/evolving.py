"""The evolving-template matcher of a well-known tool, written anew from its description (grey instead of RGB).

Full search of the squared difference under an elliptical mask within +-40 px of an extrapolated point; a parabola
each along x and y; score = mean / least - 1, divided by the peak's width when that is above 1 px. 4 counts as found,
1 to 4 asks the user, who is taken to say yes here; below 1 the point is lost. Template: 20 % of the match, cut at
whole pixels, over the old one, then 5 % of the first one.
"""

from __future__ import annotations

import cv2
import numpy as np

SEARCH_PX, EVOLVE, TETHER, NO_MATCH = 40, 0.20, 0.05, 1.0


def evolving(pictures, seeds, block):
    """Follow each point by itself, as the tool does."""
    return np.stack([_point(pictures, np.array(seed, np.float64), block) for seed in seeds], axis=1)


def _point(pictures, seed, block):
    size = block | 1
    half = size // 2
    mask = cv2.ellipse(np.zeros((size, size), np.uint8), (half, half), (half, half), 0, 0, 360, 1, -1)
    first = _cut(pictures[0], np.rint(seed).astype(int), half).astype(np.float64)
    offset, template, found = seed - np.rint(seed), first, [seed]  # the target keeps its place in the template
    for picture in pictures[1:]:
        place, score = _search(picture, template, mask, _ahead(found) - offset, half)
        match = None if place is None else _cut(picture, np.rint(place).astype(int), half)
        if match is None or score < NO_MATCH:
            found.append(np.full(2, np.nan))
            continue
        template = np.rint((1 - EVOLVE) * template + EVOLVE * match)
        template = np.rint((1 - TETHER) * template + TETHER * first)
        found.append(place + offset)
    return np.array(found)


def _ahead(found):
    """Constant acceleration, velocity or place, whichever the last four points support; per axis."""
    seen = [place for place in found[-4:] if np.isfinite(place).all()]
    if len(seen) < 4:
        return seen[-1] if seen else next(place for place in reversed(found) if np.isfinite(place).all())
    x = np.array(seen)
    one, two, three = (np.diff(x, k, axis=0) for k in (1, 2, 3))
    steady = np.abs(two[-1]) < np.abs(one).mean(axis=0)
    smooth = np.abs(three[-1]) < np.abs(two).mean(axis=0)
    return np.where(smooth, 3 * x[-1] - 3 * x[-2] + x[-3], np.where(steady, 2 * x[-1] - x[-2], x[-1]))


def _cut(picture, middle, half):
    x, y = middle
    patch = picture[max(0, y - half) : y + half + 1, max(0, x - half) : x + half + 1]
    return patch if patch.shape == (2 * half + 1, 2 * half + 1) else None


def _search(picture, template, mask, middle, half):
    rows, columns = picture.shape
    x, y = np.clip(np.rint(middle).astype(int), half, [columns - half - 1, rows - half - 1])
    x0, y0 = max(0, x - half - SEARCH_PX), max(0, y - half - SEARCH_PX)
    region = picture[y0 : y + half + SEARCH_PX + 1, x0 : x + half + SEARCH_PX + 1]
    squares = cv2.matchTemplate(region, template.astype(np.uint8), cv2.TM_SQDIFF, mask=mask).astype(np.float64)
    least, _, (column, row), _ = cv2.minMaxLoc(squares)
    if least <= 0.0:
        return np.array([x0 + column + half, y0 + row + half], np.float64), np.inf
    (dx, wx), (dy, wy) = _peak(squares[row], column), _peak(squares[:, column], row)
    width = 0.5 * (wx + wy)
    score = squares.mean() / least - 1
    return np.array([x0 + column + half + dx, y0 + row + half + dy]), score / width if width > 1 else score


def _peak(values, k):
    if not 0 < k < len(values) - 1:
        return 0.0, 1.0
    a, b, c = (float(v) for v in values[k - 1 : k + 2])
    bend = 0.5 * (a - 2 * b + c)
    return (0.25 * (a - c) / bend, float(np.sqrt(2 * b / bend))) if bend > 0 else (0.0, 1.0)
