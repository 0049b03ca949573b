"""The tables of a gradebook. Names stand in one of them; grades, keys and events are only ever added to."""

from __future__ import annotations

from sqlalchemy import Column, Float, ForeignKey, Integer, MetaData, String, Table, Text, UniqueConstraint

metadata = MetaData()


def _id() -> Column[int]:
    return Column("id", Integer, primary_key=True)


def _to(table: str, *, nullable: bool = False, primary_key: bool = False) -> Column[int]:
    return Column(
        f"{table}_id", Integer, ForeignKey(f"{table}.id"), nullable=nullable, primary_key=primary_key, index=True
    )


def _text(name: str, *, unique: bool = False) -> Column[str]:
    return Column(name, Text, nullable=False, unique=unique)


student = Table(
    "student",
    metadata,
    _id(),
    Column("pid", String(40), unique=True, nullable=False),
    _text("created_at"),
    Column("status", String(20), nullable=False, server_default="active"),  # or dropped
)
"""A person by random pseudonym: what every file and every other table carries."""

student_identity = Table(
    "student_identity",
    metadata,
    _id(),
    _to("student"),
    Column("kind", String(20), nullable=False),  # name, email, sis_id, login, canvas_id, moodle_participant
    _text("value"),
    UniqueConstraint("student_id", "kind"),
)
"""The only table with personal data; it can be emptied and the rest still works."""

assignment = Table(
    "assignment", metadata, _id(), Column("slug", String(80), unique=True, nullable=False), _text("title")
)

variant = Table(
    "variant",
    metadata,
    _id(),
    _to("assignment"),
    _to("student"),
    Column("code", String(80), unique=True, nullable=False),
    _text("issued_at"),
    Column("variant_json", Text),  # every drawn number with its generator's version: frozen, never drawn again
    Column("video_sha256", String(64)),
)

answer_key = Table(
    "answer_key",
    metadata,
    _id(),
    _to("variant"),
    _text("key_json"),  # frozen: a key is kept, never computed again
    Column("key_sha256", String(64), nullable=False),
    _text("created_at"),
    UniqueConstraint("variant_id", "key_sha256"),
)

submission = Table(
    "submission",
    metadata,
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

receipt = Table(
    "receipt",
    metadata,
    _id(),
    _text("received_at"),  # when it was handed in, as far as the platform says; else when it was collected
    _text("collected_at"),
    Column("file_sha256", String(64), nullable=False, index=True),
    _text("original_name"),
    Column("source", String(20), nullable=False),  # files, canvas, moodle, blackboard, gradescope
    Column("lms_ref", Text),  # what the platform knows the file by, no name in it
    _to("student", nullable=True),  # whom the platform names
    _to("submission", nullable=True),  # what it turned out to be
    Column("assignment", String(80), nullable=False, server_default=""),
    Column("status", String(20), nullable=False),  # grader.receipts.Status
    Column("reason", Text, nullable=False, server_default=""),
    Column("told_by", Text, nullable=False, server_default=""),  # the person who said whose it is
)
"""Every file that ever came in, also those that nobody could read."""

grade_run = Table(
    "grade_run",
    metadata,
    _id(),
    _to("submission"),
    Column("answer_key_id", Integer, ForeignKey("answer_key.id"), nullable=False),
    Column("grader_version", String(40), nullable=False),
    _text("created_at"),
    Column("points", Float, nullable=False),
    Column("out_of", Float, nullable=False),
    Column("status", String(20), nullable=False),
    _text("result_json"),  # diagnosis and reasons
    Column("ms", Integer),  # that the grading took
)

criterion_score = Table(
    "criterion_score",
    metadata,
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

adjustment = Table(
    "adjustment",
    metadata,
    _id(),
    _to("submission"),  # a newer attempt is judged anew
    Column("question", String(80), nullable=False),  # or `total`
    Column("points", Float, nullable=False),
    _text("reason"),
    _text("who"),
    _text("at"),
)
"""What a person decided about an attempt; only ever added to, the newest counts."""

release = Table("release", metadata, _id(), _to("assignment"), _text("at"), _text("who"), _text("snapshot_sha256"))
"""What was told to students and platform at one moment; exports are made from it."""

released_grade = Table(
    "released_grade",
    metadata,
    Column("release_id", Integer, ForeignKey("release.id"), primary_key=True),
    Column("student_id", Integer, ForeignKey("student.id"), primary_key=True),
    Column("grade_run_id", Integer, ForeignKey("grade_run.id")),
    Column("earned", Float, nullable=False),
    Column("late_share", Float, nullable=False),
    Column("points", Float, nullable=False),
    Column("out_of", Float, nullable=False),
    Column("attempt", Integer, nullable=False),
)

integrity_finding = Table(
    "integrity_finding",
    metadata,
    _id(),
    _to("assignment"),
    Column("student_a_id", Integer, ForeignKey("student.id"), nullable=False),
    Column("student_b_id", Integer, ForeignKey("student.id")),
    Column("method", String(40), nullable=False),
    Column("statistic", Float, nullable=False),
    Column("false_positive_rate", Float, nullable=False),
    _text("evidence"),
    _text("found_at"),
    UniqueConstraint("assignment_id", "student_a_id", "student_b_id", "method", "evidence"),
)
"""What a person may want to look at; never a penalty."""

event = Table(
    "event",
    metadata,
    _id(),
    _text("at"),
    _text("kind"),
    _text("subject"),
    _text("data_json"),
    Column("previous", String(64), nullable=False),
    Column("hash", String(64), nullable=False, unique=True),  # over this event and the one before: gaps show
)
