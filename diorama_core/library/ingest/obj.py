"""OBJ and MTL as programs write them: indices that count back, options of maps, names of another system."""

from __future__ import annotations

import re

from diorama_core.errors import LibraryError

_COUNTS = {b"v": 0, b"vt": 1, b"vn": 2}
_NEGATIVE = re.compile(rb"^[ \t]*[fl][ \t].*-\d", re.MULTILINE)
_OPTIONS = {
    "-blendu": 1, "-blendv": 1, "-boost": 1, "-mm": 2, "-o": 3, "-s": 3, "-t": 3, "-texres": 1, "-clamp": 1, "-bm": 1,
    "-imfchan": 1, "-type": 1, "-cc": 1, "-colorspace": 1,
}  # fmt: skip
"""Options of a map and how many values they take at most."""
_MAPS = re.compile(r"^\s*(map_\w+|bump|disp|norm|refl)\s+(.*)$", re.IGNORECASE)


def absolute_indices(obj: bytes) -> bytes:
    """An OBJ whose faces count from the file's beginning; as it was where none counts back.

    Raises:
        LibraryError: a face names a vertex before the first.
    """
    if _NEGATIVE.search(obj) is None:
        return obj
    counts = [0, 0, 0]
    lines = obj.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").split(b"\n")
    for number, line in enumerate(lines):
        words = line.split()
        if not words:
            continue
        if words[0] in _COUNTS:
            counts[_COUNTS[words[0]]] += 1
        elif words[0] in (b"f", b"l") and b"-" in line:
            lines[number] = b" ".join([words[0], *(_absolute(word, counts) for word in words[1:])])
    return b"\n".join(lines)


def _absolute(corner: bytes, counts: list[int]) -> bytes:
    lines = []
    for index, count in zip(corner.split(b"/"), counts, strict=False):
        if index.startswith(b"-"):
            try:
                number = count + 1 + int(index)
            except ValueError as error:
                raise LibraryError("a face of the OBJ has a corner that is no number; export it again") from error
            if number < 1:
                raise LibraryError("a face of the OBJ counts back before the first vertex; export it again")
            index = str(number).encode()
        lines.append(index)
    return b"/".join(lines)


def plain_mtl(mtl: bytes) -> bytes:
    """An MTL whose maps are plain names; how often a picture of colour repeats becomes an entry `uv_scale`."""
    lines = []
    for line in mtl.decode("utf-8", "replace").splitlines():
        match = _MAPS.match(line)
        if match is None:
            lines.append(line)
            continue
        name, scale = _without_options(match[2])
        lines.append(f"{match[1]} {name}")
        if match[1].lower() == "map_kd" and scale is not None:
            lines.append("uv_scale " + " ".join(f"{v:g}" for v in scale))
    return "\n".join(lines).encode()


def _without_options(text: str) -> tuple[str, tuple[float, float] | None]:
    """The name in a map's line, which may have blanks, and its `-s` along u and v."""
    words, scale = text.split(" "), None
    while words and (not words[0] or words[0].lower() in _OPTIONS):
        option = words.pop(0).lower()
        values: list[str] = []
        while option and words and len(values) < _OPTIONS[option] and (option not in _NUMERIC or _is_number(words[0])):
            values.append(words.pop(0))
        if option == "-s" and values:
            u = float(values[0])
            scale = (u, float(values[1]) if len(values) > 1 else u)
    return " ".join(words).strip().strip('"'), scale


_NUMERIC = ("-o", "-s", "-t", "-mm", "-bm", "-boost", "-texres")
"""Options whose values are numbers, of which the last may be left out."""


def _is_number(word: str) -> bool:
    try:
        return abs(float(word)) < 1e6
    except ValueError:
        return False
