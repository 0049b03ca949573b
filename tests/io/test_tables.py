from __future__ import annotations

import contextlib
import csv
import json
import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from openpyxl import Workbook, load_workbook
from scipy.io import loadmat

from vml_course.errors import FileFormatError, FileMissingError, MissingScaleError, TableError, VmlError
from vml_course.io.names import identifiers
from vml_course.io.tables import read_motion, write_track
from vml_course.model.frame import VideoInfo
from vml_course.model.motion import Calibration, VectorSeries
from vml_course.model.track import Status, Track
from vml_course.model.tracked import Tracked

INFO = VideoInfo(1280, 720, 300, 480.0, is_variable_rate=False, codec="h264", container="mov,mp4")
CALIBRATION = Calibration(437.1, (12.5, 700.25), 0.1, (10, 20, 106.2, 20), 0.22, "0.22 m")
LAST_DIGIT = 1e-15  # a workbook holds 16 digits, one fewer than a double may need
KINDS = ["xlsx", "csv", "mat"]


def tracked(
    points: tuple[str, ...] = ("ball", "foot"),
    frames: int = 8,
    *,
    scaled: bool = True,
    lost: bool = True,
    seed: int = 3,
) -> Tracked:
    rng = np.random.default_rng(seed)
    p = len(points)
    xy = rng.uniform(0, 1280, (frames, p, 2))
    sigma, zncc = rng.uniform(0.001, 0.1, (frames, p)), rng.uniform(0.5, 1, (frames, p))
    status, gradient = np.zeros((frames, p), np.int8), rng.normal(0, 0.1, (frames, p, 4))
    if lost:
        status[2, 0] = Status.LOST
        for values in (xy, sigma, zncc, gradient):
            values[2, 0] = np.nan
    iterations = rng.integers(1, 9, (frames, p))
    settings_ = {"method": "dic", "block": 60}
    track = Track(
        points,
        400 + np.arange(frames),
        np.arange(frames) / 480,
        xy,
        sigma,
        zncc,
        iterations,
        status,
        gradient,
        settings_,
    )
    angle = rng.uniform(-9, 9, frames)
    vector = VectorSeries("shin", points[0], points[-1], angle, np.abs(angle), np.full(frames, 0.5), np.zeros(frames))
    calibration = CALIBRATION if scaled else None
    motion = CALIBRATION.apply(track) if scaled else None
    return Tracked(
        track, INFO, calibration, motion, (vector,), 480.0, "kick.mp4", "ab" * 32, "frame / fps", 0.0147, ("one lost",)
    )


def header_of(path: Path, sheet: str) -> list[Any]:
    return [cell.value for cell in load_workbook(path)[sheet][1]]


HEADER = [
    "frame", "step", "t_s",
    "ball_x_px", "ball_y_px", "ball_x_m", "ball_y_m", "ball_sigma_m", "ball_status",
    "foot_x_px", "foot_y_px", "foot_x_m", "foot_y_m", "foot_sigma_m", "foot_status",
    "shin_angle_deg", "shin_angle_vml_deg", "shin_length_m", "shin_length_px", "shin_dlength_pct",
]  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_measured_comes_back_from_the_table(tmp_path: Path, kind: str) -> None:
    made, path = tracked(), tmp_path / f"out.{kind}"
    write_track(path, made)
    motion = read_motion(path)
    assert motion.points == ("ball", "foot")
    assert made.motion is not None
    for name in ("frame", "time_s", "xy_m", "sigma_m"):
        np.testing.assert_allclose(getattr(motion, name), getattr(made.motion, name), rtol=LAST_DIGIT)
    assert motion.px_per_m == pytest.approx(CALIBRATION.px_per_m, rel=1e-9)


