"""Digital image correlation: a block of the first picture, matched with an affine warp in every other one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import ClassVar, final

import numpy as np

from vml_course.correlate.exposure import cut_surroundings
from vml_course.correlate.icgn import Match
from vml_course.correlate.template import (
    WARPS,
    build_template,
    corner_sigma_px,
    cut_patch,
    read_only,
    significant_hessian,
)
from vml_course.correlate.texture import noise_grey
from vml_course.errors import SeedError
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma
from vml_course.model.quantity import check_quantities, quantity
from vml_course.model.track import Sighting, Status
from vml_course.track.blocks import check_block_fits, check_texture, first_sighting
from vml_course.track.blur import Sharp
from vml_course.track.ladder import follow
from vml_course.track.learning import learn
from vml_course.track.placing import manual_sighting, place
from vml_course.track.records import UPRIGHT, Past, Reference, Rules
from vml_course.track.renewal import composed, is_due, renewed

BLURS_PX = (0.6, 1.0)  # tried where a block as it is cannot hold every freedom of the warp
NOISY = 0.25  # of the texture's contrast
RICHEST = next(iter(WARPS))
LARGEST_CORNER_SIGMA_PX = 0.25  # beyond this a freedom of the warp is noise: take the next smaller warp
_NOTHING = (float("nan"),) * 9


@dataclass(frozen=True, eq=False)
class DicState:
    """What `Dic` remembers: the reference blocks, with what was learned of their pixels, and each point's past."""

    references: tuple[Reference, ...]
    pasts: tuple[Past, ...]


@final
@dataclass(frozen=True)
class Dic:
    """The paper's method (section 3.3), with the warp, criterion and solver that today's best use.

    Six-parameter affine warp, zero-normalised criterion (blind to gain and offset of the light),
    inverse-compositional Gauss-Newton, cubic B-splines; the reference is the first picture, so nothing
    drifts, unless a block changes its look for good (see `renewal`).

    A block that cannot hold six parameters gets fewer: the warp is the first of affine, rigid, translation
    whose corners the block's noise would not move by more than 0.25 px (one standard deviation).
    """

    name: ClassVar[str] = "dic"
    title: ClassVar[str] = "digital image correlation: turning, blurring, bending light; the default"

    block: float = quantity(60, "px", 11, 301, about="side of the block that is matched", whole=True)
    search_radius: float = quantity(40.0, "px", 2.0, 500.0, about="how far from its expected place a point may be")
    zncc_lost: float = quantity(0.6, "", 0.3, 0.99, about="least correlation of a match")
    zncc_far: float = quantity(0.7, "", 0.3, 0.99, about="least correlation of a match beyond the search radius")
    max_iterations: float = quantity(40, "", 3, 200, about="iterations before a match is given up", whole=True)
    give_up_frames: float = quantity(
        15, "", 1, 100000, about="pictures after which a lost point stays lost", whole=True
    )
    blur: float = quantity(0.0, "px", 0.0, 3.0, about="Gaussian blur of both pictures before matching, at least")
    shutter: float = quantity(
        0.0, "", 0.0, 1.0, about="share of the frame interval that the shutter is open; 0 leaves motion blur alone"
    )

    def __post_init__(self) -> None:
        check_quantities(self)

    @property
    def settings(self) -> Mapping[str, str | int | float]:
        """How it tracks, as written into the track's file."""
        return {"method": self.name, **asdict(self)}

    def start(self, luma: Luma, seeds_px: FloatArray) -> tuple[DicState, Sighting]:
        """Learn the blocks about the points, shape (p, 2), px, from the first picture.

        Raises
        ------
        SeedError
            When a block does not lie inside the picture, or has no texture or only an edge.
        """
        points = np.asarray(seeds_px, dtype=np.float64).reshape(-1, 2)
        references = tuple(self._learn(luma, f"seed {k + 1}", x, y) for k, (x, y) in enumerate(points))
        pasts = tuple(Past((np.concatenate([point, UPRIGHT]),)) for point in points)
        sigma_px = np.array([reference.sigma_px for reference in references])
        return DicState(references, pasts), first_sighting(points, sigma_px)

    def step(self, state: DicState, luma: Luma) -> tuple[DicState, Sighting]:
        """Find the points in the next picture."""
        picture, rules = read_only(luma), self._rules()
        followed = [
            follow(reference, past, picture, rules)
            for reference, past in zip(state.references, state.pasts, strict=True)
        ]
        learned = [
            self._renew(*learn(reference, past, found), found, picture)
            for reference, (past, found) in zip(state.references, followed, strict=True)
        ]
        references, pasts = zip(*learned, strict=True) if learned else ((), ())
        seen = _sighting(state.references, tuple(found for _, found in followed))
        return DicState(tuple(references), tuple(pasts)), seen

    def _renew(self, reference: Reference, past: Past, found: Match | None, luma: Luma) -> tuple[Reference, Past]:
        """Cut the block anew where it was just found, when its reference has faded and there is texture to hold."""
        if found is None or not is_due(past):
            return reference, past
        try:
            fresh = self._learn(luma, "renewed", *found.pose[:2].tolist())
        except SeedError:
            return reference, past
        base = composed(found.pose[2:], reference.base)
        drift_px = found.sigma_px + reference.drift_px  # what changes the look goes on pulling the same way
        return replace(fresh, base=base, drift_px=drift_px), renewed(past)

    def place(self, state: DicState, luma: Luma, points_px: FloatArray) -> tuple[DicState, Sighting]:
        """Go on from where the points, shape (p, 2), px, are said to be in this picture; see `placing`."""
        picture, rules = read_only(luma), self._rules()
        placed = [
            place(reference, past, picture, rules, point)
            for reference, past, point in zip(state.references, state.pasts, points_px, strict=True)
        ]
        seen = tuple(
            None if found is None else found._replace(pose=_as_first(reference, found))
            for reference, (_, found) in zip(state.references, placed, strict=True)
        )
        sighting = manual_sighting(points_px, seen)
        return DicState(state.references, tuple(past for past, _ in placed)), sighting

    def _rules(self) -> Rules:
        return Rules(
            self.search_radius,
            self.zncc_lost,
            self.zncc_far,
            int(self.max_iterations),
            int(self.give_up_frames),
            self.shutter,
        )

    def _learn(self, luma: Luma, name: str, x: float, y: float) -> Reference:
        size = int(self.block)
        check_block_fits(luma.shape, name, (x, y), size)
        plain = cut_patch(luma, (x, y), size)
        check_texture(plain.values, name, (x, y))
        noise = noise_grey(plain.values)
        blur_px, warp = self._choose(luma, (x, y), noise, float(plain.values.std()))
        patch = cut_patch(luma, (x, y), size, blur_px)
        template = build_template(patch, warp, blur_px=blur_px)
        sharp = Sharp(cut_surroundings(luma, (x, y), size, blur_px), size, warp, blur_px, None)
        sigma = np.sqrt(np.trace(template.solve[:2, :2])) * noise  # sqrt(2): both pictures are noisy; rms of x and y
        return Reference(template, patch.values.astype(np.float32), float(sigma), sharp)

    def _choose(self, luma: Luma, point: tuple[float, float], noise: float, contrast: float) -> tuple[float, str]:
        """Return the least blur that lets a block hold the richest warp, and that warp.

        Where noise comes near the texture, its gradients drown the block's; blurred by a pixel, the block is followed
        all the same. Where it does not, a block that holds no affine warp has no texture for one: a dot stays a dot.
        """
        size, held = int(self.block), []
        blurs = BLURS_PX if noise > NOISY * contrast else ()
        for blur_px in (self.blur, *(blur_px for blur_px in blurs if blur_px > self.blur)):
            patch = cut_patch(luma, point, size, blur_px)
            warp = choose_warp(significant_hessian(patch, noise, blur_px), noise, 0.5 * (size - 1))
            held.append((tuple(WARPS).index(warp), blur_px, warp))
            if warp == RICHEST:
                break
        _, blur_px, warp = min(held)
        return blur_px, warp


