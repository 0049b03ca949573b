"""What the name of a downloaded file says."""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass


@dataclass(frozen=True)
class Named:
    """A file of one student in a platform's download.

    Attributes
    ----------
    platform : str
    kind, value : str
        The identity that the platform gives: `canvas_id`, `moodle_participant`, `login` or `gradescope`.
    original : str
        The student's own name for the file.
    is_late : bool or None
        Whether the platform calls it late; None when it does not say.
    received : datetime or None
        When it was handed in, in the platform's local time; None when the name does not say.
    reference : str
        What the platform knows this very file by, no name in it; "" when there is nothing.
    """

    platform: str
    kind: str
    value: str
    original: str
    is_late: bool | None = None
    received: dt.datetime | None = None
    reference: str = ""
