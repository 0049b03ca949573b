"""One file an impact model."""
