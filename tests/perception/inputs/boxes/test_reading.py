"""Boxes, each rule by itself, then whole files as people hand them in."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import InputError
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.boxes.nested import word_of
from diorama_core.perception.inputs.boxes.reading import read_boxes, understand_word
from diorama_core.perception.inputs.source import Source
from tests.perception.inputs.files import HEIGHT, WIDTH, box, boxes_json, decoded, encoded, picture, refusal


def test_parts_of_the_room_are_left_out_and_far_boxes_clipped_with_a_note() -> None:
    given = boxes_json(box(0, 0, 90, 60, word="wall"), box(-30, 5, 40, 200, word="night_stand"))
    found, notes = read_boxes(Source(given, "boxes.json"), decoded())
    assert [b.box for b in found] == [(0, 5, 40, 64)]
    assert found[0].label == "night stand"
    assert "part of the room itself" in notes[0]
    assert "was clipped" in notes[1]


def test_unknown_words_are_understood_as_the_nearest_and_said() -> None:
    category, label, note = understand_word("armchiar")
    assert (category, label) == ("armchair", "armchiar")
    assert "armchair" in note
    assert understand_word("object")[1:] == ("object", "")


class TestBoxes:
    photo = encoded(picture())

    def test_classes_are_understood_and_words_retained(self) -> None:
        given = boxes_json(
            box(1, 1, 20, 20, word="night_stand"),
            box(1, 1, 20, 20, word="couches"),
            box(1, 1, 20, 20, word="void"),
            box(1, 1, 20, 20, word="zorgblatt"),
        )
        read = read_inputs(self.photo, boxes=given)
        assert [b.category for b in read.inputs.boxes] == ["night stand", "sofa", "object", "object"]
        assert [b.label for b in read.inputs.boxes] == ["night stand", "couches", "object", "zorgblatt"]
        assert any("zorgblatt" in w for w in read.warnings)

    def test_a_pixel_over_the_edge_is_not_worth_a_word(self) -> None:
        assert read_inputs(self.photo, boxes=boxes_json(box(0, 0, WIDTH + 1, 20))).warnings == ()

    @pytest.mark.parametrize(
        ("data", "word"),
        [
            (boxes_json(box(1, 1, 20, 20), box(200, 10, 300, 40)), "box 1"),
            (boxes_json(box(200, 10, 300, 40)), "outside the picture"),
            (boxes_json(box(20, 1, 5, 20)), "box 0"),
            (boxes_json(box(5, 5, 5, 5)), "no area"),
            (b"[{", "boxes are a JSON list"),
            (b"[{", "not valid JSON"),
            (b"", "0 bytes"),
            (b"\xff\xfe\x00", "no text"),
            (b'{"bbox": [1, 2, 3, 4]}', "list"),
            (boxes_json({"bbox": [1, 2, 3]}), "entry 0"),
            (boxes_json({"bbox": [1, 2, 3, "x"]}), "entry 0"),
            (boxes_json({"class": "chair"}), "entry 0"),
            (b'[{"bbox": [NaN, 1, 20, 20]}]', "NaN is no number"),
            (b'[{"bbox": [1e999, 1, 20, 20]}]', "too large"),
            (b'[{"bbox": [1e30, 1, 20, 20]}]', "entry 0"),
            (b'[{"bbox": [1, 1, 20, 20], "class": "\\ud800"}]', "no text"),
            (b"[" * 100_000, "nested"),
            (b"[" + b"1," * 3_000_000 + b"1]", "more than 500 boxes take"),
            (boxes_json(*[box(1, 1, 20, 20)] * 501), "501"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(self.photo, boxes=data)

    def test_words_cannot_break_a_line(self) -> None:
        read = read_inputs(self.photo, boxes=boxes_json(box(1, 1, 20, 20, word="  big\n\tred\x00 chair ")))
        assert read.inputs.boxes[0].label == "big red chair"

    @given(st.lists(st.floats(-500, 500), min_size=4, max_size=4))
    def test_every_box_is_inside_or_refused(self, bbox: list[float]) -> None:
        try:
            boxes = read_inputs(self.photo, boxes=boxes_json(box(*bbox))).inputs.boxes
        except InputError:
            return
        x1, y1, x2, y2 = boxes[0].box
        assert 0 <= x1 < x2 <= WIDTH
        assert 0 <= y1 < y2 <= HEIGHT


@pytest.mark.parametrize(
    ("entry", "word"),
    [({"class": "box"}, "box"), ({"label": "Box", "type": "rectangle"}, "Box"), ({"type": "box"}, "object")],
)
def test_a_box_is_a_box_but_not_as_the_type_of_a_figure(entry: dict[str, str], word: str) -> None:
    assert word_of(entry) == word
