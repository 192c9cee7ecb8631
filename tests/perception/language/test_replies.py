from __future__ import annotations

from diorama_core.perception.language.replies import GraphReply, count_votes
from diorama_core.scene.types import Support

OBJECTS = {1: "table", 2: "lamp"}
ARCHITECTURE = {90: "floor", 91: "wall"}


def reply(*relations: tuple[int, int, str], objects: tuple[tuple[int, str, str], ...] = ()) -> GraphReply:
    return GraphReply.model_validate(
        {
            "objects": [{"id": i, "caption": c, "face_direction": d} for i, c, d in objects],
            "support_relation": [{"subject_id": s, "target_id": t, "type": k} for s, t, k in relations],
        }
    )


def count(*replies: GraphReply):
    return count_votes(replies, OBJECTS, ARCHITECTURE)


def test_the_majority_decides_and_says_how_large_it_is() -> None:
    on_table, on_wall = reply((2, 1, "placed on"), (1, 90, "placed on")), reply((2, 91, "mounted on"))
    found = {e.child: (e, share) for e, share in count(on_table, on_wall, on_table).edges}
    assert found["lamp"] == (Support("lamp", "table"), 2 / 3)
    assert found["table"] == (Support("table", "floor"), 2 / 3)


def test_a_tie_is_decided_the_same_way_each_time() -> None:
    a, b = reply((2, 1, "placed on")), reply((2, 90, "placed on"))
    assert count(a, b).edges == count(b, a).edges == ((Support("lamp", "floor"), 0.5),)


def test_unknown_ids_selves_and_second_opinions_are_rejected() -> None:
    found = count(
        reply((2, 2, "placed on"), (7, 1, "placed on"), (1, 50, "placed on"), (1, 90, "placed on"), (1, 2, "placed on"))
    )
    assert found.edges == ((Support("table", "floor"), 1.0),)


def test_directions_need_more_than_half_and_captions_the_first() -> None:
    a = reply(objects=((1, "an oak table", "left"), (2, "", "left")))
    b = reply(objects=((1, "a table", "left"), (2, "a lamp", "right")))
    c = reply(objects=((2, "", "unknown"), (9, "nobody", "left")))
    found = count(a, b, c)
    assert found.facing == (("table", "left"),)
    assert found.captions == (("table", "an oak table"), ("lamp", "a lamp"))
