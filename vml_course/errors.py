"""What a user can do wrong: one class each, one line each.

Every message reads *name: expected what, got value.* and, where it helps, what to do. Errors carry the
facts as attributes, so that a page or a JSON form can show them without parsing words.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any


class VmlError(Exception):
    """Something the user can put right; `vml` prints it as one line and ends with exit code 2."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Travel between processes as words and facts; the constructor, which takes other arguments, is not asked."""
        return _arrived, (type(self), self.args, self.__dict__)


def _arrived(kind: type[VmlError], words: tuple[Any, ...], facts: Mapping[str, Any]) -> VmlError:
    error = kind.__new__(kind, *words)
    error.__dict__.update(facts)
    return error


class InputError(VmlError):
    """A value is not what was asked for.

    Parameters
    ----------
    name : str
        What the user called it: an option, a cell, a column, a file.
    expected : str
        What would have been right, with unit and range.
    got : object
        What was found.
    hint : str
        What to do about it (optional).
    """

    def __init__(self, name: str, expected: str, got: object, hint: str = "") -> None:
        self.name, self.expected, self.got, self.hint = name, expected, got, hint
        tail = f" {hint}" if hint else ""
        super().__init__(" ".join(f"{name}: expected {expected}, got {got}.{tail}".split()))


# ---------------------------------------------------------------- words and numbers


class ShapeError(InputError):
    """An array does not have the axes its record declares."""


class OutOfRangeError(InputError):
    """A quantity lies outside its declared range."""

    def __init__(self, name: str, low: float, high: float, unit: str, got: float) -> None:
        self.low, self.high, self.unit = low, high, unit
        unit_text = f" {unit}" if unit else ""
        super().__init__(name, f"{low:g} to {high:g}{unit_text}", f"{got:g}{unit_text}")


class UnknownNameError(InputError):
    """A name is not among those known (a scene, a tracker, a parameter, a point)."""

    def __init__(self, name: str, got: str, known: Iterable[str]) -> None:
        self.known = tuple(known)
        super().__init__(name, f"one of {', '.join(self.known) or '(none)'}", repr(got))


class NumberError(InputError):
    """A text is not a number."""


class AmbiguousNumberError(NumberError):
    """A text can be read as two different numbers, such as `1,234`."""


class UnitError(InputError):
    """A unit is missing, unknown, or of another dimension."""


class UncalibratedUnitError(UnitError):
    """A value is in pixels where metres are meant: it cannot be compared before there is a scale."""

    def __init__(self, name: str, accepted: str, got: str) -> None:
        super().__init__(name, f"a calibrated unit ({accepted})", got, "Set the scale first, then convert pixels.")


# ---------------------------------------------------------------- files


class FileMissingError(InputError):
    """A file that was named does not exist."""


class FileFormatError(InputError):
    """A file's ending names no format that we write or read."""


class VideoError(InputError):
    """A file is empty, truncated or not a video."""


class FrameRangeError(InputError):
    """A frame number lies outside the video, or a clip's end before its start."""


class TableError(InputError):
    """A table lacks a column that is needed, or holds text where numbers belong."""


# ---------------------------------------------------------------- simulation


class SceneRefusedError(VmlError):
    """A simulated impact or strain is not what its parameters promise; it is not handed out."""

    def __init__(self, scene: str, failed: Iterable[str], hint: str = "", *, what: str = "impact") -> None:
        self.scene, self.failed, self.hint = scene, tuple(failed), hint
        said = f"{scene}: expected an honest {what}, got failed checks: {'; '.join(self.failed)}."
        super().__init__(f"{said} {hint}".strip())


# ---------------------------------------------------------------- tracking


class SeedError(InputError):
    """A point to track lies outside the picture or on a patch that cannot be followed."""


# ---------------------------------------------------------------- kinetics


class MissingScaleError(InputError):
    """Metres are asked of a measurement that has pixels only."""


class TooFewFramesError(InputError):
    """One side of the impact has too few frames for a velocity."""


class NoImpactError(InputError):
    """The struck body never changes its velocity."""


class SeveralImpactsError(InputError):
    """The struck body changes its velocity more than once near the impact."""


class UpsideDownError(InputError):
    """Bodies fall upwards: y was exported downwards, as pixels are."""


class LengthMismatchError(InputError):
    """A given length does not fit the path that was tracked."""

    def __init__(self, name: str, found_m: float, found_sd_m: float, given_m: float) -> None:
        self.found_m, self.found_sd_m, self.given_m = found_m, found_sd_m, given_m
        found = f"{found_m:.4f} ± {max(found_sd_m, 1e-4):.4f} m, the radius of the striker's path"
        super().__init__(name, found, f"{given_m:g} m", "Check the length, the scale and which point was tracked.")


# ---------------------------------------------------------------- workers


class PackageMissingError(InputError):
    """An optional part was asked for whose package is not installed."""

    def __init__(self, name: str, package: str, install: str) -> None:
        self.package = package
        super().__init__(name, f"the package {package}", "none", f"Install it with: {install}")


class WorkerDiedError(VmlError):
    """Every process that was given a task died of it."""

    def __init__(self, tries: int) -> None:
        self.tries = tries
        super().__init__(f"worker: its process died, {tries} times of {tries}; out of memory, or ended from outside.")
