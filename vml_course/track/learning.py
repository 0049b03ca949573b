"""What a point's first pictures teach of its block."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vml_course.correlate.exposure import block_patch
from vml_course.correlate.icgn import Match
from vml_course.correlate.template import build_template
from vml_course.track.mask import attend, is_due, weight_of
from vml_course.track.records import Past, Reference


def learn(reference: Reference, past: Past, found: Match | None) -> tuple[Reference, Past]:
    """Return the reference and the past with what one more sighting teaches: which pixels move with the block."""
    if found is None or past.lessons.are_over:
        return reference, past
    lessons = attend(past.lessons, reference.template, found.pose, found.residual)
    if len(lessons.squares) == len(past.lessons.squares) or not is_due(lessons):
        return reference, past._replace(lessons=lessons)
    weight = weight_of(lessons.squares)
    if weight is None:
        return reference, past._replace(lessons=lessons)
    sharp = reference.sharp._replace(weight=weight)
    patch = block_patch(sharp.around, sharp.size)
    try:
        template = build_template(patch, sharp.warp, weight=weight, blur_px=sharp.blur_px)
    except np.linalg.LinAlgError:
        return reference, past._replace(lessons=lessons)
    return replace(reference, template=template, sharp=sharp), past._replace(lessons=lessons)
