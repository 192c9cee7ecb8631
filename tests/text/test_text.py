from __future__ import annotations

import base64
import io
import json
from collections import Counter
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from diorama_core.editing.habits import usual_relations_of
from diorama_core.editing.relations import Relation, RelationKind, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.errors import InputError, UnavailableError
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import CATEGORIES, category
from diorama_core.perception.language.client import LmmSettings
from diorama_core.scene.support import check_scene
from diorama_core.text.compose import compose_room
from diorama_core.text.language import LOOKS
from diorama_core.text.pictures import ImageSettings, picture_of
from diorama_core.text.prompt import RequestedObject, RoomRequest, Wish, read_prompt
from diorama_core.text.requested_room import ESSENTIALS, stands_in_for
from diorama_core.text.scene_from_text import finish, scene_from_text
from tests.perception.language.stub_lmm import StubLmm, answering

LIBRARY = built_in_library()
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
    "an office where two desks face each other, each with a monitor and an office chair, and a plant": (
        "office",
        {"desk": 2, "monitor": 2, "office chair": 2, "plant": 1},
    ),
    "a kids' room with two single beds": ("bedroom", {"bed": 2}),
}


@pytest.mark.parametrize("prompt", list(READINGS))
def test_prompts_are_understood(prompt: str) -> None:
    request = read_prompt(prompt)
    room, counts = READINGS[prompt]
    assert request.room == room
    assert {t.category: t.count for t in request.objects} == counts
    assert request.ignored == ()


def test_places_and_appearance_are_read() -> None:
    objects = {t.category: t for t in read_prompt("a blue sofa, a picture above the sofa").objects}
    assert objects["sofa"].appearance == ("blue",)
    assert objects["picture"].wishes == (Wish("above", ("sofa",)),)
    assert read_prompt("an elephant beside a piano").ignored == ("elephant",)
    vase = next(t for t in read_prompt("a table and a sideboard with a vase on it").objects if t.label == "vase")
    assert vase.wishes == (Wish("on", ("sideboard",)),)


@pytest.mark.parametrize(
    ("prompt", "seats"),
    [
        ("a dining room for six with an oval table", 6),
        ("a table for 8 people", 8),
        ("a dining room for four with four stools around a table", 4),
    ],
)
def test_tables_have_seats_for_as_many_as_they_are_for(prompt: str, seats: int) -> None:
    kinds = Counter({o.category: o.count for o in read_prompt(prompt).objects})
    assert kinds["chair"] + kinds["stool"] == seats


@pytest.mark.parametrize(
    ("prompt", "counts"),
    [
        ("a two seater sofa and a 3-seat couch", {"sofa": 1}),
        ("a bed and a lamp on each night stand", {"bed": 1, "lamp": 2, "night stand": 2}),
        ("three rows of four desks facing the blackboard", {"desk": 12, "whiteboard": 1}),
        ("a bedroom with no curtains, a bed and a plant", {"bed": 1, "plant": 1}),
        ("a sofa without a rug or cushions and two plants", {"sofa": 1, "plant": 2}),
    ],
)
def test_as_many_are_asked_for_as_people_mean(prompt: str, counts: dict[str, int]) -> None:
    request = read_prompt(prompt)
    assert {o.category: o.count for o in request.objects} == counts
    assert not request.ignored
    assert [o.rows for o in request.objects if o.label == "desks"] == ([3] if "rows" in prompt else [])


@pytest.mark.parametrize(
    ("prompt", "absent"),
    [
        ("a living room without a rug or a television", {"rug", "television"}),
        ("a bedroom with a wardrobe, no bed and no window", {"bed", "window"}),
        ("a bathroom with a shower and no mirror", {"mirror"}),
    ],
)
def test_rooms_do_without_what_they_are_to_do_without(prompt: str, absent: set[str]) -> None:
    made = compose_room(prompt, LIBRARY)
    assert set(made.request.excluded) == absent
    assert not absent & {o.category for o in made.scene.objects}


