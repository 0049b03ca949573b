"""The gradebook on SQLite and on a real PostgreSQL server: the same promises on both."""

from __future__ import annotations

import datetime as dt
import sqlite3
import stat
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing, contextmanager
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import create_engine, inspect, text

from assignments.terms import Calendar, Extension, Late, Terms
from grader import database, tables
from grader.adjust import Adjustment
from grader.database import SCHEMA, DatabaseError, open_database
from grader.gradebook import Gradebook
from grader.model import Finding, Grade, Outcome, Submission
from grader.roster import Enrolled

MIGRATIONS = Path(sys.modules["grader.database"].__file__ or "").parent / "migrations"
DUE = dt.datetime(2026, 5, 1, tzinfo=dt.UTC)


def _book(url: str, calendar: Calendar | None = None) -> Gradebook:
    return Gradebook(open_database(Path("unused.db"), url), calendar)


def _ready(book: Gradebook, kit) -> str:
    """Enrol one student and keep a key; return the pseudonym."""
    (arrival,) = book.take_in([Enrolled("Ann", "ann@example.org")])
    pid = arrival.student.pid
    book.keep_key(kit.variant_of(student=pid), kit.key_of(kit.impact(), student=pid))
    return pid


def _submission(content: str) -> Submission:
    return Submission("w.xlsx", "soccer-kick", "CODE1", {}, {}, (), content * 8, content * 8)


def _grade(points: float) -> Grade:
    finding = Finding("e", "value", Outcome.PARTIAL, points, 6.0, "Close.")
    return Grade((finding,), points, 6.0, "ok")


def _at(hours: float) -> str:
    return (DUE + dt.timedelta(hours=hours)).isoformat()


def test_runs_are_kept_and_the_terms_decide_what_counts(url, kit) -> None:
    late = Late("linear", share=0.1, per_hours=1)
    with _book(url, Calendar(terms={"soccer-kick": Terms(due=DUE, counts="best", late=late)})) as book:
        pid = _ready(book, kit)
        for content, points, hours in (("a", 3.0, -2), ("b", 5.0, -1), ("c", 6.0, 3)):
            book.record_run(_submission(content), _grade(points), _at(hours))
        row = book.row("soccer-kick", pid)
        assert (row.attempt, row.attempts, row.points, row.late_share) == (2, 3, 5.0, 0.0)
        assert book.is_whole()
    extended = (Extension(pid, "ill", hours=3),)
    with _book(
        url, Calendar(terms={"soccer-kick": Terms(due=DUE, counts="best", late=late)}, extensions=extended)
    ) as book:
        assert book.row("soccer-kick", pid).points == 6.0  # nothing was repaired: it is worked out anew


def test_the_same_content_again_uses_no_attempt(url, kit) -> None:
    with _book(url) as book:
        pid = _ready(book, kit)
        assert [book.record_run(_submission(c), _grade(2.0)) for c in ("a", "b", "a")] == [1, 2, 1]
        assert book.row("soccer-kick", pid).attempts == 2


def test_a_persons_decision_belongs_to_the_attempt_that_counts(url, kit, assignment) -> None:
    with _book(url, Calendar(terms={"soccer-kick": Terms(counts="first")})) as book:
        pid = _ready(book, kit)
        book.record_run(_submission("a"), _grade(2.0))
        book.record_run(_submission("b"), _grade(6.0))
        attempt, row = book.adjust(assignment, pid, Adjustment("e", 5.0, "seen on paper", "tutor", _at(0)))
        assert (attempt, row.attempt, row.points) == (1, 1, 5.0)


def test_what_was_drawn_is_frozen_beside_the_key(url, kit) -> None:
    with _book(url) as book:
        _ready(book, kit)
    engine = create_engine(url)
    with engine.connect() as connection:
        line = connection.execute(text("SELECT variant_json, video_sha256 FROM variant")).one()
    engine.dispose()
    assert '"generator_version": "1"' in line[0]
    assert line[1] == "0" * 64


def test_the_migrated_schema_is_the_one_that_the_code_uses(url) -> None:
    engine = open_database(Path("unused.db"), url)
    with engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), tables.metadata) == []
    engine.dispose()


def test_the_newest_version_is_the_head_of_the_migrations() -> None:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    assert ScriptDirectory.from_config(config).get_heads() == [SCHEMA]


