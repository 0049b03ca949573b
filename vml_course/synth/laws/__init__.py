"""Laws of impact that scenes share, one a file."""
