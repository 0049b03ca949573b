"""One file a check; its docstring is what the student reads."""
