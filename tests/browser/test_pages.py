"""What students and instructors read, in a real browser: accessible, printable, complete without script and network."""

from __future__ import annotations

import itertools
import json
import re

import pytest

NAMES = ("right", "every", "empty", "open", "class of 0", "class of 1", "class of 40")
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]
OPTIONS = {"runOnly": {"type": "tag", "values": TAGS}, "resultTypes": ["violations"]}
PAPERS = {"A4": 210.0, "Letter": 215.9}  # width in mm
MARGIN_MM, PX_PER_MM = 16.0, 96 / 25.4

Axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="needs axe-playwright-python").Axe


@pytest.mark.parametrize(("name", "scheme", "width"), list(itertools.product(NAMES, ("light", "dark"), (1100, 320))))
def test_axe_finds_nothing(desk, pages, name, scheme, width):
    with desk.opened(pages[name], scheme=scheme, width=width) as page:
        page.evaluate("document.querySelectorAll('details').forEach(part => part.open = true)")
        found = Axe().run(page, options=OPTIONS).response
    assert len(found["passes"]) > 10, "axe looked at too little"
    said = [(v["id"], v["help"], [node["html"][:160] for node in v["nodes"][:3]]) for v in found["violations"]]
    assert not said, json.dumps(said, indent=1)


def test_axe_would_find_something(desk, pages, tmp_path):
    """A page with planted faults fails, so the test above can fail."""
    broken = tmp_path / "broken.html"
    text = pages["every"].read_text(encoding="utf-8")
    broken.write_text(text.replace('lang="en"', "").replace("--quiet: #56656f", "--quiet: #c6d5df"), encoding="utf-8")
    with desk.opened(broken) as page:
        found = Axe().run(page, options=OPTIONS).response
    assert {"html-has-lang", "color-contrast"} <= {violation["id"] for violation in found["violations"]}


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("width", [1100, 320])
def test_only_tables_and_plots_move_sideways(desk, pages, name, width):
    with desk.opened(pages[name], width=width) as page:
        assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("paper", PAPERS)
def test_nothing_is_cut_off_on_paper(desk, pages, name, paper):
    """Laid out as wide as the paper allows, no element reaches beyond it, and the PDF has that paper's size."""
    width = int((PAPERS[paper] - 2 * MARGIN_MM) * PX_PER_MM)
    with desk.opened(pages[name], width=width) as page:
        page.emulate_media(media="print")
        beyond = page.evaluate(
            """width => [...document.querySelectorAll('main *')].filter(e => {
                const box = e.getBoundingClientRect();
                return box.width > 1 && (box.right > width + 1 || box.left < -1) && !e.closest('.hidden');
            }).map(e => e.outerHTML.slice(0, 120))""",
            width,
        )
        pdf = page.pdf(format=paper, prefer_css_page_size=False)
    assert beyond == []
    width_pt = float(re.search(rb"/MediaBox \[0 0 ([0-9.]+)", pdf)[1])
    assert width_pt == pytest.approx(PAPERS[paper] / 25.4 * 72, abs=1)


def test_the_page_is_complete_without_script(desk, pages):
    with desk.opened(pages["every"], scripts=False) as page:
        assert page.get_by_role("heading", name="What to do next").is_visible()
        assert page.get_by_role("img", name="The impact").is_visible()
        page.get_by_text("Numbers of this plot").first.click()
        assert page.get_by_role("columnheader", name="apart (px)").is_visible()


def test_a_keyboard_reaches_tables_that_are_wider_than_a_phone(desk, pages):
    with desk.opened(pages["every"], width=320) as page:
        table = page.get_by_role("group", name="Measurement: your answers")
        table.focus()
        page.keyboard.press("ArrowRight")
        page.wait_for_function("document.activeElement.scrollLeft > 0")
