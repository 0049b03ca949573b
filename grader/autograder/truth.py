"""What the container knows: the keys of the class, and whose each is by a hash of the address.

The hash is keyed with a number that is derived from the course's secret; the secret itself, with which all other
numbers are drawn, does not leave the instructor's machine, and no name and no address is in the file.
"""

from __future__ import annotations

import datetime as dt
import hashlib
import hmac
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from assignments import key as keys
from assignments.model import AnswerKey
from assignments.terms import Late, Terms

_DATES = ("opens", "due", "closes")


@dataclass(frozen=True)
class Held:
    """One student's variant: pseudonym, key, the signature of its workbook, and the terms of handing in."""

    pid: str
    key: AnswerKey
    signature: str
    terms: Terms


@dataclass(frozen=True)
class Truth:
    """Everything that is held back from students.

    Attributes
    ----------
    salt : bytes
        What addresses are hashed with.
    people : mapping of str to str
        Pseudonyms by hash of the address.
    held : mapping of str to Held
        By pseudonym.
    """

    salt: bytes
    people: Mapping[str, str]
    held: Mapping[str, Held]

    def of_address(self, email: str) -> Held | None:
        """Return the variant of whoever has this address, in any case."""
        return self.held.get(self.people.get(hashed(self.salt, email), ""))

    def of_code(self, code: str, signature: str) -> Held | None:
        """Return the variant that a workbook was handed out with, None where it is not this course's."""
        found = next((one for one in self.held.values() if one.key.code == code), None)
        is_ours = found is not None and hmac.compare_digest(found.signature.encode(), signature.encode())
        return found if is_ours else None


def hashed(salt: bytes, email: str) -> str:
    """Return the hash of an address, the same in any case.

    >>> hashed(b"salt", " Jane@X.edu") == hashed(b"salt", "jane@x.EDU")
    True
    """
    return hmac.new(salt, email.strip().casefold().encode(), hashlib.sha256).hexdigest()


def to_bytes(salt: bytes, people: Mapping[str, str], held: Iterable[Held]) -> bytes:
    """Return the file that is packed; `people` are pseudonyms by address."""
    content = {
        "salt": salt.hex(),
        "people": {hashed(salt, email): pid for email, pid in people.items()},
        "held": [
            {"pid": one.pid, "signature": one.signature, "terms": asdict(one.terms), "key": keys.to_json(one.key)}
            for one in held
        ],
    }
    return json.dumps(content, sort_keys=True, default=dt.datetime.isoformat).encode()


def from_bytes(data: bytes) -> Truth:
    """Return what `to_bytes` wrote."""
    content = json.loads(data)
    held = (
        Held(one["pid"], keys.from_json(one["key"]), one["signature"], _terms(one["terms"])) for one in content["held"]
    )
    return Truth(bytes.fromhex(content["salt"]), content["people"], {one.pid: one for one in held})


def _terms(content: Mapping[str, Any]) -> Terms:
    dates = {name: content[name] and dt.datetime.fromisoformat(content[name]) for name in _DATES}
    late = Late(**{**content["late"], "steps": tuple(map(tuple, content["late"]["steps"]))})
    return Terms(**{**content, **dates, "late": late})
