"""The grammar of edits in words: clauses, verbs, objects, places. Scenes are made by the room grammar."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Scene
from diorama_core.text.compose import compose_room
from diorama_core.text.edit_grammar import edits_of
from diorama_core.text.edit_plan import Edit, Insert, Move, Paint, Place, Remove, Resize, Restyle, Shift, Swap, Turn
from diorama_core.text.edit_wording import clauses_of
from diorama_core.text.looks import look_of
from diorama_core.text.phrases import noun_phrase, split_places
from diorama_core.text.selecting import Selector

LIBRARY = built_in_library()


def edits(command: str, scene: Scene, **named: list[str]) -> tuple[Edit, ...]:
    return edits_of(command, scene, LIBRARY, **named)


def on(*targets: str) -> list[Place]:
    return [Place(relation="on", targets=list(targets))]


def beside(*targets: str) -> list[Place]:
    return [Place(relation="beside", targets=list(targets))]


LIVING = {
    "remove everything on the sideboard": Remove(objects=["lamp_1", "books_1"]),
    "clear the sideboard": Remove(objects=["lamp_1", "books_1"]),
    "delete all pictures except picture 1": Remove(objects=["picture_2", "picture_3", "picture_4"]),
    "remove the lamp on the sideboard": Remove(objects=["lamp_1"]),
    "move the lamp beside the sofa": Move(objects=["lamp_1"], places=beside("sofa_1")),
    "move the lamp on the sideboard next to the sofa": Move(objects=["lamp_1"], places=beside("sofa_1")),
    "move the books to the coffee table": Move(objects=["books_1"], places=on("coffee_table_1")),
    "put the plant in the corner": Move(objects=["plant_1"], places=[Place(relation="in corner")]),
    "move the side table between the sofa and the piano": Move(
        objects=["side_table_1"], places=[Place(relation="between", targets=["sofa_1", "piano_1"])]
    ),
    "move the sofa 50 cm to the left": Shift(objects=["sofa_1"], right_m=-0.5),
    "push the coffee table half a metre closer to the sofa": Shift(
        objects=["coffee_table_1"], toward="sofa_1", toward_m=0.5
    ),
    "move the plant away from the piano": Shift(objects=["plant_1"], toward="piano_1", toward_m=-0.5),
    "slide the sofa closer to the wall": Move(objects=["sofa_1"], places=[Place(relation="against wall")]),
    "raise picture 1 by 20 cm": Shift(objects=["picture_1"], up_m=0.2),
    "lower picture 1 a bit": Shift(objects=["picture_1"], up_m=-0.1),
    "hang picture 1 a little higher": Shift(objects=["picture_1"], up_m=0.1),
    "move picture 2 20 cm lower": Shift(objects=["picture_2"], up_m=-0.2),
    "center the rug under the coffee table": Move(
        objects=["rug_1"], places=[Place(relation="under", targets=["coffee_table_1"])]
    ),
    "turn the sofa to the window": Turn(objects=["sofa_1"], toward="window_1"),
    "make the sofa face the piano": Turn(objects=["sofa_1"], toward="piano_1"),
    "rotate the sofa by 30 degrees to the right": Turn(objects=["sofa_1"], degrees=-30.0),
    "turn the sofa around": Turn(objects=["sofa_1"], degrees=180.0),
    "a rug under the coffee table": Insert(what="rug", places=[Place(relation="under", targets=["coffee_table_1"])]),
    "put two plants in the corner": Insert(what="plants", count=2, places=[Place(relation="in corner")]),
    "add a small red armchair by the window": Insert(what="small red armchair", places=beside("window_1")),
    "make the sofa light blue": Restyle(objects=["sofa_1"], look="light blue"),
    "paint the coffee table white": Restyle(objects=["coffee_table_1"], look="white"),
    "make the sofa bigger": Resize(objects=["sofa_1"], factor=1.25),
    "make the sofa 20% smaller": Resize(objects=["sofa_1"], factor=0.8),
    "swap the sofa for a leather one": Swap(objects=["sofa_1"], what="leather sofa"),
    "replace the piano with a bookshelf": Swap(objects=["piano_1"], what="bookshelf"),
    "paint the walls light blue": Paint(part="walls", colour="light blue"),
    "paint the walls sage green": Paint(part="walls", colour="sage green"),
    "make the floor oak": Paint(part="floor", colour="oak"),
}


@pytest.mark.parametrize("command", list(LIVING))
def test_commands_become_edits(command: str, living: Scene) -> None:
    assert edits(command, living) == (LIVING[command],)


def test_each_of_two_has_its_own_look_and_place(living: Scene) -> None:
    looks = edits("make the sofa white and the piano black", living)
    assert looks == (Restyle(objects=["sofa_1"], look="white"), Restyle(objects=["piano_1"], look="black"))
    both = edits("make the sofa and the piano black", living)
    assert both == (Restyle(objects=["sofa_1", "piano_1"], look="black"),)
    places = edits("move the plant in the corner and the side table beside the sofa", living)
    assert places == (
        Move(objects=["plant_1"], places=[Place(relation="in corner")]),
        Move(objects=["side_table_1"], places=beside("sofa_1")),
    )


def test_what_should_be_is_made_so_and_ordinals_choose(living: Scene, dining: Scene) -> None:
    assert edits("the sofa should be black", living) == (Restyle(objects=["sofa_1"], look="black"),)
    assert edits("remove the second picture", living) == (Remove(objects=["picture_2"]),)
    assert edits("remove the last picture", living) == (Remove(objects=["picture_4"]),)
    facing = edits("the sofa and the piano should face each other", living)
    assert facing == (Move(objects=["sofa_1", "piano_1"], places=[Place(relation="facing", targets=[])]),)


def test_a_lamp_that_goes_somewhere_is_none_of_the_ceiling() -> None:
    scene = compose_room("a living room with a sofa and a floor lamp", LIBRARY).scene
    assert {o.category for o in scene.objects} >= {"ceiling lamp", "floor lamp", "window"}
    moved = edits("move the lamp beside the sofa", scene)
    assert moved == (Move(objects=["floor_lamp_1"], places=beside("sofa_1")),)
    under = edits("move the sofa under the window", scene)
    assert under == (Move(objects=["sofa_1"], places=[Place(relation="near", targets=["window_1"])]),)


def test_lists_are_several_edits_and_clauses_follow_each_other(dining: Scene) -> None:
    found = edits("add a floor lamp and two plants", dining)
    assert [e.what for e in found if isinstance(e, Insert)] == ["floor lamp", "plants"]
    assert clauses_of("Remove the rug, then move the table and paint the walls red.") == (
        "remove the rug",
        "move the table",
        "paint the walls red",
    )
    assert clauses_of("move the lamp between the sofa and the table") == (
        "move the lamp between the sofa and the table",
    )


def test_numbers_of_a_kind_are_changed(living: Scene, dining: Scene) -> None:
    assert edits("double the number of books", living) == (Insert(what="books", count=1, places=on("sideboard_1")),)
    assert edits("triple the pictures", living) == (Insert(what="picture", count=8),)
    assert edits("double the size of the sofa", living) == (Resize(objects=["sofa_1"], factor=2.0),)
    (halved,) = edits("halve the number of chairs", dining)
    assert isinstance(halved, Remove)
    assert len(halved.objects) == 3
    with pytest.raises(EditRefused, match="only one sofa"):
        edits("halve the number of sofas", living)
    assert edits("delete all but one of the pictures", living) == (
        Remove(objects=["picture_2", "picture_3", "picture_4"]),
    )
    with pytest.raises(EditRefused, match="only 4"):
        edits("remove all but six pictures", living)


def test_every_lamp_is_of_every_sort_and_everything_is_what_can_be_meant() -> None:
    scene = compose_room("a sofa, a floor lamp, a wooden coffee table, a rug and a lamp on a side table", LIBRARY).scene
    (turned,) = edits("turn every lamp around", scene)
    assert isinstance(turned, Turn)
    assert {scene.object(i).category for i in turned.objects} == {"lamp", "floor lamp", "ceiling lamp"}
    (moved,) = edits("push everything against the walls", scene)
    assert isinstance(moved, Move)
    assert {scene.object(i).category for i in moved.objects} == {"sofa", "floor lamp", "coffee table", "side table"}
    (white,) = edits("make all the wooden furniture white", scene)
    assert isinstance(white, Restyle)
    assert "coffee_table_1" in white.objects
    assert not {"sofa", "rug", "lamp", "floor lamp"} & {scene.object(i).category for i in white.objects}


def test_of_several_with_one_label_none_is_taken_unasked(living: Scene) -> None:
    alike = tuple(replace(o, label="picture") if o.category == "picture" else o for o in living.objects)
    with pytest.raises(EditRefused, match=r"there are 4 of these.*the second picture"):
        edits("remove the picture", replace(living, objects=alike))


def test_armchairs_are_chairs_where_there_are_no_others(living: Scene) -> None:
    sofa = living.object("sofa_1")
    only = replace(living, objects=tuple(replace(o, category="armchair") if o is sofa else o for o in living.objects))
    assert Selector(only, LIBRARY).objects("all chairs") == ("sofa_1",)
    with pytest.raises(EditRefused, match="there is no chair"):
        Selector(living, LIBRARY).objects("all chairs")


def test_all_and_some_of_a_kind(dining: Scene) -> None:
    every = edits("make all chairs wooden", dining)[0]
    assert isinstance(every, Restyle)
    assert len(every.objects) == 5
    two = edits("remove two chairs", dining)[0]
    assert isinstance(two, Remove)
    assert len(two.objects) == 2
    with pytest.raises(EditRefused, match="there are 5 of these"):
        edits("remove the chair", dining)
    chosen = edits("remove the chair", dining, selected=["chair_3"])
    assert chosen == (Remove(objects=["chair_3"]),)
    assert edits("remove it", dining, last=["chair_2"]) == (Remove(objects=["chair_2"]),)


REFUSED = {
    "remove the bathtub": "no bathtub in this scene; it has",
    "remove the zorkmid": "called “zorkmid”",
    "make the sofa": "no colour, material or size",
    "paint the walls zorkmid": "names no colour",
    "move the sofa": "where to",
    "turn the sofa": "which way",
    "swap the sofa": "for what",
    "whatever": "not understood",
    "align the pictures with the sofa": "not understood",
    "delete the ninth picture": "there are 4",
    "delete the sixth picture": "only 4 of these",
    "remove it": "not clear",
    "remove the vase on the sofa": "no vase",
}


@pytest.mark.parametrize("command", list(REFUSED))
def test_what_is_not_understood_is_named_in_one_line(command: str, living: Scene) -> None:
    with pytest.raises(EditRefused) as refused:
        edits(command, living)
    assert REFUSED[command] in str(refused.value)
    assert "\n" not in str(refused.value)


@given(
    st.sampled_from(["", "move the ", "make the sofa ", "put a "]),
    st.text(alphabet="abcdefghijklmnopqrstuvwxyz ,.%0123456789", max_size=60),
)
def test_any_text_is_edits_or_a_refusal(living: Scene, start: str, text: str) -> None:
    said = ""
    try:
        for clause in clauses_of(start + text):
            edits(clause, living)
    except EditRefused as refused:
        said = str(refused)
    assert "\n" not in said, "one line"


def test_phrases() -> None:
    phrase, unknown = noun_phrase("two dark wooden dining chairs")
    assert phrase is not None
    assert (phrase.category, phrase.count, phrase.appearance, unknown) == ("chair", 2, ("dark", "wooden"), "")
    head, places = split_places("a lamp on the desk to the left of the monitor")
    assert head == "a lamp"
    assert [(p.kind, p.words) for p in places] == [("on", "the desk"), ("left of", "the monitor")]
    assert [p.kind for p in split_places("an armchair in the corner facing the window")[1]] == ["in corner", "facing"]
    vase, _ = noun_phrase("a vase of flowers")
    assert vase is not None
    assert vase.category == "vase"


def test_looks() -> None:
    light = look_of("light blue")
    dark = look_of("dark blue")
    assert light is not None
    assert dark is not None
    assert sum(light.colour or ()) > sum(dark.colour or ())
    wooden = look_of("wooden")
    assert wooden is not None
    assert wooden.material == "wood"
    assert look_of("light blue piano") is None


def test_selectors_tell_objects_by_place_and_size(living: Scene, dining: Scene) -> None:
    selector = Selector(living, LIBRARY)
    assert selector.objects("everything", split_places("on the sideboard")[1]) == ("lamp_1", "books_1")
    assert len(Selector(dining, LIBRARY).objects("the chairs", split_places("around the table")[1])) >= 3
    assert "sofa" in selector.inventory()
