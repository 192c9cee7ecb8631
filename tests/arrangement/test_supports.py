"""The supports of a room: a tree of least cost, from poses, kinds and what the photo shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.arrangement.support_hypotheses import (
    MEASURED,
    REASONED,
    SupportEvidence,
    SupportHypothesis,
    support_hypotheses,
)
from diorama_core.arrangement.support_terms import TERMS, SupportWeights, sentence_of, support_weights
from diorama_core.arrangement.supports import (
    STANDING_TERMS,
    choose_supports,
    standing_walls,
    wall_relation,
    with_decided_supports,
)
from diorama_core.library.taxonomy import category
from diorama_core.scene.types import Scene, Support
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

LIBRARY = box_library()
TABLE_TOP = float(LIBRARY.shape("table_0").size_m[2])
DEPTH, _, HEIGHT = box_library().shape("cabinet_10").size_m


def decided(scene: Scene, noise=MEASURED, **below) -> Scene:
    return with_decided_supports(scene, LIBRARY, noise, SupportEvidence.of(scene, below)).scene


def at(shape: str, level: float) -> float:
    return level + LIBRARY.shape(shape).size_m[2] / 2


def test_a_cup_on_a_table_is_taken_off_the_floor_that_was_believed_to_hold_it(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.5, at("table_0", 0.0)))
    cup = room.put("cup_21", (0.0, 0.5, at("cup_21", TABLE_TOP)))
    found = with_decided_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED, SupportEvidence())
    assert found.scene.support_of(cup) == Support(cup, table)
    assert found.scene.support_of(table).parent == "floor"
    assert found.choices[cup].probabilities[table] > 0.7


def test_a_change_is_told_in_words_and_by_terms(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.5, at("table_0", 0.0)))
    cup = room.put("cup_21", (0.0, 0.5, at("cup_21", TABLE_TOP)), on="wall_2", relation="mounted on")
    scene = room.scene(camera=looking_north())
    found = with_decided_supports(scene, LIBRARY, MEASURED, SupportEvidence.of(scene, {cup: {table: 1.0}}))
    assert found.notes == (f"support changed: {cup} rests on {table}, not wall 3",)
    assert found.choices[cup].shares["seen below"] > 0.0


def test_what_agrees_already_stays_as_it_is(room: Room) -> None:
    room.put("table_0", (0.0, 0.5, at("table_0", 0.0)))
    room.put("cup_21", (0.0, 0.5, at("cup_21", TABLE_TOP)), on="table_0_0", parent_surface=0)
    scene = room.scene(camera=looking_north())
    assert decided(scene) == scene
    assert decided(Scene()) == Scene()


def test_a_cabinet_with_its_back_at_a_wall_stands_against_it_and_a_table_in_the_middle_does_not(room: Room) -> None:
    depth = LIBRARY.shape("cabinet_10").size_m[0]
    yaw = -np.pi / 2  # its front looks from the far wall into the room
    cabinet = room.put("cabinet_10", (0.0, 2.5 - depth / 2 - 0.01, at("cabinet_10", 0.0)), yaw=yaw)
    table = room.put("table_0", (0.0, 0.0, at("table_0", 0.0)))
    for noise in (MEASURED, REASONED):
        found = decided(room.scene(camera=looking_north()), noise)
        assert found.support_of(cabinet).adheres_to == ("wall_2",)
        assert found.support_of(table).adheres_to == ()


def test_things_that_would_hold_each_other_up_get_a_tree(room: Room) -> None:
    first = room.put("box_24", (0.0, 0.5, at("box_24", 0.0)), on=None)
    second = room.put("box_24", (0.0, 0.5, at("box_24", 0.0)), on=None)
    circle = (Support(first, second), Support(second, first))
    scene = replace(room.scene(camera=looking_north()), supports=circle)
    parents = {s.child: s.parent for s in decided(scene).supports}
    assert "floor" in parents.values()


def test_from_a_photo_alone_what_hangs_on_another_wall_looks_the_same_there(room: Room) -> None:
    picture = room.put("picture_13", (0.0, 1.5, 1.5), on="floor", yaw=-np.pi / 2)
    scene = room.scene(camera=looking_north())
    found = decided(scene, REASONED)
    edge, eye = found.support_of(picture), scene.camera.position
    assert edge.relation == "mounted on"
    assert found.has_plane(edge.parent)
    before, after = (s.object(picture).pose.position - eye for s in (scene, found))
    assert np.allclose(np.cross(before, after), 0.0, atol=1e-9)
    assert np.linalg.norm(after) / np.linalg.norm(before) == pytest.approx(
        float(found.object(picture).size_m[1] / scene.object(picture).size_m[1])
    )


HYPOTHESES = st.tuples(st.floats(0, 20), st.floats(0, 3), st.floats(0, 1), st.booleans())


def test_what_stands_on_a_table_that_was_found_farther_away_goes_there_along_its_line_of_sight(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.8, at("table_0", 0.0)))
    cup = room.put("cup_21", (0.0, 1.8, at("cup_21", TABLE_TOP)), on=table)
    scene = room.scene(camera=looking_north())
    eye, there = scene.camera.position, scene.object(cup)
    pose = replace(there.pose, position=eye + 0.6 * (there.pose.position - eye), scale=0.6 * there.pose.scale)
    before = replace(scene, objects=tuple(replace(o, pose=pose) if o.id == cup else o for o in scene.objects))
    after = decided(before, REASONED)
    assert after.support_of(cup).parent == table
    assert after.object(cup).pose.position == pytest.approx(there.pose.position, abs=0.2)
    assert after.object(cup).pose.scale == pytest.approx(there.pose.scale, rel=0.12)
    assert decided(before, MEASURED).object(cup) == before.object(cup)


@given(HYPOTHESES, st.floats(0, 20))
def test_a_wider_gap_never_speaks_for_a_supporter(drawn: tuple[float, float, float, bool], more: float) -> None:
    gap, outside, below, believed = drawn
    kind, carrier = category("cup"), category("table")

    def cost(gap: float) -> float:
        edge = Support("cup", "table")
        return support_weights().cost(
            SupportHypothesis(edge, "object", kind, carrier, believed, gap, outside, below=below)
        )

    assert cost(gap + more) >= cost(gap) - 1e-12


def test_fitted_weights_name_every_term_and_say_how_they_were_found() -> None:
    weights = support_weights()
    assert set(weights.terms) == {term.name for term in TERMS}
    assert len(weights.places) == 16
    assert set(weights.walls) == {"measured", "reasoned"}
    assert all(set(of_walls) == set(STANDING_TERMS) for of_walls in weights.walls.values())


def test_without_weights_of_a_term_it_says_nothing(room: Room) -> None:
    room.put("table_0", (0.0, 0.5, at("table_0", 0.0)))
    scene = room.scene(camera=looking_north())
    hypotheses = support_hypotheses(scene, LIBRARY, MEASURED, SupportEvidence())
    nothing = SupportWeights({}, {}, {})
    assert all(nothing.cost(h) == 0.0 for of_one in hypotheses.values() for h in of_one)
    assert set(choose_supports(hypotheses, nothing)) == set(hypotheses)


def test_terms_are_told_in_plain_words() -> None:
    held = SupportHypothesis(Support("cup", "table"), "object", category("cup"), category("table"))
    assert sentence_of("company", held) == "a cup is often on a table"
    assert sentence_of("usual place", held) == "a cup is usually on furniture"
    assert sentence_of("company", SupportHypothesis(Support("cup", "floor"), "floor", category("cup"))) == ""


def walls_of_cabinet(room: Room, gap_m: float, yaw: float) -> tuple[str, ...]:
    """Those of a cabinet before the far wall of a room of 6 x 5 m, at x = 0."""
    cabinet = room.put("cabinet_10", (0.0, 2.5 - DEPTH / 2 - gap_m, HEIGHT / 2), yaw=yaw)
    scene = room.scene(camera=looking_north())
    return standing_walls(scene, scene.object(cabinet), MEASURED, support_weights().walls)


@pytest.mark.parametrize(("gap_m", "yaw"), [(1.0, -np.pi / 2), (0.15, np.deg2rad(-60.0))])
def test_a_cabinet_away_from_a_wall_or_aslant_to_it_stands_free(room: Room, gap_m: float, yaw: float) -> None:
    assert walls_of_cabinet(room, gap_m, yaw) == ()


def test_a_wall_that_ends_before_an_object_has_no_relation_to_it(room: Room) -> None:
    cabinet = room.put("cabinet_10", (7.0, 2.0, HEIGHT / 2), yaw=-np.pi / 2)
    scene = room.scene(camera=looking_north())
    assert wall_relation(scene, scene.object(cabinet), scene.plane("wall_2"), MEASURED) is None
