"""Boxes as text, one a line: YOLO, tables with a header (CSV), KITTI, and a word with four numbers."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from typing import Any

from diorama_core.errors import InputError
from diorama_core.io.bounded import parse_json
from diorama_core.perception.inputs.boxes.entry import (
    UNNAMED,
    BoxEntry,
    BoxFile,
    BoxText,
    Corners,
    Layout,
    entries_of,
    from_layout,
    rows_of_picture,
)
from diorama_core.perception.inputs.boxes.nested import (
    PICTURE_FILE,
    box_numbers,
    box_of,
    numbers,
    score_of,
    size_in,
    word_of,
)
from diorama_core.perception.inputs.source import Source

_NAME_FILES = (
    "classes.txt", "obj.names", "*.names", "labels.txt", "data.yaml", "*.yaml", "../data.yaml", "../classes.txt",
    "../*.yaml", "../../data.yaml", "../../classes.txt", "../../*.yaml",
)  # fmt: skip
_YAML_NAMES = re.compile(
    r"^names\s*:\s*(?:\[(?P<flow>[^\]]*)\]|\{(?P<map>[^}]*)\}|\n(?P<block>(?:[ \t-].*(?:\n|$))+))", re.MULTILINE
)
_KITTI_WORDS = 15
_PICTURE_COLUMN = r"(?:image|file|picture|photo)?_?(?:name|id|path|file)|image|filename|external_id"
_PARTS = ("TRAIN", "VALIDATE", "VALIDATION", "TEST", "UNASSIGNED")
"""First word of a line of a data set."""


def is_yolo(text: BoxText) -> bool:
    """Lines of a class number and shares of the picture: middle and size, with a confidence, or a polygon."""
    rows = _rows(text)
    return bool(rows) and all(_is_yolo_row(r) for r in rows)


def read_yolo(text: BoxText) -> BoxFile:
    """Boxes in shares of the picture, with the names of the list of classes beside the file."""
    boxes, names = [], _class_names(text.source)
    for index, row in enumerate(_rows(text)):
        values = [float(v) for v in row[1:]]
        where = f"{text.source.name}: line {index + 1}"
        if len(values) >= 6 and len(values) % 2 == 0:
            corners: Corners | None = box_of({"points": values}, where)
        else:
            corners = from_layout(numbers(values[:4], where), "centred")
        score = values[4] if len(values) == 5 else 1.0
        word = names.get(int(float(row[0])), UNNAMED)
        boxes.append((corners, word, min(max(score, 0.0), 1.0)))
    note = f"{text.source.name} is in YOLO's form; its class numbers need their names: put classes.txt beside it"
    return BoxFile(entries_of(boxes), unit="shares", notes=() if names else (note,))


def is_table(text: BoxText) -> bool:
    """A header that names the columns of a box, and rows under it."""
    rows = _table(text)
    return bool(rows) and _table_box(rows[0]) is not None


def read_table(text: BoxText) -> BoxFile:
    """Rows of the photo, where a column names pictures."""
    rows = _table(text)
    pictures = next((k for k in rows[0] if re.fullmatch(_PICTURE_COLUMN, k.lower())), None)
    if pictures is not None:
        rows = rows_of_picture(((row[pictures], row) for row in rows), text, "table")
    entries = []
    for index, row in enumerate(rows):
        values, layout = _table_box(row) or ((0,), "corners")
        corners = from_layout(numbers(values, f"{text.source.name}: row {index + 1}"), layout)
        entries.append(BoxEntry(corners, word_of({**row, **_values_in(row)}), score_of(_values_in(row))))
    # The width of a picture is a column of its own only where the box has corners.
    size = size_in(_values_in(rows[0])) if rows and "xmin" in "".join(rows[0]).lower() else None
    return BoxFile(tuple(entries), size)


def is_words(text: BoxText) -> bool:
    """Lines of a word and four numbers, or KITTI's fifteen columns."""
    rows = _rows(text)
    return bool(rows) and all(_split_words(r) is not None for r in rows)