def test_tables_are_large_enough_for_their_seats() -> None:
    made = compose_room("a table with eight chairs around it", LIBRARY)
    table = next(o for o in made.scene.objects if o.category == "table")
    chairs = [o for o in made.scene.objects if o.category == "chair"]
    assert len(chairs) == 8
    # None sits in a second row.
    for chair in chairs:
        local = np.abs((chair.pose.position - table.pose.position)[:2] @ table.pose.R_world_object[:2, :2])
        assert (local - table.size_m[:2] / 2).max() < 0.5


def test_a_television_stays_at_its_wall_in_a_large_room() -> None:
    made = compose_room("a huge living room with a sofa facing a television on a tv stand", LIBRARY)
    frame = RoomFrame.of(made.scene)
    stand = next(o for o in made.scene.objects if o.category == "tv stand")
    assert not made.notes
    assert is_met(made.scene, stand.id, Relation("against wall"), frame)


def test_arrangements_that_are_no_relation_are_named() -> None:
    assert read_prompt("a study with an L of two desks").ignored == ("l of",)


@given(st.text(max_size=120))
def test_any_text_is_read_without_complaint(text: str) -> None:
    request = read_prompt(text)
    assert all(1 <= t.count <= 12 for t in request.objects)


@pytest.mark.parametrize("prompt", [p for p in READINGS if READINGS[p][1]])
def test_rooms_hold_what_was_asked_for(prompt: str) -> None:
    room = compose_room(prompt, LIBRARY)
    check_scene(room.scene)
    counts = Counter(o.category for o in room.scene.objects)
    for name, wanted in READINGS[prompt][1].items():
        assert counts[name] == wanted, room.notes


def test_the_same_words_give_the_same_room_and_another_seed_another() -> None:
    prompt = "a bedroom with a bed and a wardrobe"
    first, again, other = (compose_room(prompt, LIBRARY, seed) for seed in (0, 0, 1))
    assert first.scene == again.scene
    assert first.scene != other.scene


def test_beds_side_by_side_lie_the_same_way_at_one_wall() -> None:
    scene = compose_room("a twin bedroom with two beds, each with a night stand, and a wardrobe", LIBRARY).scene
    first, second = (o for o in scene.objects if o.category == "bed")
    assert abs(np.sin(first.pose.yaw_rad - second.pose.yaw_rad)) < 0.05
    assert np.cos(first.pose.yaw_rad - second.pose.yaw_rad) > 0.9
    apart = (second.pose.position - first.pose.position)[:2] @ first.pose.R_world_object[:2, :2]
    assert abs(apart[0]) < 0.3, "their heads are at one wall"


def test_lamps_stand_on_their_night_stands() -> None:
    room = compose_room("a double bed, two night stands and a lamp on each night stand", LIBRARY)
    holders = [s.parent for s in room.scene.supports if s.child.startswith("lamp")]
    assert len(set(holders)) == 2
    assert all(h.startswith("night_stand") for h in holders)


WISHES = {
    "two desks facing each other": ("desk", Wish("facing", each_other=True)),
    "a desk by the window": ("desk", Wish("near", ("window",))),
    "a bed flanked by two night stands": ("night stand", Wish("beside", ("bed",))),
    "a coffee table between the sofa and the armchair": ("coffee table", Wish("between", ("sofa", "armchair"))),
    "two sofas with a coffee table between them": ("coffee table", Wish("between", ("sofa",))),
    "an armchair in the corner": ("armchair", Wish("in corner")),
    "a table in the middle of the room": ("table", Wish("in middle")),
    "a sofa facing a television on a tv stand": ("television", Wish("on", ("tv stand",))),
    "a chair at the desk": ("chair", Wish("around", ("desk",))),
    "bookshelves along the wall": ("bookshelf", Wish("against wall")),
    "a reading nook by the window with a rocking chair": ("rocking chair", Wish("near", ("window",))),
    "a desk by the door and a bed in the opposite corner": ("bed", Wish("in corner")),
    "a bunk bed with a toy chest at its foot": ("chest", Wish("in front of", ("bunk bed",))),
    "a washing machine and a dryer side by side": ("dryer", Wish("beside", ("washing machine",))),
    "an armchair and a sofa facing each other": ("armchair", Wish("facing", ("sofa",))),
    "an armchair, a floor lamp and a bookshelf near it": ("bookshelf", Wish("near", ("armchair",))),
    "a sideboard with two candles and a vase on it": ("vase", Wish("on", ("sideboard",))),
    "two armchairs by the fireplace with a side table between them": ("side table", Wish("between", ("armchair",))),
    "a table with four chairs and a lamp on it": ("lamp", Wish("on", ("table",))),
    "a table and an armchair with a cushion on it": ("pillow", Wish("on", ("armchair",))),
    "a piano at the end of the sofa": ("piano", Wish("beside", ("sofa",))),
    "a dining room for six with an oval table": ("chair", Wish("around", ("table",))),
}


