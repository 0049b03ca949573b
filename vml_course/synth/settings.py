"""From names and values to a scene, a camera and a recording: what `--set` and the variants speak."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

from vml_course.errors import InputError, NumberError, UnknownNameError
from vml_course.model.camera import Camera
from vml_course.model.choice import Choice, choices_of
from vml_course.model.quantity import Quantity, quantities_of
from vml_course.model.reading import read_number
from vml_course.model.recording import Recording
from vml_course.synth.scene import AnyScene, scene_class

Value = float | str


@dataclass(frozen=True)
class Settings:
    """All that makes a clip, beside the seed."""

    scene: AnyScene
    camera: Camera
    recording: Recording


def settable(scene: str) -> dict[str, Quantity]:
    """Return every number that can be set for a scene, by field name: its own, the camera's, the recording's.

    Raises
    ------
    UnknownNameError
        When there is no such scene.
    """
    kind = scene_class(scene)
    camera = {
        name: replace(item, default=getattr(kind.default_camera, name)) for name, item in quantities_of(Camera).items()
    }
    return quantities_of(kind) | camera | quantities_of(Recording)


def settable_words(scene: str) -> dict[str, Choice]:
    """Return every word that can be set for a scene, by field name.

    Raises
    ------
    UnknownNameError
        When there is no such scene.
    """
    return choices_of(scene_class(scene)) | choices_of(Recording)


def make_settings(scene: str, values: Mapping[str, Value]) -> Settings:
    """Build the records of a clip from values by field name or symbol; what is not named keeps its default.

    Parameters
    ----------
    scene : str
    values : mapping
        SI units, such as ``{"e": 0.7, "fps": 240, "format": "avi"}``.

    Raises
    ------
    UnknownNameError, OutOfRangeError, InputError

    >>> made = make_settings("soccer_kick", {"e": 0.7, "fps": 240})
    >>> made.scene.restitution, made.camera.fps, made.recording.format
    (0.7, 240, 'mp4')
    """
    kind = scene_class(scene)
    named = {_field_name(scene, name): value for name, value in values.items()}

    def of(record: type) -> dict[str, Value]:
        return {item.name: named[item.name] for item in fields(record) if item.name in named}

    return Settings(
        scene=kind(**of(kind)),
        camera=replace(kind.default_camera, **of(Camera)),  # type: ignore[arg-type]
        recording=Recording(**of(Recording)),  # type: ignore[arg-type]
    )


def read_settings(scene: str, texts: Sequence[str]) -> Settings:
    """Build the records of a clip from texts such as ``e=11/15``.

    Raises
    ------
    InputError
        When a text has no ``=`` or a name comes twice.
    NumberError
        When a value is neither a number nor a fraction of two.
    """
    values: dict[str, Value] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals:
            raise InputError("--set", "NAME=VALUE", repr(text))
        field = _field_name(scene, name)
        if field in values:
            raise InputError(name, "one value", "two")
        values[field] = value if field in settable_words(scene) else read_fraction(name, value)
    return make_settings(scene, values)


def read_fraction(name: str, text: str) -> float:
    """Read a number or a fraction of two.

    >>> read_fraction("e", "11/15")
    0.7333333333333333
    """
    top, slash, bottom = text.partition("/")
    divisor = read_number(bottom, name=name) if slash else 1.0
    if divisor == 0:
        raise NumberError(name, "a number or a fraction such as 11/15", repr(text))
    return read_number(top, name=name) / divisor


def _field_name(scene: str, name: str) -> str:
    known, words = settable(scene), settable_words(scene)
    by_symbol = {item.symbol: field for field, item in known.items() if item.symbol}
    if name in known or name in words:
        return name
    if name in by_symbol:
        return by_symbol[name]
    raise UnknownNameError(f"--set {name}", name, sorted({*known, *by_symbol, *words}, key=str.lower))
