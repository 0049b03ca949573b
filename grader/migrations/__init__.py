"""Versions of the gradebook's schema, newest last; `grader.database` runs them."""
