"""Change the code that decides about people one bit at a time, and see that a test notices (`make mutants`).

    python tools/mutants.py                 every room of tests/mutants/
    python tools/mutants.py judging         one room
    python tools/mutants.py judging 'grader.own.*'    some of its mutants, by mutmut's names

A room is a file of `tests/mutants/`: its `sources`, the fast `tests` that hold them, and its `survivors`, each with
the reason `why` nothing can notice it. The run fails where a mutant survives that nobody has argued, and where an
argument no longer belongs to a survivor. Words of a sentence are counted apart: tests hold what a sentence names, not
its letters.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ROOT / "tests" / "mutants"
WORK = ROOT / "build" / "mutants"
COPIED = ("vml_course", "assignments", "grader", "tests", "tools", "README.md", "pyproject.toml")
NOTICED = {"killed", "timeout", "caught by type check", "segfault", "skipped"}
LITERAL = re.compile(r"""("(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*')""")


@dataclass(frozen=True)
class Mutant:
    """One change of one function: lines without their indentation, `-` before the old and `+` before the new."""

    name: str
    function: str
    change: str

    @property
    def is_wording(self) -> bool:
        """Say whether only words of a sentence (a literal with a space in it) are changed."""
        old, new = ([line[1:] for line in self.change.splitlines() if line.startswith(sign)] for sign in ("-", "+"))
        was, now = ("\n".join(lines) for lines in (old, new))
        if LITERAL.sub('""', was) != LITERAL.sub('""', now):
            return False
        pairs = zip(LITERAL.findall(was), LITERAL.findall(now), strict=True)
        return all(" " in a.strip("\"' ") for a, b in pairs if a != b)


def main() -> int:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("room", nargs="?", help="file of tests/mutants/ without .toml; all of them when left out")
    asked.add_argument("names", nargs="*", help="only these mutants (mutmut's names, with *)")
    asked.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    options = asked.parse_args()
    known = sorted(path.stem for path in ROOMS.glob("*.toml"))
    if options.room and options.room not in known:
        asked.error(f"room: expected one of {', '.join(known)}; got {options.room!r}")
    rooms = [options.room] if options.room else known
    return max([run_room(room, options.names, options.processes) for room in rooms])


def run_room(room: str, names: list[str], processes: int) -> int:
    about = tomllib.loads((ROOMS / f"{room}.toml").read_text("utf-8"))
    folder = prepare(room, about, whole=not names)
    with (folder / "mutmut.log").open("w", encoding="utf-8") as log:
        done = mutmut(folder, "run", "--max-children", str(processes), *names, log=log)
    if done.returncode:
        print(f"{room}: mutmut stopped with {done.returncode}; see {folder.relative_to(ROOT) / 'mutmut.log'}")
        return 1
    return report(room, about, results(folder), folder, whole=not names)


def prepare(room: str, about: dict, *, whole: bool) -> Path:
    """Lay a copy of the tree down; only a run of some mutants keeps what others ended as."""
    folder = WORK / room
    if whole:
        shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mutants" / "mutmut-stats.json").unlink(missing_ok=True)  # which test runs what: tests have changed
    for name in COPIED:
        source, target = ROOT / name, folder / name
        if source.is_dir():
            shutil.rmtree(target, ignore_errors=True)
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(source, target)
    settings = {
        "source_paths": about["sources"],
        "also_copy": [name for name in COPIED if name != "tests"],
        "pytest_add_cli_args_test_selection": about["tests"],
        "pytest_add_cli_args": ["-p", "no:cacheprovider", "-p", "no:xdist"],
    }
    lines = [f"{key} = {value}" for key, value in settings.items()]
    with (folder / "pyproject.toml").open("a", encoding="utf-8") as out:
        out.write("\n[tool.mutmut]\n" + "\n".join(lines).replace("'", '"') + "\n")
    return folder


def mutmut(folder: Path, *words: str, log: TextIO | int = subprocess.PIPE) -> "subprocess.CompletedProcess[str]":
    """Run mutmut in the copy, where nothing but the copy can be found."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | {"CI": "1"}
    command = [str(Path(sys.executable).with_name("mutmut")), *words]
    return subprocess.run(
        command, cwd=folder, env=environment, stdout=log, stderr=subprocess.STDOUT, text=True, check=False
    )


def results(folder: Path) -> dict[str, str]:
    lines = mutmut(folder, "results", "--all", "true").stdout.splitlines()
    pairs = [line.strip().rsplit(": ", 1) for line in lines if "__mutmut_" in line]
    return dict(pairs)


def report(room: str, about: dict, found: dict[str, str], folder: Path, *, whole: bool) -> int:
    statuses = Counter(found.values())
    alive = sorted(name for name, status in found.items() if status not in NOTICED and status != "not checked")
    with ThreadPoolExecutor() as threads:
        mutants = list(threads.map(lambda name: shown(folder, name), alive))
    wording = [mutant for mutant in mutants if mutant.is_wording]
    argued = {(one["function"], one["change"].strip()) for one in about.get("survivors", [])}
    left = [mutant for mutant in mutants if not mutant.is_wording and (mutant.function, mutant.change) not in argued]
    stale = argued - {(mutant.function, mutant.change) for mutant in mutants} if whole else set()
    for mutant in left:
        print(f'\n# {mutant.name}: {found[mutant.name]}\n[[survivors]]\nfunction = "{mutant.function}"')
        print(f"change = '''\n{mutant.change}\n'''\nwhy = \"\"")
    for function, change in sorted(stale):
        print(f"\n# argued, but no longer a survivor: {function}\n{change}")
    tested = sum(number for status, number in statuses.items() if status != "not checked")
    print(
        f"\n{room}: {tested} mutants, {tested - len(mutants)} noticed, {len(wording)} change words of a sentence, "
        f"{len(mutants) - len(wording) - len(left)} argued, {len(left)} not argued, {len(stale)} arguments out of date",
    )
    return 1 if left or stale or not tested else 0


def shown(folder: Path, name: str) -> Mutant:
    lines = mutmut(folder, "show", name).stdout.splitlines()
    changed = [line for line in lines if line[:1] in "+-" and not line.startswith(("+++", "---"))]
    change = "\n".join(f"{line[0]}{line[1:].strip()}" for line in changed if line)
    module, _, mangled = name.rpartition(".")
    function = re.sub(r"__mutmut_\d+$", "", mangled).removeprefix("x_").removeprefix("xǁ").replace("ǁ", ".")
    return Mutant(name, f"{module}.{function}", change)


if __name__ == "__main__":
    sys.exit(main())