def read_words(text: BoxText) -> BoxFile:
    """A word, perhaps a score, and four numbers a line."""
    named: list[tuple[str, tuple[Corners | None, str, float]]] = []
    for index, row in enumerate(_rows(text)):
        pair, where = _split_words(row), f"{text.source.name}: line {index + 1}"
        if pair is None:
            continue
        words, values = pair
        picture = next((w for w in words if PICTURE_FILE.search(w)), "")
        word = " ".join(w for w in words if w != picture and w not in _PARTS) or UNNAMED
        corners = box_of({"points": [float(v) for v in values]}, where) if len(values) == 8 else numbers(values, where)
        named.append((picture, (corners, word, 1.0)))
    return BoxFile(entries_of(rows_of_picture(named, text, "list")), ambiguous_layout=True)


def _rows(text: BoxText) -> list[list[str]]:
    if not isinstance(text.document, str):
        return []
    lines = [line.strip() for line in text.document.splitlines()]
    skipped = ("#", "imagesource:", "gsd:")  # comments, and the head of DOTA's files
    return [[v for v in re.split(r"[\s,;]+", line) if v] for line in lines if line and not line.startswith(skipped)]


def _is_yolo_row(row: list[str]) -> bool:
    values = [_number(v) for v in row]
    if len(values) < 5 or any(v is None for v in values):
        return False
    number, *shares = values
    whole = number is not None and number == int(number) and number >= 0
    return whole and (len(shares) in (4, 5) or len(shares) % 2 == 0) and all(-0.1 <= (v or 0.0) <= 1.1 for v in shares)


def _split_words(row: list[str]) -> tuple[list[str], list[str]] | None:
    """The words and the four numbers of a line, or the eight of four corners."""
    values = [v for v in row if _number(v) is not None]
    words = [v.strip("\"'") for v in row if _number(v) is None]
    if len(row) in (_KITTI_WORDS, _KITTI_WORDS + 1) and len(words) == 1 and _number(row[0]) is None:
        return row[:1], row[4:8]
    if words and len(values) in (8, 9) and all(_number(v) is not None for v in row[:8]):
        return words, values[:8]  # DOTA's
    if not words or len(values) not in (4, 5):
        return None
    return words, values[-4:] if _number(row[0]) is None else values[:4]


def _table(text: BoxText) -> list[dict[str, str]]:
    if not isinstance(text.document, str):
        return []
    try:
        first = text.document.split("\n", 1)[0]
        delimiter = max(",;\t", key=first.count)
        rows = csv.DictReader(text.document.splitlines(), delimiter=delimiter)
        return [{str(k).strip(): str(v).strip() for k, v in row.items() if k is not None} for row in rows]
    except csv.Error:
        return []


def _table_box(row: dict[str, str]) -> tuple[Sequence[float], Layout] | None:
    try:
        box = box_numbers(_values_in(row), "")
    except Exception:  # a cell holds no number; the reader says which
        return None
    return None if box is None else box[:2]


def _values_in(row: dict[str, str]) -> dict[str, Any]:
    """The cells that hold a number, or an object of JSON as in VIA's tables."""
    values: dict[str, Any] = {k: number for k, v in row.items() if (number := _number(v)) is not None}
    for key, cell in row.items():
        if cell.startswith("{"):
            try:
                values[key] = parse_json(cell.encode(), key, InputError)
            except InputError:
                continue
    return values


def _number(word: str) -> float | None:
    try:
        value = float(word)
    except ValueError:
        return None
    return value if abs(value) < 1e9 else None


def _class_names(source: Source) -> dict[int, str]:
    """Names of class numbers: a line each, or the `names` of a YAML file."""
    for file in source.sibling_files(*_NAME_FILES):
        content = file.data[:200_000].decode("utf-8", "replace")
        names = _yaml_names(content) if file.suffix in (".yaml", ".yml") else dict(enumerate(content.split("\n")))
        names = {k: v.strip()[:200] for k, v in names.items() if v.strip()}
        if names:
            return names
    return {}


def _yaml_names(content: str) -> dict[int, str]:
    match = _YAML_NAMES.search(content)
    if match is None:
        return {}
    if match["flow"] is not None:
        return dict(enumerate(v.strip(" \n\"'") for v in match["flow"].split(",")))
    rows = match["map"].split(",") if match["map"] is not None else match["block"].splitlines()
    names = {}
    for index, row in enumerate(rows):
        numbered = re.match(r"\s*(\d+)\s*:\s*(.*)", row)
        names[int(numbered[1]) if numbered else index] = (numbered[2] if numbered else row).strip(" -\"'")
    return names
