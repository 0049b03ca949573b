"""A variant before the camera: everything that is filmed follows from what the variant keeps.

Nothing is looked up in the catalogue: years later the same video can be made from a kept variant.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from assignments.model import Variant
from vml_course.model.camera import Camera
from vml_course.model.recording import Recording
from vml_course.model.truth import Truth
from vml_course.synth.scene import AnyScene, scene_class
from vml_course.synth.simulate import simulate
from vml_course.usecases.make_video import MadeVideo, make_video


def film(variant: Variant, folder: Path) -> MadeVideo:
    """Simulate and render a variant into a folder: the video, and the truth beside it.

    Raises
    ------
    SceneRefusedError
    """
    recording: dict[str, Any] = dict(variant.recording)
    return make_video(scene_of(variant), Camera(**variant.camera), Recording(**recording), variant.seed, folder)


def foresee(variant: Variant) -> Truth:
    """Return what will be true of the video of a variant, without rendering it.

    Raises
    ------
    SceneRefusedError
    """
    return simulate(scene_of(variant), Camera(**variant.camera), variant.seed)


def scene_of(variant: Variant) -> AnyScene:
    """Return the scene with the variant's parameters."""
    settings: dict[str, Any] = {**variant.parameters, **variant.words}
    return scene_class(variant.scene)(**settings)
