"""The one thing that can go wrong in reading: this file cannot be graded as it is."""

from __future__ import annotations

from vml_course.errors import InputError, VmlError

SAVE_AS = "In Excel or LibreOffice choose File, Save As, Excel Workbook (.xlsx), and hand in that file."
AGAIN = "Open it on your computer, save it again and hand in the new copy."
UNPACKED = "Hand in the workbook itself, not packed."
OUR_TEMPLATE = "Type your answers into the workbook that came with your video and hand in that file."


class UnreadableError(InputError):
    """A file is no workbook that can be graded; the message says what it is and what to do."""

    def __init__(self, name: str, got: str, hint: str = AGAIN, expected: str = "an Excel workbook (.xlsx)") -> None:
        super().__init__(name, expected, got, hint)


class RefusedError(Exception):
    """A limit was passed inside a file; `read_workbook` turns it into an UnreadableError with the file's name."""

    def __init__(self, got: str, hint: str = AGAIN) -> None:
        self.got, self.hint = got, hint
        super().__init__(got)


class ReaderFailedError(VmlError):
    """The process that reads workbooks cannot be started: no file is to blame."""

    def __init__(self) -> None:
        super().__init__("reader: the process that reads workbooks cannot be started. Is memory short? Try again.")
