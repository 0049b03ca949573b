"""Nothing that is handed out tells an answer: every byte of it is searched, in every form a number can take.

The searcher is tested, too: a leak planted in each place is found.
"""

from __future__ import annotations

import base64
import dataclasses
import io
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path

import av
import pytest
from openpyxl import Workbook, load_workbook
from openpyxl.workbook.defined_name import DefinedName

from assignments.bundle import zip_bytes
from assignments.load import assignment_ids, load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.release import Order, Release, release

SECRET = bytes(range(32))
PUBLIC = {"fps", "v_b1"}  # told, and known to be zero
PAGE, BOOK, VIDEO = "handout.html", "workbook.xlsx", "video.mp4"


# ---------------------------------------------------------------- where things are


def parts(name: str, content: bytes, depth: int = 0) -> Iterator[tuple[str, bytes]]:
    """Yield a file and all that is in it: members of zips, data addresses of pages, streams of pictures, metadata."""
    yield name, content
    if depth > 3:
        return
    inner = []
    if zipfile.is_zipfile(io.BytesIO(content)):
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            inner += [(f"{name}/{member}", archive.read(member)) for member in archive.namelist()]
            inner += [(f"{name}/comments", archive.comment + b"".join(m.comment + m.extra for m in archive.infolist()))]
            inner += [(f"{name}/names", "\n".join(archive.namelist()).encode())]
    for number, found in enumerate(re.findall(rb"base64,([A-Za-z0-9+/=]+)", content)):
        inner.append((f"{name}/data address {number}", base64.b64decode(found + b"=" * (-len(found) % 4))))
    if content.startswith(b"\x89PNG"):
        inner += [(f"{name}/{kind}", data) for kind, data in png_chunks(content)]
    if name.endswith((".mp4", ".avi")):
        inner.append((f"{name}/metadata", video_words(content)))
    for where, data in inner:
        yield from parts(where, data, depth + 1)


def png_chunks(content: bytes) -> Iterator[tuple[str, bytes]]:
    at = 8
    while at + 8 <= len(content):
        length, kind = struct.unpack(">I4s", content[at : at + 8])
        data = content[at + 8 : at + 8 + length]
        yield kind.decode("latin-1"), zlib.decompress(data.partition(b"\0\0")[2]) if kind == b"zTXt" else data
        at += 12 + length


def video_words(content: bytes) -> bytes:
    with av.open(io.BytesIO(content)) as container:
        words = [
            *container.metadata.items(),
            *(pair for stream in container.streams for pair in stream.metadata.items()),
        ]
    return repr(words).encode()


# ---------------------------------------------------------------- how a number is written


def forms(value: float, digits: int = 3) -> Iterator[tuple[str, bytes]]:
    """Yield every way in which a number of so many digits and more may be found in bytes, with what it is called."""
    for text in texts(value, digits):
        yield "text", text.encode()
        yield "UTF-16", text.encode("utf-16-le")
    for layout in "<d", ">d":
        yield "double", struct.pack(layout, value)
    for layout in "<f", ">f":
        if struct.pack(layout, value).count(0) < 2:  # 0.125 is three zeros and a byte: every video has that somewhere
            yield "float", struct.pack(layout, value)
    for layout in "<d", ">d":
        yield from (("base64", middle) for middle in base64_middles(struct.pack(layout, value)))
    for text in texts(value, digits):
        if len(text) >= 7:
            yield from (("base64 text", middle) for middle in base64_middles(text.encode()))


def texts(value: float, least: int = 3) -> set[str]:
    """Return a number as people and programs write it: up to 17 digits, fixed and scientific, point and comma."""
    written = {f"{value:.{digits}g}" for digits in range(3, 18)} | {repr(value)}
    written |= {f"{value:.{digits}f}" for digits in range(2, 9)}
    written |= {f"{value:.{digits}{kind}}" for digits in range(2, 8) for kind in "eE"}
    written |= {text.replace("e+0", "e").replace("e-0", "e-").replace("e+", "e") for text in written if "e" in text}
    written |= {text.replace("0.", ".", 1) for text in written if text.startswith(("0.", "-0."))}
    long = {text for text in written if len(re.sub(r"[eE].*|[-+.]", "", text).strip("0")) >= least}
    return long | {text.replace(".", ",") for text in long}


