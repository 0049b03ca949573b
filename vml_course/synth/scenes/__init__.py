"""One file a scene; a file that is here is a scene that exists."""
