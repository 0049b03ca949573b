"""What the documents promise exists."""

import re
import shlex
from pathlib import Path

import pytest

from vml_course.cli import run

ROOT = Path(__file__).parent.parent
DOCUMENTS = ("README.md", "CONTRIBUTING.md", *sorted(str(p.relative_to(ROOT)) for p in ROOT.glob("*/README.md")))
LINKED = re.compile(r"\]\((?!https?:)([^)#]+)\)")
GROUPS = ("course", "gradebook", "assignment", "roster")


def commands():
    lines = (ROOT / "README.md").read_text("utf-8").splitlines()
    return [line for line in lines if line.startswith("vml ")]


@pytest.mark.parametrize("line", commands())
def test_every_command_of_the_readme_exists_with_its_options(line, capsys):
    words = shlex.split(line)[1:]
    name = words[:2] if words[0] in GROUPS else words[:1]
    assert run([*name, "--help"]) == 0
    told = capsys.readouterr().out
    assert [word for word in words if word.startswith("-") and word not in told] == []


@pytest.mark.parametrize("document", DOCUMENTS)
def test_every_link_leads_to_a_file(document):
    path = ROOT / document
    targets = LINKED.findall(path.read_text("utf-8"))
    assert [target for target in targets if not (path.parent / target).exists()] == []


def test_every_make_target_of_the_documents_exists():
    makefile = (ROOT / "Makefile").read_text("utf-8")
    named = set(re.findall(r"`make ([a-z]+)`", "".join((ROOT / d).read_text("utf-8") for d in DOCUMENTS)))
    assert [target for target in named if not re.search(rf"^{target}:", makefile, re.MULTILINE)] == []