@pytest.mark.parametrize("prompt", list(WISHES))
def test_relations_are_read(prompt: str) -> None:
    name, wish = WISHES[prompt]
    request = read_prompt(prompt)
    assert request.ignored == ()
    assert next(o for o in request.objects if o.category == name).wishes == (wish,)


@pytest.mark.parametrize("prompt", list(WISHES))
def test_relations_are_met_or_named(prompt: str) -> None:
    room = compose_room(prompt, LIBRARY)
    check_scene(room.scene)
    frame = RoomFrame.of(room.scene)
    name, wish = WISHES[prompt]
    if wish.kind == "between" or wish.each_other or room.notes:
        assert not room.notes
        return
    item = next(o for o in room.scene.objects if o.category == name)
    targets = tuple(o.id for o in room.scene.objects if o.category in wish.targets)[:1]
    assert is_met(room.scene, item.id, Relation(wish.kind, targets), frame)


def test_what_has_no_place_is_named() -> None:
    wardrobes = (RequestedObject("wardrobe", "wardrobe", 1, (), (Wish("on", ("cup",)),)), RequestedObject("cup", "cup"))
    room = compose_room("x", LIBRARY, request=RoomRequest("living", wardrobes))
    assert any("wardrobe" in note for note in room.notes)


def test_customs_name_known_categories() -> None:
    assert all(category(n).name == n for rows in ESSENTIALS.values() for n, _ in rows)
    assert {kind for c in CATEGORIES for kind, _ in usual_relations_of(c.name)} < set(get_args(RelationKind))
    assert usual_relations_of("recliner") == usual_relations_of("armchair")
    assert stands_in_for("office chair", frozenset({"stool"}))
    assert not stands_in_for("stove", frozenset({"table"}))


def test_rooms_of_a_kind_have_what_they_need() -> None:
    kitchen = compose_room("a kitchen with a round table", LIBRARY)
    assert {"stove", "refrigerator", "kitchen counter"} <= {o.category for o in kitchen.scene.objects}
    assert set(kitchen.added) == {"stove", "refrigerator", "kitchen counter"}


def test_a_scene_from_text_is_the_composed_room_with_a_camera() -> None:
    made = scene_from_text("two armchairs and a round table", LIBRARY)
    composed = compose_room("two armchairs and a round table", LIBRARY)
    assert finish(composed.scene, LIBRARY)[0] == made.scene
    assert made.scene.camera is not None
    assert {p.texture for p in made.scene.architecture.planes} <= set(made.textures)
    assert Counter(o.category for o in made.scene.objects)["armchair"] == 2
    assert made.notes == ("the room was composed from the library by rules",)


