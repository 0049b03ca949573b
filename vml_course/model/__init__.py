"""The words every room speaks: frozen records of read-only arrays."""
