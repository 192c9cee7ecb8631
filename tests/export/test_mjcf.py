"""MuJoCo loads what is written, and gravity leaves it in its place."""

from __future__ import annotations

import itertools
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from diorama_core.export.bodies import hull_volume
from diorama_core.export.colliders import physical_scene, world_parts
from diorama_core.export.gathering import ExportOptions, gather
from diorama_core.export.mjcf import mjcf_text, write_mjcf
from diorama_core.export.overlaps import cut
from diorama_core.export.stability import Shake, stability
from diorama_core.layout.problem.parts import parts_of_shape
from diorama_core.scene import edits
from diorama_core.scene.types import box_corners
from tests.export.scenes import desk_in_dresser, gathered, scene_of

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed (optional extra 'sim')")


@pytest.mark.parametrize("source", ["example", "fittings", "primitives", "boxes", "empty shell"])
def test_mujoco_loads_the_file_with_its_meshes(source: str, tmp_path: Path) -> None:
    scene = gathered(source)
    write_mjcf(scene, tmp_path / "room.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for item in scene.objects:
        np.testing.assert_allclose(data.body(item.slug).xpos, item.T_world[:3, 3], atol=1e-6)
        np.testing.assert_allclose(data.body(item.slug).xmat.reshape(3, 3), item.T_world[:3, :3], atol=1e-6)


def test_the_photo_s_camera_looks_past_the_middle_where_the_photo_s_does() -> None:
    scene, library = scene_of("fittings")
    assert scene.camera is not None
    lens = replace(scene.camera.intrinsics, cx=scene.camera.intrinsics.cx + 40.0)
    off = gather(replace(scene, camera=replace(scene.camera, intrinsics=lens)), library)
    model = mujoco.MjModel.from_xml_string(mjcf_text(off, physical_scene(off)))
    pixel = model.cam_sensorsize[0][0] / lens.width
    expected = [lens.fx, lens.fy, lens.width / 2 - lens.cx, lens.height / 2 - lens.cy]
    np.testing.assert_allclose(model.cam_intrinsic[0] / pixel, expected, rtol=1e-4, atol=1e-3)


def test_a_zip_holds_the_model_and_all_it_refers_to(tmp_path: Path) -> None:
    write_mjcf(gathered("fittings"), tmp_path / "room.zip")
    with zipfile.ZipFile(tmp_path / "room.zip") as archive:
        archive.extractall(tmp_path / "unpacked")
    mujoco.MjModel.from_xml_path(str(tmp_path / "unpacked" / "room.xml"))
    assert [p.name for p in tmp_path.glob("room*")] == ["room.zip"]


@pytest.mark.parametrize("source", ["example", "fittings", "boxes"])
def test_objects_stay_for_two_seconds(source: str) -> None:
    report = stability(gathered(source))
    assert report.stable_share >= 0.98, report.unstable
    assert any(d.free for d in report.drifts)


def test_an_object_in_the_air_is_reported_as_falling() -> None:
    scene, library = scene_of("boxes")
    lifted = scene.objects[0]
    lifted = replace(lifted, pose=lifted.pose.move(np.array([0.0, 0.0, 0.5])))
    moved = replace(scene, objects=(lifted, *scene.objects[1:]))
    report = stability(gather(moved, library))
    assert report.unstable[0].object_id == lifted.id
    assert report.unstable[0].moved_m > 0.3


def test_what_stands_beside_its_carrier_is_welded_to_it_and_noted() -> None:
    """It would fall: nothing is below its foot. What hangs over an edge is held, and stays free."""
    scene, library = scene_of("fittings")
    lamp, dresser = scene.object("lamp_1"), scene.object("dresser_1")
    depth = float(dresser.size_m[0] / 2)
    for forward, free in ((depth + lamp.size_m[0], False), (depth - 0.05, True)):
        away = dresser.pose.R_world_object[:, 0] * forward
        physical = physical_scene(gather(edits.move(scene, "lamp_1", lamp.pose.move(away)), library))
        body = next(b for b in physical.bodies if b.node.id == "lamp_1")
        assert body.free == free
        assert any("lamp_1 stands beside dresser_1" in note for note in physical.notes) != free


def test_a_floor_that_shakes_hard_makes_things_fall_and_a_gentle_one_does_not() -> None:
    scene = gathered("fittings")
    assert not stability(scene, shake=Shake(0.05, 2.0, 1.0)).falls
    fallen = stability(scene, shake=Shake(1.5, 1.0, 2.0)).falls
    assert "lamp_1" in {d.object_id for d in fallen}
    assert all(d.free for d in fallen)


def test_welded_by_choice(tmp_path: Path) -> None:
    write_mjcf(gathered("example", bodies="welded"), tmp_path / "room.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml"))
    assert model.njnt == 0
    write_mjcf(gathered("example"), tmp_path / "room.xml")
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml")).njnt > 15


