"""Pages of one sample class in a real browser: Debian's chromium, steered by Playwright, axe from its package.

Nothing is fetched: a page that asks for anything outside itself fails its test.
"""

from __future__ import annotations

import datetime as dt
import os
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from assignments.film import foresee
from assignments.impact_frame import cut_out
from assignments.key import answer_key
from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.terms import Late, Terms
from assignments.variants import draw_variant
from assignments.words import tracking_columns
from grader.adjust import Adjustment
from grader.class_page import class_page
from grader.feedback import Report, feedback_page
from grader.grade import grade
from grader.gradebook import Row, Student
from grader.items import evidence_of
from grader.model import Answer, Kind, Outcome, Submission, overall

SECRET = bytes(range(32))
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
# The sd of each number that the reference reaches on such videos, as parts of the value.
SD_PARTS = {"omega1": 3e-4, "omega2": 4e-4, "v_f1": 4e-4, "v_f2": 5e-4, "v_b2": 1e-4, "e": 3e-3, "I": 2e-3}


# ---------------------------------------------------------------- a sample class


@cache
def kick() -> Assignment:
    return load_assignment("soccer-kick")


@cache
def key_of(student: str) -> AnswerKey:
    variant = draw_variant(kick(), SECRET, student)
    key = answer_key(kick(), variant, foresee(variant), None, "0" * 64)
    harder = 1 + sum(map(ord, student)) % 7 / 3
    return replace(key, expected_sd={name: harder * part * abs(key.values[name]) for name, part in SD_PARTS.items()})


def table_of(key: AnswerKey, noise_px: float, rng: np.random.Generator) -> dict[str, np.ndarray]:
    xy = (key.xy_px + rng.normal(0, noise_px, key.xy_px.shape)) * [1, -1] / key.truth["px_per_m"]
    names = [name for name in kick().points if name in key.points]
    columns = [key.frame, key.time_s]
    for name in names:
        columns += list(xy[:, key.points.index(name)].T)
    return dict(zip(tracking_columns(names), columns, strict=True))


def submission_of(key: AnswerKey, changes: Mapping[str, object], tracking, *, blank: bool = False) -> Submission:
    answers = {}
    for question in kick().questions:
        value = changes.get(question.id, float(f"{key.values[question.id]:.5g}"))
        unit = str(changes.get(f"unit of {question.id}", question.unit))
        where = {"where": "Answers!C7", "found_by": "name"}
        if blank:
            answers[question.id] = Answer(**where)
        elif isinstance(value, str):
            answers[question.id] = Answer(Kind.TEXT, None, value, unit, **where)
        else:
            answers[question.id] = Answer(Kind.NUMBER, value, f"{value:.15g}", unit, **where)
    return Submission("w.xlsx", kick().id, key.code, answers, tracking)


def report_of(kind: str) -> Report:
    """A right submission, one with every kind of finding, an empty one, and one that may be handed in again."""
    key, rng = key_of("pupil001"), np.random.default_rng(1)
    right = submission_of(key, {}, table_of(key, 0.1, rng))
    if kind == "empty":
        right = submission_of(key, {}, {}, blank=True)
    if kind in {"every", "open"}:
        changes = {
            "v_f1": key.values["v_f1"] * 1.3,
            "v_f2": key.values["v_f2"] * 1.015,
            "v_b2": -key.values["v_b2"],
            "omega1": "about <5>",
            "unit of v_b1": "",
            "e": 1 / key.values["e"],
            "I": 1234567.0,
        }
        right = submission_of(key, changes, table_of(key, 2.5, rng))
    result = grade(right, key, kick())
    frame = cut_out(picture(), tuple(key.xy_px[int(key.truth["frame_before"]), -1]), int(key.truth["frame_before"]))
    report = Report(kick(), right, key, result, show_truth=kind != "open", frame=frame)
    if kind in {"every", "open"}:
        return replace(report, **terms_of(result, is_over=kind == "every"))
    return report


def terms_of(result, *, is_over: bool) -> dict[str, object]:
    due = dt.datetime(2026, 12, 1, 23, 59, tzinfo=dt.UTC)
    terms = Terms(due=due, attempts=3, counts="best", late=Late("fixed", share=0.1))
    row = replace(row_of("pupil001", "", result), attempts=2, attempt=2, late_share=0.1, points=0.9 * result.points)
    words = ("e: 4.5 points, by A. Teacher: the digits were meant",)
    due_text = "Tuesday 1 December 2026, 23:59 (UTC)"
    return {"row": row, "terms": terms, "due": due_text, "is_over": is_over, "attempt": 2, "adjustments": words}