METHOD = Dic


def choose_warp(hessian: FloatArray, noise: float, half_px: float) -> str:
    """Return the most general warp that a block can hold, from its Hessian (6, 6); see `Dic` for the rule."""
    held = (warp for warp in WARPS if corner_sigma_px(hessian, warp, noise, half_px) <= LARGEST_CORNER_SIGMA_PX)
    return next(held, "translation")


def _sighting(references: tuple[Reference, ...], matches: tuple[Match | None, ...]) -> Sighting:
    rows = [
        _NOTHING if found is None else _row(reference, found)
        for reference, found in zip(references, matches, strict=True)
    ]
    table = np.array(rows, dtype=np.float64).reshape(-1, len(_NOTHING))
    return Sighting(
        xy_px=table[:, :2],
        gradient=table[:, 2:6] - UPRIGHT,
        sigma_px=table[:, 6],
        zncc=table[:, 7],
        drift_px=table[:, 8],
        iterations=np.array([0 if found is None else found.iterations for found in matches], np.int64),
        status=np.array([Status.LOST if found is None else Status.AUTO for found in matches], np.int8),
    )


def _row(reference: Reference, found: Match) -> tuple[float, ...]:
    drift = reference.drift_px
    return (*_as_first(reference, found).tolist(), math.hypot(found.sigma_px, drift), found.zncc, drift)


def _as_first(reference: Reference, found: Match) -> FloatArray:
    """Return a pose against the first block, whichever the reference is now."""
    if not reference.drift_px:
        return found.pose
    return np.concatenate([found.pose[:2], composed(found.pose[2:], reference.base)])
