"""A broken workbook ends as a submission or as one polite sentence; benchmarks/reading_fuzz.py tries many more."""

from __future__ import annotations

import mutants

from grader.read import ReadRequest, UnreadableError, read_workbook
from grader.read.locate import find_submission


def test_three_hundred_broken_workbooks_end_politely(assignment, good_bytes):
    read = 0
    for data in mutants.mutants(good_bytes, 300, seed=1):
        try:
            book = read_workbook(ReadRequest("w.xlsx", data))
            find_submission(book, assignment.questions, {}, assignment.points)
            read += 1
        except UnreadableError as error:
            sentence = str(error)
            if not sentence.isprintable() or not error.hint:
                raise
    assert 30 < read < 270  # neither all broken beyond reading nor all whole
