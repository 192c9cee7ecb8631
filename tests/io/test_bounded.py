from __future__ import annotations

import ast
import io
import json
import os
import warnings
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from jaxtyping import Float32
from PIL import Image

import diorama_app
import diorama_core
from diorama_core.errors import InputError
from diorama_core.io.bounded import (
    MAX_JSON_DEPTH,
    as_member,
    fits,
    megabytes,
    parse_json,
    picture_of,
    read_bytes,
    read_json,
    read_picture,
    shorten,
)


def png(width: int = 6, height: int = 4) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(np.full((height, width, 3), 90, np.uint8)).save(buffer, "PNG")
    return buffer.getvalue()


def test_files_are_read_up_to_the_bound(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"x" * 10)
    assert read_bytes(path, 10, InputError) == b"x" * 10
    with pytest.raises(InputError, match="has more than the"):
        read_bytes(path, 9, InputError)


def test_what_is_no_file_is_refused_without_waiting(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path, reason in (
        (tmp_path, "is not a file|cannot be read"),
        (tmp_path / "pipe", "is not a file"),
        (tmp_path / "gone", "cannot be read"),
        (tmp_path / "a\0b", "cannot be read"),
    ):
        with pytest.raises(InputError, match=f"({reason}).*; use the copy"):
            read_bytes(path, 100, InputError, "use the copy")


values = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(st.characters(exclude_categories=("Cs",)), max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text("ab{[\"\\", max_size=4), inner, max_size=4),
    max_leaves=30,
)  # fmt: skip


@given(values)
def test_json_comes_back_as_it_was_written(value) -> None:
    assert parse_json(json.dumps(value), "x", InputError) == value


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", r"is not valid JSON \(line 1"),
        ("NaN", "NaN is no number"),
        ("[-Infinity]", "is no number"),
        ("1e999", "too large"),
        (f"[{10**400}]", "too large"),
        (b"\xff\xfe", "no text"),
        (r'"\ud800"', "no text"),
        ("[" * (MAX_JSON_DEPTH + 1) + "]" * (MAX_JSON_DEPTH + 1), "levels deep"),
        ('[{"a":' * MAX_JSON_DEPTH + "1" + "}]" * MAX_JSON_DEPTH, "levels deep"),
    ],
)
def test_json_that_cannot_be_written_back_is_refused(text, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        parse_json(text, "scene.json", InputError)


def test_brackets_in_strings_are_no_levels_and_infinity_may_be_allowed(tmp_path: Path) -> None:
    assert parse_json("[" * MAX_JSON_DEPTH + "]" * MAX_JSON_DEPTH, "x", InputError)
    assert parse_json(json.dumps([[]] * 100), "x", InputError) == [[]] * 100
    deep = ["[" * 500, '\\"[' * 100]
    assert parse_json(json.dumps(deep), "x", InputError) == deep
    assert parse_json("[1e999, Infinity]", "x", InputError, finite=False) == [float("inf")] * 2
    (tmp_path / "a.json").write_text("\ufeff[1]")
    assert read_json(tmp_path / "a.json", InputError) == [1]


def test_pictures_are_judged_before_they_are_decoded(tmp_path: Path) -> None:
    assert picture_of(png(), "x", InputError).shape == (4, 6, 3)
    with pytest.raises(InputError, match="6 x 4 pixels are more than"):
        picture_of(png(), "x", InputError, most_pixels=23)
    assert picture_of(png(), "x", InputError, most_pixels=24).shape == (4, 6, 3)
    with pytest.raises(InputError, match="is not a whole picture"):
        picture_of(png()[:50], "x", InputError)
    with pytest.raises(InputError, match=r"not a whole picture \(JPEG\)"):
        picture_of(png(), "x", InputError, formats=("JPEG",))
    (tmp_path / "a.png").write_bytes(png(8, 2))
    assert read_picture(tmp_path / "a.png", InputError).shape == (2, 8, 3)


def test_the_decoders_own_bounds_are_one_line_or_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 20)  # it warns above, and refuses above twice as many
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert picture_of(png(6, 4), "x", InputError).shape == (4, 6, 3)
    with pytest.raises(InputError, match="x: more pixels than are read"):
        picture_of(png(7, 6), "x", InputError)


