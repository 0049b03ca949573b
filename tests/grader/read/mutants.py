"""Workbooks with something broken in them: bytes of the archive, or markup of a part, seeded."""

from __future__ import annotations

import random
import re
import zipfile
from collections.abc import Iterator

import corpus

TOKENS = [
    *(b"", b"<", b">", b'"', b"/", b"&#0;", b"&#xFFFF;", b"&amp;", b"&x;", b"]]>", b"<!--", b"<![CDATA[", b"<?x?>"),
    *(b"<c>", b"</c>", b"<c r='A1'>", b"<row r='-1'>", b"<row r='99999999'>", b"<f>", b"<v>", b"</v>", b"<is><t>"),
    *(b"-1", b"1e999", b"nan", b"99999999999999999999", b"0x1", b"A1", b"XFD1048576", b"AAAA1", b"$A$1", b"#REF!"),
    *(b' t="s"', b' t="e"', b' t="d"', b' t="zzz"', b' s="9999999"', b' r=""', b" xmlns='x'", b"\xff", b"\x00"),
    *(b"\xef\xbb\xbf", b"\xff\xfe", b"encoding='utf-16'", b"encoding='latin-1'", b"standalone='yes'", b"..//..", b"\\"),
]


def mutants(good: bytes, count: int, seed: int) -> Iterator[bytes]:
    """Yield `count` broken copies: bytes, lengths, markup, whole parts."""
    rng = random.Random(seed)  # noqa: S311 - no secret
    parts = corpus.members(good)
    kinds = [_bytes, _cut, _markup, _markup, _markup, _parts, _headers]
    for _ in range(count):
        yield rng.choice(kinds)(good, parts, rng)


def _bytes(good: bytes, _: dict[str, bytes], rng: random.Random) -> bytes:
    data = bytearray(good)
    for _ in range(rng.randint(1, 8)):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


def _headers(good: bytes, _: dict[str, bytes], rng: random.Random) -> bytes:
    """Bytes of the headers alone: sizes, offsets, methods, flags, names."""
    data = bytearray(good)
    for _ in range(rng.randint(1, 3)):
        mark = rng.choice([b"PK\x01\x02", b"PK\x03\x04", b"PK\x05\x06"])
        places = [found.start() for found in re.finditer(mark, good[:-50])] or [0]
        data[rng.choice(places) + rng.randrange(4, 48)] = rng.choice([0, 1, 8, 127, 255, rng.randrange(256)])
    return bytes(data)


def _cut(good: bytes, _: dict[str, bytes], rng: random.Random) -> bytes:
    start, end = sorted(rng.randrange(len(good)) for _ in range(2))
    piece = good[start:end]
    return rng.choice([good[:start], good[end:], good[:start] + good[end:], good[:end] + piece + good[end:], piece])


def _markup(_: bytes, parts: dict[str, bytes], rng: random.Random) -> bytes:
    name = rng.choice([name for name in parts if name.endswith((".xml", ".rels"))])
    content = parts[name]
    for _ in range(rng.randint(1, 5)):
        at = rng.randrange(len(content) + 1)
        content = content[:at] + rng.choice(TOKENS) * rng.choice([1, 1, 1, 50]) + content[at + rng.randrange(14) :]
    return corpus.pack({**parts, name: content}, zipfile.ZIP_STORED)


def _parts(_: bytes, parts: dict[str, bytes], rng: random.Random) -> bytes:
    changed = dict(parts)
    one, other = rng.choice(list(parts)), rng.choice(list(parts))
    changed[one] = rng.choice([b"", b"<a/>", parts[other], parts[one][: len(parts[one]) // 2]])
    if rng.random() < 0.3:
        changed.pop(other, None)
    return corpus.pack(changed, zipfile.ZIP_STORED)
