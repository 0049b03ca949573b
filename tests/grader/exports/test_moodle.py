"""Moodle's grading worksheet as it is downloaded, and the zip of feedback files."""

from __future__ import annotations

import io
import re
import zipfile
from dataclasses import replace

import pytest

from grader.enrolment import Student
from vml_course.errors import InputError, TableError

ENGLISH = (
    'Identifier,"Full name","Email address",Status,Grade,"Maximum Grade","Grade can be changed",'
    '"Last modified (submission)","Last modified (grade)","Feedback comments"\n'
    '"Participant 48213","Jane Doe",jane@x.edu,"Submitted for grading - ",,10.00,Yes,'
    '"Monday, 3 November 2025, 10:12 PM",-,"<p>Good, but ""late""</p>"\n'
    '"Participant 48214","Jürg Müller",juerg.mueller@x.edu,"Submitted for grading - ",6.17,10.00,Yes,-,-,\n'
    '"Participant 48215","Ana Smith",ana.one@x.edu,"Submitted for grading - ",,10.00,No,-,-,\n'
    '"Participant 48216","Ana Smith",ana.two@x.edu,"No submission - ",4.00,10.00,Yes,-,-,"old\nlines"\n'
    '"Participant 48217","Nora New",nora@x.edu,"No submission - ",5.00,10.00,Yes,-,-,\n'
)
GERMAN = (
    '\ufeffID,"Vollständiger Name",E-Mail-Adresse,Status,Bewertung,Bestwertung,"Bewertung kann geändert werden",'
    '"Zuletzt geändert (Abgabe)","Zuletzt geändert (Bewertung)","Feedback als Kommentar"\r\n'  # codespell:ignore als
    'Teilnehmer/in48213,"Jane Doe",jane@x.edu,"Zur Bewertung abgegeben - ",,"10,00",Ja,'
    '"Montag, 3. November 2025, 22:12",-,\r\n'
    'Teilnehmer/in48214,"Jürg Müller",juerg.mueller@x.edu,"Keine Abgabe - ",-,"10,00",Nein,-,-,\r\n'
)
FINNISH = (  # no word of it is known: the columns are found by what stands in them
    "Tunniste;Koko nimi;Sähköpostiosoite;Tila;Arvosana;Korkein arvosana;Arvosanan voi muuttaa;Muokattu;Muokattu;P\n"
    "Osallistuja 48213;Jane Doe;jane@x.edu;Palautettu;;20,00;Kyllä;-;-;\n"
    "Osallistuja 48214;Jürg Müller;juerg.mueller@x.edu;Palautettu;;20,00;Kyllä;-;-;\n"
)
BLIND = (
    'Identifier,Status,Grade,"Maximum Grade","Grade can be changed","Last modified (grade)"\n'
    '"Participant 48213","Submitted for grading - ",,20.00,Yes,-\n'
    '"Participant 48214","Submitted for grading - ",,20.00,Yes,-\n'
)


def test_only_grades_are_filled_and_feedback_stays(desk, swap) -> None:
    got = desk.run("moodle", ENGLISH.encode()).decode()
    wanted = swap(ENGLISH, ('ng - ",,10.00,Yes', 'ng - ",8.5,10.00,Yes'), (",4.00,10.00", ",0,10.00"))
    assert got == wanted


def test_the_reasons_of_moodle_are_told(desk) -> None:
    desk.run("moodle", ENGLISH.encode())
    assert desk.lines["Jane Doe"].reason == "17 of 20, scaled to 10"
    assert desk.lines["Jürg Müller"].status == "unchanged"
    assert desk.lines["Nora New"].status == "no grade"


def test_a_locked_grade_is_left_out_in_any_language(desk) -> None:
    desk.run("moodle", GERMAN.encode())
    line = desk.lines["Jürg Müller"]
    assert (line.status, line.reason) == ("skipped", "locked or overridden in Moodle's gradebook")


def test_a_german_worksheet_gets_decimal_commas(desk, swap) -> None:
    got = desk.run("moodle", GERMAN.encode()).decode()
    assert got == swap(GERMAN, ('abgegeben - ",,', 'abgegeben - ","8,5",'))


