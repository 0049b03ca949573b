"""What can be wrong with a course's gradebook or with what is asked of it."""

from __future__ import annotations

from vml_course.errors import InputError


class UnknownVariantError(InputError):
    """A workbook carries a variant code that this course never handed out."""

    def __init__(self, name: str, code: str) -> None:
        hint = "Is it another course's, or last year's? Hand in the workbook that came with your video."
        super().__init__(name, "a variant code of this course", repr(code[:40]), hint)


class NoKeyError(InputError):
    """A student has no variant of an assignment."""

    def __init__(self, assignment: str, pid: str) -> None:
        super().__init__(pid, f"a variant of {assignment}", "none", "Hand it out first: vml handout.")


class RosterError(InputError):
    """A roster is no table of names and e-mail addresses."""


class CollectError(InputError):
    """A download, or a file in it, is not what was meant."""


class NoDownloadError(CollectError):
    """What should be a platform's download is something else."""

    def __init__(self, source: str, got: str, hint: str) -> None:
        super().__init__(source, "a zip as the platform gives it, or a folder", got, hint)


class OtherAssignmentError(CollectError):
    """A workbook in a download belongs to another assignment, `assignment`, than the one that is collected."""

    def __init__(self, name: str, wanted: str, assignment: str) -> None:
        self.assignment = assignment
        hint = f"Collect it for that one: vml collect {assignment}."
        super().__init__(name, f"a workbook of {wanted}", f"one of {assignment}", hint)


class NothingGradedError(InputError):
    """There is no grade to release or to export."""

    def __init__(self, assignment: str) -> None:
        super().__init__(assignment, "grades", "none", "Grade something first: vml grade.")


class NothingReleasedError(InputError):
    """Nothing was released that a platform could be told."""

    def __init__(self, assignment: str) -> None:
        super().__init__(assignment, "released grades", "none", f"Release them first: vml release {assignment}.")
