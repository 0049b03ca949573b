import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from vml_course.errors import AmbiguousNumberError, NumberError, UncalibratedUnitError, UnitError
from vml_course.model.reading import UNITS, Reading, read_number, read_quantity
from vml_course.model.units import dimension_of, to_si


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.73", 0.73),
        ("0,73", 0.73),
        ("0,730", 0.73),
        ("−0.73", -0.73),
        ("– 0,73", -0.73),
        ("+0.73", 0.73),
        ("\u00a00.73\u200b", 0.73),
        ("０．７３", 0.73),
        ("7.3e-1", 0.73),
        ("7,3·10^-1", 0.73),
        ("7.3 × 10⁻¹", 0.73),
        ("7.3*10**-1", 0.73),
        ("73 %", 0.73),
        ("73%", 0.73),
        ("(73 ± 2) %", 0.73),
        ("0.73 ± 0.02", 0.73),
        ("0.73+/-0.02", 0.73),
        ("1.234,5", 1234.5),
        ("1,234.5", 1234.5),
        ("1.234", 1.234),
        ("1,234,567", 1234567.0),
        ("1 234,5", 1234.5),
        ("1\u202f234.5", 1234.5),
        ("12345,678", 12345.678),
        (".5", 0.5),
        (",5", 0.5),
        ("5.", 5.0),
    ],
)
def test_numbers_as_people_type_them_are_read(text, value):
    assert read_number(text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize("text", ["1,234", "-12,345", "12.5.2024", "1,23.4", "1.2,3.4", "1,234e3", "0.73 ± 3 %", "5,"])
def test_a_text_with_two_readings_is_asked_back(text):
    with pytest.raises(AmbiguousNumberError, match="value: expected"):
        read_number(text)


@pytest.mark.parametrize(
    "text",
    ["", " ", ".", "nan", "NaN", "inf", "-Infinity", "1e999", "1_000", "0x1F", "True", "#N/A", "~0.7", "1/2", "½",
     "9**9**9", "2**2**40", "--5", "5 5", "1e", "1±2±3", "±2", "1" * 201, "٣", "1 2345"],
)  # fmt: skip
def test_what_is_no_number_is_refused(text):
    with pytest.raises((NumberError, UnitError)):
        read_number(text)


def test_a_boolean_is_no_number():
    with pytest.raises(NumberError):
        read_number(True)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("22 cm", "length", 0.22),
        ("1 ft", "length", 0.3048),
        ('10"', "length", 0.254),
        ("0,5kg", "mass", 0.5),
        ("1 LB", "mass", 0.45359237),
        ("54 km/h", "velocity", 15.0),
        ("15 m·s⁻¹", "velocity", 15.0),
        ("180°", "angle", math.pi),
        ("60 rpm", "angular_velocity", 2 * math.pi),
        ("26.8 1/s", "angular_velocity", 26.8),
        ("26.8 s^-1", "angular_velocity", 26.8),
        ("1.88 kg m²", "inertia", 1.88),
        ("1.88 kg·m²", "inertia", 1.88),
        ("1.88 kg*m^2", "inertia", 1.88),
        ("1.88 kgm2", "inertia", 1.88),
        ("1,88 N m s^2", "inertia", 1.88),
        ("1.88 Nms²", "inertia", 1.88),
        ("1.88e7 g cm^2", "inertia", 1.88),
        ("5 px/cm", "scale", 500.0),
        ("2 mm/px", "scale", 500.0),
        ("480 fps", "rate", 480.0),
        ("480 frames/s", "rate", 480.0),
    ],
)
def test_units_are_converted_to_si(text, dimension, value):
    assert read_quantity(text, dimension).value == pytest.approx(value, rel=1e-12)


def test_an_uncertainty_comes_along_in_si_units():
    assert read_quantity("0.5 kg ± 10 g", "mass").uncertainty == pytest.approx(0.01)
    assert read_quantity("(50 ± 1) cm", "length").uncertainty == pytest.approx(0.01)
    assert read_quantity("0.5 kg ± 2 %", "mass").uncertainty == pytest.approx(0.01)
    assert read_quantity("2 ± 0.1 mm/px", "scale").uncertainty == pytest.approx(25.0)


def test_a_missing_unit_is_an_error_unless_a_default_is_given_and_then_it_is_marked():
    with pytest.raises(UnitError, match="length: expected a unit after the number"):
        read_quantity("5", "length", name="length")
    assert read_quantity("5", "length", "m") == Reading(5.0, "m", None, unit_assumed=True)


def test_pixels_where_metres_are_meant_are_named_as_uncalibrated():
    with pytest.raises(UncalibratedUnitError, match="Set the scale first"):
        read_quantity("800 px/s", "velocity")


def test_a_unit_of_another_dimension_lists_those_accepted():
    with pytest.raises(UnitError, match="m, cm, mm, km, in, ft"):
        read_quantity("5 kg", "length")


def test_a_zero_scale_per_pixel_is_refused():
    with pytest.raises(NumberError):
        read_quantity("0 mm/px", "scale")


def test_the_first_unit_of_every_dimension_is_its_si_unit():
    for dimension, units in UNITS.items():
        first = next(iter(units))
        assert to_si(1.0, first, dimension) == 1.0
        assert first in UNITS[dimension_of(first)]


@given(st.text(max_size=60), st.sampled_from(sorted(UNITS)))
def test_any_text_gives_a_finite_reading_or_one_line_of_refusal(text, dimension):
    try:
        reading = read_quantity(text, dimension)
    except (NumberError, UnitError) as error:
        lines = str(error).splitlines()
    else:
        lines = [repr(reading)]
        assert math.isfinite(reading.value)
    assert len(lines) == 1


_PIECES = st.lists(st.sampled_from([*"0123456789.,+-e%±()· ^*/_", "10^", "kg", "m", "px", "mm/px", "1/", "−", "²"]))


@given(_PIECES, st.sampled_from(sorted(UNITS)))
def test_any_heap_of_number_pieces_gives_a_finite_reading_or_a_refusal(pieces, dimension):
    try:
        reading = read_quantity("".join(pieces), dimension)
    except (NumberError, UnitError):
        return
    assert math.isfinite(reading.value)
    assert reading.uncertainty is None or reading.uncertainty >= 0


@given(st.floats(allow_nan=False, allow_infinity=False), st.sampled_from([".", ","]), st.sampled_from(["-", "−"]))
def test_any_float_written_with_either_decimal_mark_reads_back(value, mark, minus):
    text = repr(value).replace(".", mark).replace("-", minus)
    whole, _, fraction = text.partition(mark)
    assume(mark == "." or len(fraction.split("e")[0]) != 3 or whole.strip(minus) == "0" or len(whole.strip(minus)) > 3)
    assert read_number(text) == value


@given(st.floats(1e-6, 1e6), st.sampled_from([(d, u) for d in sorted(UNITS) for u in UNITS[d] if u]))
def test_every_listed_unit_reads_back_through_its_own_spelling(value, where):
    dimension, unit = where
    reading = read_quantity(f"{value!r} {unit}", dimension)
    assert reading.unit == unit
    assert reading.value == pytest.approx(value * UNITS[dimension][unit], rel=1e-12)