def test_a_worksheet_in_an_unknown_language_is_understood_by_its_content(desk, swap) -> None:
    got = desk.run("moodle", FINNISH.encode()).decode()
    jane, juerg = "jane@x.edu;Palautettu;", "juerg.mueller@x.edu;Palautettu;"
    assert got == FINNISH.replace(jane, f"{jane}17").replace(juerg, f"{juerg}12,35")


def test_more_than_the_maximum_is_not_written(desk) -> None:
    grades = {pid: grade for pid, grade in desk.job.grades.items() if pid == "jane2345"}
    grades["jane2345"] = replace(grades["jane2345"], points=21.0)
    assert desk.run("moodle", ENGLISH.encode(), grades=grades).decode() == ENGLISH
    assert desk.lines["Jane Doe"].reason == "the platform takes 0 to 10 only"


def test_the_number_of_another_assignment_is_not_believed(desk) -> None:
    wrong = Student("wron2345", "Wrong Person", "wrong@x.edu", {"moodle_participant": "48213"})
    desk.run("moodle", ENGLISH.encode(), students=(*desk.job.students, wrong))
    assert desk.lines["Jane Doe"].points == "8.5"


def test_with_blind_marking_the_number_is_all_there_is(desk) -> None:
    jane = Student("jane2345", "Jane Doe", "jane@x.edu", {"moodle_participant": "48213"})
    got = desk.run("moodle", BLIND.encode(), students=(jane,)).decode()
    assert got.count("17,20.00") == 1
    assert "48214" in next(name for name, line in desk.lines.items() if line.status == "skipped")


@pytest.mark.parametrize(
    "text",
    [
        "Student,ID,Section\nJane,1,A\n",
        'Identifier,"Full name",Status,Grade\n"Participant 48213","Jane Doe",x,Good\n',  # graded by words
        "\n",
    ],
)
def test_what_is_no_worksheet_with_points_is_refused(desk, text) -> None:
    with pytest.raises(TableError):
        desk.run("moodle", text.encode())


# ---------------------------------------------------------------- feedback files


@pytest.fixture
def pages(desk):
    for pid in ("jane2345", "jurg2345", "anac2345"):
        desk.job.course.shelf.write(f"feedback/soccer-kick/{pid}.html", f"<p>{pid}</p>".encode())
    return desk


def zipped(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        return {name: archive.read(name) for name in archive.namelist()}


def test_moodle_finds_every_page_by_the_number_alone(pages) -> None:
    files = zipped(pages.run("moodle-feedback", ENGLISH.encode()))
    assert set(files) == {
        f"{pid}_{number}_assignsubmission_file/feedback.html"
        for pid, number in (("jane2345", 48213), ("jurg2345", 48214), ("anac2345", 48216))
    }
    for name, data in files.items():
        pieces = name.partition("/")[0].split("_", 4)  # as importziplib.php takes it apart
        assert re.fullmatch(r"\d+", pieces[1])
        assert pieces[2:4] == ["assignsubmission", "file"]
        assert data == f"<p>{pieces[0]}</p>".encode()


def test_no_name_is_in_the_zip(pages) -> None:
    data = pages.run("moodle-feedback", ENGLISH.encode())
    assert not re.search(b"Jane|Doe|M\xc3\xbcller|x\\.edu", data)


def test_a_page_that_is_newer_than_the_release_does_not_go_out(pages) -> None:
    files = zipped(pages.run("moodle-feedback", ENGLISH.encode(), stale=frozenset({"jane2345"})))
    assert not any("48213" in name for name in files)
    assert "vml release" in pages.lines["Jane Doe"].reason


def test_who_has_no_page_or_no_grade_gets_no_file(pages) -> None:
    files = zipped(pages.run("moodle-feedback", ENGLISH.encode()))
    assert not any("48217" in name or "48215" in name for name in files)
    assert pages.lines["Nora New"].status == "no grade"


def test_a_participant_whom_nobody_knows_gets_no_file(pages) -> None:
    stranger = ENGLISH.replace('"Jane Doe",jane@x.edu', '"Eve Other",eve@x.edu')
    files = zipped(pages.run("moodle-feedback", stranger.encode()))
    assert not any("48213" in name for name in files)
    assert pages.lines["Eve Other"].status == "skipped"
    assert pages.lines["Jane Doe"].status == "not in template"


def test_the_worksheet_is_needed_because_it_has_the_numbers(pages) -> None:
    with pytest.raises(InputError, match="grading worksheet"):
        pages.run("moodle-feedback")
