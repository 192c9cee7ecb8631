"""The room from a photo alone, on rooms whose geometry is known: boxes and others.

A wall whose foot is hidden all along is not told from the one beside it: the furniture leaves the corners' feet free.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diorama_core.architecture.single_view.settings import SETTINGS
from diorama_core.architecture.single_view.stage import PhotoRoom, _push
from diorama_core.architecture.walls.wall_candidates import WallCandidate
from diorama_core.architecture.walls.wall_path import Run
from diorama_core.artefacts import Inputs, ObjectGeometry, Photo
from diorama_core.evaluation.metrics.architecture import architecture_scores
from diorama_core.progress import CancelToken, Progress
from diorama_core.provenance import RoomMethod, ScaleSource
from diorama_core.scene.types import Support
from tests.architecture.known_rooms import L_SHAPE, open_room
from tests.architecture.single_view.plain_cues import cues
from tests.synthetic_rooms import box_room, cuboid, look, shoot

FURNITURE = (cuboid("cabinet", (-0.6, 2.5, 0), (0.6, 0.8, 0.8)), cuboid("stand", (0.8, 2.2, 0), (0.5, 0.5, 0.9)))


def reconstruct(shot, geometry=None):
    return PhotoRoom().reconstruct(shot.inputs, shot.objects, geometry or shot.geometry, Progress())


@cache
def usual():
    """A shot of a furnished box room, and what is found in it."""
    shot = shoot(look(20, 15), box_room(-2.0, 2.0, 4.0, 2.6), FURNITURE)
    return shot, reconstruct(shot)


def wall_facing(estimate, normal):
    walls = estimate.architecture.by_role("wall")
    return next((w for w in walls if w.normal @ np.array(normal) > 0.99), None)


@pytest.mark.parametrize(
    ("yaw", "pitch", "box"),
    [(0, 12, (-1.8, 2.2, 4.0, 2.6)), (20, 18, (-2.5, 1.5, 3.5, 2.5)), (40, 10, (-3.0, 2.0, 3.0, 2.7))],
)
def test_finds_the_walls_that_are_in_view(yaw, pitch, box):
    shot = shoot(look(yaw, pitch), box_room(*box), FURNITURE)
    estimate = reconstruct(shot)
    far, left = wall_facing(estimate, (0, -1, 0)), wall_facing(estimate, (1, 0, 0))
    assert far is not None
    assert far.polygon[0, 1] == pytest.approx(box[2], abs=0.1)
    assert left is not None
    assert left.polygon[0, 0] == pytest.approx(box[0], abs=0.1)


def test_finds_the_ceiling_when_it_is_in_view():
    shot = shoot(look(0, -5, fov_deg=75), box_room(-2.0, 2.0, 4.5, 2.5))
    ceilings = reconstruct(shot).architecture.by_role("ceiling")
    assert len(ceilings) == 1
    assert ceilings[0].polygon[0, 2] == pytest.approx(2.5, abs=0.1)


def test_planes_face_the_room_and_share_their_corners():
    architecture = usual()[1].architecture
    inside = np.array([0.0, 1.0, 1.0])
    for plane in architecture.planes:
        assert plane.normal @ inside > plane.offset
        assert np.abs(plane.polygon @ plane.normal - plane.offset).max() < 1e-9
    feet = np.concatenate([w.polygon[:2] for w in architecture.by_role("wall")])
    floor_corners = architecture.floor.polygon
    assert all(np.abs(floor_corners - foot).sum(axis=1).min() < 1e-9 for foot in feet)


def test_ids_and_colours():
    architecture = usual()[1].architecture
    assert [p.id for p in architecture.planes][:2] == ["floor", "wall_1"]
    np.testing.assert_allclose(architecture.floor.colour, np.array([150, 110, 80]) / 255, atol=0.03)


def test_a_wall_that_is_hardly_seen_gives_way_to_what_stands_before_it():
    deep = cuboid("wardrobe", (0.0, 4.6, 0), (1.5, 2.0, 2.0))
    shot = shoot(look(0, 10), box_room(-2.0, 2.0, 6.0, 2.6), (deep,))
    grey = Photo(np.full((480, 640, 3), 128, np.uint8), "blank", (640, 480))
    estimate = reconstruct(replace(shot, inputs=replace(shot.inputs, photo=grey)))
    for wall_found in estimate.architecture.by_role("wall"):
        assert (deep.corners_world @ wall_found.normal).min() > wall_found.offset - 0.05


def test_a_corner_that_is_clearly_seen_stays_although_something_stands_through_one_of_its_walls():
    row = cuboid("sideboard", (0.9, 3.7, 0), (0.5, 3.0, 0.9), yaw_deg=-90)
    bed = cuboid("bed", (-1.0, 2.2, 0), (1.5, 1.8, 0.5))
    shot = shoot(look(30, 0, fov_deg=75), box_room(-2.0, 2.5, 4.0, 2.6), (row, bed))
    too_far_left = replace(bed, centre=bed.centre - np.array([0.65, 0.0, 0.0]))
    estimate = reconstruct(shot, replace(shot.geometry, cuboids=(row, too_far_left)))
    far, left = wall_facing(estimate, (0, -1, 0)), wall_facing(estimate, (1, 0, 0))
    assert far is not None
    assert left is not None
    assert (left.polygon[0, 0], far.polygon[0, 1]) == pytest.approx((-2.0, 4.0), abs=0.25)
    corner = np.degrees(np.arctan2(left.polygon[0, 0], far.polygon[0, 1]))
    assert corner == pytest.approx(np.degrees(np.arctan2(-2.0, 4.0)), abs=0.5)


def test_what_could_stand_on_furniture_does_not_move_the_wall_that_it_would_be_behind():
    shot = shoot(look(10, 10), box_room(-2.0, 2.0, 4.0, 2.6), FURNITURE)
    before = wall_facing(reconstruct(shot), (0, -1, 0))
    behind = cuboid("plant", (0.3, 5.2, 0), (0.6, 0.6, 1.0))
    item = replace(shot.objects[0], id=behind.object_id, category="plant", mask=np.zeros_like(shot.objects[0].mask))
    geometry = replace(shot.geometry, cuboids=(*shot.geometry.cuboids, behind))
    after = wall_facing(reconstruct(replace(shot, objects=(*shot.objects, item)), geometry), (0, -1, 0))
    assert before is not None
    assert after is not None
    assert after.polygon[0, 1] == pytest.approx(before.polygon[0, 1], abs=0.05)


def test_one_doubtful_thing_far_behind_a_clear_wall_does_not_move_it_but_several_sure_ones_do():
    shot = shoot(look(10, 10), box_room(-2.0, 2.0, 4.0, 2.6), FURNITURE)
    there = wall_facing(reconstruct(shot), (0, -1, 0))
    assert there is not None

    def wall_with(*things):
        geometry = replace(shot.geometry, cuboids=(*shot.geometry.cuboids, *things))
        found = wall_facing(reconstruct(shot, geometry), (0, -1, 0))
        assert found is not None
        return float(found.polygon[0, 1])

    doubtful = replace(cuboid("sofa", (0.2, 5.0, 0), (0.9, 1.8, 0.8)), confidence=0.15)
    assert wall_with(doubtful) == pytest.approx(there.polygon[0, 1], abs=0.05)
    row = [replace(cuboid(f"shelf_{k}", (-0.9 + 0.7 * k, 4.1, 0), (0.5, 0.6, 1.8)), confidence=0.9) for k in range(3)]
    assert wall_with(*row) > max(c.corners_world[:, 1].max() for c in row)


def test_every_pixel_sees_the_room():
    from diorama_core.geometry.casting import camera_rays, cast_planes

    camera = look(-30, 20, fov_deg=70)
    shot = shoot(camera, box_room(-2.0, 2.0, 4.0, 2.6), FURNITURE)
    planes = reconstruct(shot).architecture.planes
    origin, rays = camera_rays(camera, step=8)
    assert np.isfinite(cast_planes(origin, rays, planes)[0]).mean() > 0.97


def test_supports_are_resolved_to_planes():
    against_the_wall = cuboid("shelf", (-1.8, 2.0, 0), (0.35, 0.9, 1.7))
    picture = cuboid("picture", (0.0, 3.97, 1.3), (0.04, 0.8, 0.6), yaw_deg=-90)
    free = cuboid("chair", (0.5, 2.0, 0), (0.5, 0.5, 0.9))
    shot = shoot(
        look(10, 12),
        box_room(-2.0, 2.0, 4.0, 2.6),
        (against_the_wall, picture, free),
        ("bookshelf", "picture", "chair"),
    )
    edges = (Support("shelf", "floor"), Support("picture", "wall"), Support("chair", "floor"))
    estimate = reconstruct(shot, ObjectGeometry(shot.camera, shot.cuboids, edges, ScaleSource.GIVEN))
    resolved = {s.child: s for s in estimate.supports}
    far, left = wall_facing(estimate, (0, -1, 0)), wall_facing(estimate, (1, 0, 0))
    assert resolved["picture"].parent == far.id
    assert resolved["picture"].relation == "mounted on"
    assert (resolved["shelf"].parent, resolved["shelf"].adheres_to) == ("floor", (left.id,))
    assert (resolved["chair"].parent, resolved["chair"].adheres_to) == ("floor", ())


def test_a_blank_picture_gives_a_usual_room_and_says_so():
    camera = look()
    blank = Inputs(Photo(np.full((480, 640, 3), 128, np.uint8), "blank", (640, 480)))
    geometry = ObjectGeometry(camera, (), (), ScaleSource.CAMERA_HEIGHT)
    estimate = PhotoRoom().reconstruct(blank, (), geometry, Progress())
    assert estimate.architecture.floor is not None
    assert estimate.architecture.by_role("wall")
    assert estimate.confidence < 0.3
    assert estimate.source.method is RoomMethod.USUAL_SIZES


@pytest.mark.parametrize("pitch", [-60, 60, 85])
def test_extreme_views_still_give_floor_and_wall(pitch):
    shot = shoot(look(30, pitch), box_room(-2.0, 2.0, 3.0, 2.6))
    architecture = reconstruct(shot).architecture
    assert architecture.floor is not None
    assert architecture.by_role("wall")


def test_an_l_shaped_room_keeps_its_protruding_corner():
    shot = shoot(look(0, 12, fov_deg=70), L_SHAPE, FURNITURE)
    estimate = reconstruct(shot)
    scores = architecture_scores(estimate.architecture.planes, shot.planes, shot.camera)
    facing = [w for w in estimate.architecture.by_role("wall") if w.normal @ [0, -1, 0] > 0.99]
    assert sorted(w.polygon[0, 1] for w in facing) == pytest.approx([3.0, 4.8], abs=0.2)
    assert scores.pixel_error < 0.05


def test_a_slanted_wall_is_found_slanted():
    shot = shoot(look(0, 10, fov_deg=75), open_room((-2, -3), (-2, 2.4), (2.5, 4.6), (2.5, -3)))
    estimate = reconstruct(shot)
    across = np.array([2.2, -4.5, 0.0]) / np.hypot(2.2, 4.5)
    assert max(w.normal @ across for w in estimate.architecture.by_role("wall")) > np.cos(np.deg2rad(6))
    assert architecture_scores(estimate.architecture.planes, shot.planes, shot.camera).pixel_error < 0.08


def test_confidence_is_higher_where_more_is_seen():
    plain, estimate = usual()
    blank = replace(
        plain, inputs=replace(plain.inputs, photo=Photo(np.full((480, 640, 3), 128, np.uint8), "", (640, 480)))
    )
    assert estimate.confidence > reconstruct(blank).confidence + 0.2


def test_is_deterministic():
    shot, estimate = usual()
    assert reconstruct(shot) == estimate


def test_stops_when_asked():
    from diorama_core.errors import Cancelled

    token = CancelToken()
    token.cancel()
    shot = shoot(look(), box_room(-2.0, 2.0, 4.0, 2.6))
    with pytest.raises(Cancelled):
        PhotoRoom().reconstruct(shot.inputs, shot.objects, shot.geometry, Progress(token=token))


def pushed(out_m: float, weight: float, sure: float, *others: tuple[float, float]) -> float:
    """How far a wall 3 m ahead gives way to objects that protrude through it, by protrusion and confidence."""
    known = ((out_m, weight), *others)
    low = np.array([[-0.5, 2.5, 0.0] for _ in known])
    high = np.array([[0.5, 3.0 + out, 0.8] for out, _ in known])
    found = cues(object_low=low, object_high=high, object_weights=np.array([w for _, w in known]))
    wall = WallCandidate(np.array([0.0, -1.0]), -3.0, np.zeros(0, dtype=bool), 0.0, 1.0)
    return _push(Run(wall, -1.0, 1.0), found, sure)


def test_an_unsure_wall_gives_way_to_a_sure_object_and_a_sure_wall_does_not():
    assert pushed(0.4, 0.6, 0.3) == pytest.approx(0.4 + SETTINGS.search.clearance_m)
    assert pushed(0.4, 0.6, 0.9) == 0.0
    assert pushed(0.4, 0.2, 0.3) == 0.0


def test_a_wall_stays_before_the_rear_end_of_an_object_and_moves_for_all_of_it():
    assert pushed(0.2, 0.9, 0.4) == 0.0
    assert pushed(0.9, 0.9, 0.4) == pytest.approx(0.9 + SETTINGS.search.clearance_m)


def test_a_wall_may_be_wholly_wrong_as_objects_may():
    assert pushed(1.1, 0.6, 0.27) == pytest.approx(1.1 + SETTINGS.search.clearance_m)
    assert pushed(1.1, 0.6, 0.9) == 0.0
    # Once it is, what hardly anybody saw still does not take it along.
    assert pushed(1.1, 0.6, 0.27, (1.9, 0.03)) == pytest.approx(1.1 + SETTINGS.search.clearance_m)
