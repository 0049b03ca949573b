"""What a student reads when one of the mistakes of `mistakes.py` is recognised: a hint where to look, no verdict.

Words in braces are filled in: what the scene calls body, striker, struck and pivot, and the questions' symbols.
"""

from __future__ import annotations

from collections.abc import Mapping

PINNED_HINTS: Mapping[str, str] = {
    "E1": "Your e looks turned over: separation belongs above the line. e = ({v_b2} − {v_f2}) / ({v_f1} − {v_b1}).",
    "E2": "The {striker} still moves after the impact. Does your separation speed contain {v_f2}?",
    "E3": "Look at the sign of {v_f2}: the separation is the {struck}'s velocity minus the {striker}'s.",
    "E4": "It looks as if the {striker}'s speeds before and after changed places.",
    "E5": (
        "The size fits, the sign does not. "
        "Take {struck} minus {striker} above the line and {striker} minus {struck} below it."
    ),
    "E6": "You seem to have divided the changes of velocity, {striker} by {struck}. e compares relative velocities.",
    "E6b": "You seem to have divided the changes of velocity, {struck} by {striker}. e compares relative velocities.",
    "E7": "Your value looks like e squared. e is a ratio of velocities, not of energies.",
    "E8": "Your value looks like a square root of e. e is the ratio of velocities itself.",
    "E9": "Your value looks like a ratio of kinetic energies. e is a ratio of relative velocities.",
    "E10": "It looks as if ω was used where the speed of the {striker}, ω {arm}, belongs.",
    "E11": "The {struck}'s velocity looks as if it were in px/s and the {striker}'s in m/s. Calibrate both.",
    "E12": "The {striker}'s speed looks as if it were in feet per second and the {struck}'s in metres.",
    "E12b": "The {struck}'s velocity looks as if it were in feet per second and the {striker}'s in metres.",
    "E13": "It looks as if ω was in degrees per second when you multiplied it by {arm}. Use rad/s.",
    "E13b": "It looks as if ω was in revolutions per minute when you multiplied it by {arm}. Use rad/s.",
    "E14": "The sign of ω looks reversed. Pixels count downwards; angles are positive counter-clockwise with y up.",
    "E19": "Your value looks like {v_f2} / {v_f1}. The {struck}'s velocity belongs into e as well.",
    "E20": (
        "You divided by the {struck}'s velocity after. "
        "The approach speed before, {v_f1} − {v_b1}, belongs below the line."
    ),
    "E21": (
        "You divided by the {striker}'s speed after. "
        "The approach speed before, {v_f1} − {v_b1}, belongs below the line."
    ),
    "E22": (
        "Your value looks like the {striker}'s loss of speed over its speed before. e compares relative velocities."
    ),
    "I1": (
        "The arm {arm} seems to be missing: what is conserved is the moment of momentum about the {pivot}, m {arm} v."
    ),
    "I2": "There seems to be one {arm} too many. The {struck}'s moment of momentum about the {pivot} is m {arm} v.",
    "I4": (
        "Your value looks like an effective mass at the {striker}, I / L²: m v where m {arm} v belongs, or v_f for ω."
    ),
    "I5": "The arm looks as if it were in feet.",
    "I5b": "The arm looks as if it were in feet, and squared.",
    "I5c": "The arm looks as if it were in centimetres.",
    "I5d": "The arm looks as if it were in centimetres, and squared.",
    "I6": "The {struck}'s mass looks as if it were in grams. Use kg.",
    "I6b": "The {struck}'s mass looks as if it were in pounds. Use kg.",
    "I6c": "It looks as if the {struck}'s weight was used for its mass.",
    "I6d": "It looks as if 0.45 kg was used for the {struck}. Your {struck} has its own mass: see your handout.",
    "I7": "The {struck}'s velocity looks as if it were in px/s. Calibrate it.",
    "I7b": "{Struck} and arm look as if they were in pixels. Calibrate both.",
    "I8": "ω looks as if it were in degrees per second. Use rad/s.",
    "I8b": "ω looks as if it were in revolutions per minute. Use rad/s.",
    "I9": "The arm looks like {arm} + R. The {striker} strikes at the distance {arm} from the {pivot}.",
    "I9b": "The arm looks like {arm} − R. The {striker} strikes at the distance {arm} from the {pivot}.",
    "I9c": "The arm looks like {arm} + D. The {striker} strikes at the distance {arm} from the {pivot}.",
    "I10": "You seem to have added a spin of the {struck}. The impact gives it none.",
    "I11": "The sign suggests that before and after were swapped in one of the differences.",
    "I13": "Your value fits a {struck} that stays on the {striker}. It leaves faster than the {striker}: use {v_b2}.",
    "I14": (
        "Your value fits conservation of energy, which is lost. Moment of momentum about the {pivot} is conserved."
    ),
    "I15": (
        "The {struck}'s change of velocity is {v_b2} − {v_b1}; you seem to have taken the separation speed "
        "{v_b2} − {v_f2}."
    ),
    "I15b": (
        "The {struck}'s change of velocity is {v_b2} − {v_b1}; you seem to have subtracted the {striker}'s speed."
    ),
    "I16": "It looks as if ω₁ and ω₂ were added. The {body} loses ω₁ − ω₂.",
    "I17": "Only ω₁ seems to be used. The {body} loses ω₁ − ω₂.",
    "I17b": "Only ω₂ seems to be used. The {body} loses ω₁ − ω₂.",
    "I18": "Your value looks like one about the middle of the {body}. It is asked about the {pivot}.",
    "I19": "The arm looks as if it were taken from the hip. It is asked about the {pivot}.",
    "I27": "Your value looks like m L² of the {struck}. It is the {body}'s moment of inertia that is asked.",
    "I28": "m L² of the {struck} seems to be added. The {body}'s own moment of inertia is asked.",
    "I28b": "m L² of the {struck} seems to be subtracted. The {body}'s own moment of inertia is asked.",
}
