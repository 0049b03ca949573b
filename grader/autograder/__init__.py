"""Grading one submission inside Gradescope's container: what is packed into it, and what runs there."""
