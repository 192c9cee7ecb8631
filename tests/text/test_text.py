from __future__ import annotations

import base64
import io
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from diorama_core.errors import InputError, UnavailableError
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.support import check_scene
from diorama_core.text.compose import composed_room
from diorama_core.text.pictures import ImageSettings, picture_of
from diorama_core.text.prompt import understood_prompt
from tests.perception.language.stub_lmm import StubLmm, answering

READINGS = {
    "a reading corner with two armchairs": ("living", {"armchair": 2}),
    "a cosy bedroom with a double bed, two night stands and a lamp on each night stand": (
        "bedroom",
        {"bed": 1, "night stand": 2, "lamp": 2},
    ),
    "a wooden dining table with six chairs around it": ("dining", {"table": 1, "chair": 6}),
    "home office with a desk, an office chair and a plant next to the desk": (
        "study",
        {"desk": 1, "office chair": 1, "plant": 1},
    ),
    "a vase of flowers on a round table": ("living", {"table": 1, "vase": 1}),
    "kitchen": ("kitchen", {}),
}


@pytest.mark.parametrize("prompt", list(READINGS))
def test_prompts_are_understood(prompt: str) -> None:
    request = understood_prompt(prompt)
    room, counts = READINGS[prompt]
    assert request.room == room
    assert {t.category: t.count for t in request.objects} == counts
    assert request.ignored == ()


def test_places_and_appearance_are_read() -> None:
    objects = {t.category: t for t in understood_prompt("a blue sofa, a picture above the sofa").objects}
    assert objects["sofa"].appearance == ("blue",)
    assert (objects["picture"].place, objects["picture"].target) == ("above", "sofa")
    assert understood_prompt("an elephant beside a piano").ignored == ("elephant",)
    vase = next(t for t in understood_prompt("a table and a sideboard with a vase on it").objects if t.label == "vase")
    assert (vase.place, vase.target) == ("on", "sideboard")


@given(st.text(max_size=120))
@settings(deadline=None, max_examples=80)
def test_any_text_is_read_without_complaint(text: str) -> None:
    request = understood_prompt(text)
    assert all(1 <= t.count <= 12 for t in request.objects)


@pytest.mark.parametrize("prompt", [p for p in READINGS if READINGS[p][1]])
def test_rooms_hold_what_was_asked_for(prompt: str) -> None:
    room = composed_room(prompt, built_in_library())
    check_scene(room.scene)
    counts = Counter(o.category for o in room.scene.objects)
    for name, wanted in READINGS[prompt][1].items():
        assert counts[name] == wanted, room.notes


def test_the_same_words_give_the_same_room_and_another_seed_another() -> None:
    prompt = "a bedroom with a bed and a wardrobe"
    first, again, other = (composed_room(prompt, built_in_library(), seed) for seed in (0, 0, 1))
    assert first.scene == again.scene
    assert first.scene != other.scene


def test_lamps_stand_on_their_night_stands() -> None:
    room = composed_room("a double bed, two night stands and a lamp on each night stand", built_in_library())
    holders = [s.parent for s in room.scene.supports if s.child.startswith("lamp")]
    assert len(set(holders)) == 2
    assert all(h.startswith("night_stand") for h in holders)


def test_a_composed_picture_carries_its_truth_and_says_so() -> None:
    made = picture_of("a reading corner with two armchairs", built_in_library(), size=(160, 120))
    assert made.inputs.depth_m is not None
    assert made.inputs.instances is not None
    assert [b.category for b in made.inputs.boxes].count("armchair") == 2
    assert "composed from the library" in made.notes[0]


@pytest.mark.parametrize(
    ("prompt", "wanted"),
    [
        ("two armchairs and a round table", {"armchair": 2, "table": 1}),
        (
            "a modern home office with a wooden desk, an office chair, a bookshelf, a floor lamp and three plants",
            {"desk": 1, "office chair": 1, "bookshelf": 1, "floor lamp": 1, "plant": 3},
        ),
        (
            "a small bedroom with a double bed, two night stands, a wardrobe and a rug",
            {"bed": 1, "night stand": 2, "wardrobe": 1, "rug": 1},
        ),
    ],
    ids=["two armchairs", "home office", "bedroom"],
)
def test_the_picture_shows_what_was_asked_for(prompt: str, wanted: dict[str, int]) -> None:
    made = picture_of(prompt, built_in_library(), size=(320, 240))
    shown = Counter(b.category for b in made.inputs.boxes)
    assert {name: shown[name] for name in wanted} == wanted, (shown, made.notes)


def test_armchairs_gather_around_a_table() -> None:
    room = composed_room("two armchairs and a round table", built_in_library()).scene
    table = next(o for o in room.objects if o.category == "table")
    for chair in (o for o in room.objects if o.category == "armchair"):
        away = table.pose.position[:2] - chair.pose.position[:2]
        front = np.array([np.cos(chair.pose.yaw_rad), np.sin(chair.pose.yaw_rad)])
        assert np.linalg.norm(away) < 1.8
        assert front @ away / np.linalg.norm(away) > 0.9


def _png() -> str:
    buffer = io.BytesIO()
    Image.fromarray(np.full((90, 120, 3), 120, np.uint8)).save(buffer, "PNG")
    return base64.b64encode(buffer.getvalue()).decode()


def test_an_image_endpoint_makes_the_picture() -> None:
    with answering(StubLmm(["yes"], picture=_png())) as stub:
        made = picture_of("a kitchen", built_in_library(), endpoint=ImageSettings(stub.address, "painter"))
    assert made.inputs.photo.rgb.shape == (90, 120, 3)
    assert "painter" in made.notes[0]
    assert "a kitchen" in stub.images[0]["prompt"]


@pytest.mark.parametrize("case", ["refuses", "no picture", "not base64", "not a picture"])
def test_a_bad_image_endpoint_is_one_clear_line(case: str) -> None:
    picture = {"not base64": "%%%", "not a picture": base64.b64encode(b"hello").decode()}.get(case, "")
    with answering(StubLmm([400 if case == "refuses" else "yes"], picture=picture)) as stub:
        settings_ = ImageSettings(stub.address, "painter", timeout_s=5.0)
        with pytest.raises((UnavailableError, InputError)) as error:
            picture_of("a kitchen", built_in_library(), endpoint=settings_)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("prompt", ["", "   ", "x" * 3000], ids=["empty", "blank", "endless"])
def test_unusable_prompts_are_one_clear_line(prompt: str) -> None:
    with pytest.raises(InputError):
        picture_of(prompt, built_in_library())
