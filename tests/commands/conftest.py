"""What every test of a command needs: to run it in this process and hear what it says."""

import pytest

from vml_course.cli import run


@pytest.fixture
def vml(capsys):
    """Run `vml` with these words; return exit code, standard output, standard error."""

    def call(*arguments):
        code = run([str(argument) for argument in arguments])
        said = capsys.readouterr()
        return code, said.out, said.err

    return call
