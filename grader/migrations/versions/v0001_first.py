"""The first schema: frozen here as it was, whatever `grader.tables` has become."""

from __future__ import annotations

from alembic import op
from sqlalchemy import Column, Float, ForeignKey, Integer, MetaData, String, Table, Text, UniqueConstraint

revision, down_revision, branch_labels, depends_on = "0001", None, None, None

_metadata = MetaData()


def _id() -> Column[int]:
    return Column("id", Integer, primary_key=True)


def _to(table: str, *, nullable: bool = False, primary_key: bool = False) -> Column[int]:
    return Column(
        f"{table}_id", Integer, ForeignKey(f"{table}.id"), nullable=nullable, primary_key=primary_key, index=True
    )


def _text(name: str, *, unique: bool = False) -> Column[str]:
    return Column(name, Text, nullable=False, unique=unique)


Table("student", _metadata, _id(), Column("pid", String(40), unique=True, nullable=False), _text("created_at"))

Table(
    "student_identity",
    _metadata,
    _id(),
    _to("student"),
    Column("kind", String(20), nullable=False),  # name, email
    _text("value"),
    UniqueConstraint("student_id", "kind"),
)

Table("assignment", _metadata, _id(), Column("slug", String(80), unique=True, nullable=False), _text("title"))

Table(
    "variant",
    _metadata,
    _id(),
    _to("assignment"),
    _to("student"),
    Column("code", String(80), unique=True, nullable=False),
    _text("issued_at"),
)

Table(
    "answer_key",
    _metadata,
    _id(),
    _to("variant"),
    _text("key_json"),  # frozen: a key is kept, never computed again
    Column("key_sha256", String(64), nullable=False),
    _text("created_at"),
    UniqueConstraint("variant_id", "key_sha256"),
)

Table(
    "submission",
    _metadata,
    _id(),
    _to("variant"),
    Column("attempt", Integer, nullable=False),
    _text("received_at"),
    Column("file_sha256", String(64), nullable=False),  # the bytes lie in inbox/ under this name
    Column("content_sha256", String(64), nullable=False),
    _text("original_name"),
    UniqueConstraint("variant_id", "attempt"),
    UniqueConstraint("variant_id", "content_sha256"),  # the same content again is the same attempt
)

Table(
    "grade_run",
    _metadata,
    _id(),
    _to("submission"),
    Column("answer_key_id", Integer, ForeignKey("answer_key.id"), nullable=False),
    Column("grader_version", String(40), nullable=False),
    _text("created_at"),
    Column("points", Float, nullable=False),
    Column("out_of", Float, nullable=False),
    Column("status", String(20), nullable=False),
    _text("result_json"),  # diagnosis and reasons
)

Table(
    "criterion_score",
    _metadata,
    Column("grade_run_id", Integer, ForeignKey("grade_run.id"), primary_key=True),
    Column("position", Integer, primary_key=True),
    Column("question", String(80), nullable=False),
    Column("aspect", String(20), nullable=False),
    Column("outcome", String(20), nullable=False),
    Column("points", Float, nullable=False),
    Column("out_of", Float, nullable=False),
    Column("mistake", String(20), nullable=False),
    Column("carried", Integer, nullable=False),
    _text("detail_json"),
)

Table(
    "adjustment",
    _metadata,
    _id(),
    _to("submission"),  # a newer attempt is judged anew
    Column("question", String(80), nullable=False),  # or `total`
    Column("points", Float, nullable=False),
    _text("reason"),
    _text("who"),
    _text("at"),
)

Table(
    "event",
    _metadata,
    _id(),
    _text("at"),
    _text("kind"),
    _text("subject"),
    _text("data_json"),
    Column("previous", String(64), nullable=False),
    Column("hash", String(64), nullable=False, unique=True),  # over this event and the one before: gaps show
)


def upgrade() -> None:
    """Make all tables."""
    _metadata.create_all(op.get_bind())
