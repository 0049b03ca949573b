"""What a student reads when a mistake is recognised: a hint where to look, not a verdict.

Codes E* and I* are those of `assignments.mistakes`; codes K* are slips of units, scale, rate and sign that
show in the velocities or in the tracking table.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from assignments.mistakes import MISTAKES
from grader.model import Diagnosis, Finding

KINEMATIC: Mapping[str, str] = {
    "K1": "not calibrated: still in pixels",
    "K1b": "scale turned over: px/m used as m/px",
    "K1c": "pixels per frame instead of metres per second",
    "K2": "frame rate of the playback instead of the recording",
    "K2b": "frame number used as time",
    "K3": "feet",
    "K3b": "inches",
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
}

HINTS: Mapping[str, str] = {
    "E1": "Your e looks turned over: separation belongs above the line. e = (v_b2 − v_f2) / (v_f1 − v_b1).",
    "E2": "The foot still moves after the impact. Does your separation speed contain v_f2?",
    "E3": "Look at the sign of v_f2: the separation is the ball's velocity minus the foot's.",
    "E4": "It looks as if the foot's speeds before and after changed places.",
    "E5": "The size fits, the sign does not. Take ball minus foot above the line and foot minus ball below it.",
    "E6": "You seem to have divided the changes of velocity, foot by ball. e compares relative velocities.",
    "E6b": "You seem to have divided the changes of velocity, ball by foot. e compares relative velocities.",
    "E7": "Your value looks like e squared. e is a ratio of velocities, not of energies.",
    "E8": "Your value looks like a square root of e. e is the ratio of velocities itself.",
    "E9": "Your value looks like a ratio of kinetic energies. e is a ratio of relative velocities.",
    "E10": "It looks as if ω was used where the speed of the foot, ω L, belongs.",
    "E11": "The ball's velocity looks as if it were in px/s and the foot's in m/s. Calibrate both.",
    "E12": "The foot's speed looks as if it were in feet per second and the ball's in metres.",
    "E12b": "The ball's velocity looks as if it were in feet per second and the foot's in metres.",
    "E13": "It looks as if ω was in degrees per second when you multiplied it by L. Use rad/s.",
    "E13b": "It looks as if ω was in revolutions per minute when you multiplied it by L. Use rad/s.",
    "E14": "The sign of ω looks reversed. Pixels count downwards; angles are positive counter-clockwise with y up.",
    "E19": "Your value looks like v_f2 / v_f1. The ball's velocity belongs into e as well.",
    "E20": "You divided by the ball's velocity after. The approach speed before, v_f1 − v_b1, belongs below the line.",
    "E21": "You divided by the foot's speed after. The approach speed before, v_f1 − v_b1, belongs below the line.",
    "E22": "Your value looks like the foot's loss of speed over its speed before. e compares relative velocities.",
    "I1": "The arm L seems to be missing: what is conserved is the moment of momentum about the knee, m L v.",
    "I2": "There seems to be one L too many. The ball's moment of momentum about the knee is m L v.",
    "I4": "Your value looks like an effective mass at the foot, I / L²: m v where m L v belongs, or v_f for ω.",
    "I5": "The arm looks as if it were in feet.",
    "I5b": "The arm looks as if it were in feet, and squared.",
    "I5c": "The arm looks as if it were in centimetres.",
    "I5d": "The arm looks as if it were in centimetres, and squared.",
    "I6": "The ball's mass looks as if it were in grams. Use kg.",
    "I6b": "The ball's mass looks as if it were in pounds. Use kg.",
    "I6c": "It looks as if the ball's weight was used for its mass.",
    "I6d": "It looks as if 0.45 kg was used for the ball. Your ball has its own mass: see your handout.",
    "I7": "The ball's velocity looks as if it were in px/s. Calibrate it.",
    "I7b": "Ball and arm look as if they were in pixels. Calibrate both.",
    "I8": "ω looks as if it were in degrees per second. Use rad/s.",
    "I8b": "ω looks as if it were in revolutions per minute. Use rad/s.",
    "I9": "The arm looks like L + R. The foot strikes at the distance L from the knee.",
    "I9b": "The arm looks like L − R. The foot strikes at the distance L from the knee.",
    "I9c": "The arm looks like L + D. The foot strikes at the distance L from the knee.",
    "I10": "You seem to have added a spin of the ball. The impact gives it none.",
    "I11": "The sign suggests that before and after were swapped in one of the differences.",
    "I13": "Your value fits a ball that stays on the foot. It leaves faster than the foot: use v_b2.",
    "I14": "Your value fits conservation of energy, which is lost. Moment of momentum about the knee is conserved.",
    "I15": "The ball's change of velocity is v_b2 − v_b1; you seem to have taken the separation speed v_b2 − v_f2.",
    "I15b": "The ball's change of velocity is v_b2 − v_b1; you seem to have subtracted the foot's speed.",
    "I16": "It looks as if ω₁ and ω₂ were added. The leg loses ω₁ − ω₂.",
    "I17": "Only ω₁ seems to be used. The leg loses ω₁ − ω₂.",
    "I17b": "Only ω₂ seems to be used. The leg loses ω₁ − ω₂.",
    "I18": "Your value looks like one about the middle of the leg. It is asked about the knee.",
    "I19": "The arm looks as if it were taken from the hip. It is asked about the knee.",
    "I27": "Your value looks like m L² of the ball. It is the leg's moment of inertia that is asked.",
    "I28": "m L² of the ball seems to be added. The leg's own moment of inertia is asked.",
    "I28b": "m L² of the ball seems to be subtracted. The leg's own moment of inertia is asked.",
    "K1": "Your velocities look not calibrated: still in pixels per second. Divide by the scale in px/m.",
    "K1b": "The scale seems to be used the wrong way round: pixels divided by px/m give metres.",
    "K1c": "Your velocities look like pixels per frame. Divide by the scale, multiply by the frame rate.",
    "K2": "All are off by the ratio of two frame rates. Use the rate of the recording, not that of the playback.",
    "K2b": "The frame number seems to stand for the time. Time is frame number divided by frame rate.",
    "K3": "These look like feet per second. Use metres.",
    "K3b": "These look like inches per second. Use metres.",
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
}


def about(code: str) -> str:
    """Return a mistake in a few words."""
    return KINEMATIC[code] if code in KINEMATIC else MISTAKES[code].about


def hint_for(codes: Iterable[str]) -> str:
    """Return the sentence for one mistake, or for a group that the numbers cannot tell apart."""
    codes = tuple(codes)
    if len(codes) == 1:
        return HINTS.get(codes[0], f"Your value fits this slip: {about(codes[0])}. Check that step.")
    return f"Your numbers fit more than one slip; check each: {'; '.join(about(code) for code in codes)}."


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
    """Add a hint for each mistake that a single finding tells of, such as a scale turned over."""
    diagnosis = tuple(diagnosis)
    known = {(code, id_) for d in diagnosis for code in d.codes for id_ in d.ids}
    marks = [f for f in findings if f.mistake and (f.mistake, f.question_id) not in known]
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
        first = joined.get(cause, replace(item, ids=()))
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
