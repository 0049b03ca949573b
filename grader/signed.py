"""Whether a workbook's code was given out by this course: a code typed by hand has no signature."""

from __future__ import annotations

import hmac

from assignments.course import Course
from assignments.model import AnswerKey
from assignments.variants import signature_of
from grader.read.locate import Claims


def is_signed(course: Course, key: AnswerKey, claims: Claims) -> bool:
    """Tell whether the course's own signature is on the code."""
    expected = signature_of(course.secret, key.assignment_id, claims.code)
    return hmac.compare_digest(expected.encode(), claims.signature.encode())
