"""What is counted of rooms and pictures, attics, and what the splits keep apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.synthesis import ROOM_KINDS, furnish_room
from diorama_core.synthesis.finishes import FLOORS, WALLS, choose_finishes, colours_of, room_styles
from diorama_core.synthesis.layout_rooms import box_library, generate_room
from diorama_core.synthesis.plan import RoomPlan, Slope, room_plan
from diorama_core.synthesis.splits import share_out
from diorama_core.synthesis.survey import ViewSurvey, colliding_pairs, support_depth, survey_room

SPLITS = ("train", "validation", "test")
SQUARE = np.array([[-2.0, -2], [2, -2], [2, 2], [-2, 2]])


@pytest.mark.parametrize("low", range(4))
def test_an_attic_slopes_down_to_its_low_wall(low):
    plan = RoomPlan(SQUARE, 2.6, Slope(low, 1.0, 1.6))
    wall = plan.walls[low]
    foot = wall.start + 0.5 * (wall.end - wall.start)
    at = np.stack([foot, foot + 0.8 * wall.inward, foot + 1.6 * wall.inward, foot + 3 * wall.inward])
    assert plan.roof_m(at) == pytest.approx([1.0, 1.8, 2.6, 2.6])
    assert plan.fits_under_roof(np.array([[*at[1], 1.7]]))
    assert not plan.fits_under_roof(np.array([[*at[1], 1.79]]))
    planes = plan.architecture().planes
    middle = np.array([0.0, 0.0, 0.9])
    assert all(p.normal @ middle - p.offset > 0.5 for p in planes)
    assert sorted(len(p.polygon) for p in planes if p.role == "wall") == [4, 4, 5, 5]
    above = [p.polygon * [1, 1, 0] for p in planes if p.role == "ceiling"]
    areas = [np.linalg.norm(np.cross(c, np.roll(c, -1, axis=0)).sum(axis=0)) / 2 for c in above]
    assert sum(areas) == pytest.approx(16.0)


def test_attics_are_furnished_under_their_roof(rng):
    plan = room_plan(rng, (4.0, 4.0), (3.5, 3.5), "attic")
    assert 0.9 <= plan.roof_m(plan.outline).min() <= 1.4
    library = built_in_library()
    scene = furnish_room(3, "bedroom", library, outline="attic")
    survey = survey_room("bedroom", scene, library)
    assert (survey.outline, survey.collisions, survey.outside) == ("attic", (), ())
    assert survey.objects >= 8


def test_cut_meshes_and_objects_outside_are_found():
    library = box_library()
    scene = generate_room(3, 8).truth
    assert colliding_pairs(scene, library) == ()
    first, second, *rest = scene.objects
    into = replace(second, pose=replace(second.pose, position=first.pose.position))
    hit = colliding_pairs(replace(scene, objects=(first, into, *rest)), library)
    assert any({first.id, second.id} <= set(pair) for pair in hit)
    sunk = replace(first, pose=first.pose.move([0, 0, -0.05]))
    assert first.id in survey_room("x", replace(scene, objects=(sunk, second, *rest)), library).outside


def test_depth_counts_what_stands_on_what():
    scene = generate_room(3, 12).truth
    depths = {o.id: support_depth(scene, o.id) for o in scene.objects}
    for edge in scene.supports:
        assert depths[edge.child] == (1 if scene.has_plane(edge.parent) else depths[edge.parent] + 1)


def test_pictures_nobody_would_take_are_told():
    good = ViewSurvey("a", 6, 0.2, 0.3, 0.0, 2)
    assert good.faults(4) == ()
    assert replace(good, asked=3).faults(4) == ("few objects",)
    assert replace(good, floor=0.0, largest=0.9, near=0.5).faults(4) == ("no floor", "one object fills it", "too near")


def test_finishes_and_room_styles_are_split():
    for part, table in (("floor", FLOORS), ("wall", WALLS)):
        for style, colours in table.items():
            shares = [colours_of(part, style, s) for s in SPLITS]
            assert sorted(c for share in shares for c in share) == sorted(colours)
    for kind in ROOM_KINDS:
        shares = [set(room_styles(kind, s)) for s in SPLITS]
        assert all(shares)
        assert sum(len(s) for s in shares) == len(set.union(*shares)) <= len(set(room_styles(kind)))
        for split in SPLITS:
            names = choose_finishes(np.random.default_rng(4), kind, split)
            for name, part in zip(names, ("floor", "wall")):
                _, style, colour, _ = name.split(":")
                assert colour in colours_of(part, style, split)


def test_of_two_names_one_is_tested():
    assert sorted(share_out(["a", "b"]).values()) == ["test", "train"]
    assert share_out(["a"]) == {"a": "train"}
