"""Following points through a clip."""
