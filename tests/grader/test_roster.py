"""Class lists as platforms write them, and what becomes of them in the gradebook."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assignments.course import new_course
from grader.errors import RosterError
from grader.gradebook import Gradebook
from grader.roster import Enrolled, decoded, parse_roster, read_roster
from vml_course.cli import run
from vml_course.errors import FileMissingError, InputError, VmlError

CANVAS = """Student,ID,SIS User ID,SIS Login ID,Section,Collision lab (4711)
    Points Possible,,,,,10
"Doe, Jane",90210,S0012345,jdoe@example.org,ME-101-01,8.5
"Ærø, Søren",90211,S0012346,saeroe,ME-101-01,
"Student, Test",90212,,,ME-101-01,
"""
MOODLE_WORKSHEET = """Identifier,"Full name","Email address",Status,Grade,"Maximum Grade","Grade can be changed"
"Participant 48213","Jane Doe",jane@example.org,"No submission",,10.00,Yes
"Participant 48214","O'Neil, Peter",peter@example.org,"No submission",,10.00,Yes
"""
MOODLE_PARTICIPANTS = """Vorname,Nachname,ID-Nummer,E-Mail-Adresse,Gruppen
Jürgen,Müller,0815,j.mueller@example.org,A
Anna,Müller,0816,a.mueller@example.org,B
"""
BLACKBOARD = '"Last Name"\t"First Name"\t"Username"\t"Student ID"\t"Availability"\n"Doe"\t"Jane"\t"jdoe"\t"77"\t"Yes"\n'
GRADESCOPE = "First Name,Last Name,SID,Email,Role\nJane,Doe,77,jane@example.org,Student\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            CANVAS,
            [
                Enrolled(
                    "Doe, Jane",
                    "jdoe@example.org",
                    {"sis_id": "S0012345", "login": "jdoe@example.org", "canvas_id": "90210"},
                ),
                Enrolled("Ærø, Søren", "", {"sis_id": "S0012346", "login": "saeroe", "canvas_id": "90211"}),
            ],
        ),
        (
            MOODLE_WORKSHEET,
            [
                Enrolled("Jane Doe", "jane@example.org", {"moodle_participant": "48213"}),
                Enrolled("O'Neil, Peter", "peter@example.org", {"moodle_participant": "48214"}),
            ],
        ),
        (
            MOODLE_PARTICIPANTS,
            [
                Enrolled("Jürgen Müller", "j.mueller@example.org", {"sis_id": "0815"}),
                Enrolled("Anna Müller", "a.mueller@example.org", {"sis_id": "0816"}),
            ],
        ),
        (BLACKBOARD, [Enrolled("Jane Doe", "", {"sis_id": "77", "login": "jdoe"})]),
        (GRADESCOPE, [Enrolled("Jane Doe", "jane@example.org", {"sis_id": "77"})]),
        ("Naam;Contact\nJan;jan@example.org\n", None),
        ("name,Kontakt\nJan,jan@example.org\n", [Enrolled("Jan", "jan@example.org")]),
    ],
    ids=["canvas", "moodle-worksheet", "moodle-participants", "blackboard", "gradescope", "no-name", "by-content"],
)
def test_the_list_of_every_platform_is_understood(text: str, expected: list[Enrolled] | None) -> None:
    if expected is None:
        with pytest.raises(RosterError, match="expected the columns name,email"):
            parse_roster("list.csv", text)
    else:
        assert list(parse_roster("list.csv", text)) == expected


@pytest.mark.parametrize("order", [(0, 1, 2), (1, 0, 2), (2, 1, 0)])
def test_rows_of_canvas_that_name_nobody_are_left_out_in_any_order(order: tuple[int, ...]) -> None:
    head, possible, *students = CANVAS.splitlines()
    rows = (possible, ",,,,,Manual Posting", ",,,,,(read only)")
    assert parse_roster("c.csv", CANVAS) == parse_roster(
        "c.csv", "\n".join([head, *(rows[k] for k in order), *students])
    )


def test_split_names_of_canvas_are_its_own_too() -> None:
    text = "LastName,FirstName,ID,Section,Lab (1)\n,,,,Manual Posting\nPoints Possible,,,,10\nDoe,Jane,90210,A,\n"
    assert parse_roster("c.csv", text) == (Enrolled("Jane Doe", "", {"canvas_id": "90210"}),)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_every_usual_encoding_is_understood(encoding: str) -> None:
    assert parse_roster("l.csv", decoded(MOODLE_PARTICIPANTS.encode(encoding)))[0].name == "Jürgen Müller"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("name,email\n" + "x" * 300 + ",a@b.c\n", "a line of at most 200 characters"),
        ('name,email\n"two\nlines",a@b.c\n', "a line of at most 200 characters"),
        ("name,email\nAnn,a@b.c\nBen,A@B.C\n", "expected each student once, got 'A@B.C' twice"),
        ("name,sid\nAnn,7\nBen,7\n", "expected each student once, got '7' twice"),
        ("name\nAnn\n ann \n", "expected each student once"),
        ("name,email\n,a@b.c\n", "expected a name, got only 'a@b.c'"),
        ("name,email\nA\0nn,a@b.c\n", "got a file that is no text. Export the list"),
        ('name,email\n"Ann' + "x" * 200_000, "got something else in line 2. Export the list"),
    ],
)
def test_a_mistake_in_the_list_is_one_line(text: str, words: str) -> None:
    with pytest.raises(RosterError) as caught:
        parse_roster("list.csv", text)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("data", "got"),
    [
        (b"PK\x03\x04\n\r\x00 x", "a zip archive"),
        (b"PK\x03\x04\n\r\x00 [Content_Types].xml", "a workbook or another document"),
        (b"<html><table>", "a web page"),
    ],
)
def test_what_is_no_class_list_is_called_by_what_it_is(tmp_path: Path, data: bytes, got: str) -> None:
    (tmp_path / "list.csv").write_bytes(data)
    with pytest.raises(
        RosterError, match=f"^list.csv: expected a class list, .*, got {got}. Export the list .* as CSV"
    ):
        read_roster(tmp_path / "list.csv")


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_may_end_as_on_any_computer(end: str) -> None:
    assert len(parse_roster("l.csv", end.join(["name;email", "Ann;a@x.org", "Ben;b@x.org", ""]))) == 2


def test_two_people_of_one_name_are_two_when_anything_else_differs() -> None:
    assert len(parse_roster("l.csv", "name,email\nMüller,a@x.org\nMüller,b@x.org\n")) == 2


@given(st.text(max_size=400))
@settings(max_examples=300)
def test_any_text_is_a_class_list_or_one_polite_line(text: str) -> None:
    said, people = "", ()
    try:
        people = parse_roster("l.csv", text)
    except VmlError as error:
        said = str(error)
    assert "\n" not in said
    assert bool(people) != bool(said)
    assert all(person.name for person in people)


names = st.text(st.characters(categories=["L"], include_characters=" ,'"), min_size=1, max_size=60).filter(str.strip)


@given(st.lists(names, min_size=1, max_size=5))
def test_any_name_comes_back_from_a_quoted_list(people: list[str]) -> None:
    rows = "".join(f'"{name}",p{n}@example.org\n' for n, name in enumerate(people))
    found = parse_roster("l.csv", "name,email\n" + rows)
    assert [one.name for one in found] == [" ".join(name.split()) for name in people]


# ---------------------------------------------------------------- in the gradebook


@pytest.fixture
def book(tmp_path: Path):
    with Gradebook.open(new_course(tmp_path / "c")) as opened:
        yield opened


def _statuses(arrivals) -> list[str]:
    return [arrival.status for arrival in arrivals]


def test_a_second_list_changes_nobodys_pseudonym(book) -> None:
    first = book.take_in(parse_roster("c.csv", CANVAS))
    again = book.take_in(parse_roster("c.csv", CANVAS))
    assert _statuses(first) == ["new", "new"]
    assert _statuses(again) == ["known", "known"]
    assert [a.student.pid for a in again] == [a.student.pid for a in first]


def test_another_platforms_list_finds_the_same_people(book) -> None:
    (jane, _) = book.take_in(parse_roster("c.csv", CANVAS))
    arrivals = book.take_in([Enrolled("Jane Doe-Smith", "JDOE@example.org", {"moodle_participant": "5"})])
    assert (arrivals[0].status, arrivals[0].student.pid) == ("known", jane.student.pid)
    assert arrivals[0].student.name == "Jane Doe-Smith"
    assert arrivals[0].student.ids == {**jane.student.ids, "moodle_participant": "5"}


def test_a_name_alone_links_where_nothing_speaks_against_it(book) -> None:
    book.take_in([Enrolled("Ann", ""), Enrolled("Ben", "ben@x.org")])
    arrivals = book.take_in([Enrolled("ann", "ann@x.org"), Enrolled("Ben", "other@x.org")])
    assert _statuses(arrivals)[:2] == ["linked", "new"]


def test_two_of_one_name_are_never_linked_by_it(book) -> None:
    book.take_in([Enrolled("Müller", "")])
    arrivals = book.take_in([Enrolled("Müller", "a@x.org"), Enrolled("Müller", "b@x.org")])
    assert _statuses(arrivals) == ["new", "new", "not listed"]


def test_a_line_that_fits_two_students_is_refused_and_nothing_is_taken_in(book) -> None:
    book.take_in([Enrolled("Ann", "ann@x.org"), Enrolled("Ben", "", {"sis_id": "7"})])
    with pytest.raises(RosterError, match="expected one student for 'Ann', got 2 of the gradebook"):
        book.take_in([Enrolled("New", "new@x.org"), Enrolled("Ann", "ann@x.org", {"sis_id": "7"})])
    assert len(book.students()) == 2


def test_last_weeks_participant_number_says_nothing_of_who_it_is(book) -> None:
    """Moodle numbers participants anew for each assignment."""
    book.take_in([Enrolled("Ann", "ann@x.org", {"moodle_participant": "1"}), Enrolled("Ben", "ben@x.org")])
    arrivals = book.take_in([Enrolled("Ben", "ben@x.org", {"moodle_participant": "1"})])
    assert arrivals[0].student.email == "ben@x.org"
    assert arrivals[0].student.ids == {"moodle_participant": "1"}


def test_a_trial_changes_nothing(book) -> None:
    arrivals = book.take_in(parse_roster("c.csv", CANVAS), dry_run=True)
    assert _statuses(arrivals) == ["new", "new"]
    assert book.students() == ()
    assert book.is_whole()


def test_who_is_dropped_stays_with_grades_and_comes_back_with_a_list(book) -> None:
    (ann,) = book.take_in([Enrolled("Ann", "ann@x.org")])
    book.set_status(ann.student.pid, "dropped")
    assert book.students(active_only=True) == ()
    assert [s.status for s in book.students()] == ["dropped"]
    (again,) = book.take_in([Enrolled("Ann", "ann@x.org")])
    assert (again.student.pid, again.student.status) == (ann.student.pid, "active")


def test_who_was_dropped_is_not_brought_back_by_the_courses_own_list(book, tmp_path: Path) -> None:
    own = tmp_path / "roster.csv"
    own.write_text("name,email\nAnn,ann@x.org\nBen,ben@x.org\n", encoding="utf-8")
    (ann, _) = book.students_from_roster(own)
    book.set_status(ann.pid, "dropped")
    assert [s.name for s in book.students_from_roster(own)] == ["Ann", "Ben"]
    assert [s.name for s in book.students(active_only=True)] == ["Ben"]


def test_forgotten_names_are_gone_and_pseudonyms_stay(book) -> None:
    (ann, _) = book.take_in([Enrolled("Ann", "ann@x.org"), Enrolled("Ben", "ben@x.org")])
    assert book.forget_names([ann.student.pid]) == 1
    assert [(s.pid == ann.student.pid, s.name) for s in book.students()] == [(True, ""), (False, "Ben")]


def test_an_unknown_pseudonym_is_told(book) -> None:
    with pytest.raises(InputError, match="expected a pseudonym of this course, got 'zz'"):
        book.set_status("zz", "dropped")


def test_an_extension_is_kept_in_the_settings_and_in_the_chain(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    text = course.shelf.read("course.toml") + b"[assignment.soccer-kick]\ndue = 2027-04-26T23:59:00\nattempts = 2\n"
    course.shelf.write("course.toml", text)
    with Gradebook.open(course) as book:
        pid = book.students_from_roster(course.roster)[0].pid
    words = ["gradebook", "extend", pid, "--hours", "24", "--attempts", "1", "--reason", "ill", "--course"]
    assert run([*words, str(tmp_path / "c")]) == 0
    assert f"{pid}  soccer-kick: due Tuesday 27 April 2027, 23:59 (UTC), 3 attempts" in capsys.readouterr().out
    assert run(["gradebook", "verify", "--course", str(tmp_path / "c")]) == 0
    assert "Chain of events: 4 events, unbroken." in capsys.readouterr().out
    assert run(["gradebook", "extend", "zz", "--hours", "1", "--reason", "x", "--course", str(tmp_path / "c")]) == 2


def test_an_extension_of_an_assignment_that_does_not_exist_is_not_written(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    with Gradebook.open(course) as book:
        pid = book.students_from_roster(course.roster)[0].pid
    before = course.shelf.read("course.toml")
    words = ["gradebook", "extend", pid, "--assignment", "soccerkick", "--hours", "1", "--reason", "x", "--course"]
    assert run([*words, str(tmp_path / "c")]) == 2
    assert "assignment: expected one of soccer-kick," in capsys.readouterr().err
    assert course.shelf.read("course.toml") == before


# ---------------------------------------------------------------- the course's own file


@pytest.mark.parametrize(
    "text",
    [
        "name,email\nAna,a@x\nBen,b@x\n",
        "\ufeffEmail;Name\na@x;Ana\nb@x;Ben\n",
        "Name\tEmail\tid\nAna\ta@x\t1\n\nBen\tb@x\t2\n",
    ],
)
def test_rosters_of_many_shapes_are_read(tmp_path, text):
    (tmp_path / "r.csv").write_text(text, encoding="utf-8")
    assert [(s.name, s.email) for s in read_roster(tmp_path / "r.csv")] == [("Ana", "a@x"), ("Ben", "b@x")]


def test_a_roster_in_an_old_encoding_is_read(tmp_path):
    (tmp_path / "r.csv").write_bytes("name,email\nJosé,j@x\n".encode("cp1252"))
    assert read_roster(tmp_path / "r.csv")[0].name == "José"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "empty"),
        ("a,b\n1,2\n", "name,email"),
        ("name,email\nA,x@y\nB,X@y\n", "twice"),
        ("name,email\n", "at least one student"),
        ("name,email\nA,x@y\n,z@y\n", "line 3: expected a name"),
        ("name,email\nDoe, Jane,x@y\n", "line 2: expected as many cells .* in quotes"),
        ("name,email,group\nDoe, Jane,x@y\n", "line 2: expected an e-mail address"),
    ],
)
def test_a_roster_that_is_none_is_told(tmp_path, text, words):
    (tmp_path / "r.csv").write_text(text)
    with pytest.raises(RosterError, match=words):
        read_roster(tmp_path / "r.csv")


def test_a_missing_roster_is_told(tmp_path):
    with pytest.raises(FileMissingError, match="name,email"):
        read_roster(tmp_path / "r.csv")


# ---------------------------------------------------------------- grading a batch


def test_removing_names_says_where_others_are_left(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    with Gradebook.open(course) as book:
        book.students_from_roster(course.roster)
    (course.folder / "exports").mkdir()
    (course.folder / "exports" / "soccer-kick-csv.csv").write_text("name,points")
    assert run(["roster", "purge", "--yes", "--course", str(course.folder)]) == 0
    said = capsys.readouterr().out
    assert "the names of 3 students" in said
    assert "Names are still in roster.csv" in said
    assert "Names are still in exports/soccer-kick-csv.csv" in said


@pytest.mark.parametrize(("first", "then"), [("Doe, Jane", "Jane Doe"), ("Jane Doe", "Doe, Jane")])
def test_the_same_name_written_last_name_first_is_the_same_person(book, first: str, then: str) -> None:
    (known,) = book.take_in([Enrolled(first, "", {"canvas_id": "1"})])
    (again,) = book.take_in([Enrolled(then, "", {"moodle_participant": "48213"})])
    assert (again.status, again.student.pid) == ("linked", known.student.pid)
