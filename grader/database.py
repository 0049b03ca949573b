"""The gradebook's database: a SQLite file by default, PostgreSQL by URL, the same code for both.

The schema has versions (`migrations/`). An older gradebook is brought up to date when it is opened, a copy of the
file kept beside it first.
"""

from __future__ import annotations

import datetime as dt
import logging
import os
import sqlite3
import time
from contextlib import closing
from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from sqlalchemy import Connection, Engine, create_engine, inspect
from sqlalchemy import event as engine_event
from sqlalchemy.engine import URL, make_url
from sqlalchemy.exc import ArgumentError, NoSuchModuleError, OperationalError, SQLAlchemyError

from vml_course.errors import InputError

SCHEMA = "0003"
"""The newest version in `migrations/versions`."""

_FIRST = "0001"
_PATIENCE_S = 10  # with others who write
_WRITERS = 8_240_917  # the number of PostgreSQL's lock that writers of a gradebook take in turn
_MIGRATIONS = Path(__file__).parent / "migrations"


class DatabaseError(InputError):
    """The gradebook's database cannot be opened."""


def open_database(file: Path, url: str = "") -> Engine:
    """Open a gradebook's database at a URL, or in a file, and bring its schema up to date.

    Raises
    ------
    DatabaseError
        When there is no such database, it cannot be reached, or was written by a newer version.
    """
    address = _address(file, url)
    engine = _sqlite(address) if address.get_backend_name() == "sqlite" else _server(address)
    try:
        _bring_up_to_date(engine, address)
    except OperationalError as error:
        engine.dispose()
        raise DatabaseError(_shown(address), "a database that can be opened", _reason(error)) from error
    except BaseException:
        engine.dispose()
        raise
    return engine


def _address(file: Path, url: str) -> URL:
    if not url:
        return URL.create("sqlite", database=str(file))
    try:
        address = make_url(url)
        backend = address.get_backend_name()
    except (ArgumentError, NoSuchModuleError) as error:
        hint = "Such as postgresql+psycopg://user@host/dynamics."
        raise DatabaseError("gradebook", "the URL of a database", repr(url[:60]), hint) from error
    if backend == "sqlite" and address.database and not Path(address.database).is_absolute():
        address = address.set(database=str(file.parent / address.database))  # beside the course, not the prompt
    if backend not in ("sqlite", "postgresql"):
        raise DatabaseError("gradebook", "a database of sqlite or postgresql", repr(backend))
    return address


def _sqlite(address: URL) -> Engine:
    """Open a file: only for its owner, write-ahead log, foreign keys on, patient with other writers."""
    if address.database:
        _keep_private(Path(address.database))
    engine = create_engine(address, connect_args={"timeout": _PATIENCE_S})

    @engine_event.listens_for(engine, "connect")
    def _settings(connection: Any, _: Any) -> None:
        connection.isolation_level = None  # SQLAlchemy says BEGIN itself, below
        _keep_a_log(connection)
        for setting in ("foreign_keys=ON", f"busy_timeout={1000 * _PATIENCE_S}", "synchronous=NORMAL"):
            connection.execute(f"PRAGMA {setting}")

    @engine_event.listens_for(engine, "begin")
    def _begin(connection: Connection) -> None:
        # Take the write lock at once: two graders then queue instead of failing halfway.
        connection.exec_driver_sql("BEGIN" if _only_reads(connection) else "BEGIN IMMEDIATE")

    return engine


def _keep_a_log(connection: sqlite3.Connection) -> None:
    """Switch a file to a write-ahead log; SQLite does not wait for whoever writes to a new file meanwhile: we do."""
    until = time.monotonic() + _PATIENCE_S
    while True:
        try:
            connection.execute("PRAGMA journal_mode=WAL")
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY or time.monotonic() > until:
                raise
            time.sleep(0.01)
        else:
            return


def _server(address: URL) -> Engine:
    """Connect to a server; writers take turns, so that the chain of events has no forks."""
    try:
        engine = create_engine(address, pool_pre_ping=True)
    except ImportError as error:
        hint = "Install: pip install 'vml-course[postgres]'"
        raise DatabaseError("gradebook", "a driver for PostgreSQL", str(error), hint) from error

    @engine_event.listens_for(engine, "begin")
    def _begin(connection: Connection) -> None:
        if not _only_reads(connection):
            connection.exec_driver_sql(f"SELECT pg_advisory_xact_lock({_WRITERS})")

    return engine


def _only_reads(connection: Connection) -> bool:
    return bool(connection.get_execution_options().get("reads", False))


def _keep_private(path: Path) -> None:
    """Names and answers lie in it: nobody else may read it, not even for a moment."""
    if not path.parent.is_dir():
        return
    os.close(os.open(path, os.O_RDWR | os.O_CREAT, 0o600))
    if path.stat().st_mode & 0o077:
        path.chmod(0o600)


# ---------------------------------------------------------------- versions


def _bring_up_to_date(engine: Engine, address: URL) -> None:
    version = _version(engine)
    if version == SCHEMA:
        return
    if version > SCHEMA:
        hint = "Use the vml-course that wrote it, or a newer one."
        raise DatabaseError(_shown(address), f"a gradebook of version {SCHEMA} or older", version, hint)
    if version:
        _back_up(address, version)
    with engine.begin() as connection:  # the write lock: of two that open it first, one migrates and one waits
        at = _version_in(connection)
        config = _config(connection)
        if at == _FIRST and not inspect(connection).has_table("alembic_version"):
            command.stamp(config, _FIRST)  # from before versions were kept
        command.upgrade(config, "head")


def _version(engine: Engine) -> str:
    with engine.execution_options(reads=True).connect() as connection:
        return _version_in(connection)


def _version_in(connection: Connection) -> str:
    """Return the version of the schema, "" for an empty database."""
    tables = inspect(connection).get_table_names()
    if "alembic_version" in tables:
        return str(connection.exec_driver_sql("SELECT version_num FROM alembic_version").scalar() or "")
    return _FIRST if "grade_run" in tables else ""


def _config(connection: Connection) -> Config:
    logging.getLogger("alembic").setLevel(logging.WARNING)
    config = Config()
    config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
    config.attributes["connection"] = connection
    return config


def _back_up(address: URL, version: str) -> None:
    """Copy a file before its schema changes; a server's database is its keeper's to copy."""
    if address.get_backend_name() != "sqlite" or not address.database:
        return
    path = Path(address.database)
    stamp = dt.datetime.now(dt.UTC).strftime("%Y%m%dT%H%M%S%f")
    copy = path.with_name(f"{path.stem}-before-{SCHEMA}-from-{version}-{stamp}.db")
    _keep_private(copy)
    with closing(sqlite3.connect(path)) as source, closing(sqlite3.connect(copy)) as target:
        source.backup(target)


def _shown(address: URL) -> str:
    return address.render_as_string(hide_password=True)


def _reason(error: SQLAlchemyError) -> str:
    return str(getattr(error, "orig", error)).strip().splitlines()[0][:200]