def test_a_language_model_lists_and_mends() -> None:
    facing, between = {"relation": "facing", "each_other": True}, {"relation": "between", "targets": ["armchair"]}
    listed = {
        "room": "living",
        "size": 1.0,
        "objects": [
            {"what": "armchair", "count": 2, "places": [facing]},
            {"what": "side table", "count": 1, "places": [between]},
        ],
    }
    vase = {"do": "insert", "what": "vase", "count": 1, "places": [{"relation": "on", "targets": ["side_table_1"]}]}
    with answering(StubLmm([json.dumps(listed), json.dumps({"edits": [vase]}), json.dumps({"edits": []})])) as stub:
        settings_ = LmmSettings(stub.address, "stub", timeout_s=60.0)
        made = scene_from_text("a place to talk", LIBRARY, language_model=settings_)
    counts = Counter(o.category for o in made.scene.objects)
    assert (counts["armchair"], counts["side table"], counts["vase"]) == (2, 1, 1)
    assert any(note.startswith("mended by stub") for note in made.notes)
    assert len(stub.requests) == 1 + LOOKS


@pytest.mark.parametrize("answer", ["nonsense", 500, json.dumps({"room": "moon", "objects": []})])
def test_bad_replies_leave_the_room_to_the_grammar(answer: str | int) -> None:
    with answering(StubLmm([answer])) as stub:
        settings_ = LmmSettings(stub.address, "stub", timeout_s=60.0, re_asks=0)
        made = scene_from_text("a sofa", LIBRARY, language_model=settings_)
    assert any(o.category == "sofa" for o in made.scene.objects)
    assert any("was not used" in note for note in made.notes)


def test_armchairs_gather_around_a_table() -> None:
    room = compose_room("two armchairs and a round table", LIBRARY).scene
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
        made = picture_of("a kitchen", ImageSettings(stub.address, "painter"))
    assert made.inputs.photo.rgb.shape == (90, 120, 3)
    assert "painter" in made.notes[0]
    assert "a kitchen" in stub.images[0]["prompt"]


@pytest.mark.parametrize("case", ["refuses", "no picture", "not base64", "not a picture"])
def test_a_bad_image_endpoint_is_one_clear_line(case: str) -> None:
    picture = {"not base64": "%%%", "not a picture": base64.b64encode(b"hello").decode()}.get(case, "")
    with answering(StubLmm([400 if case == "refuses" else "yes"], picture=picture)) as stub:
        settings_ = ImageSettings(stub.address, "painter", timeout_s=60.0)
        with pytest.raises((UnavailableError, InputError)) as error:
            picture_of("a kitchen", settings_)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("prompt", ["", "   ", "x" * 3000], ids=["empty", "blank", "endless"])
def test_unusable_prompts_are_one_clear_line(prompt: str) -> None:
    with pytest.raises(InputError):
        scene_from_text(prompt, LIBRARY)


def test_desks_at_opposite_walls_look_at_each_other() -> None:
    desks = read_prompt("an office with two desks against opposite walls").objects[0]
    assert Wish("against wall") in desks.wishes
    assert Wish("opposite", each_other=True) in desks.wishes
    shelves = read_prompt("four bookshelves aligned along the wall").objects[0]
    assert Wish("aligned with", each_other=True) in shelves.wishes


def test_a_round_table_is_as_wide_as_deep() -> None:
    scene = compose_room("a round coffee table and an armchair", LIBRARY).scene
    table = next(o for o in scene.objects if o.category == "coffee table")
    assert max(table.size_m[:2]) < 1.15 * min(table.size_m[:2])


def test_night_stands_and_armchairs_are_where_people_put_them() -> None:
    scene = compose_room("a bedroom with a double bed and two night stands beside the bed", LIBRARY).scene
    bed = next(o for o in scene.objects if o.category == "bed")
    sides = [
        (bed.pose.R_world_object.T @ (o.pose.position - bed.pose.position))[1]
        for o in scene.objects
        if o.category == "night stand"
    ]
    assert len(sides) == 2
    assert sides[0] * sides[1] < 0


def test_what_is_unknown_is_named_wherever_it_is_listed() -> None:
    request = read_prompt("a bedroom with two lamps, a wardrobe and a helicopter, all facing the window")
    assert [o.category for o in request.objects][:2] == ["lamp", "wardrobe"]
    assert request.ignored == ("helicopter",)
    assert read_prompt("a sofa, cosy and bright, by the window").ignored == ()
