"""The instructor's page: every formula is worked with the variant's numbers, and gives the true value."""

from __future__ import annotations

import math
import re
from html import unescape

import pytest

from assignments.key import answer_key
from assignments.load import assignment_ids, load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.solution import printed, render_solution
from assignments.variants import draw_variant
from vml_course.model.camera import Camera
from vml_course.model.solution import Estimate, ImpactSolution
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate

ROUNDED = 4e-3  # relative: four digits in every number


def key_of(assignment: Assignment, measured: ImpactSolution | None = None) -> AnswerKey:
    variant = draw_variant(assignment, bytes(range(32)), "s2")
    truth = simulate(scene_class(assignment.scene)(**variant.parameters), Camera(**variant.camera), variant.seed)
    return answer_key(assignment, variant, truth, measured, "0" * 64)


def worked(line: str, phi: float) -> float:
    """Work out what is printed, as a reader would with a calculator."""
    text = line.replace("−", "-").replace("·", "*").replace("½", "0.5").replace("²", "**2").replace("arctan", "atan")
    text = re.sub(r"\|(.*?)\|", r"abs(\1)", text).replace("cos φ", "*cos(phi)").replace("sin φ", "*sin(phi)")
    text = re.sub(r"cos ([0-9.]+)", r"cos(\1)", text)
    names = {"cos": math.cos, "sin": math.sin, "atan": math.atan, "abs": abs, "phi": phi, "__builtins__": {}}
    return float(eval(text, names))  # noqa: S307 - our own page


@pytest.mark.parametrize("name", assignment_ids())
def test_the_printed_numbers_give_the_printed_result(name: str) -> None:
    assignment = load_assignment(name)
    key = key_of(assignment)
    html = unescape(render_solution(assignment, key))
    solution = html.split("formula by formula")[1].split("5. Rubric")[0]
    found = re.findall(r"= ([^<>]+)<br>\s*(?:\xa0|&nbsp;|\s)*= <strong>(\S+)", solution)
    conclusions = [question for question in assignment.questions if question.group == "conclusion"]
    assert len(found) == len(conclusions)
    for question, (line, result) in zip(conclusions, found, strict=True):
        value = worked(line, key.values.get("phi", 0.0))
        assert value == pytest.approx(key.values[question.id], rel=ROUNDED)
        assert result == printed(key.values[question.id])


@pytest.mark.parametrize("name", assignment_ids())
def test_it_has_goals_rubric_and_the_value_of_each_common_mistake(name: str) -> None:
    assignment = load_assignment(name)
    html = unescape(render_solution(assignment, key_of(assignment)))
    assert all(goal in html for goal in assignment.goals)
    assert "Do not hand it out" in html
    rubric = html.split("5. Rubric")[1]
    assert all(question.label in rubric for question in assignment.questions)
    mistakes = html.split("6. Common mistakes")[1]
    assert all(f"<td>{code}</td>" in mistakes for code in assignment.separation.mistakes)
    assert "–</td>" not in mistakes.replace("<td>–", "")  # every one has a value
    assert "{" not in html.split("</style>")[1]


def test_the_reference_stands_beside_the_truth_in_the_question_s_sign() -> None:
    rod = load_assignment("struck-rod")
    measured = ImpactSolution("free-rod", "joint", {"v_b1": Estimate(-3.0, 0.001), "e": Estimate(0.7, 0.002)}, 0.1, 24)
    html = render_solution(rod, key_of(rod, measured))
    assert "3 ± 0.001" in html
    assert "−3 ± 0.001" not in html
    assert "reference: 0.7 ± 0.002" in html
