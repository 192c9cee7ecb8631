"""Edits of the room: it stays closed, attached things follow, the photo still fits after rescaling."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.room_edits import set_surface_finish
from diorama_core.scene.types import Architecture, Plane, Pose, Scene, SceneObject, Support, SurfaceFinish
from tests.synthetic_rooms import box_room, look


def item(name, position, size=(0.5, 0.5, 0.8), **more):
    return SceneObject(name, name, "cabinet", "shape", size, Pose.upright(position), **more)


@pytest.fixture
def scene():
    objects = (
        item("cabinet", (0.0, 3.7, 0.4)),
        item("vase", (0.0, 3.7, 0.9), (0.2, 0.2, 0.2)),
        item("picture", (1.0, 3.98, 1.5), (0.04, 0.6, 0.5)),
        item("chair", (0.5, 2.0, 0.45)),
        item("lamp", (0.0, 2.0, 2.4), (0.4, 0.4, 0.4)),
        item("bolted", (-1.0, 3.98, 1.5), (0.04, 0.6, 0.5), locked=True),
    )
    supports = (
        Support("cabinet", "floor", adheres_to=("back",)),
        Support("vase", "cabinet"),
        Support("picture", "back", "mounted on"),
        Support("chair", "floor"),
        Support("lamp", "ceiling", "mounted on"),
        Support("bolted", "back", "mounted on"),
    )
    return Scene(look(), Architecture(box_room(-2.0, 2.0, 4.0, 2.6)), objects, supports)


def closed(scene):
    """Corners of walls that no other plane shares, not counting the open side behind the camera."""
    planes = scene.architecture.planes
    for plane in planes:
        assert np.abs(plane.polygon @ plane.normal - plane.offset).max() < 1e-9
        others = np.concatenate([p.polygon for p in planes if p.id != plane.id])
        for corner in plane.polygon[plane.polygon[:, 1] > 0]:
            assert np.linalg.norm(others - corner, axis=1).min() < 1e-9


@settings(max_examples=25)
@given(
    plane=st.sampled_from(["back", "left", "right", "floor", "ceiling"]), distance=st.floats(-1.2, 3.0, allow_nan=False)
)
def test_the_room_stays_closed_and_the_plane_moves_by_that_much(plane, distance):
    before = Scene(look(), Architecture(box_room(-2.0, 2.0, 4.0, 2.6)))
    after = edits.move_plane(before, plane, distance)
    closed(after)
    moved = after.plane(plane)
    np.testing.assert_allclose(moved.normal, before.plane(plane).normal, atol=1e-9)
    assert before.plane(plane).offset - moved.offset == pytest.approx(distance, abs=1e-9)
    for other in after.architecture.planes:
        if other.id != plane:
            assert other.offset == pytest.approx(before.plane(other.id).offset, abs=1e-9)


def test_a_slanted_neighbour_keeps_its_plane():
    slanted = Plane("slanted", "wall", np.array([[-2.0, 1, 0], [-1.0, 4, 0], [-1.0, 4, 2.6], [-2.0, 1, 2.6]]))
    back = Plane("back", "wall", np.array([[-1.0, 4, 0], [2.0, 4, 0], [2.0, 4, 2.6], [-1.0, 4, 2.6]]))
    after = edits.move_plane(Scene(architecture=Architecture((slanted, back))), "back", 0.6)
    assert after.plane("slanted").offset == pytest.approx(slanted.offset, abs=1e-9)
    np.testing.assert_allclose(after.plane("back").polygon[0], [-0.8, 4.6, 0.0], atol=1e-9)
    np.testing.assert_allclose(after.plane("slanted").polygon[1], [-0.8, 4.6, 0.0], atol=1e-9)


def test_what_is_fastened_to_a_wall_follows_and_the_rest_stays(scene):
    after = edits.move_plane(scene, "back", 0.5)
    shift = {o.id: after.object(o.id).pose.position - o.pose.position for o in scene.objects}
    for name in ("cabinet", "vase", "picture"):
        np.testing.assert_allclose(shift[name], [0, 0.5, 0], atol=1e-12)
    for name in ("chair", "lamp", "bolted"):
        np.testing.assert_allclose(shift[name], 0, atol=1e-12)


def test_moving_there_and_back_changes_nothing(scene):
    there_and_back = edits.move_plane(edits.move_plane(scene, "left", 0.7), "left", -0.7)
    for plane in scene.architecture.planes:
        np.testing.assert_allclose(there_and_back.plane(plane.id).polygon, plane.polygon, atol=1e-9)


def test_a_room_cannot_be_turned_inside_out(scene):
    with pytest.raises(EditRefused, match="nothing of"):
        edits.move_plane(scene, "back", -8.0)
    with pytest.raises(EditRefused, match="no plane"):
        edits.move_plane(scene, "attic", 1.0)
    with pytest.raises(EditRefused, match="cannot move"):
        edits.move_plane(scene, "back", float("nan"))


@pytest.mark.parametrize("height", [2.2, 3.1])
def test_ceiling_height(scene, height):
    after = edits.set_ceiling_height(scene, height)
    assert edits.ceiling_height(after) == pytest.approx(height)
    closed(after)
    assert after.object("lamp").pose.position[2] == pytest.approx(2.4 + height - 2.6)
    assert after.object("picture") == scene.object("picture")
    without = replace(scene, architecture=Architecture(scene.architecture.planes[:-1]), supports=())
    assert edits.ceiling_height(edits.set_ceiling_height(without, height)) == pytest.approx(height)


def test_a_sloped_ceiling_keeps_its_slope():
    sloped = Plane("ceiling", "ceiling", np.array([[-2, 0, 3.0], [-2, 4, 2.0], [2, 4, 2.0], [2, 0, 3.0]], dtype=float))
    back = Plane("back", "wall", np.array([[-2, 4, 0], [2, 4, 0], [2, 4, 2.0], [-2, 4, 2.0]], dtype=float))
    after = edits.set_ceiling_height(Scene(architecture=Architecture((back, sloped))), 3.4)
    np.testing.assert_allclose(after.plane("ceiling").normal, sloped.normal, atol=1e-12)
    assert after.plane("back").polygon[2:, 2] == pytest.approx([2.4, 2.4])


@pytest.mark.parametrize("height", [0.2, 99.0, float("inf")])
def test_heights_that_are_no_rooms_are_refused(scene, height):
    with pytest.raises(EditRefused, match="no room"):
        edits.set_ceiling_height(scene, height)


def test_nothing_to_raise():
    with pytest.raises(EditRefused, match="neither"):
        edits.set_ceiling_height(Scene(), 2.5)


def test_this_edge_is_that_long(scene):
    now = edits.edge_length_m(scene, "back", 0)
    after = edits.rescale_by_edge(scene, "back", 0, 2.4)
    assert now == pytest.approx(4.0)
    assert edits.edge_length_m(after, "back", 0) == pytest.approx(2.4)
    for item in scene.objects:
        np.testing.assert_allclose(after.object(item.id).size_m, 0.6 * item.size_m)
        np.testing.assert_allclose(
            after.camera.project(after.object(item.id).corners_world), scene.camera.project(item.corners_world)
        )
    np.testing.assert_allclose(
        after.camera.project(after.plane("back").polygon), scene.camera.project(scene.plane("back").polygon)
    )


@pytest.mark.parametrize("length", [0.0, -1.0, float("nan"), 1e9])
def test_lengths_that_cannot_be_are_refused(scene, length):
    with pytest.raises(EditRefused):
        edits.rescale_by_edge(scene, "back", 0, length)


def test_a_finish_is_put_on_changed_and_taken_off_again(scene) -> None:
    before = scene.plane("floor")
    boards = SurfaceFinish("boards", (0.7, 0.5, 0.4))
    finished = set_surface_finish(scene, ("floor",), boards)
    again = set_surface_finish(finished, ("floor",), replace(boards, scale=2.0))
    assert again.plane("floor").finish.scale == 2.0
    assert again.plane("floor").colour == boards.colour
    assert (again.plane("floor").photo_colour, again.plane("floor").photo_texture) == (before.colour, before.texture)
    assert set_surface_finish(again, ("floor",), None).plane("floor") == before
    assert set_surface_finish(scene, ("floor",), None) == scene


@pytest.mark.parametrize("scale", [0.0, -1.0, float("nan"), 1e6])
def test_a_pattern_of_no_size_is_refused(scene, scale) -> None:
    with pytest.raises(EditRefused, match="times as large"):
        set_surface_finish(scene, ("floor",), SurfaceFinish("boards", (0.7, 0.5, 0.4), scale))
    with pytest.raises(EditRefused, match="there is no plane"):
        set_surface_finish(scene, ("roof",), None)
