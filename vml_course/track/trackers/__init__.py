"""One file a tracking method; a file that is here is a method that exists."""
