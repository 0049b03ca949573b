"""What is asked of students: assignments, variants, workbooks, handouts."""
