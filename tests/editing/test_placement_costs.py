"""What places cost: wishes before habits, habits before nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.editing.placement_candidates import Candidates
from diorama_core.editing.placement_costs import placement_costs
from diorama_core.editing.relations import Relation, Stances
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Architecture, Scene, SceneObject
from diorama_core.synthesis.grammar import furnish_room
from tests.editing.objects import SOFA, item

ROOM = furnish_room(3, "living", built_in_library(), outline="box", clutter=0).architecture
FRAME = RoomFrame.of(Scene(architecture=ROOM))


def cost(
    what: SceneObject,
    *stances: tuple[Float[np.ndarray, "2"], float],
    there: tuple[SceneObject, ...] = (),
    relations: tuple[Relation, ...] = (),
    usual: tuple[Relation, ...] = (),
    others: dict[str, tuple[Relation, ...]] | None = None,
    near: Float[np.ndarray, "3"] | None = None,
    room: Architecture = ROOM,
) -> list[float]:
    """Cost of an object at places with headings, on the floor of a room."""
    count = len(stances)
    places = Stances(what.size_m, np.array([xy for xy, _ in stances]), np.array([yaw for _, yaw in stances]))
    here = Candidates(places, np.zeros(count), [None] * count, np.zeros(count), np.ones(count, dtype=bool))
    scene = Scene(architecture=room, objects=there)
    return placement_costs(scene, what, here, relations, usual, others or {}, RoomFrame.of(scene), near).tolist()


WALL = FRAME.walls[0]
AT_WALL = (WALL.point(WALL.length_m / 2, 0.25), WALL.yaw_rad)
IN_CORNER = (WALL.point(0.65, 0.25), WALL.yaw_rad)
FREE = (FRAME.middle, WALL.yaw_rad)


def test_backs_are_at_walls_and_some_in_the_middle_of_theirs() -> None:
    wardrobe, sofa = (item(c, (0.45, 1.2, 0.8), 0.0, 0.0) for c in ("wardrobe", "sofa"))
    for what in (wardrobe, sofa):
        against, free = cost(what, AT_WALL, FREE)
        assert against < free
    middle, corner = cost(sofa, AT_WALL, IN_CORNER)
    assert middle < corner
    assert np.ptp(cost(wardrobe, AT_WALL, IN_CORNER)) < 1e-9


def test_nothing_is_put_before_doors_or_furniture_that_is_used() -> None:
    box = item("box", (0.4, 0.4, 0.4), 0.0, 0.0)
    for category in ("door", "wardrobe"):
        other = item(category, (0.5, 0.9, 2.0), *AT_WALL[0], WALL.yaw_rad)
        before, aside = (WALL.point(WALL.length_m / 2 + along, 0.8) for along in (0.0, 1.5))
        blocked, free = cost(box, (before, 0.0), (aside, 0.0), there=(other,))
        assert blocked > free + 1.0, category


def test_a_wish_weighs_more_than_what_is_usual_and_both_more_than_what_is_near() -> None:
    chair = item("armchair", (0.5, 0.5, 0.8), 0.0, 0.0)
    beside, away = (np.array([0.0, 1.3]), 0.0), (np.array([-1.5, -1.5]), 0.0)
    relation = Relation("beside", ("sofa",))
    room = Architecture()
    wish, usual, none = (
        np.subtract(*cost(chair, away, beside, there=(SOFA,), room=room, **how))
        for how in ({"relations": (relation,)}, {"usual": (relation,)}, {"usual": ()})
    )
    assert wish > usual > none
    nearer, farther = cost(chair, away, beside, there=(SOFA,), room=room, near=np.array([-1.5, -1.5, 0.0]))
    plain = cost(chair, away, beside, there=(SOFA,), room=room)
    assert nearer == plain[0]
    assert farther > plain[1]


def test_wishes_of_others_that_name_it_count() -> None:
    sofa_wants = {"sofa": (Relation("facing", ("armchair",)),)}
    chair = item("armchair", (0.5, 0.5, 0.8), 0.0, 0.0)
    ahead, behind = (np.array([1.8, 0.0]), np.pi), (np.array([-1.8, 0.0]), np.pi)
    plain = np.subtract(*cost(chair, behind, ahead, there=(SOFA,), room=Architecture()))
    wished = np.subtract(*cost(chair, behind, ahead, there=(SOFA,), room=Architecture(), others=sofa_wants))
    assert wished > plain + 1.0


def test_two_of_a_kind_stand_on_both_sides() -> None:
    table = item("night stand", (0.4, 0.4, 0.5), 0.0, 1.3)
    second = replace(table, id="second")
    beside = (Relation("beside", ("sofa",)),)
    same, other = cost(
        second, (np.array([0.0, 1.35]), 0.0), (np.array([0.0, -1.35]), 0.0), there=(SOFA, table), relations=beside,
        room=Architecture(),
    )  # fmt: skip
    assert other < same


def test_large_furniture_stands_square_and_an_armchair_may_turn() -> None:
    sofa, armchair = item("sofa", (0.9, 2.0, 0.8), 0.0, 0.0), item("armchair", (0.8, 0.8, 0.8), 0.0, 0.0)
    square, turned = ((FRAME.middle, WALL.yaw_rad + turn) for turn in (0.0, np.radians(12.0)))
    ahead = FRAME.middle + 2.5 * np.array([np.cos(turned[1]), np.sin(turned[1])])
    screen = item("television", (0.1, 0.9, 0.6), *ahead, WALL.yaw_rad + np.pi)
    facing = (Relation("facing", (screen.id,)),)
    for what, straight in ((sofa, True), (armchair, False)):
        first, second = cost(what, square, turned, there=(screen,), relations=facing)
        assert (first < second) == straight
