"""Files that students might send, made here: hostile ones, other formats, and the dialects of other programs.

Used by the tests of this folder and by benchmarks/reading.py.
"""

from __future__ import annotations

import functools
import io
import struct
import zipfile
import zlib
from collections.abc import Callable, Mapping
from itertools import product

MIB = 2**20
HEAD = b'<?xml version="1.0"?>'
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
STRICT_MAIN, STRICT_OFFICE = (
    "http://purl.oclc.org/ooxml/spreadsheetml/main",
    "http://purl.oclc.org/ooxml/officeDocument",
)
PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"
SHEET = "xl/worksheets/sheet2.xml"
OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"


def members(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {info.filename: archive.read(info) for info in archive.infolist()}


def pack(parts: Mapping[str, bytes], packing: int = zipfile.ZIP_DEFLATED) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", packing) as archive:
        for name, part in parts.items():
            archive.writestr(name, part)
    return content.getvalue()


def with_parts(data: bytes, **parts: bytes) -> bytes:
    return pack({**members(data), **parts})


# ---------------------------------------------------------------- archives made by hand


def raw_archive(entries: list[tuple[bytes, bytes, int, int, int]], body: bytes) -> bytes:
    """An archive of directory entries (name, packed bytes' length as bytes, size, crc, offset) over a given body."""
    directory = b""
    for name, packed, size, crc, offset in entries:
        directory += struct.pack(
            "<4s6H3I5H2I", b"PK\x01\x02", 20, 20, 0, 8, 0, 0, crc, len(packed), size, len(name), 0, 0, 0, 0, 0, offset
        )
        directory += name
    end = struct.pack("<4s4H2IH", b"PK\x05\x06", 0, 0, len(entries), len(entries), len(directory), len(body), 0)
    return body + directory + end


def deflated(content: bytes) -> bytes:
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    return packer.compress(content) + packer.flush()


def local(name: bytes, packed: bytes, size: int, crc: int) -> bytes:
    return struct.pack("<4s5H3I2H", b"PK\x03\x04", 20, 0, 8, 0, 0, crc, len(packed), size, len(name), 0) + name + packed


def spaces(megabytes: int) -> bytes:
    """Deflated spaces: one packed megabyte that needs nothing before it, repeated."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    block = packer.compress(b" " * MIB) + packer.flush(zlib.Z_FULL_FLUSH)
    return block * megabytes + b"\x03\x00"


def bomb(good: bytes, part: str, megabytes: int = 1024, declared: int | None = None) -> bytes:
    """`good` with one part that unpacks to very much, and declares it, or `declared` bytes."""
    body, entries = b"", []
    for name, content in {**members(good), part: b""}.items():
        packed = spaces(megabytes) if name == part else deflated(content)
        size = (megabytes * MIB if declared is None else declared) if name == part else len(content)
        entries.append((name.encode(), packed, size, zlib.crc32(content), len(body)))
        body += local(name.encode(), packed, size, zlib.crc32(content))
    return raw_archive(entries, body)


def overlapping(count: int = 401) -> bytes:
    """Very many directory entries that all lie on the same packed bytes."""
    packed, size = deflated(b" " * 1000), 1000
    body = local(b"[Content_Types].xml", packed, size, 0)
    names = [b"[Content_Types].xml", *(f"xl/{i}.xml".encode() for i in range(count))]
    return raw_archive([(name, packed, size, 0, 0) for name in names], body)


def quoted_overlap() -> bytes:
    """A member whose packed bytes hold the next member, header and all."""
    inner_packed = deflated(b"<worksheet/>")
    inner = local(b"b.xml", inner_packed, 12, zlib.crc32(b"<worksheet/>"))
    head = local(b"a.xml", inner, len(inner), 0)
    start = len(head) - len(inner)
    entries = [(b"a.xml", inner, len(inner), 0, 0), (b"b.xml", inner_packed, 12, 0, start)]
    return raw_archive(entries, head)


def doctype(good: bytes, part: str, declared: bytes) -> bytes:
    body = members(good).get(part, b"<sst/>").partition(b"?>")[2] or members(good).get(part, b"<sst/>")
    return with_parts(good, **{part: HEAD + declared + body})


LAUGHS = b"<!DOCTYPE a [<!ENTITY l0 'ha'>" + b"".join(
    b"<!ENTITY l%d '%s'>" % (i, b"&l%d;" % (i - 1) * 10) for i in range(1, 10)
)
LAUGHS += b"]>"
QUADRATIC = b"<!DOCTYPE a [<!ENTITY q '" + b"a" * 100_000 + b"'>]>"
OUTSIDE = b'<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/hostname">]>'


def duplicate(good: bytes, name: str) -> bytes:
    content = io.BytesIO(good)
    with zipfile.ZipFile(content, "a") as archive:
        info = zipfile.ZipInfo("x")
        info.filename = name
        archive.writestr(info, b"<worksheet/>")
    return content.getvalue()


def many_sheets(good: bytes, count: int = 1500) -> bytes:
    sheets = b"".join(b'<sheet name="s%d" sheetId="%d"/>' % (i, i) for i in range(count))
    return with_parts(good, **{"xl/workbook.xml": b"<workbook><sheets>" + sheets + b"</sheets></workbook>"})


def many_styles(good: bytes, count: int = 2_000_000) -> bytes:
    return with_parts(
        good, **{"xl/styles.xml": b"<styleSheet><cellXfs>" + b"<xf/>" * count + b"</cellXfs></styleSheet>"}
    )


# Every hostile file of the measured table that must be refused, with a word of the refusal.
HOSTILE: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "sheet of 1 GB": (lambda good: bomb(good, SHEET), "unpacks to more than 96 MB"),
    "shared strings of 1 GB": (lambda good: bomb(good, "xl/sharedStrings.xml"), "unpacks to more than 96 MB"),
    "a sheet just below the sum": (lambda good: bomb(good, SHEET, 90), "unreasonable size"),
    "styles, 2 million": (many_styles, "unreasonable size"),
    "picture of 1 GB, unread": (lambda good: bomb(good, "xl/media/image1.png"), "unpacks to more than 96 MB"),
    "header lies about size": (lambda good: bomb(good, "xl/workbook.xml", 1024, declared=600), "damaged"),
    "billion laughs in the sheet": (lambda good: doctype(good, SHEET, LAUGHS), "document type"),
    "billion laughs in the workbook": (lambda good: doctype(good, "xl/workbook.xml", LAUGHS), "document type"),
    "billion laughs in the styles": (lambda good: doctype(good, "xl/styles.xml", LAUGHS), "document type"),
    "quadratic blow-up": (lambda good: doctype(good, SHEET, QUADRATIC), "document type"),
    "entity from outside": (lambda good: doctype(good, SHEET, OUTSIDE), "document type"),
    "a sheet twice": (lambda good: duplicate(good, SHEET), "twice"),
    "a sheet twice, in capitals": (lambda good: duplicate(good, SHEET.upper()), "twice"),
    "a sheet twice, backslashes": (lambda good: duplicate(good, SHEET.replace("/", "\\")), "twice"),
    "401 entries on one": (lambda _: overlapping(), "overlap"),
    "an entry inside another": (lambda _: quoted_overlap(), "overlap"),
    "1500 sheets": (many_sheets, "more than 64 sheets"),
    "1000 parts": (lambda good: with_parts(good, **{f"x/{i}": b"" for i in range(1000)}), "512 parts"),
    "deep markup": (lambda good: with_parts(good, **{SHEET: b"<a>" * 10_000}), "far too many cells"),
}


# ---------------------------------------------------------------- other formats under the name of a workbook


def ole(stream: str) -> bytes:
    """The start of a compound file whose directory names one stream."""
    return OLE + bytes(504) + stream.encode("utf-16-le") + bytes(1024)


def document(kind: str) -> bytes:
    return pack({"[Content_Types].xml": b"<Types/>", "_rels/.rels": b"<Relationships/>", kind: b"<a/>"})


OTHER_FORMATS: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "nothing": (lambda _: b"", "empty file"),
    "old .xls": (lambda _: ole("Workbook"), "old Excel workbook (.xls)"),
    "password": (lambda _: ole("EncryptedPackage"), "password-protected"),
    "old .doc": (lambda _: ole("WordDocument"), "an old Word document (.doc)"),
    "csv": (lambda _: "Größe;Wert\ne;0,7\n".encode("cp1252"), "text table (CSV)"),
    "csv, UTF-16": (lambda _: "quantity\tvalue\n".encode("utf-16"), "text table (CSV)"),
    "html": (lambda _: b"\xef\xbb\xbf\r\n<!DOCTYPE html><html><table>", "web page"),
    "xml of Excel 2003": (lambda _: HEAD + b"<Workbook/>", "XML file"),
    "pdf": (lambda _: b"%PDF-1.7\n", "PDF document"),
    "docx": (lambda _: document("word/document.xml"), "Word document"),
    "pptx": (lambda _: document("ppt/presentation.xml"), "presentation"),
    "xlsb": (lambda _: document("xl/workbook.bin"), "binary workbook (.xlsb)"),
    "ods": (
        lambda _: pack({"mimetype": b"application/vnd.oasis.opendocument.spreadsheet", "content.xml": b"<a/>"}),
        "OpenDocument",
    ),
    "numbers": (lambda _: pack({"Index/Document.iwa": b"x", "Metadata/Properties.plist": b"x"}), "Apple Numbers"),
    "zip of no workbook": (lambda _: pack({"a.txt": b"x"}), "ZIP archive"),
    "zip of two workbooks": (lambda good: pack({"a.xlsx": good, "b.xlsx": good}), "ZIP archive"),
    "zip in a zip": (lambda good: pack({"a.zip": pack({"w.xlsx": good})}), "ZIP archive"),
    "zip in a zip, named so": (lambda good: pack({"a.xlsx": pack({"w.xlsx": good})}), "ZIP archive"),
    "half an upload": (lambda good: good[: len(good) // 2], "incomplete upload"),
    "the tail cut off": (lambda good: good[:-30], "incomplete upload"),
    "a shortcut of a cloud drive": (
        lambda _: b'{"url": "https://docs.google.com/open?id=x", "doc_id": "x"}',
        "link to an online document",
    ),
    "a shortcut of Windows": (lambda _: b"L\0\0\0\x01\x14\x02\0" + bytes(60), "shortcut"),
}


# ---------------------------------------------------------------- dialects

Grid = list[list[object]]


def _text(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")


def content_types(sheets: int) -> str:
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    parts = {"workbook.xml": "sheet.main", "sharedStrings.xml": "sharedStrings"}
    parts |= {f"worksheets/sheet{i}.xml": "worksheet" for i in range(1, sheets + 1)}
    lines = "".join(f'<Override PartName="/xl/{n}" ContentType="{kind}.{k}+xml"/>' for n, k in parts.items())
    return f'<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">{lines}</Types>'


class Dialect:
    """Writes a workbook as some program does: where texts stand, whether cells say where they are, how paths go."""

    def __init__(self, texts: str = "shared", refs: bool = True, absolute: bool = False, prefix: str = "") -> None:
        self.texts, self.refs, self.absolute, self.p = texts, refs, absolute, f"{prefix}:" if prefix else ""
        self.main, self.office, self.extra, self.formula = MAIN, OFFICE, "", ""
        self.xmlns = f'xmlns:{prefix}="{{}}"' if prefix else 'xmlns="{}"'
        self.dimension = f"<{self.p}dimension ref='A1:A1'/>"  # wrong, as some programs write it
        self.strings: list[str] = []

    def write(self, sheets: Mapping[str, Grid], names: Mapping[str, str] | None = None) -> bytes:
        p, ns = self.p, self.xmlns.format(self.main)
        parts = {
            "[Content_Types].xml": content_types(len(sheets)),
            "_rels/.rels": self._relations([("officeDocument", "xl/workbook.xml")]),
        }
        listed = "".join(
            f'<{p}sheet name="{_text(name)}" sheetId="{i}" r:id="rId{i}"/>' for i, name in enumerate(sheets, start=1)
        )
        defined = "".join(
            f'<{p}definedName {self.extra} name="{name}">{_text(place)}</{p}definedName>'
            for name, place in (names or {}).items()
        )
        for i, grid in enumerate(sheets.values(), start=1):
            parts[f"xl/worksheets/sheet{i}.xml"] = self._sheet(grid, ns)
        targets = [("worksheet", f"xl/worksheets/sheet{i}.xml") for i in range(1, len(sheets) + 1)]
        parts["xl/_rels/workbook.xml.rels"] = self._relations(
            [*targets, ("sharedStrings", "xl/sharedStrings.xml")], "xl/"
        )
        parts["xl/workbook.xml"] = (
            f'<{p}workbook {ns} xmlns:r="{self.office}"><{p}sheets>{listed}</{p}sheets>'
            f"<{p}definedNames>{defined}</{p}definedNames></{p}workbook>"
        )
        entries = "".join(f'<{p}si><{p}t xml:space="preserve">{_text(text)}</{p}t></{p}si>' for text in self.strings)
        parts["xl/sharedStrings.xml"] = f"<{p}sst {ns}>{entries}</{p}sst>"
        return pack({name: HEAD + content.encode() for name, content in parts.items()})

    def _relations(self, targets: list[tuple[str, str]], folder: str = "") -> str:
        lines = "".join(
            f'<Relationship Id="rId{i}" Type="{self.office}/{kind}" '
            f'Target="{"/" + path if self.absolute else path.removeprefix(folder)}"/>'
            for i, (kind, path) in enumerate(targets, start=1)
        )
        return f'<Relationships xmlns="{PACKAGE}">{lines}</Relationships>'

    def _sheet(self, grid: Grid, ns: str) -> str:
        p = self.p
        rows = "".join(
            (f'<{p}row r="{r}">' if self.refs else f"<{p}row>")
            + "".join(self._cell(value, f"{chr(64 + c)}{r}") for c, value in enumerate(row, start=1))
            + f"</{p}row>"
            for r, row in enumerate(grid, start=1)
        )
        return f"<{p}worksheet {ns}>{self.dimension}<{p}sheetData>{rows}</{p}sheetData></{p}worksheet>"

    def _cell(self, value: object, at: str) -> str:
        p, where = self.p, f' r="{at}"' if self.refs else ""
        if value is None:
            return f'<{p}c{where} s="0"/>'
        if isinstance(value, str):
            return self._string(value, where)
        if isinstance(value, bool):
            return f'<{p}c{where} t="b"><{p}v>{int(value)}</{p}v></{p}c>'
        if isinstance(value, tuple):  # formula, stored value
            formula, stored = value
            kind = ' t="str"' if isinstance(stored, str) else ""
            return f"<{p}c{where}{kind}><{p}f{self.formula}>{_text(formula)}</{p}f><{p}v>{stored}</{p}v></{p}c>"
        return f'<{p}c{where} t="n"><{p}v>{value!r}</{p}v></{p}c>'

    def _string(self, value: str, where: str) -> str:
        p = self.p
        if self.texts == "shared":
            self.strings.append(value)
            return f'<{p}c{where} t="s"><{p}v>{len(self.strings) - 1}</{p}v></{p}c>'
        if self.texts == "inline":
            return f'<{p}c{where} t="inlineStr"><{p}is><{p}t>{_text(value)}</{p}t></{p}is></{p}c>'
        runs = f"<{p}r><{p}rPr/><{p}t>{_text(value[:1])}</{p}t></{p}r><{p}r><{p}t>{_text(value[1:])}</{p}t></{p}r>"
        return f'<{p}c{where} t="inlineStr"><{p}is>{runs}</{p}is></{p}c>'


def libre_office() -> Dialect:
    """LibreOffice: a `aca` mark on formulas, three marks on names, numbers with t="n"."""
    dialect = Dialect()
    dialect.extra, dialect.formula = 'function="false" hidden="false" vbProcedure="false"', ' aca="false"'
    return dialect


def strict() -> Dialect:
    """Excel's "Strict Open XML Spreadsheet": the same words in other namespaces."""
    dialect = Dialect()
    dialect.main, dialect.office = STRICT_MAIN, f"{STRICT_OFFICE}/relationships"
    return dialect


def matrix() -> dict[str, Callable[[], Dialect]]:
    """Every combination of where texts stand, whether cells say where they are, how paths go, and prefixes."""
    dialects = {}
    for texts, refs, absolute, prefix in product(("shared", "inline", "rich"), (True, False), (True, False), ("", "x")):
        name = f"{texts} strings, {'' if refs else 'no '}refs, {'absolute' if absolute else 'relative'}, '{prefix}'"
        dialects[name] = functools.partial(Dialect, texts, refs, absolute, prefix)
    return dialects


DIALECTS: dict[str, Callable[[], Dialect]] = {**matrix(), "LibreOffice": libre_office, "Excel, strict": strict}