def picture() -> np.ndarray:
    y, x = np.mgrid[:720, :1280]
    return np.repeat((110 + 60 * np.sin(x / 23) * np.sin(y / 31))[..., None], 3, axis=2).astype(np.uint8)


def row_of(pid: str, name: str, result) -> Row:
    outcomes: dict[str, Outcome] = {}
    for question in kick().questions:
        found = result.of(question.id)
        out_of = sum(f.out_of for f in found)
        outcomes[question.id] = overall((f.outcome for f in found), sum(f.points for f in found), out_of)
    mistakes = tuple(code for d in result.diagnosis if d.is_unique for code in d.codes)
    return Row(
        Student(pid, name), kick().id, 1, result.points, result.out_of, result.status, "", outcomes, mistakes,
        result.reasons, earned=result.points,
    )  # fmt: skip


def class_of(count: int) -> str:
    """The instructor's page of so many students, of whom every fourth slips."""
    rows, evidence, rng = [], {}, np.random.default_rng(7)
    for number in range(count):
        key = key_of(f"pupil{number:03}")
        changes = {id_: key.values[id_] * (1 + rng.normal(0, 0.004)) for id_ in SD_PARTS}
        if number % 4 == 1:
            changes["e"] = 1 / key.values["e"]
        if number % 8 == 3:
            changes["omega1"] = "fast"
        if number % 8 == 6:
            changes |= dict.fromkeys(("v_f1", "v_f2", "v_b2", "omega1", "omega2", "e", "I"), 99.5)
        result = grade(submission_of(key, changes, table_of(key, 0.4, rng)), key, kick())
        rows.append(row_of(key.student, f"Student {number} of a long name", result))
        evidence[key.student] = evidence_of(result.findings, key)
    if count > 5:
        rows[0] = replace(
            rows[0],
            attempts=3,
            attempt=2,
            late_share=0.2,
            decisions=(Adjustment("e", 3.0, "a typing slip", "ann", "2026-05-01"),),
        )
    students = [row.student for row in rows] + ([Student("zz", "Nobody Yet")] if count else [])
    unreadable = [("report.pdf", "report.pdf: expected a workbook, got a PDF.")] if count else []
    return class_page(kick(), rows, unreadable, students, evidence)


PAGES: Mapping[str, Callable[[], str]] = {
    "right": lambda: feedback_page(report_of("right")),
    "every": lambda: feedback_page(report_of("every")),
    "empty": lambda: feedback_page(report_of("empty")),
    "open": lambda: feedback_page(report_of("open")),
    "class of 0": lambda: class_of(0),
    "class of 1": lambda: class_of(1),
    "class of 40": lambda: class_of(40),
}


@pytest.fixture(scope="session")
def kit() -> ModuleType:
    """The makers of this file."""
    return sys.modules[__name__]


@pytest.fixture(scope="session")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Path]:
    """Every page as a file."""
    folder = tmp_path_factory.mktemp("pages")
    made = {name: folder / f"{name.replace(' ', '-')}.html" for name in PAGES}
    for name, path in made.items():
        path.write_text(PAGES[name](), encoding="utf-8")
    return made


# ---------------------------------------------------------------- the browser


@dataclass(frozen=True)
class Desk:
    """A browser that opens pages and remembers what they asked for and complained of."""

    browser: object

    @contextmanager
    def opened(self, path: Path, *, scheme: str = "light", width: int = 1100, scripts: bool = True) -> Iterator:
        """Open a page; at the end, it has asked for nothing outside itself and complained of nothing."""
        context = self.browser.new_context(
            color_scheme=scheme,
            viewport={"width": width, "height": 900},
            java_script_enabled=scripts,
            bypass_csp=scripts,
        )
        page, asked, told = context.new_page(), [], []
        page.on("request", lambda request: asked.append(request.url))
        page.on("console", lambda message: told.append(message.text))
        page.on("pageerror", lambda error: told.append(str(error)))
        page.goto(path.as_uri())
        yield page
        context.close()
        outside = [url for url in asked if url != path.as_uri() and not url.startswith("data:")]
        assert outside == []
        assert told == []


@pytest.fixture(scope="session")
def desk() -> Iterator[Desk]:
    if CHROMIUM is None:
        missing = "these tests need chromium: apt-get install chromium"
        pytest.fail(missing) if os.environ.get("VML_NEEDS_BROWSER") else pytest.skip(missing)
    playwright = pytest.importorskip("playwright.sync_api", reason="needs the package playwright")
    with playwright.sync_playwright() as driver:
        flags = ["--disable-gpu", "--disable-background-networking", "--disable-dev-shm-usage"]
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=flags)
        yield Desk(browser)
        browser.close()
