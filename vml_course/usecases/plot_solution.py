"""Write the plot of a solved impact, as a student hands it in."""

from __future__ import annotations

from pathlib import Path

from vml_course.chart.raster import to_png
from vml_course.chart.shapes import Drawing
from vml_course.chart.svg import to_svg
from vml_course.errors import FileFormatError, InputError
from vml_course.io.files import check_folder, replacing
from vml_course.kinetics.plot import impact_plot
from vml_course.usecases.solve_table import Solved

ENDINGS = (".svg", ".png")


def check_plot(path: Path) -> None:
    """Check before any work that a plot can be written there.

    Raises
    ------
    FileFormatError, FileMissingError
    """
    check_drawing(path, "--plot")


def check_drawing(path: Path, option: str) -> None:
    """Check before any work that what `option` names can be drawn and written.

    Raises
    ------
    FileFormatError, FileMissingError
    """
    if path.suffix.lower() not in ENDINGS:
        raise FileFormatError(option, f"a name that ends in {' or '.join(ENDINGS)}", path.name)
    check_folder(path)


def plot_solution(solved: Solved, path: Path) -> None:
    """Write positions and angle with the fits, the impact, and residuals to an SVG or PNG file.

    Raises
    ------
    InputError
        When there is no joint solution to draw.
    FileFormatError, FileMissingError
    """
    check_plot(path)
    if solved.joint is None:
        raise InputError("--plot", "a joint solution to draw", "lines alone", "Use --method both or joint.")
    write_drawing(impact_plot(solved.motion, solved.joint, solved.options.striker, solved.options.struck), path)


def write_drawing(drawing: Drawing, path: Path) -> None:
    """Write a drawing as SVG or PNG, by the ending of its name."""
    content = to_png(drawing) if path.suffix.lower() == ".png" else to_svg(drawing).encode()
    with replacing(path) as temporary:
        temporary.write_bytes(content)
