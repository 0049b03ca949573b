"""The commands of the laboratory: parse, one use case, print."""

from __future__ import annotations

import importlib
import pkgutil

import typer


def register(app: typer.Typer) -> None:
    """Add every command of this folder to `app`; each file has one `register(app)`, but for `_` ones, which help."""
    for module in pkgutil.iter_modules(__path__):
        if module.name.startswith("_"):
            continue
        importlib.import_module(f"{__name__}.{module.name}").register(app)
