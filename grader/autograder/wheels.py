"""The packages that grading needs in the container, as wheels: nothing is fetched when the image is built.

Not all that the project needs: no pictures and no video (OpenCV, numba, av), no tables (pandas), no database
(sqlalchemy, alembic), no web, no command line. Pymunk comes along because a scene's file says what is simulated.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from vml_course.errors import FileMissingError, InputError

NEEDED = (
    "annotated-types",
    "cffi",
    "et_xmlfile",
    "MarkupSafe",
    "numpy",
    "openpyxl",
    "pycparser",
    "pydantic",
    "pydantic_core",
    "pymunk",
    "scipy",
    "typing-inspection",
    "typing_extensions",
)
_PLATFORMS = ("manylinux2014_x86_64", *(f"manylinux_2_{minor}_x86_64" for minor in range(18, 36)))  # Ubuntu 22.04: 2.35


def python_version() -> str:
    """Return the Python that the container has to have: that of the installed packages.

    >>> python_version().startswith("3.")
    True
    """
    return f"{sys.version_info.major}.{sys.version_info.minor}"


def download_wheels(folder: Path) -> None:
    """Fetch the wheels of the installed versions, for Linux whatever this machine is.

    Raises
    ------
    InputError
        When they cannot be fetched.
    """
    platforms = [word for platform in _PLATFORMS for word in ("--platform", platform)]
    command = [
        sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary=:all:",
        "--disable-pip-version-check", "--implementation", "cp", "--python-version", python_version(), *platforms,
        "--dest", str(folder), *(f"{name}=={version(name)}" for name in NEEDED),
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - pip, our own list
    if done.returncode != 0:
        said = (done.stderr.strip() or "nothing said").splitlines()[-1]
        hint = "Is there a network? Or give a folder of prepared wheels: --wheels DIR."
        raise InputError("wheels", "pip to fetch them", said[:200], hint)


def wheels_in(folder: Path) -> list[Path]:
    """Return the wheels of a folder that are needed, one of each package.

    Raises
    ------
    FileMissingError
        When one is not there.
    """
    found = {_plain(path.name.partition("-")[0]): path for path in sorted(folder.glob("*.whl"))}
    lacking = [name for name in NEEDED if _plain(name) not in found]
    if lacking:
        raise FileMissingError(str(folder), "a wheel of every package that is needed", f"none of {', '.join(lacking)}")
    return [found[_plain(name)] for name in NEEDED]


def distributions(modules: Iterable[str]) -> set[str]:
    """Return names of packages as they are compared.

    >>> distributions(["typing_extensions", "MarkupSafe"]) == {"typing-extensions", "markupsafe"}
    True
    """
    return set(map(_plain, modules))


def _plain(name: str) -> str:
    return name.casefold().replace("_", "-").replace(".", "-")
