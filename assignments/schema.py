"""What `assignment.toml` may hold: shape and types; whether its names exist is `resolve`'s question."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from assignments.model import Assignment, Derived, Draw, Given, Question, Separation, Stick

# Question and given ids name cells of the workbook: `ans_<id>`, `unit_<id>`.
CellName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,30}$")]
Text = Annotated[str, StringConstraints(min_length=1, max_length=300, strip_whitespace=True)]
FileName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_][A-Za-z0-9_.-]*$")]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Group = Literal["calibration", "measurement", "conclusion"]


class _Table(BaseModel):
    """A table of the file; a key that is not declared is a mistake, not a remark."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


class DrawTable(_Table):
    """`[draw.<parameter>]`."""

    low: Finite
    high: Finite
    step: Positive
    avoid: tuple[tuple[Finite, Finite], ...] = ()


class DeriveTable(_Table):
    """`[derive.<parameter>]`."""

    formula: Text
    inputs: dict[str, str]


class SeparateTable(_Table):
    """`[separate]`."""

    mistakes: tuple[str, ...]
    apart: Positive


class StickTable(_Table):
    """`[stick]`."""

    tail: Text
    head: Text
    given: CellName


class GivenTable(_Table):
    """`[[given]]`."""

    id: CellName
    label: Text
    symbol: Text
    unit: str
    parameter: str = ""
    factor: Finite = 1.0
    value: Finite | None = None


class QuestionTable(_Table):
    """`[[question]]`."""

    id: CellName
    label: Text
    symbol: Text
    dimension: Text
    unit: str
    points: Annotated[float, Field(ge=0, allow_inf_nan=False)]
    check: Text
    tolerance: Positive
    group: Group
    needs: tuple[str, ...] = ()
    floor: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 0.0
    hint: str = ""


class AssignmentFile(_Table):
    """The whole file."""

    format: Literal[1]
    version: Text
    title: Text
    summary: Text
    scene: Text
    model: Text
    points: tuple[Text, ...] = Field(min_length=1)
    handout: FileName
    goals: tuple[Text, ...] = ()
    stick: StickTable
    camera: dict[str, Finite] = {}
    recording: dict[str, Finite | str] = {}
    solve: dict[str, Finite | str] = {}
    fixed: dict[str, Finite] = {}
    words: dict[str, Text] = {}
    draw: dict[str, DrawTable]
    derive: dict[str, DeriveTable] = {}
    limits: dict[str, tuple[Finite, Finite]] = {}
    separate: SeparateTable | None = None
    given: tuple[GivenTable, ...]
    question: tuple[QuestionTable, ...] = Field(min_length=1)

    def record(self, folder: Path) -> Assignment:
        """Return what the file says as this package's own frozen record."""
        return Assignment(
            id=folder.name,
            draws=tuple(Draw(parameter=name, **_plain(table)) for name, table in self.draw.items()),
            derived=tuple(Derived(parameter=name, **_plain(table)) for name, table in self.derive.items()),
            givens=tuple(Given(**_plain(table)) for table in self.given),
            questions=tuple(Question(**_plain(table)) for table in self.question),
            separation=Separation(**_plain(self.separate)) if self.separate else Separation(),
            stick=Stick(**_plain(self.stick)),
            handout_template=self.handout,
            folder=str(folder),
            **{name: getattr(self, name) for name in _SAME_NAME},
        )


_SAME_NAME = (
    "title",
    "summary",
    "goals",
    "scene",
    "model",
    "points",
    "version",
    "camera",
    "recording",
    "solve",
    "fixed",
    "words",
    "limits",
)


def _plain(table: _Table) -> dict[str, Any]:
    return {name: getattr(table, name) for name in type(table).model_fields}
