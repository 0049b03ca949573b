"""Receipts, releases, findings for the instructor's eyes; frozen variants; students who left."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision, down_revision, branch_labels, depends_on = "0002", "0001", None, None


def upgrade() -> None:
    """Add what is new; nothing that was there changes."""
    op.add_column("student", sa.Column("status", sa.String(20), nullable=False, server_default="active"))
    op.add_column("variant", sa.Column("variant_json", sa.Text))
    op.add_column("variant", sa.Column("video_sha256", sa.String(64)))
    op.add_column("grade_run", sa.Column("ms", sa.Integer))
    _receipts()
    _releases()
    _findings()


def _receipts() -> None:
    op.create_table(
        "receipt",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("received_at", sa.Text, nullable=False),
        sa.Column("collected_at", sa.Text, nullable=False),
        sa.Column("file_sha256", sa.String(64), nullable=False, index=True),
        sa.Column("original_name", sa.Text, nullable=False),
        sa.Column("source", sa.String(20), nullable=False),
        sa.Column("lms_ref", sa.Text),
        sa.Column("student_id", sa.Integer, sa.ForeignKey("student.id"), index=True),
        sa.Column("submission_id", sa.Integer, sa.ForeignKey("submission.id"), index=True),
        sa.Column("assignment", sa.String(80), nullable=False, server_default=""),
        sa.Column("status", sa.String(20), nullable=False),
        sa.Column("reason", sa.Text, nullable=False, server_default=""),
    )


def _releases() -> None:
    op.create_table(
        "release",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("assignment_id", sa.Integer, sa.ForeignKey("assignment.id"), nullable=False, index=True),
        sa.Column("at", sa.Text, nullable=False),
        sa.Column("who", sa.Text, nullable=False),
        sa.Column("snapshot_sha256", sa.Text, nullable=False),
    )
    op.create_table(
        "released_grade",
        sa.Column("release_id", sa.Integer, sa.ForeignKey("release.id"), primary_key=True),
        sa.Column("student_id", sa.Integer, sa.ForeignKey("student.id"), primary_key=True),
        sa.Column("grade_run_id", sa.Integer, sa.ForeignKey("grade_run.id")),
        sa.Column("earned", sa.Float, nullable=False),
        sa.Column("late_share", sa.Float, nullable=False),
        sa.Column("points", sa.Float, nullable=False),
        sa.Column("out_of", sa.Float, nullable=False),
        sa.Column("attempt", sa.Integer, nullable=False),
    )


def _findings() -> None:
    op.create_table(
        "integrity_finding",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("assignment_id", sa.Integer, sa.ForeignKey("assignment.id"), nullable=False, index=True),
        sa.Column("student_a_id", sa.Integer, sa.ForeignKey("student.id"), nullable=False),
        sa.Column("student_b_id", sa.Integer, sa.ForeignKey("student.id")),
        sa.Column("method", sa.String(40), nullable=False),
        sa.Column("statistic", sa.Float, nullable=False),
        sa.Column("false_positive_rate", sa.Float, nullable=False),
        sa.Column("evidence", sa.Text, nullable=False),
        sa.Column("found_at", sa.Text, nullable=False),
        sa.UniqueConstraint("assignment_id", "student_a_id", "student_b_id", "method", "evidence"),
    )
