"""Whose a file is, where a person said so: the workbook's own code is not asked then."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision, down_revision, branch_labels, depends_on = "0003", "0002", None, None


def upgrade() -> None:
    """Add who said it; nobody did before."""
    op.add_column("receipt", sa.Column("told_by", sa.Text, nullable=False, server_default=""))
