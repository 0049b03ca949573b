"""Tables as they are written: what is not filled stays byte for byte."""

from __future__ import annotations

import csv
import io

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.filling.cells import TextTable
from grader.filling.numbers import number_in, points_text, uses_comma
from vml_course.errors import TableError

ODD = st.text(alphabet='ab",;\t\r\n é', min_size=1).filter(lambda text: bool(text.strip()))


@given(ODD, st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]))
def test_whatever_is_read_is_written_back_byte_for_byte(text, encoding) -> None:
    data = text.encode(encoding)
    assert TextTable("t.csv", data).encoded() == data


@given(st.lists(st.lists(st.text(alphabet='ab",;\n é', min_size=1), min_size=2, max_size=4), min_size=1, max_size=4))
def test_cells_say_what_the_csv_module_reads(rows) -> None:
    rows = [["first", "second"], *rows]
    text = io.StringIO()
    csv.writer(text, lineterminator="\r\n").writerows(rows)
    table = TextTable("t.csv", text.getvalue().encode())
    assert [list(table.row(row)) for row in range(len(table))] == rows


@given(st.text(alphabet='a1",;\t\n', max_size=8), st.sampled_from(",;\t"))
def test_one_cell_is_written_and_no_other_changes(text, delimiter) -> None:
    table = TextTable(
        "t.csv", delimiter.join(["one", "two", "three"]).encode() + b"\r\n" + delimiter.join("xyz").encode()
    )
    table.put(1, 1, text)
    again = TextTable("t.csv", table.encoded())
    assert again.row(1) == ("x", text, "z")
    assert again.headings == ("one", "two", "three")


def test_a_short_row_grows_up_to_the_cell() -> None:
    table = TextTable("t.csv", b"a,b,c\nx\n")
    assert table.get(1, 2) == ""
    table.put(1, 2, "5")
    assert table.encoded() == b"a,b,c\nx,,5\n"


def test_a_file_that_quotes_everything_goes_on_doing_so() -> None:
    table = TextTable("t.csv", b'"a","b"\n"x",\n')
    table.put(1, 1, "5")
    assert table.encoded() == b'"a","b"\n"x","5"\n'


@pytest.mark.parametrize("data", [b"", b"\xff\xfe", b"PK\x03\x04\x00\x00", b"\xff\xfea"], ids=repr)
def test_what_is_no_table_is_refused(data) -> None:
    with pytest.raises(TableError, match="separated values"):
        TextTable("t.csv", data)


def test_windows_files_keep_their_letters() -> None:
    table = TextTable("t.csv", "Name;Note\r\nMüller;\r\n".encode("cp1252"))
    table.put(1, 1, "8,5")
    assert table.encoded() == "Name;Note\r\nMüller;8,5\r\n".encode("cp1252")


@given(st.floats(0, 99999), st.booleans())
def test_points_hold_no_mark_between_thousands_and_read_back(points, comma) -> None:
    text = points_text(points, comma=comma)
    assert len([c for c in text if c in ",."]) <= 1
    assert ("." in text) <= (not comma)
    assert abs(number_in(text) - points) <= 0.005 + 1e-9


def test_the_decimal_mark_is_that_of_most_numbers() -> None:
    assert uses_comma(["8,50", "10,00", ""], "auto")
    assert not uses_comma(["8.50", "1,000"], "auto")
    assert not uses_comma(["10"], "auto")
    assert uses_comma(["8.5"], "comma")
    assert not uses_comma(["8,5"], "point")