def base64_middles(data: bytes) -> Iterator[bytes]:
    """Yield what base64 makes of data wherever it begins within three bytes, without what its neighbours decide."""
    for before in range(3):
        coded = base64.b64encode(b"\0" * before + data)
        yield coded[-(-8 * before // 6) : (8 * (before + len(data))) // 6]


def leaks(
    files: Mapping[str, bytes],
    secrets: Mapping[str, float],
    digits: int = 3,
    others: Mapping[str, bytes] | None = None,
) -> list[str]:
    """Return where which secret number stands, in which form; with fewer digits it is none.

    `others` are files of somebody with other numbers: what stands there, too, such as a size of type, tells nothing.
    """
    searched = [part for name, content in files.items() for part in parts(name, content)]
    common = [content for name, data in (others or {}).items() for _, content in parts(name, data)]
    found = []
    for secret, value in secrets.items():
        for kind, form in forms(value, digits):
            pattern = alone(form) if kind == "text" else re.compile(re.escape(form), re.DOTALL)
            places = [where for where, content in searched if form in content and pattern.search(content)]
            if places and not any(form in content and pattern.search(content) for content in common):
                found += [f"{secret} as {kind} {form!r} in {where}" for where in places]
    return found


def alone(text: bytes) -> re.Pattern[bytes]:
    """Match a number that is not part of a longer one."""
    return re.compile(rb"(?<![0-9.,])" + re.escape(text) + rb"(?![0-9])")


def secrets_of(key: AnswerKey, assignment: Assignment) -> dict[str, float]:
    """Return the numbers that nobody may find: answers, what they follow from, what the reference measured."""
    made_up = {number.parameter for number in (*assignment.draws, *assignment.derived)}
    drawn = {name: value for name, value in key.parameters.items() if name in made_up}
    kinds = {"answer": key.values, "true": key.truth, "measured": key.measured, "drawn": drawn}
    numbers = {f"{kind} {name}": float(v) for kind, values in kinds.items() for name, v in values.items()}
    known = {*key.given.values(), *assignment.fixed.values(), *(given.value for given in assignment.givens)}
    known |= {key.values[name] for name in PUBLIC if name in key.values}
    # A whole number of one or two digits, such as the last frame before the impact, stands everywhere.
    return {
        name: v for name, v in numbers.items() if abs(v) > 1e-3 and v not in known and not (v.is_integer() and v < 100)
    }


# ---------------------------------------------------------------- what is handed out


@dataclasses.dataclass(frozen=True)
class Case:
    assignment: Assignment
    one: Release
    other: Release


@pytest.fixture(scope="module", params=assignment_ids())
def case(request: pytest.FixtureRequest) -> Case:
    assignment = load_assignment(request.param)
    one, other = (release(Order(assignment, SECRET, student)) for student in ("s1", "s2"))
    return Case(assignment, one, other)


def test_no_secret_number_stands_in_what_is_handed_out(case: Case) -> None:
    files = case.one.files  # the zip holds the same bytes, not compressed
    secrets = secrets_of(case.one.key, case.assignment)
    places = {
        name: value for name, value in secrets.items() if name.endswith("_px")
    }  # seen in the picture, not so sharply
    assert len(secrets) > 15
    assert leaks(files, places, digits=5) == []
    theirs = secrets_of(case.other.key, case.assignment)
    own = {name: value for name, value in secrets.items() if name not in places}
    same = {name: value for name, value in own.items() if value == theirs.get(name)}
    assert leaks(files, same) == []
    assert leaks(files, {name: value for name, value in own.items() if name not in same}, others=case.other.files) == []


def test_a_students_numbers_are_not_in_another_students_files(case: Case) -> None:
    mine, theirs = (secrets_of(released.key, case.assignment) for released in (case.one, case.other))
    own = {name: value for name, value in mine.items() if value != theirs.get(name)}
    assert len(own) > 15
    assert leaks(case.other.files, own, digits=5) == []
    for word in (case.one.variant.code, case.one.variant.signature, case.one.key.video_sha256):
        for where, content in (part for name, data in case.other.files.items() for part in parts(name, data)):
            assert word.encode() not in content, where


def test_the_workbook_hides_nothing_but_the_variants_code_and_computes_nothing(case: Case) -> None:
    book = load_workbook(io.BytesIO(case.one.files[BOOK]))
    for sheet in book.worksheets:
        cells = [cell for row in sheet.iter_rows() for cell in row if cell.value is not None]
        formulas = [cell.coordinate for cell in cells if cell.data_type == "f"]
        numbers = [cell for cell in cells if cell.data_type == "n"]
        assert formulas == [], sheet.title
        if sheet.sheet_state != "visible":
            assert [cell.coordinate for cell in numbers] == [], sheet.title
        assert [cell.coordinate for cell in cells if cell.comment] == []
    hidden = [sheet for sheet in book.worksheets if sheet.sheet_state != "visible"]
    said = {str(cell.value) for sheet in hidden for row in sheet.iter_rows() for cell in row if cell.value is not None}
    assert {case.one.variant.code, case.one.variant.signature} <= said
    assert [sheet.title for sheet in hidden] == ["_meta"]
    for name in book.defined_names.values():
        assert re.fullmatch(r"'?[^'!]+'?!\$[A-Z]+\$\d+", name.attr_text), name.attr_text  # a place, never a value


def test_documents_tell_no_person_time_or_machine(case: Case) -> None:
    book = load_workbook(io.BytesIO(case.one.files[BOOK]))
    properties = {name: value for name, value in vars(book.properties).items() if value}
    assert {properties.pop(name).year for name in ("created", "modified")} == {2000}
    assert set(properties) <= {"title", "creator"}
    assert properties["creator"] == "Virtual Mechanics Laboratory"
    home = str(Path.home())
    for where, content in (part for name, data in case.one.files.items() for part in parts(name, data)):
        for word in (SECRET.hex().encode(), SECRET, b"truth", case.assignment.folder.encode(), home.encode()):
            assert word not in content, f"{word!r} in {where}"
    name = next(name for name in case.one.files if name.startswith("video."))
    words = video_words(case.one.files[name]).decode().lower()
    assert not re.search(r"title|comment|date|creation|encoder|x264", words)


# ---------------------------------------------------------------- the searcher finds what is planted

VALUE = 0.734561234
SECRET_NUMBERS = {"e": VALUE}


def book_with(plant) -> bytes:
    book, content = Workbook(), io.BytesIO()
    plant(book)
    book.save(content)
    return content.getvalue()


def hidden_sheet(book: Workbook) -> None:
    sheet = book.create_sheet("key")
    sheet.sheet_state = "veryHidden"
    sheet["Q400"] = VALUE


def formula(book: Workbook) -> None:
    book.active["A1"] = f"=IF(B1={VALUE:.4f},1,0)"


def defined_name(book: Workbook) -> None:
    book.defined_names["e_true"] = DefinedName("e_true", attr_text=str(VALUE))


def document_property(book: Workbook) -> None:
    book.properties.keywords = f"{VALUE:.3f}"


def in_a_png(text: bytes) -> bytes:
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"tEXt", b"Comment\0" + text)


def in_a_packed_png(text: bytes) -> bytes:
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"zTXt", b"Comment\0\0" + zlib.compress(text))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def page_with(picture: bytes) -> bytes:
    return b"<img src='data:image/png;base64," + base64.b64encode(picture) + b"'>"