def test_colliders_are_the_parts_of_the_layout() -> None:
    """A bookshelf stays open inside: its bodies are its boards, not its hull."""
    scene = gathered("example")
    shelf = next(b for b in physical_scene(scene).bodies if b.node.id == "bookshelf_1")
    shape = scene.library.shape(shelf.node.item.shape_id)
    assert len(shelf.parts) == len(parts_of_shape(scene.library, shape)) > 4
    assert shelf.volume_m3 < 0.6 * float(np.prod(shelf.node.item.size_m))


def test_masses_are_those_of_furniture() -> None:
    bodies = {b.node.id: b for b in physical_scene(gathered("example")).bodies}
    assert 25 < bodies["sofa_1"].mass_kg < 90
    assert 2 < bodies["chair_1"].mass_kg < 12
    assert 0.05 < bodies["cup_1"].mass_kg < 0.8  # thin enamelled steel weighs less than stoneware
    assert all(0.2 < b.friction < 1.0 for b in bodies.values())


def test_a_cut_leaves_the_part_on_one_side() -> None:
    cube = box_corners((1.0, 1.0, 1.0))
    rest = cut(cube, np.array([0.0, 0.0, 1.0]), -0.3, 0.4)
    assert rest is not None
    assert hull_volume(rest) == pytest.approx(0.8)
    assert rest[:, 2].min() == pytest.approx(-0.3)
    assert cut(cube, np.array([0.0, 0.0, 1.0]), 0.2, 0.4) is None


def test_what_overlaps_deeply_is_not_shot_out_by_its_drawers() -> None:
    """What both fill is taken from the one, in every format: not all of them can say what does not collide."""
    overlapping = desk_in_dresser()
    desk, dresser = (b for b in physical_scene(overlapping).bodies if b.node.id in ("desk_1", "dresser_1"))
    pairs = itertools.product(world_parts(desk), world_parts(dresser))
    assert max(depth(*pair) for pair in pairs) < 1e-5
    assert not {d.object_id for d in stability(overlapping).unstable} & {"desk_1", "dresser_1"}


def depth(a: np.ndarray, b: np.ndarray) -> float:
    """How deep two convex bodies are in each other, metres, along the normals of their faces."""
    normals = np.concatenate([ConvexHull(a).equations, -ConvexHull(b).equations])[:, :3]
    return -float(((b @ normals.T).min(axis=0) - (a @ normals.T).max(axis=0)).max())


def test_what_others_fill_entirely_stays_where_it_is() -> None:
    scene, library = scene_of("example")
    sofa, chair = scene.object("sofa_1"), scene.object("chair_1")
    inside = replace(chair.pose, position=sofa.pose.position, scale=0.2 * np.asarray(chair.pose.scale))
    swallowed = physical_scene(gather(edits.move(scene, chair.id, inside), library))
    assert "chair_1 is inside other objects and stays where it is" in swallowed.notes
    assert not next(b for b in swallowed.bodies if b.node.id == chair.id).free


def test_the_leaves_of_two_doors_in_one_place_stay_closed() -> None:
    """Doors are welded to their walls, but their leaves move: they must not push each other open."""
    scene, library = scene_of("fittings")
    door = scene.object("door_1")
    aside = replace(door.pose, position=door.pose.position + np.array([0.05, 0.02, 0.0]))
    twin, held = replace(door, id="door_2", pose=aside), replace(scene.support_of("door_1"), child="door_2")
    both = replace(scene, objects=(*scene.objects, twin), supports=(*scene.supports, held))
    doubled = gather(both, library, options=ExportOptions(joints=True))
    physical = physical_scene(doubled)
    model = mujoco.MjModel.from_xml_string(mjcf_text(doubled, physical))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    for name in ("door_1__door", "door_2__door"):
        assert abs(data.qpos[model.joint(name).qposadr[0]]) < 0.02
