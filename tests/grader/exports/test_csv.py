"""The plain table."""

from __future__ import annotations

import csv
import io

from grader.enrolment import Student


def read(data: bytes, delimiter: str = ",") -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(data.decode("utf-8-sig")), delimiter=delimiter))


def test_everybody_with_a_released_grade_has_a_line_and_nobody_else(desk) -> None:
    rows = read(desk.run("csv"))
    assert [row["pid"] for row in rows] == ["jane2345", "jurg2345", "anab2345", "anac2345"]
    assert rows[1] == {
        "email": "juerg.mueller@x.edu", "sis_id": "S2", "login": "jmueller", "name": "Jürg Müller", "pid": "jurg2345",
        "attempt": "1", "earned": "12.35", "late_share": "0", "points": "12.35", "out_of": "20",
        "state": "final",
    }  # fmt: skip
    assert (desk.lines["Nora New"].status, desk.lines["Guy Gone"].status) == ("no grade", "skipped")


def test_the_state_tells_final_points_from_open_and_changed_ones(desk) -> None:
    rows = read(desk.run("csv", unsettled=frozenset({"jane2345"}), stale=frozenset({"anab2345"})))
    assert [row["state"] for row in rows] == ["open", "final", "changed", "final"]
    assert rows[0]["points"] == "17"
    jane, juerg = desk.lines["Jane Doe"], desk.lines["Jürg Müller"]
    assert jane.reason == "open: up to 17 of 20, a person has to look"
    assert (jane.is_open, jane.needs_attention) == (True, True)
    assert (juerg.reason, juerg.is_open, juerg.needs_attention) == ("", False, False)


def test_names_that_a_spreadsheet_would_compute_are_made_harmless_but_not_identities(desk) -> None:
    evil = Student("jane2345", '=HYPERLINK("http://x")', "+jane@x.edu", {"login": "@jane", "sis_id": "-1"})
    (row,) = read(desk.run("csv", students=(evil,)))
    assert row["name"] == '\'=HYPERLINK("http://x")'
    assert (row["email"], row["login"], row["sis_id"]) == ("+jane@x.edu", "@jane", "-1")


def test_decimal_commas_come_with_semicolons(desk) -> None:
    rows = read(desk.run("csv", decimal="comma"), ";")
    assert rows[1]["points"] == "12,35"


def test_addresses_keep_their_case(desk) -> None:
    (row,) = read(desk.run("csv", students=(Student("jane2345", "Jane Doe", "Jane.Doe@X.edu"),)))
    assert row["email"] == "Jane.Doe@X.edu"
