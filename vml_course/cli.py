"""The `vml` command: finds the command groups of the installed packages and says errors in one line."""

from __future__ import annotations

import io
import os
import sys
from importlib.metadata import entry_points

import typer

from vml_course.errors import VmlError

DEBUG_VARIABLE = "VML_DEBUG"
"""Set to anything, a failure of ours ends in its traceback instead of one line."""


def build_app() -> typer.Typer:
    """Collect the commands of every package that offers some."""
    app = typer.Typer(
        name="vml",
        add_completion=True,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_group)
    for point in sorted(entry_points(group="vml.commands"), key=lambda point: point.name):
        point.load()(app)
    return app


def _group() -> None:
    """Virtual Mechanics Laboratory: simulate, track, solve and grade an impact."""


def main(arguments: list[str] | None = None) -> None:
    """Run `vml` and end the process: 0 done, 1 some items need attention, 2 wrong input, 3 our failure, 130 stopped."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a Windows pipe may know no sigma; better a ? than a traceback
            stream.reconfigure(errors="replace")
    try:
        code = run(arguments)
    except Exception as error:
        if os.environ.get(DEBUG_VARIABLE):
            raise
        what = f"{type(error).__name__}: {error}"
        _say(f"vml: failed, and it is not your fault ({what}). To see where, run it again with {DEBUG_VARIABLE}=1 set.")
        code = 3
    sys.exit(code)


def run(arguments: list[str] | None = None) -> int:
    """Run `vml` and return its exit code; every expected mistake is one line on standard error."""
    arguments = sys.argv[1:] if arguments is None else arguments
    command = typer.main.get_command(build_app())
    try:
        code = command.main(args=arguments or ["--help"], prog_name="vml", standalone_mode=False)
    except VmlError as error:
        return _say(str(error))
    except typer.TyperException as error:
        context = getattr(error, "ctx", None)
        where = context.command_path if context else "vml"
        return _say(f"{where}: {error.format_message()} (try '{where} --help')")
    except OSError as error:  # a full disk, a folder where a file belongs: the system says it better than a traceback
        return _say(f"{error.filename or 'vml'}: expected a place to read or write, got: {error.strerror or error}.")
    except (typer.Abort, KeyboardInterrupt):
        _say("vml: stopped.")
        return 130
    return code if isinstance(code, int) else 0


def _say(line: str) -> int:
    sys.stderr.write(" ".join(line.split()) + "\n")
    return 2