def _first_version(url: str) -> None:
    """Make a database as the first version did, before versions were kept, with a student in it."""
    module = __import__("grader.migrations.versions.v0001_first", fromlist=["_metadata"])
    engine = create_engine(url)
    module._metadata.create_all(engine)
    with engine.begin() as connection:
        connection.execute(text("INSERT INTO student (pid, created_at) VALUES ('k3m9x2ab', '2026-01-01')"))
    engine.dispose()


def test_an_older_gradebook_is_brought_up_to_date_and_keeps_what_it_holds(url) -> None:
    _first_version(url)
    with _book(url) as book:
        (student,) = book.students()
    assert (student.pid, student.status) == ("k3m9x2ab", "active")
    with _book(url) as book:  # and again: nothing left to do
        assert len(book.students()) == 1


def test_a_copy_is_kept_before_a_file_changes_its_schema(tmp_path: Path) -> None:
    url = f"sqlite:///{tmp_path}/book.db"
    _first_version(url)
    _book(url).close()
    (copy,) = tmp_path.glob("book-before-*-from-0001-*.db")
    assert stat.S_IMODE(copy.stat().st_mode) == 0o600
    engine = create_engine(f"sqlite:///{copy}")
    assert "receipt" not in inspect(engine).get_table_names()
    engine.dispose()


def test_a_gradebook_of_a_newer_version_is_left_alone(url) -> None:
    _book(url).close()
    engine = create_engine(url)
    with engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    engine.dispose()
    with pytest.raises(DatabaseError, match=rf"expected a gradebook of version {SCHEMA} or older, got 9999"):
        _book(url)


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("nonsense", "gradebook: expected the URL of a database"),
        ("oracle://x/y", "gradebook: expected"),
        ("mysql://x/y", "gradebook: expected"),
        ("postgresql+psycopg://nobody:secret@127.0.0.1:1/none", "expected a database that can be opened"),
    ],
)
def test_a_database_that_cannot_be_opened_is_one_line_without_its_password(url: str, words: str) -> None:
    with pytest.raises(DatabaseError) as caught:
        open_database(Path("x.db"), url)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
    assert "secret" not in str(caught.value)


def test_a_relative_file_lies_beside_the_course(tmp_path: Path) -> None:
    open_database(tmp_path / "gradebook.db", "sqlite:///grades.db").dispose()
    assert (tmp_path / "grades.db").is_file()


def _write_many(url: str, name: str, number: int) -> int:
    with Gradebook(open_database(Path("unused.db"), url)) as book:
        for k in range(number):
            content = f"{name}{k}"
            book.record_run(replace(_submission("x"), content_sha256=content, file_sha256=content), _grade(1.0))
    return number


@contextmanager
def _two_at_once() -> Iterator[ProcessPoolExecutor]:
    """Two processes that begin in the same moment; spawned, for the tests' own process has threads."""
    spawned = get_context("spawn")
    with ProcessPoolExecutor(2, spawned, initializer=spawned.Barrier(2).wait) as pool:
        yield pool


def test_two_graders_at_once_lose_nothing_and_number_no_attempt_twice(url, kit) -> None:
    with _book(url) as book:
        pid = _ready(book, kit)
    with _two_at_once() as pool:
        written = sum(pool.map(_write_many, [url, url], ["one", "other"], [25, 25]))
    with _book(url) as book:
        row = book.row("soccer-kick", pid)
        assert written == row.attempts == row.attempt == 50
        assert book.is_whole()


def test_two_who_open_a_new_gradebook_at_once_both_can(url) -> None:
    with _two_at_once() as pool:
        assert list(pool.map(_opened, [url] * 4)) == [0, 0, 0, 0]


def _opened(url: str) -> int:
    with _book(url) as book:
        return len(book.students())


def test_a_file_is_opened_while_somebody_still_writes_its_first_page(tmp_path: Path) -> None:
    """SQLite answers "locked" at once when the log of a file that is being written is switched on."""
    path = tmp_path / "book.db"
    with closing(sqlite3.connect(path, isolation_level=None, check_same_thread=False)) as other:
        other.execute("CREATE TABLE of_another (x)")
        other.execute("BEGIN IMMEDIATE")
        ends = threading.Timer(0.2, other.execute, ["COMMIT"])
        ends.start()
        with _book(f"sqlite:///{path}") as book:
            assert book.students() == ()
        ends.join()


def test_a_file_that_stays_locked_is_one_line(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(database, "_PATIENCE_S", 0.1)
    path = tmp_path / "book.db"
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("CREATE TABLE of_another (x)")
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(DatabaseError, match=r"expected a database that can be opened, got database is locked\.$"):
            _book(f"sqlite:///{path}")
