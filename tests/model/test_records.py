from dataclasses import FrozenInstanceError, dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.errors import InputError, OutOfRangeError, ShapeError, UnknownNameError
from vml_course.model.arrays import Axes
from vml_course.model.camera import Camera
from vml_course.model.motion import Calibration, Motion, vector_between
from vml_course.model.quantity import check_quantities, quantities_of, quantity
from vml_course.model.recording import Recording

SAME_PLACE_PX = 1e-9  # two maps that undo each other agree to rounding

coordinate = st.floats(-1e4, 1e4)
point = st.tuples(coordinate, coordinate)


@dataclass(frozen=True)
class Ball:
    mass_kg: float = quantity(0.5, "kg", 0.1, 2.0, about="mass", symbol="m")
    count: float = quantity(3, "", 1, 5, whole=True)

    def __post_init__(self):
        check_quantities(self)


def test_an_array_of_another_length_is_refused_by_name():
    axes = Axes()
    axes.freeze("time_s", [0, 1, 2], "n")
    with pytest.raises(ShapeError, match=r"xy_px: expected shape \(n=3, 2\), got \(2, 2\)"):
        axes.freeze("xy_px", [[0, 0], [1, 1]], "n", 2)


def test_an_array_with_too_few_axes_is_refused():
    with pytest.raises(ShapeError):
        Axes().freeze("xy_px", [1.0, 2.0], "n", 2)


def test_arrays_of_a_record_cannot_be_written():
    motion = Motion(("a",), [0], [0.0], [[[1.0, 2.0]]], [[0.1]])
    with pytest.raises(ValueError, match="read-only"):
        motion.xy_m[0] = 0.0
    with pytest.raises(FrozenInstanceError):
        motion.points = ()


def test_a_record_keeps_its_own_copy():
    times = np.array([0.0])
    motion = Motion(("a",), [0], times, [[[1.0, 2.0]]], [[0.1]])
    times[0] = 5.0
    assert motion.time_s[0] == 0.0


def test_an_unknown_point_names_the_known_ones():
    with pytest.raises(UnknownNameError, match="expected one of a, got 'b'"):
        Motion(("a",), [0], [0.0], [[[1.0, 2.0]]], [[0.1]]).of("b")


def test_a_quantity_is_declared_once_and_known_everywhere():
    declared = quantities_of(Ball)["mass_kg"]
    assert (declared.default, declared.unit, declared.symbol, declared.range_text) == (0.5, "kg", "m", "0.1 to 2 kg")


@pytest.mark.parametrize("value", [0.05, 2.5])
def test_a_quantity_outside_its_range_is_refused(value):
    with pytest.raises(OutOfRangeError, match=r"mass_kg \(m\): expected 0\.1 to 2 kg"):
        Ball(mass_kg=value)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "0.5", None, True])
def test_what_is_no_number_is_refused(value):
    with pytest.raises(InputError, match=r"mass_kg \(m\): expected a number"):
        Ball(mass_kg=value)


def test_a_fraction_is_refused_where_a_whole_number_belongs():
    with pytest.raises(InputError, match="count: expected a whole number"):
        Ball(count=2.5)


@given(point, st.floats(60, 4000), point)
def test_camera_maps_undo_each_other(xy, px_per_m, origin):
    camera = Camera(px_per_m=px_per_m, origin_x_px=origin[0] / 3, origin_y_px=origin[1] / 3)
    assert np.allclose(camera.to_px(camera.to_m(np.array(xy))), xy, atol=SAME_PLACE_PX)


def test_a_camera_sees_y_up_as_y_down():
    camera = Camera(px_per_m=100, origin_x_px=10, origin_y_px=20)
    assert camera.to_px(np.array([1.0, 0.1])) == pytest.approx([110, 10])


def test_an_odd_picture_is_refused():
    with pytest.raises(InputError, match="height_px: expected an even number"):
        Camera(height_px=721)


@given(point, st.floats(1, 1e5), point, st.floats(-7, 7))
def test_calibration_and_its_inverse_undo_each_other(xy, px_per_m, origin, angle):
    calibration = Calibration(px_per_m, origin, angle)
    assert np.allclose(calibration.to_px(calibration.to_m(np.array(xy))), xy, atol=1e-7)


def test_a_turned_axis_measures_along_itself():
    calibration = Calibration(px_per_m=100, origin_px=(0, 0), axis_angle_rad=np.radians(30))
    along = np.array([100 * np.cos(np.radians(30)), -100 * np.sin(np.radians(30))])
    assert calibration.to_m(along) == pytest.approx([1.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("scale", [0.0, -5.0, float("nan")])
def test_a_scale_that_is_not_positive_is_refused(scale):
    with pytest.raises(InputError, match="px_per_m"):
        Calibration(px_per_m=scale, origin_px=(0, 0))


def test_a_vector_angle_is_signed_and_unwrapped_and_vmls_is_neither():
    turned = np.linspace(0.0, -3 * np.pi, 40)
    head = np.column_stack([np.cos(turned), np.sin(turned)])
    vector = vector_between("v", "a", "b", np.zeros_like(head), head)
    assert vector.angle_rad == pytest.approx(turned)
    assert vector.angle_vml_deg.min() >= 0
    assert vector.angle_vml_deg.max() <= 180
    assert vector.change_pct == pytest.approx(0.0, abs=1e-9)


def test_a_gap_in_a_vector_stays_a_gap_and_does_not_break_the_unwrapping():
    turned = np.linspace(0.0, 8.0, 60)
    head = np.column_stack([np.cos(turned), np.sin(turned)])
    head[20:22] = np.nan
    vector = vector_between("v", "a", "b", np.zeros_like(head), head)
    assert np.isnan(vector.angle_rad[20:22]).all()
    assert vector.angle_rad[-1] == pytest.approx(8.0)


def test_an_unknown_format_of_recording_is_refused():
    with pytest.raises(UnknownNameError, match="expected one of mp4, avi"):
        Recording(format="gif")
