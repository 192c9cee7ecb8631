from __future__ import annotations

import pytest

from diorama_core.pipeline.findings import finding
from tests.app.small_room import furnished_scene


class Room:
    architecture = furnished_scene().architecture


@pytest.mark.unchecked
@pytest.mark.parametrize(
    ("name", "artefact", "words"),
    [
        ("outlined_objects", [1], "1 object"),
        ("detected_boxes", [1, 2], "2 pieces of furniture"),
        ("shapes", [1, 2, 3], "shapes for 3 objects"),
        ("architecture", Room(), "4 walls"),
        ("architecture", None, ""),
        ("posed", [1], ""),
    ],
)
def test_what_was_found_is_told_in_a_few_words(name: str, artefact: object, words: str) -> None:
    assert finding(name, artefact) == words
