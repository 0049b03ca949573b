"""Copies are found and honest students left alone; what is found is kept as evidence and changes no grade."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sqlalchemy import create_engine, insert

from grader import tables
from grader.findings import add_findings, findings_of, keys_of_class, newest_files
from grader.integrity import NEVER, NO_BOUND, SELDOM, Evidence, HandedIn, compare
from grader.integrity_commands import _rate
from grader.residuals import correlations, residual_of
from grader.trajectory import fit_trajectory

STUDENTS = 12


@pytest.fixture(scope="module")
def impacts(kit):
    rng = np.random.default_rng(11)
    return [kit.impact(*rng.uniform((0.4, 0.4, 0.2, 0.4, 12), (0.9, 1.5, 0.6, 0.7, 26))) for _ in range(STUDENTS)]


@pytest.fixture
def honest(kit, assignment, impacts):
    """A class whose students tracked their own videos, with 0.5 px of noise."""
    rng = np.random.default_rng(3)
    handed = []
    for number, impact in enumerate(impacts):
        xy = kit.trajectory_m(impact)
        table = kit.table_of(np.round(xy + 0.5 / kit.SCALE * rng.standard_normal(xy.shape), 5))
        submission = replace(kit.submission_of(assignment, {}, tracking=table), content_sha256=f"content {number}")
        handed.append(HandedIn(f"p{number}", submission, kit.key_of(impact, student=f"p{number}")))
    return handed


def with_table(one, table):
    return replace(one, submission=replace(one.submission, tracking=table))


def jittered(kit, one, noise_px, seed=5):
    rng = np.random.default_rng(seed)
    return {
        name: column + (noise_px / kit.SCALE * rng.standard_normal(len(column)) if name.endswith("_m") else 0.0)
        for name, column in one.submission.tracking.items()
    }


def methods(found, pid):
    return {item.method for item in found if item.pid == pid}


def test_an_honest_class_is_left_alone(honest):
    assert compare(honest) == ()


def test_a_class_of_nobody_is_compared():
    assert compare([]) == ()


def test_a_copied_table_is_found_in_three_ways(honest):
    honest[4] = with_table(honest[4], honest[1].submission.tracking)
    found = compare(honest)
    assert {item.method for item in found} == {"other-video", "same-noise", "same-cells"}
    assert {frozenset((item.pid, item.other)) for item in found} == {frozenset(("p1", "p4"))}
    assert "p1" in next(item.words for item in found if item.method == "other-video")


@pytest.mark.parametrize("noise_px", [0.1, 0.5])
def test_jitter_hides_digits_but_neither_video_nor_noise(kit, honest, noise_px):
    honest[4] = with_table(honest[4], jittered(kit, honest[1], noise_px))
    found = compare(honest)
    assert {item.method for item in found} == {"other-video", "same-noise"}
    rho = next(item.statistic for item in found if item.method == "same-noise")
    assert rho == pytest.approx(1 / np.sqrt(1 + (noise_px / 0.5) ** 2), abs=0.1)


def test_another_scale_origin_and_frame_count_hide_nothing(honest):
    table = dict(honest[1].submission.tracking)
    table = {name: 1.1 * column + 0.4 if name.endswith("_m") else column for name, column in table.items()}
    table["frame"] = table["frame"] + 3
    honest[4] = with_table(honest[4], table)
    assert {"other-video", "same-noise"} <= methods(compare(honest), "p4")


def test_the_owner_of_a_video_may_have_handed_in_nothing(honest):
    gone = honest.pop(1)
    honest[3] = with_table(honest[3], gone.submission.tracking)
    (item,) = compare(honest, {gone.pid: gone.key})
    assert (item.pid, item.other, item.method) == ("p4", "p1", "other-video")


def test_a_table_of_no_video_at_all_is_no_copy(kit, honest):
    rng = np.random.default_rng(0)
    honest[4] = with_table(honest[4], kit.table_of(rng.standard_normal((60, 3, 2))))
    assert compare(honest) == ()


def test_a_missing_table_is_no_sign(honest):
    honest[4] = with_table(honest[4], {})
    assert compare(honest) == ()


def test_the_same_file_and_links_to_another_are_told(honest):
    honest[2] = replace(
        honest[2], submission=replace(honest[2].submission, file_sha256="ab", flags=("links", "macros"))
    )
    honest[5] = replace(honest[5], submission=replace(honest[5].submission, file_sha256="ab"))
    found = {item.method: item for item in compare(honest)}
    assert found["same-file"].pid == "p5"
    assert found["same-file"].other == "p2"
    assert (found["other-workbook"].pid, found["other-workbook"].false_positive_rate) == ("p2", NO_BOUND)


def test_a_few_cells_in_common_are_no_sign(honest):
    table = {name: column.copy() for name, column in honest[4].submission.tracking.items()}
    for name in ("ball_x_m", "ball_y_m"):
        table[name][:4] = honest[1].submission.tracking[name][:4]
    honest[4] = with_table(honest[4], table)
    assert "same-cells" not in {item.method for item in compare(honest)}


def test_coarse_positions_may_be_equal_by_chance(honest):
    coarse = [
        with_table(one, {name: np.round(column, 1) for name, column in one.submission.tracking.items()})
        for one in honest[:2]
    ]
    assert "same-cells" not in {item.method for item in compare(coarse)}


def test_independent_noise_does_not_correlate(honest):
    fits = [(fit_trajectory(one.submission.tracking, one.key), one.key) for one in honest]
    rho, count = correlations([residual_of(fit, key) for fit, key in fits])
    apart = rho[np.triu_indices(STUDENTS, 1)]
    assert np.abs(apart).max() < 0.3
    assert np.diag(rho) == pytest.approx(1.0)
    assert count.min() > 100
    assert [one.shape for one in correlations([])] == [(0, 0), (0, 0)]


def test_too_few_frames_have_no_noise(kit, honest):
    one = honest[0]
    table = {name: column[24:36] for name, column in one.submission.tracking.items()}
    fit = fit_trajectory(table, one.key)
    assert fit is not None
    assert residual_of(fit, one.key) is None


def test_progress_is_told(honest):
    said = []
    compare(honest[:3], progress=lambda done, total: said.append((done, total)))
    assert said == [(1, 3), (2, 3), (3, 3)]


@pytest.mark.parametrize(
    ("rate", "words"),
    [
        (NEVER, "never by chance"),
        (SELDOM, "in at most 3.0% of honest classes"),
        (0.99, "in at most 99.0% of honest classes"),
        (NO_BOUND, "says little by itself"),
    ],
)
def test_a_rate_is_told_in_words(rate, words):
    assert _rate(rate) == words


# ---------------------------------------------------------------- what is kept


@pytest.fixture
def connection():
    engine = create_engine("sqlite://")
    tables.metadata.create_all(engine)
    with engine.begin() as opened:
        opened.execute(insert(tables.assignment).values(slug="soccer-kick", title="Kick"))
        for pid in ("p1", "p2"):
            opened.execute(insert(tables.student).values(pid=pid, created_at="2027"))
            at = 1 if pid == "p1" else 2
            line = {"assignment_id": 1, "student_id": at, "code": f"CODE {pid}", "issued_at": "2027"}
            opened.execute(insert(tables.variant).values(**line))
        yield opened
    engine.dispose()


EVIDENCE = Evidence("p1", "p2", "same-noise", 0.9, 0.03, "Noise.")
ALONE = Evidence("p2", "", "other-workbook", 1.0, 1.0, "Links.")


def test_evidence_is_added_once(connection):
    assert add_findings(connection, "soccer-kick", [EVIDENCE, ALONE, ALONE]) == 2
    assert add_findings(connection, "soccer-kick", [ALONE, EVIDENCE]) == 0
    assert findings_of(connection, "soccer-kick") == (EVIDENCE, ALONE)
    assert findings_of(connection, "another") == ()


def test_the_newest_attempt_is_compared(connection):
    for number in (1, 2):
        line = {"variant_id": 1, "attempt": number, "received_at": "2027", "content_sha256": str(number)}
        connection.execute(insert(tables.submission).values(**line, file_sha256=f"file {number}", original_name="w"))
    (newest,) = newest_files(connection, "soccer-kick")
    assert (newest.pid, newest.file_sha256) == ("p1", "file 2")
    assert keys_of_class(connection, "soccer-kick") == {}