def video_with(**metadata: str) -> bytes:
    content = io.BytesIO()
    with av.open(content, "w", format="mp4", options={"movflags": "use_metadata_tags"}) as container:
        container.metadata.update(metadata)
        stream = container.add_stream("libx264", rate=30)
        stream.width = stream.height = 16
        stream.pix_fmt = "yuv420p"
        container.mux(stream.encode(av.VideoFrame(16, 16, "yuv420p")))
        container.mux(stream.encode(None))
    return content.getvalue()


def zip_with(comment: bytes = b"", name: str = "a.txt") -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, b"nothing")
        archive.comment = comment
    return content.getvalue()


PLANTED = {
    "a hidden sheet": (BOOK, lambda: book_with(hidden_sheet)),
    "a formula": (BOOK, lambda: book_with(formula)),
    "a defined name": (BOOK, lambda: book_with(defined_name)),
    "a document property": (BOOK, lambda: book_with(document_property)),
    "a workbook in a zip": ("s1.zip", lambda: zip_bytes({BOOK: book_with(hidden_sheet)})),
    "a zip's comment": ("s1.zip", lambda: zip_with(comment=b"0.7346")),
    "a member's name": ("s1.zip", lambda: zip_with(name="e is 0.735.txt")),
    "a page": (PAGE, lambda: b"<p data-e='0.7346'>"),
    "a page, decimal comma": (PAGE, lambda: b"e = 0,735"),
    "a page, three digits": (PAGE, lambda: b"<!-- 0.735 -->"),
    "a page, without the zero": (PAGE, lambda: b"var e=.7346;"),
    "a page, scientific": (PAGE, lambda: b"7.346e-01"),
    "a page, scientific and short": (PAGE, lambda: b"7.346E-01 or 7.35e-1"),
    "a page, base64 of a double": (
        PAGE,
        lambda: b"var k='" + base64.b64encode(b"xy" + struct.pack("<d", VALUE)) + b"'",
    ),
    "a page, base64 of digits": (PAGE, lambda: b"k='" + base64.b64encode(b"e=0.73456123;") + b"'"),
    "a page's picture": (
        PAGE,
        lambda: b"<img src='data:image/png;base64," + base64.b64encode(in_a_png(b"0.7346")) + b"'>",
    ),
    "a packed text of a picture": (
        PAGE,
        lambda: b"<img src='data:image/png;base64," + base64.b64encode(in_a_packed_png(b"0.7346")) + b"'>",
    ),
    "a video, double": (VIDEO, lambda: video_with() + struct.pack(">d", VALUE)),
    "a video, float": (VIDEO, lambda: video_with() + struct.pack("<f", VALUE)),
    "a video's title": (VIDEO, lambda: video_with(title="e=0.7346")),
    "UTF-16": ("notes.txt", lambda: "e 0.7346".encode("utf-16-le")),
}


@pytest.mark.parametrize("place", PLANTED)
def test_a_leak_that_is_planted_is_found(place: str) -> None:
    name, make = PLANTED[place]
    assert leaks({name: make()}, SECRET_NUMBERS)


@pytest.mark.parametrize("text", [b"10.7346", b"0.73468", b"0.734", b"0.73", b"7346", b"version 1.0.7346"])
def test_another_number_is_no_leak(text: bytes) -> None:
    assert leaks({PAGE: text}, SECRET_NUMBERS) == []
