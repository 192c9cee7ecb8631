"""Damage to samples: bytes as a disk or a network spoils them, and values as somebody writes them wrongly."""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Callable
from typing import Any

import numpy as np

Random = np.random.Generator
Mutate = Callable[[bytes, Random], bytes]

STRANGE: tuple[Any, ...] = (
    None,
    True,
    -1,
    0,
    10**400,
    2**63,
    1e308,
    -1e308,
    5e-324,
    float("nan"),
    float("inf"),
    "",
    "x" * 5000,
    "\ud800",
    "\x00",
    "<img src=x onerror=alert(1)>",
    "../../etc/passwd",
    [],
    {},
    [[]],
    [None],
    {"array": -1},
    {"class": "Scene", "fields": {}},
)
MAGIC = (
    b"",
    b"\0",
    b"\xff\xfe",
    b"PK\x03\x04",
    b"%!PS-Adobe-3.0 EPSF-3.0\n",
    b"\x89PNG\r\n\x1a\n",
    b"glTF",
    b"[" * 5000,
)


def damaged(data: bytes, random: Random) -> bytes:
    """A few bytes changed, cut, doubled, or replaced by the beginning of another format."""
    out = bytearray(data)
    for _ in range(int(random.integers(1, 6))):
        at = int(random.integers(0, len(out) + 1))
        kind = int(random.integers(0, 7))
        if kind == 0 and at < len(out):
            out[at] ^= 1 << int(random.integers(0, 8))
        elif kind == 1 and at < len(out):
            out[at] = int(random.choice([0, 1, 0x7F, 0x80, 0xFF]))
        elif kind == 2:
            del out[at : at + int(random.integers(1, 200))]
        elif kind == 3:
            out[at:at] = out[at : at + int(random.integers(1, 200))]
        elif kind == 4:
            out[at : at + 4] = int(random.choice([0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF])).to_bytes(4, "little")
        elif kind == 5:
            out[at:at] = MAGIC[int(random.integers(0, len(MAGIC)))]
        else:
            del out[int(random.integers(0, len(out) + 1)) :]
    return bytes(out)


def strange_json(data: bytes, random: Random) -> bytes:
    """JSON with values replaced, left out, doubled or renamed; sometimes no JSON any more."""
    if random.integers(0, 5) == 0:
        return damaged(data, random)
    value = json.loads(data)
    for _ in range(int(random.integers(1, 4))):
        value = _strange(value, random)
    return json.dumps(value).encode()


def _strange(value: Any, random: Random, depth: int = 0) -> Any:
    if depth > 12 or not isinstance(value, (dict, list)) or not value or random.integers(0, 8) == 0:
        if isinstance(value, (int, float)) and abs(value) < 1e300 and random.integers(0, 2):
            return value * float(random.choice([-1.0, 0.0, 1e-9, 1e9, 1.0 + 1e-7]))
        return STRANGE[int(random.integers(0, len(STRANGE)))]
    if isinstance(value, dict):
        key = list(value)[int(random.integers(0, len(value)))]
        kind = int(random.integers(0, 8))
        if kind == 0:
            return {k: v for k, v in value.items() if k != key}
        if kind == 1:
            return {**value, "surprise": value[key]}
        return {**value, key: _strange(value[key], random, depth + 1)}
    at = int(random.integers(0, len(value)))
    kind = int(random.integers(0, 8))
    if kind == 0:
        return value[:at] + value[at + 1 :]
    if kind == 1:
        return [*value, value[at]]
    return [*value[:at], _strange(value[at], random, depth + 1), *value[at + 1 :]]


def strange_zip(data: bytes, random: Random) -> bytes:
    """An archive that is damaged, or whole with other content in it."""
    if random.integers(0, 3) == 0:
        return damaged(data, random)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    name = list(entries)[int(random.integers(0, len(entries)))]
    kind = int(random.integers(0, 6))
    if kind == 0:
        del entries[name]
    elif kind == 1:
        entries["surprise"] = entries[name]
    elif name.endswith(".json"):
        entries[name] = strange_json(entries[name], random)
    else:
        entries[name] = damaged(entries[name], random)
    buffer = io.BytesIO()
    packing = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)[
        int(random.integers(0, 4))
    ]
    with zipfile.ZipFile(buffer, "w", packing) as archive:
        for entry, content in entries.items():
            archive.writestr(entry, content)
    return buffer.getvalue()


def strange_glb(data: bytes, random: Random) -> bytes:
    """A GLB that is damaged, or whole with a strange document in it."""
    if random.integers(0, 2) == 0 or data[:4] != b"glTF":
        return damaged(data, random)
    length = int.from_bytes(data[12:16], "little")
    document, rest = strange_json(data[20 : 20 + length], random), data[20 + length :]
    document += b" " * (-len(document) % 4)
    total = 20 + len(document) + len(rest)
    return (
        b"glTF"
        + (2).to_bytes(4, "little")
        + total.to_bytes(4, "little")
        + len(document).to_bytes(4, "little")
        + b"JSON"
        + document
        + rest
    )


NUMBERS = (b"-1", b"0", b"1e308", b"-1e308", b"5e-324", b"nan", b"inf", b"9223372036854775807", b"1e9", b"0.000001")
WORDS = (b'""', b'"\\ud800"', b'"' + b"x" * 5000 + b'"', b"@../../outside.usda@", b"None", b"[]", b"</Scene>")


def strange_usd(data: bytes, random: Random) -> bytes:
    """USD that is damaged, or text of it with other numbers and words in it."""
    if random.integers(0, 3) == 0 or data[:5] != b"#usda":
        return damaged(data, random)
    for _ in range(int(random.integers(1, 4))):
        number = bool(random.integers(0, 2))
        found = list(re.finditer(rb"-?\d+(?:\.\d+)?(?:e-?\d+)?" if number else rb'"[^"\n]*"|@[^@\n]*@|<[^>\n]*>', data))
        if found:
            place = found[int(random.integers(0, len(found)))]
            choices = NUMBERS if number else WORDS
            data = data[: place.start()] + choices[int(random.integers(0, len(choices)))] + data[place.end() :]
    return data
