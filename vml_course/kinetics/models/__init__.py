"""One file an impact model: each defines `MODEL`, found here by looking through the folder."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache

from vml_course.errors import UnknownNameError
from vml_course.kinetics.impact_model import ImpactModel


@cache
def _models() -> dict[str, ImpactModel]:
    modules = (importlib.import_module(f"{__name__}.{found.name}") for found in pkgutil.iter_modules(__path__))
    return {module.MODEL.name: module.MODEL for module in modules}


def model_names() -> tuple[str, ...]:
    """Return the names of all impact models, sorted."""
    return tuple(sorted(_models()))


def impact_model(name: str) -> ImpactModel:
    """Return an impact model by its name.

    Raises
    ------
    UnknownNameError
    """
    if name not in _models():
        raise UnknownNameError("model", name, model_names())
    return _models()[name]
