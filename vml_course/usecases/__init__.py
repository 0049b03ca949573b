"""One file a verb: the hallway where the rooms meet."""