def test_a_jpeg_may_be_decoded_smaller_but_never_below_what_is_wanted() -> None:
    buffer = io.BytesIO()
    Image.fromarray(np.full((400, 800, 3), 90, np.uint8)).save(buffer, "JPEG")
    found = picture_of(buffer.getvalue(), "x", InputError, within=(150, 100))
    assert found.shape[0] < 400
    assert found.shape[1] >= 150
    assert found.shape[0] >= 100


def test_messages_are_one_short_line() -> None:
    assert shorten("a\nb\x1b[31m \ud800") == "a b[31m ?"
    assert len(shorten("x" * 500)) == 200
    assert shorten("x" * 200) == "x" * 200
    assert megabytes(64_000_000) == "64 MB"
    assert (megabytes(100_000), megabytes(99_000)) == ("0.1 MB", "99 kB")
    assert megabytes(1_500) == "1.5 kB"


def test_every_picture_is_opened_with_the_formats_that_it_may_have() -> None:
    packages = [Path(module.__file__).parent for module in (diorama_core, diorama_app) if module.__file__]
    opened = 0
    for source in (file for package in packages for file in package.rglob("*.py")):
        if "Image.open" not in (text := source.read_text()):
            continue
        for call in ast.walk(ast.parse(text)):
            if isinstance(call, ast.Call) and ast.unparse(call.func) in ("Image.open", "PIL.Image.open"):
                opened += 1
                assert "formats" in {keyword.arg for keyword in call.keywords}, f"{source.name}, line {call.lineno}"
    assert opened >= 8


@dataclass(frozen=True)
class Leaf:
    name: str
    share: float = 0.5


@dataclass(frozen=True)
class Tree:
    leaves: tuple[Leaf, ...]
    kind: Literal["oak", "ash"]
    depth: Float32[np.ndarray, "h w"] | None = None


DEPTH = np.zeros((2, 3), np.float32)
GOOD = Tree((Leaf("a"),), "oak", DEPTH)


@pytest.mark.parametrize(
    ("value", "annotation"),
    [
        (3, int), (3, float), (2.5, float), ("x", str), (None, None), (None, str | None), ("x", str | None),
        ((1, "a"), tuple[int, str]), ((1, 2, 3), tuple[int, ...]), ((), tuple[int, ...]), ((1, "a"), tuple),
        ({"a": 1}, dict[str, int]), (object(), Any), ("oak", Literal["oak"]), (DEPTH, Float32[np.ndarray, "h w"]),
        (GOOD, Tree), (Tree((), "ash"), Tree),
    ],
)  # fmt: skip
def test_values_of_their_type_fit(value, annotation) -> None:
    assert fits(value, annotation)


@pytest.mark.parametrize(
    ("value", "annotation"),
    [
        (True, int), (True, float), (2.5, int), (float("nan"), float), (float("inf"), float), ("3", int), (None, str),
        ((1,), tuple[int, str]), ((1, 2), tuple[int, str]), ([1], tuple[int, ...]), ((1, "a"), tuple[int, ...]),
        ({1: 1}, dict[str, int]), ({"a": "b"}, dict[str, int]), ([], dict[str, int]), ("elm", Literal["oak"]),
        (DEPTH[0], Float32[np.ndarray, "h w"]), (DEPTH.astype(float), Float32[np.ndarray, "h w"]),
        (np.full((2, 3), np.nan, np.float32), Float32[np.ndarray, "h w"]),
        (Tree((Leaf(3),), "oak"), Tree), (Tree((), "elm"), Tree), (Tree([], "oak"), Tree), (Leaf("a"), Tree),
    ],
)  # fmt: skip
def test_others_do_not(value, annotation) -> None:
    assert not fits(value, annotation)


class Wood(StrEnum):
    OAK = "oak"


def test_strings_become_the_members_that_are_asked_for_and_nothing_else_changes() -> None:
    assert as_member("oak", Wood) is Wood.OAK
    with pytest.raises(ValueError, match="elm"):
        as_member("elm", Wood)
    for value, annotation in ((5, Wood), ("oak", str), ("oak", Literal["oak"]), ("oak", None), (GOOD, Tree)):
        assert as_member(value, annotation) is value
