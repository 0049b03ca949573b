"""Runs the migrations on the connection that `grader.database` hands over; alembic calls this file."""

from __future__ import annotations

from alembic import context

from grader.tables import metadata

context.configure(connection=context.config.attributes["connection"], target_metadata=metadata, render_as_batch=True)
with context.begin_transaction():
    context.run_migrations()
