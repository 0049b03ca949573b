"""What a student reads when a mistake is recognised: a hint where to look, not a verdict.

Codes K* are slips of units, scale, rate and sign that show in the velocities or in the tracking table; all others
are those of the textbooks, which bring their own sentences.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from assignments.names import filled, names_in
from assignments.textbook import every_mistake
from grader.model import Diagnosis, Finding

KINEMATIC: Mapping[str, str] = {
    "K1": "not calibrated: still in pixels",
    "K1b": "scale turned over: px/m used as m/px",
    "K1c": "pixels per frame instead of metres per second",
    "K2": "frame rate of the playback instead of the recording",
    "K2b": "frame number used as time",
    "K3": "feet",
    "K3b": "inches",
    "K3c": "kilometres per hour",
    "K4": "centimetres",
    "K4b": "millimetres",
    "K5": "a length taken twice as large, such as a diameter for a radius",
    "K5b": "a length taken half as large, such as a radius for a diameter",
    "K6": "sign: positive direction reversed",
    "K7": "scale",
    "K8": "frame rate",
    "K9": "degrees",
    "K9b": "revolutions per minute",
    "K9c": "degrees converted twice",
    "K10": "y axis pointing down",
    "K11": "time shifted by some frames",
    "K12": "another length than L as the arm",
    "K13": "two points exchanged",
    "K14": "smoothed across the impact",
    "K15": "x axis pointing to the left",
}

_KINEMATIC_HINTS: Mapping[str, str] = {
    "K1": "Your velocities look not calibrated: still in pixels per second. Divide by the scale in px/m.",
    "K1b": "The scale seems to be used the wrong way round: pixels divided by px/m give metres.",
    "K1c": "Your velocities look like pixels per frame. Divide by the scale, multiply by the frame rate.",
    "K2": "All are off by the ratio of two frame rates. Use the rate of the recording, not that of the playback.",
    "K2b": "The frame number seems to stand for the time. Time is frame number divided by frame rate.",
    "K3": "These look like feet per second. Use metres.",
    "K3b": "These look like inches per second. Use metres.",
    "K3c": "These look like kilometres per hour. Use metres per second.",
    "K4": "These look like centimetres per second. Use metres.",
    "K4b": "These look like millimetres per second. Use metres.",
    "K5": "All are twice too large. Was a length taken twice as large, such as a diameter for a radius?",
    "K5b": "All are half as large as they should be. Was a length halved, such as a radius for a diameter?",
    "K6": "The sizes are right, the signs are all reversed. Which direction is positive?",
    "K7": "All are off by as much as your scale. Measure the known length again, end to end.",
    "K8": "All are off by as much as your frame rate. It stands in your handout.",
    "K9": "These look like degrees per second. Use rad/s.",
    "K9b": "These look like revolutions per minute. Use rad/s.",
    "K9c": "It looks as if radians were converted from degrees twice.",
    "K10": "The y axis of your table points down. Pixels count downwards; the world's y points up.",
    "K11": "Your table is shifted in time. Which frame is frame 0?",
    "K12": "Foot speed and I fit another arm than L. Use the L of your handout, in metres.",
    "K13": "Two points of your table look exchanged. Which column belongs to which point?",
    "K14": "Your paths are rounded off at the impact: fit each side by itself, and smooth nothing across it.",
    "K15": "The x axis of your table points to the left. The world's x points to the right of the picture.",
}


HINTS: Mapping[str, str] = {
    **{code: mistake.hint for code, mistake in every_mistake().items() if mistake.hint},
    **_KINEMATIC_HINTS,
}

_USUAL_NAMES = names_in("soccer_kick")


def about(code: str, names: Mapping[str, str] = _USUAL_NAMES) -> str:
    """Return a mistake in a few words, with the names of `assignments.names.names_in`."""
    return KINEMATIC[code] if code in KINEMATIC else filled(every_mistake()[code].about, names)


def hint_for(codes: Iterable[str], names: Mapping[str, str] = _USUAL_NAMES) -> str:
    """Return the sentence for one mistake, or for a group that the numbers cannot tell apart."""
    codes = tuple(codes)
    if len(codes) == 1:
        usual = f"Your value fits this slip: {about(codes[0], names)}. Check that step."
        return filled(HINTS[codes[0]], names) if codes[0] in HINTS else usual
    return f"Your numbers fit more than one slip; check each: {'; '.join(about(code, names) for code in codes)}."


# ---------------------------------------------------------------- one hint for one cause

# A wrong scale shows in the scale's own cell, in all velocities and in the table, under different names.
_SCALE = frozenset({"K1", "K1b", "K3", "K4", "K4b", "K5", "K5b", "K7"})
_RATE = frozenset({"K2", "K8"})
_AT_SOURCE = frozenset({"px_per_m", "fps"})

SOURCE_HINTS: Mapping[str, str] = {
    "K1": "A scale of 1 px/m leaves everything in pixels. Measure the known length in pixels, divide by its metres.",
    "K1b": "The scale looks turned over: pixels in one metre are asked, not metres in one pixel.",
    "K2": "This is the rate of a player. The rate of the recording stands in your handout.",
    "K3": "The scale looks as if the known length were in feet. Use metres.",
    "K4": "The scale looks as if the known length were in centimetres. Use metres.",
    "K4b": "The scale looks as if the known length were in millimetres. Use metres.",
    "K5": "The scale is twice too large. Was the known length taken half as long, or twice as many pixels counted?",
    "K5b": "The scale is half as large as it should be. Were only half of the pixels counted, or the length doubled?",
}
"""What is said where the wrong cell is the scale or the frame rate itself."""


def with_marks(diagnosis: Iterable[Diagnosis], findings: Iterable[Finding]) -> tuple[Diagnosis, ...]:
    """Add a hint for each mistake that a single finding tells of, such as a scale turned over.

    A cell that is explained already gets no second explanation: the size of −e fits a reversed sign as well.
    """
    diagnosis = tuple(diagnosis)
    explained = {id_ for item in diagnosis for id_ in item.ids}
    marks = [finding for finding in findings if finding.mistake and finding.question_id not in explained]
    return (*(_mark(finding) for finding in marks), *diagnosis)


def _mark(finding: Finding) -> Diagnosis:
    code, at = finding.mistake, finding.question_id
    hint = SOURCE_HINTS.get(code, "") if at in _AT_SOURCE else ""
    return Diagnosis(at, (code,), hint or hint_for((code,)), "truth", (at,))


def one_hint_a_cause(diagnosis: Iterable[Diagnosis]) -> tuple[Diagnosis, ...]:
    """Join what tells of one cause: the first hint stays, and names all cells that show it."""
    joined: dict[str, Diagnosis] = {}
    for item in diagnosis:
        cause = _cause(item)
        first = joined.get(cause, item)
        codes = first.codes if first.is_unique else item.codes
        joined[cause] = replace(first, codes=codes, ids=tuple(dict.fromkeys((*first.ids, *item.ids))))
    return tuple(joined.values())


def _cause(item: Diagnosis) -> str:
    """Name the cause: a slip of the scale is one, wherever it shows; a group that cannot be told apart is its own."""
    codes = set(item.codes)
    if "omega1" in item.ids and not codes <= _RATE:
        return f"omega {' '.join(item.codes)}"
    if codes <= _SCALE:
        return "scale"
    return "rate" if codes <= _RATE else " ".join(item.codes)