@settings(max_examples=25, deadline=None)
@given(
    names=st.lists(st.text(min_size=1, max_size=40), min_size=1, max_size=4, unique=True),
    frames=st.integers(1, 12),
    kind=st.sampled_from(KINDS),
    seed=st.integers(0, 10**6),
)
def test_any_names_and_numbers_survive_the_round_trip(names: list[str], frames: int, kind: str, seed: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        made = tracked(tuple(names), frames, lost=frames > 2, seed=seed)
        path = Path(folder) / f"out.{kind}"
        write_track(path, made)
        motion = read_motion(path)
        assert made.motion is not None
        assert motion.points == tuple(identifiers(names).values())
        np.testing.assert_allclose(motion.xy_m, made.motion.xy_m, rtol=LAST_DIGIT)


@pytest.mark.parametrize("kind", KINDS)
def test_pixels_only_is_said_when_metres_are_asked(tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"out.{kind}"
    write_track(path, tracked(scaled=False))
    with pytest.raises(MissingScaleError, match=r"pixels only.*--scale"):
        read_motion(path)


def test_the_workbook_is_laid_out_as_promised(tmp_path: Path) -> None:
    path = tmp_path / "out.xlsx"
    write_track(path, tracked())
    book = load_workbook(path)
    assert book.sheetnames == ["ReadMe", "Data", "Quality", "Calibration", "Settings", "Columns"]
    assert header_of(path, "Data") == HEADER
    assert {name for sheet in book for name in sheet.tables} == {
        "tblData", "tblQuality", "tblCalibration", "tblSettings", "tblColumns",
    }  # fmt: skip
    data = book["Data"]
    assert data.freeze_panes == "D2"
    assert not any(sheet.merged_cells.ranges for sheet in book)
    assert data["A2"].value == 400
    assert data["D4"].value is None
    assert data["I4"].value == "lost"
    assert data["D2"].number_format == "0.000"
    facts = {row[0].value: row[1].value for row in book["Calibration"].iter_rows(min_row=2)}
    assert facts["px_per_m"] == 437.1
    assert facts["m_per_px"] == pytest.approx(1 / 437.1)
    assert facts["length_typed"] == "0.22 m"
    described = {row[0].value for row in book["Columns"].iter_rows(min_row=2)}
    assert described == set(header_of(path, "Data")) | set(header_of(path, "Quality"))


def test_without_a_scale_there_are_no_columns_in_metres(tmp_path: Path) -> None:
    path = tmp_path / "out.xlsx"
    write_track(path, tracked(scaled=False))
    assert not [name for name in header_of(path, "Data") if name.endswith("_m")]


def test_a_name_that_looks_like_a_formula_stays_a_text(tmp_path: Path) -> None:
    made = tracked()
    path = tmp_path / "out.xlsx"
    write_track(path, Tracked(**{**vars(made), "video": '=HYPERLINK("http://x")', "warnings": ("=1+1",)}))
    cells = [cell for sheet in load_workbook(path) for row in sheet.iter_rows() for cell in row]
    assert not [cell for cell in cells if cell.data_type == "f"]


def test_csv_is_plain_and_tells_the_rest_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "out.csv"
    write_track(path, tracked())
    raw = path.read_bytes()
    assert raw.startswith(b"\xef\xbb\xbfframe,step,t_s,ball_x_px,ball_y_px,")
    assert raw.count(b"\r\n") == raw.count(b"\n") == 9
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == HEADER
    assert rows[2]["ball_x_px"] == rows[2]["ball_x_m"] == ""
    assert rows[2]["ball_status"] == "lost"
    meta = json.loads((tmp_path / "out.meta.json").read_text(encoding="utf-8"))
    assert meta["calibration"]["px_per_m"] == {"value": 437.1, "unit": "px/m"}
    assert meta["settings"]["block"] == 60
    assert {path.name for path in tmp_path.iterdir()} == {"out.csv", "out.meta.json"}


def test_the_matlab_file_has_the_promised_variables(tmp_path: Path) -> None:
    path, made = tmp_path / "out.mat", tracked()
    write_track(path, made)
    held = loadmat(path)
    assert [str(cell.item()) for cell in held["pointNames"].ravel()] == ["ball", "foot"]
    assert held["pointNames"].shape == (1, 2)
    assert held["t"].shape == held["frame"].shape == held["step"].shape == (8, 1)
    assert held["X"].shape == held["Ypx"].shape == held["sigma"].shape == held["status"].shape == (8, 2)
    assert held["status"].dtype == np.int8
    assert math.isnan(held["X"][2, 0])
    assert held["theta"].shape == held["thetaVML"].shape == held["len"].shape == (8, 1)
    points = held["points"]
    assert points.shape == (1, 2)
    assert set(points.dtype.names) == {"name", "xy", "xy_px", "sigma", "zncc", "status", "grad"}
    assert points[0, 1]["grad"].shape == (8, 4)
    assert held["cal"]["px_per_m"].item().item() == 437.1
    assert held["meta"]["index_base"].item().item() == 0
    assert held["events"].shape[1] == 0


def test_names_become_identifiers_that_differ_without_regard_to_case() -> None:
    mapped = identifiers(["Ball", "ball", "1", "größe x", "=cmd()", "日本"])
    assert all(name.isidentifier() and name.isascii() for name in mapped.values())
    assert len({name.lower() for name in mapped.values()}) == 6


def test_no_name_reads_as_the_escape_of_a_letter_in_a_workbook() -> None:
    assert [*identifiers(["toe_x41", "a_x0041_b", "x1"]).values()] == ["toex41", "ax0041_b", "x1"]


# ---------------------------------------------------------------- tables of others


def text_file(folder: Path, text: str, name: str = "table.csv", encoding: str = "utf-8") -> Path:
    path = folder / name
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize(
    ("text", "name", "encoding"),
    [
        ("t_s,ball_x_m,ball_y_m\n0,1.5,2\n0.5,,\n", "a.csv", "utf-8"),
        ("\ufefft;ball_x_m;ball_y_m\r\n0;1,5;2\r\n0,5;;\r\n", "a.csv", "utf-8"),
        ("Versuch 3; Gruppe Müller\n\nt;ball_x_m;ball_y_m\n0;1,5;2\n0,5;;\n", "a.csv", "cp1252"),
        ("mass A\nt\txball\tyball\n0\t1.5\t2\n0.5\t\t\n", "a.txt", "utf-8"),
        ("t_s\tball_x_cm\tball_y_cm\n0\t150\t200\n0.5\tNaN\t\n\n", "a.tsv", "utf-16"),
    ],
)
def test_tables_of_other_programs_are_read(tmp_path: Path, text: str, name: str, encoding: str) -> None:
    motion = read_motion(text_file(tmp_path, text, name, encoding))
    assert motion.points == ("ball",)
    np.testing.assert_array_equal(motion.time_s, [0, 0.5])
    np.testing.assert_allclose(motion.xy_m[:, 0], [[1.5, 2], [np.nan, np.nan]])
    assert np.isnan(motion.sigma_m).all()


def test_a_sheet_with_the_tracking_columns_is_found_among_others(tmp_path: Path) -> None:
    book = Workbook()
    book.worksheets[0].append(["Instructions"])
    sheet = book.create_sheet("Tracking")
    for row in (["frame", "t_s", "foot_x_m", "foot_y_m"], [400, 0, 1.25, 2], [401, 0.002, "1.5", None], [None] * 4):
        sheet.append(row)
    path = tmp_path / "workbook.xlsx"
    book.save(path)
    motion = read_motion(path)
    np.testing.assert_array_equal(motion.frame, [400, 401])
    np.testing.assert_array_equal(motion.of("foot"), [[1.25, 2], [1.5, np.nan]])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("t_s,ball_x_m,ball_y_m\n0,1,2\n1,lost,3\n", r"a\.csv, column ball_x_m, row 3: expected a number .* 'lost'"),
        ("t_s,ball_x_m,ball_y_m\n0,1,2\n1,1_0,3\n", r"column ball_x_m, row 3"),
        ("t_s,ball_x_m,ball_y_m\n0,1,2\n1,1e999x,3\n", r"row 3"),
        ("t_s,ball_x_m,ball_y_m\n0,1,2\n,1,3\n", r"row 3: expected a time .* an empty cell"),
        ("t_s,ball_x_m,ball_y_m\n1,1,2\n0,1,3\n", r"row 3: expected a time later"),
        ("t_s,ball_x_m\n1,1\n", r"column ball_y_m beside ball_x_m"),
        ("t_s,ball_x_m,ball_y_m\n", r"rows below the header"),
        ("time,ball_x_m,ball_y_m\n1,1,1\n", r"a header with a column t_s"),
        ("t_s,speed\n1,1\n", r"columns <point>_x_m and <point>_y_m"),
        ("t_s,ball_x_m,ball_y_m,ball_x_m\n1,1,1,1\n", r"each column once"),
        ("frame,t_s,ball_x_m,ball_y_m\n1.5,1,1,1\n", r"column frame, row 2: expected a whole number"),
        ("", r"header"),
    ],
)
def test_a_wrong_table_is_one_line_that_says_where(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(TableError, match=words):
        read_motion(text_file(tmp_path, text, "a.csv"))


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.binary(max_size=400), kind=st.sampled_from([*KINDS, "txt"]), is_wound=st.booleans())
def test_any_bytes_are_a_table_or_one_clear_error(tmp_path: Path, data: bytes, kind: str, is_wound: bool) -> None:
    path = tmp_path / f"any.{kind}"
    path.write_bytes(data)
    if is_wound and kind != "txt":
        write_track(path, tracked())
        whole = bytearray(path.read_bytes())
        at = sum(data) * 37 % len(whole)
        whole[at : at + len(data)] = data
        path.write_bytes(whole)
    with contextlib.suppress(VmlError):
        read_motion(path)


def test_unknown_endings_and_missing_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"\.xlsx, \.csv, \.mat"):
        write_track(tmp_path / "out.ods", tracked())
    with pytest.raises(FileFormatError):
        read_motion(tmp_path / "out.ods")
    for kind in KINDS:
        with pytest.raises(FileMissingError):
            read_motion(tmp_path / f"out.{kind}")
    assert list(tmp_path.iterdir()) == []


@settings(max_examples=100)
@given(
    scale=st.floats(1, 1e4),
    origin=st.tuples(st.floats(-2e3, 2e3), st.floats(-2e3, 2e3)),
    angle=st.floats(-math.pi, math.pi),
    point=st.tuples(st.floats(-4e3, 4e3), st.floats(-4e3, 4e3)),
)
def test_pixels_to_metres_and_back_is_the_identity(
    scale: float, origin: tuple[float, float], angle: float, point: tuple[float, float]
) -> None:
    calibration = Calibration(scale, origin, angle)
    there_and_back = calibration.to_px(calibration.to_m(np.array(point)))
    np.testing.assert_allclose(there_and_back, point, rtol=0, atol=1e-8)
