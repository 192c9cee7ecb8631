"""Dragging, dropping, aligning, copying: the geometry behind the mouse."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_app.interaction.gestures import objects_in
from diorama_app.session.problem_checker import problems
from diorama_core.editing import aligning as arranging
from diorama_core.editing.clipboard import clip_of, paste_clip
from diorama_core.editing.collisions import Collisions
from diorama_core.editing.dragging import GRID_M, Slide, snap_pose
from diorama_core.editing.placing import against_wall, hits_along, insertion, places_of, seat, spot_in_view
from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import with_openings
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import Shape
from diorama_core.scene import edits
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Pose, Scene, SceneObject, Support
from tests.app.small_room import PlainLibrary, furnished_scene

LIBRARY = PlainLibrary()
SCENE = furnished_scene()
EYE = np.array([0.0, -2.5, 2.2])


def under_hand(scene: Scene, object_id: str, grabbed: np.ndarray, target: np.ndarray, **options: bool) -> Scene:
    slide = Slide.begin(scene, LIBRARY, object_id, grabbed)
    return slide.to(EYE, target - EYE, **{"snap": False, "slide": False} | options)[0]


@given(x=st.floats(-1.8, 1.8), y=st.floats(0.0, 3.0))
def test_what_is_dragged_over_the_floor_stays_under_the_hand(x: float, y: float) -> None:
    chair = SCENE.object("chair_1")
    grabbed = chair.pose.position + np.array([0.0, -0.1, 0.1])
    to = np.array([x, y, grabbed[2]])
    moved = under_hand(SCENE, "chair_1", grabbed, to)
    np.testing.assert_allclose(moved.object("chair_1").pose.position - chair.pose.position, to - grabbed, atol=1e-6)
    assert moved.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert moved.support_of("chair_1") == SCENE.support_of("chair_1")


def test_a_lamp_climbs_down_to_the_floor_and_onto_the_table_again() -> None:
    lamp = SCENE.object("lamp_1")
    down = under_hand(SCENE, "lamp_1", lamp.pose.position, np.array([-1.2, 0.6, 0.225]))
    assert down.support_of("lamp_1").parent == "floor"
    assert down.object("lamp_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    up = under_hand(down, "lamp_1", down.object("lamp_1").pose.position, np.array([0.1, 2.2, 0.74 + 0.225]))
    assert up.support_of("lamp_1").parent == "table_1"
    assert up.object("lamp_1").corners_world[:, 2].min() == pytest.approx(0.74, abs=1e-6)


def test_a_chair_does_not_climb_a_table_and_a_table_takes_its_lamp_along() -> None:
    chair = SCENE.object("chair_1")
    moved = under_hand(SCENE, "chair_1", chair.pose.position, np.array([0.1, 2.2, 0.8]))
    assert moved.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    table = SCENE.object("table_1")
    shifted = under_hand(SCENE, "table_1", table.pose.position, table.pose.position + np.array([0.3, -0.2, 0.0]))
    shift = shifted.object("lamp_1").pose.position - SCENE.object("lamp_1").pose.position
    np.testing.assert_allclose(shift, (0.3, -0.2, 0.0), atol=1e-6)


def test_a_picture_slides_on_its_wall_and_turns_onto_the_next() -> None:
    picture = SCENE.object("picture_1")
    moved = under_hand(SCENE, "picture_1", picture.pose.position, np.array([0.5, 3.4, 1.7]))
    assert moved.object("picture_1").pose.position[1] == pytest.approx(picture.pose.position[1], abs=0.01)
    assert moved.object("picture_1").pose.position[2] > picture.pose.position[2] + 0.1
    other = under_hand(SCENE, "picture_1", picture.pose.position, np.array([2.2, 1.5, 1.4]))
    wall = other.plane(other.support_of("picture_1").parent)
    assert wall.id != "wall_3"
    item = other.object("picture_1")
    np.testing.assert_allclose(item.pose.R_world_object[:, 0], wall.normal, atol=1e-6)
    gap = float((item.corners_world @ wall.normal).min()) - wall.offset
    assert gap == pytest.approx(
        SCENE.plane("wall_3").normal @ (picture.pose.position) - SCENE.plane("wall_3").offset - 0.015, abs=1e-3
    )


def test_sliding_stops_at_the_table_and_snapping_keeps_to_the_grid() -> None:
    chair = SCENE.object("chair_2")
    into = np.array([0.5, 2.2, chair.pose.position[2]])
    through = under_hand(SCENE, "chair_2", chair.pose.position, into)
    assert Collisions(LIBRARY).pairs(through, ["chair_2"])
    slid = under_hand(SCENE, "chair_2", chair.pose.position, into, slide=True)
    assert not Collisions(LIBRARY).pairs(slid, ["chair_2"])
    snapped = under_hand(SCENE, "chair_2", chair.pose.position, np.array([1.013, 0.484, 0.4]), snap=True)
    x, y = snapped.object("chair_2").pose.position[:2] / GRID_M
    assert (x - round(x), y - round(y)) == pytest.approx((0.0, 0.0), abs=1e-6)
    turned = snap_pose(chair.pose, Pose.upright(chair.pose.position, chair.pose.yaw_rad + 0.4))
    assert (np.degrees(turned.yaw_rad) / 15.0) == pytest.approx(round(np.degrees(turned.yaw_rad) / 15.0))


def test_locked_objects_are_not_dragged_and_others_come_along() -> None:
    scene = edits.set_locked(SCENE, "chair_1", True)
    with pytest.raises(EditRefused, match="locked"):
        Slide.begin(scene, LIBRARY, "chair_1", np.zeros(3))
    slide = Slide.begin(
        scene, LIBRARY, "chair_2", scene.object("chair_2").pose.position, ("chair_1", "table_1", "lamp_1", "chair_2")
    )
    assert slide.along == ("table_1",)


def test_aligned_distributed_and_mirrored() -> None:
    x = np.array([1.0, 0.0, 0.0])
    ids = ["chair_1", "chair_2", "table_1"]
    for anchor, pick in (("low", np.min), ("high", np.max)):
        made = arranging.align(SCENE, ids, x, anchor)
        ends = [pick(made.object(i).corners_world[:, 0]) for i in ids]
        assert np.ptp(ends) == pytest.approx(0.0, abs=1e-9)
        assert made.object("table_1").pose == SCENE.object("table_1").pose
    even = arranging.distribute(SCENE, ids, x)
    spans = sorted((even.object(i).corners_world[:, 0].min(), even.object(i).corners_world[:, 0].max()) for i in ids)
    assert spans[1][0] - spans[0][1] == pytest.approx(spans[2][0] - spans[1][1])
    once = arranging.mirror(SCENE, ids, x, LIBRARY)
    twice = arranging.mirror(once, ids, x, LIBRARY)
    lamp, table = (once.object(i).pose.position[0] for i in ("lamp_1", "table_1"))
    was = [SCENE.object(i).pose.position[0] for i in ("lamp_1", "table_1")]
    assert lamp - table == pytest.approx(was[1] - was[0]), "what stands on it is reflected too"
    for i in [*ids, "lamp_1"]:
        np.testing.assert_allclose(twice.object(i).pose.matrix, SCENE.object(i).pose.matrix, atol=1e-9)
    with pytest.raises(EditRefused, match="select three"):
        arranging.distribute(SCENE, ids[:2], x)


def test_mirrored_desks_have_their_drawers_at_the_other_side() -> None:
    library = built_in_library()
    shape = library.shape("desk-office-grey")
    pose = Pose.upright((0.5, 2.0, shape.size_m[2] / 2), 0.4)
    desk = SceneObject("desk_1", "desk", "desk", shape.id, shape.size_m, pose)
    scene, x = Scene(objects=(desk,)), np.array([1.0, 0.0, 0.0])
    once = arranging.mirror(scene, ["desk_1"], x, library)
    assert once.object("desk_1").shape_id.endswith(";mirrored=yes")
    twice = arranging.mirror(once, ["desk_1"], x, library).object("desk_1")
    assert twice.shape_id == desk.shape_id
    np.testing.assert_allclose(twice.pose.matrix, pose.matrix, atol=1e-9)


def test_copies_keep_standing_on_copies_and_paste_into_another_room() -> None:
    clip = clip_of(SCENE, ["table_1"])
    assert [o.id for o in clip.objects] == ["table_1", "lamp_1"]
    again, heads = paste_clip(SCENE, clip)
    check_scene(again)
    assert len(heads) == 1
    lamp = next(o for o in again.objects if o.category == "lamp" and o.id != "lamp_1")
    assert again.support_of(lamp.id).parent == heads[0]
    elsewhere, _ = paste_clip(Scene(architecture=SCENE.architecture), clip_of(SCENE, ["lamp_1"]))
    check_scene(elsewhere)
    assert elsewhere.support_of("lamp_1").parent == "floor"


def test_a_new_supporter_and_a_wall_are_followed_at_once() -> None:
    on_table = seat(edits.attach(SCENE, Support("chair_1", "table_1")), LIBRARY, "chair_1")
    assert on_table.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.74)
    wall = SCENE.plane("wall_2")
    backed = against_wall(SCENE, "chair_2", wall).object("chair_2")
    assert float((backed.corners_world @ wall.normal).min()) == pytest.approx(wall.offset, abs=1e-9)
    np.testing.assert_allclose(backed.pose.R_world_object[:, 0], wall.normal, atol=1e-9)


def test_what_is_wrong_is_found_and_what_is_right_is_not() -> None:
    collisions = Collisions(LIBRARY)
    assert problems(SCENE, LIBRARY, collisions) == {}
    raised = edits.move(SCENE, "chair_1", SCENE.object("chair_1").pose.move((0, 0, 0.2)))
    assert problems(raised, LIBRARY, collisions) == {"chair_1": ("floats",)}
    away = edits.move(SCENE, "chair_1", SCENE.object("chair_1").pose.move((-3.0, 0, 0)))
    assert problems(away, LIBRARY, collisions) == {"chair_1": ("outside",)}
    into = edits.move(SCENE, "chair_1", SCENE.object("chair_2").pose)
    assert set(problems(into, LIBRARY, collisions)) == {"chair_1", "chair_2"}


def test_a_frame_takes_in_what_is_seen_inside_it() -> None:
    camera = SCENE.camera
    assert camera is not None
    fov = camera.intrinsics.vertical_fov_rad
    aspect = camera.intrinsics.width / camera.intrinsics.height
    seen = (camera.T_world_camera[:3, :3], camera.position, fov, aspect)
    everything = objects_in(SCENE, (0.0, 0.0), (1.0, 1.0), *seen)
    assert set(everything) == {o.id for o in SCENE.objects}
    u, v = camera.project(SCENE.object("chair_2").pose.position) / (camera.intrinsics.width, camera.intrinsics.height)
    assert objects_in(SCENE, (u - 0.02, v - 0.02), (u + 0.02, v + 0.02), *seen) == ("chair_2",)


def test_doors_stand_at_the_foot_of_their_wall_and_windows_stay_within_it() -> None:
    for category, size, clicked, expected in (
        ("door", (0.1, 0.9, 2.0), 1.6, 1.0),
        ("window", (0.1, 1.2, 1.2), 2.3, 1.9),
        ("window", (0.1, 1.2, 1.2), 1.2, 1.2),
    ):
        shape = Shape(id="s", category=category, caption="", size_m=size, surfaces=(), content_hash="s")
        hits = hits_along(EYE, np.array([0.5, 3.4, clicked]) - EYE, places_of(SCENE, LIBRARY))
        item, edge = insertion(SCENE, shape, "new", hits[0], 0.0)
        assert edge.parent == "wall_3"
        assert item.pose.position[2] == pytest.approx(expected)
        opened = with_openings(edits.insert(SCENE, item, edge)).plane("wall_3")
        assert len(opened.polygon) > 4, "and cut it"


def test_what_hangs_is_put_on_the_wall_or_the_ceiling_in_the_middle_of_the_view() -> None:
    shape = Shape(id="s", category="mirror", caption="", size_m=(0.03, 0.6, 0.9), surfaces=(), content_hash="s")
    eye, ahead = np.array([0.0, 0.0, 1.6]), np.array([0.3, 1.0, -0.1])
    hit = spot_in_view(SCENE, shape, eye, ahead, on_ceiling=False)
    assert hit.place.parent == "wall_3"
    assert hit.point[2] == pytest.approx(1.5)
    above = spot_in_view(SCENE, shape, eye, np.array([0.0, 0.2, 1.0]), on_ceiling=True)
    assert above.place.parent == "ceiling"
    from_above = spot_in_view(SCENE, shape, np.array([0.0, 1.0, 9.0]), np.array([0.0, 0.0, -1.0]), on_ceiling=False)
    assert SCENE.plane(from_above.place.parent).role == "wall"
    assert spot_in_view(Scene(), shape, eye, ahead, on_ceiling=False) is None
