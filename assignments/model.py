"""The words of assignments: what is asked, one student's variant of it, and its answer key."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vml_course.model.arrays import Axes, FloatArray, IntArray, set_frozen


@dataclass(frozen=True)
class Draw:
    """How one number is drawn: a value from `low` to `high` on a grid of `step`, SI units.

    `parameter` is a parameter of the scene, or a name of its own that a `Derived` parameter is computed
    from. `avoid` holds closed intervals that no value is taken from.
    """

    parameter: str
    low: float
    high: float
    step: float
    avoid: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True)
class Derived:
    """A scene parameter that is computed from drawn numbers by a named formula of `assignments.derive`.

    `inputs` says which number each argument of the formula takes.
    """

    parameter: str
    formula: str
    inputs: Mapping[str, str]


@dataclass(frozen=True)
class Separation:
    """Which wrong answers must lie apart, so that a wrong number names its mistake.

    Attributes
    ----------
    mistakes : tuple of str
        Codes of the textbook's mistakes.
    apart : float
        Smallest relative distance between any two of their values.
    """

    mistakes: tuple[str, ...] = ()
    apart: float = 0.0


@dataclass(frozen=True)
class Stick:
    """The known length to calibrate with: two marks of the scene and the given number that is their distance."""

    tail: str
    head: str
    given: str


@dataclass(frozen=True)
class Given:
    """A number that the student is told: label, symbol, unit; `parameter` names where its value comes from.

    `parameter` is a parameter of the scene or `camera.<field>`; `factor` converts it, such as 2 from a
    radius to a diameter. A number that is the same for everybody has `value` and no parameter.
    """

    id: str
    label: str
    symbol: str
    unit: str
    parameter: str
    factor: float = 1.0
    value: float | None = None


@dataclass(frozen=True)
class Question:
    """A number that the student measures or computes, in one named cell of the workbook.

    Attributes
    ----------
    id : str
        Name of the workbook cell, such as `v_b2`.
    label, symbol : str
        What the student reads.
    dimension : str
        `length`, `velocity`, `angular_velocity`, `inertia`, `number`, `rate`, `scale` ...; decides the accepted units.
    unit : str
        The SI unit in which truth and tolerance are kept.
    points : float
    check : str
        Name of the check that judges it.
    tolerance : float
        Relative tolerance of full credit.
    group : str
        `calibration`, `measurement` or `conclusion`.
    needs : tuple of str
        Questions from whose answers this one can be recomputed.
    floor : float
        Absolute tolerance in `unit`, for a truth at or near zero: the larger of it and the relative one holds.
    hint : str
        One short sentence beside the cell.
    """

    id: str
    label: str
    symbol: str
    dimension: str
    unit: str
    points: float
    check: str
    tolerance: float
    group: str
    needs: tuple[str, ...] = ()
    floor: float = 0.0
    hint: str = ""


@dataclass(frozen=True)
class Assignment:
    """One folder of the catalogue, read and checked.

    Attributes
    ----------
    fixed : mapping of str to float
        Scene parameters that are the same for every student.
    words : mapping of str to str
        The scene's settings that are words, such as ``knee = "plain"``, where they are not the usual ones.
    camera, recording : mapping
        What differs from the scene's own camera and from the default recording.
    draws, derived, limits
        How the other parameters come about; a draw outside `limits` (low, high) is drawn again.
    solve : mapping of str to str or float
        Options of the impact model that the assignment declares, such as `drive = "none"`.
    points : tuple of str
        The points to track.
    handout_template : str
        File name in `folder`.
    goals : tuple of str
        What a student can do afterwards, one sentence each.
    version : str
        Of the assignment's text and numbers; it goes into every workbook.
    """

    id: str
    title: str
    summary: str
    scene: str
    model: str
    fixed: Mapping[str, float]
    camera: Mapping[str, float]
    recording: Mapping[str, float | str]
    draws: tuple[Draw, ...]
    givens: tuple[Given, ...]
    questions: tuple[Question, ...]
    points: tuple[str, ...]
    handout_template: str
    folder: str
    version: str = "1"
    derived: tuple[Derived, ...] = ()
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    separation: Separation = Separation()
    stick: Stick = Stick("bar_left", "bar_right", "bar")
    solve: Mapping[str, str | float] = field(default_factory=dict)
    words: Mapping[str, str] = field(default_factory=dict)
    goals: tuple[str, ...] = ()

    @property
    def total_points(self) -> float:
        """Points of all questions together."""
        return sum(question.points for question in self.questions)

    def question_groups(self) -> dict[str, tuple[Question, ...]]:
        """Return the questions by group, in the order in which they are asked."""
        groups = dict.fromkeys(question.group for question in self.questions)
        return {group: tuple(q for q in self.questions if q.group == group) for group in groups}

    def question(self, question_id: str) -> Question:
        """Return a question by its id (KeyError when there is none: ids were checked on loading)."""
        return {question.id: question for question in self.questions}[question_id]


NOBODY = "practice"
"""The pseudonym that a practice variant is made for: it belongs to nobody."""


@dataclass(frozen=True)
class Variant:
    """One student's own version: frozen numbers, nothing to recompute.

    Attributes
    ----------
    assignment_id, student : str
        The student's pseudonym; names live in the roster table only.
    code : str
        Unguessable code that the workbook carries.
    parameters : mapping of str to float
        The scene's parameters, SI units.
    camera, recording : mapping
    seed : int
        For texture and noise.
    redraws : int
        How many draws were rejected before this one.
    generator_version : str
    signature : str
        The course's signature of `code`: shows that a workbook was handed out by this course.
    scene : str
        Name of the scene that `parameters` belong to: a catalogue may change, what was handed out does not.
    words : mapping of str to str
        The scene's settings that are words, where they are not the usual ones.
    """

    assignment_id: str
    student: str
    code: str
    parameters: Mapping[str, float]
    camera: Mapping[str, float]
    recording: Mapping[str, float | str]
    seed: int
    redraws: int
    generator_version: str
    signature: str = ""
    scene: str = ""
    words: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class AnswerKey:
    """What is true of one variant; kept in the instructor's gradebook, never handed out.

    Attributes
    ----------
    assignment_id, student, code : str
    values : mapping of str to float
        True value of each question by id, SI units.
    expected_sd : mapping of str to float
        One standard deviation that the reference tracker and solver reached on the very video handed out.
    measured : mapping of str to float
        What they measured, or what follows from it.
    given : mapping of str to float
        The numbers that the student was told, by symbol (`m`, `L`, `D` ...), SI units.
    truth : mapping of str to float
        Further true numbers that mistakes are computed from: `px_per_m`, `fps`, `R`, `theta_impact_rad` ...
    video_sha256 : str
    versions : mapping of str to str
    points : tuple of str
    frame : int array, shape (n,)
    time_s : float array, shape (n,)
    xy_px : float array, shape (n, p, 2)
        The true trajectory.
    parameters : mapping of str to float
        Of the scene.
    scene : str
        Its name; it says which textbook answers are judged by. Keys of the first version had none: all were kicks.
    """

    assignment_id: str
    student: str
    code: str
    values: Mapping[str, float]
    expected_sd: Mapping[str, float]
    measured: Mapping[str, float]
    given: Mapping[str, float]
    truth: Mapping[str, float]
    video_sha256: str
    versions: Mapping[str, str]
    points: tuple[str, ...]
    frame: IntArray
    time_s: FloatArray
    xy_px: FloatArray
    parameters: Mapping[str, float] = field(default_factory=dict)
    scene: str = "soccer_kick"

    def __post_init__(self) -> None:
        axes = Axes()
        set_frozen(
            self,
            frame=axes.freeze("frame", self.frame, "n", dtype="int64"),
            time_s=axes.freeze("time_s", self.time_s, "n"),
            xy_px=axes.freeze("xy_px", self.xy_px, "n", len(self.points), 2),
        )
