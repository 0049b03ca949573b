import pytest

from vml_course.cli import run


def one_line(text):
    return text.count("\n") == 1 and "Traceback" not in text


COMMANDS = ("demo", "render", "clip", "track", "solve", "course new", "handout", "grade", "gradebook show", "check")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(vml, command):
    code, out, _ = vml(*command.split(), "--help")
    assert code == 0
    assert f"vml {command}" in out.replace("\n", " ")
    assert "xample" in out


def test_vml_alone_shows_its_commands(vml):
    code, out, _ = vml()
    assert code == 0
    assert all(command.split()[0] in out for command in COMMANDS)


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (["nonsense"], "nonsense"),
        (["render"], "SCENE"),
        (["render", "no_such_scene", "-o", "x"], "soccer_kick"),
        (["render", "soccer_kick", "--set", "e=2", "-o", "x"], "restitution"),
        (["render", "soccer_kick", "--set", "mass=2", "-o", "x"], "mass"),
        (["render", "soccer_kick", "--set", "e", "-o", "x"], "NAME=VALUE"),
        (["track", "no_such_file.mp4", "-p", "a=1,2", "-o", "x.csv"], "no_such_file.mp4"),
        (["clip", "no_such_file.mp4", "--start", "0", "--end", "1", "-o", "x.avi"], "no_such_file.mp4"),
        (["solve", "no_such_table.csv", "--model", "fixed-pivot"], "no_such_table.csv"),
        (["handout", "soccer-kick", "--course", "no_such_course"], "no_such_course"),
        (["grade", "no_such_file.xlsx", "--course", "no_such_course"], "no_such_course"),
        (["check", "no_such_file.xlsx"], "no_such_file.xlsx"),
    ],
)
def test_a_mistake_is_one_line_and_exit_code_2(vml, tmp_path, monkeypatch, arguments, names):
    monkeypatch.chdir(tmp_path)
    code, out, err = vml(*arguments)
    assert code == 2
    assert one_line(err), err
    assert names in err
    assert out == ""
    assert list(tmp_path.iterdir()) == []


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    folder = tmp_path_factory.mktemp("clip")
    assert run(["render", "soccer_kick", "-o", str(folder)]) == 0
    return folder / "video.mp4"


@pytest.mark.parametrize("output", ["video.mp4", "folder.csv", "gone/a.csv", "/proc/a.csv"])
def test_an_output_that_cannot_be_or_would_destroy_the_video_is_refused_before_tracking(vml, clip, output):
    (clip.parent / "folder.csv").mkdir(exist_ok=True)
    before = clip.read_bytes()
    option = "--overlay" if output.endswith(".mp4") else "-o"
    code, out, err = vml("track", clip, "-p", "ball=513,480", option, clip.parent / output)
    assert (code, out) == (2, "")
    assert one_line(err), err
    assert clip.read_bytes() == before


@pytest.mark.parametrize("command", [["render", "soccer_kick", "-o"], ["course", "new"]])
def test_a_file_where_a_folder_is_wanted_is_one_line(vml, tmp_path, command):
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    code, _, err = vml(*command, tmp_path / "file")
    assert code == 2
    assert one_line(err), err
    assert (tmp_path / "file").read_text("utf-8") == "mine"


def test_a_mistake_is_one_line_at_the_first_start_too(vml, monkeypatch, tmp_path):
    """The notice that kernels are compiled must not come before a mistake in the request."""
    monkeypatch.setattr("vml_course.usecases.kernels_ready.compile_notice", lambda method: f"compiling for {method}")
    code, _, err = vml("track", tmp_path / "gone.mp4", "-p", "a=1,2", "-o", tmp_path / "x.csv")
    assert code == 2
    assert one_line(err), err
