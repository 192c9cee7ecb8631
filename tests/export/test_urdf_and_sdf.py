"""URDF against MuJoCo's reader, SDF against the scene, joints against gravity and force."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from diorama_core.export.colliders import physical_scene
from diorama_core.export.gathering import gather
from diorama_core.export.links import inertia_terms, links_of, numbers, srgb_rgba
from diorama_core.export.mjcf import mjcf_text, write_mjcf
from diorama_core.export.sdf import write_sdf
from diorama_core.export.stability import stability, urdf_model
from diorama_core.export.urdf import write_urdf
from diorama_core.render.appearance import Material
from diorama_core.scene.types import Support
from tests.export.scenes import gathered, scene_of

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed (optional extra 'sim')")


@pytest.mark.parametrize("source", ["example", "fittings", "boxes", "empty shell"])
def test_mujoco_reads_the_urdf(source: str, tmp_path: Path) -> None:
    """The room, and every object that may move by itself: few programs read floating joints."""
    scene = gathered(source, joints=True)
    write_urdf(scene, tmp_path / "room.urdf")
    model = urdf_model(tmp_path / "room.urdf")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for body in physical_scene(scene).bodies:
        name = f"{body.node.slug}/{body.node.slug}" if body.free else body.node.slug
        np.testing.assert_allclose(data.body(name).xpos, body.node.T_world[:3, 3], atol=1e-5)
        np.testing.assert_allclose(data.body(name).xmat.reshape(3, 3), body.node.T_world[:3, :3], atol=1e-5)
        assert model.body(name).mass[0] == pytest.approx(body.mass_kg, rel=1e-3)
    for file in tmp_path.rglob("*.urdf"):
        assert {j.get("type") for j in ElementTree.parse(file).iter("joint")} <= {
            "fixed",
            "revolute",
            "prismatic",
            "continuous",
        }


def test_gravity_leaves_what_the_urdf_itself_says_in_its_place(tmp_path: Path) -> None:
    """With MuJoCo's own settings, and on a rug that carries some and lies under the feet of others. From a package,
    since the tests above read plain files."""
    scene = gathered("example", joints=True)
    write_urdf(scene, tmp_path / "room.zip")
    report = stability(scene, urdf=tmp_path / "room.zip")
    assert report.unstable == ()
    assert len(report.drifts) == len(scene.objects)


def test_a_rug_stays_where_it_is_and_holds_up_only_what_stands_on_it() -> None:
    scene, library = scene_of("fittings")
    rug, chair = scene.object("rug_1"), scene.object("chair_1")
    standing = replace(
        chair, pose=chair.pose.move(np.append((rug.pose.position - chair.pose.position)[:2], rug.size_m[2]))
    )
    scene = replace(
        scene,
        objects=tuple(standing if o.id == chair.id else o for o in scene.objects),
        supports=(*(s for s in scene.supports if s.child != chair.id), Support(chair.id, rug.id)),
    )
    carrying = gather(scene, library)
    body = next(b for b in physical_scene(carrying).bodies if b.node.id == rug.id)
    assert not body.free
    assert 0 < body.volume_m3 < 0.2 * float(np.prod(rug.size_m))
    assert {chair.id, rug.id}.isdisjoint(d.object_id for d in stability(carrying).unstable)


def test_the_floor_reaches_beyond_the_room() -> None:
    """What a robot pushes out of a room that lacks a wall does not fall."""
    scene = gathered("example")
    floor = next(s for s in physical_scene(scene).slabs if s.plane.role == "floor")
    (box,) = floor.pieces
    room = floor.plane.polygon
    assert (box[:, :2].min(axis=0) < room[:, :2].min(axis=0) - 5).all()
    assert (box[:, :2].max(axis=0) > room[:, :2].max(axis=0) + 5).all()
    assert box[:, 2].max() == pytest.approx(room[:, 2].max(), abs=1e-9)
    assert np.ptp(box[:, 2]) > 0.3


def test_urdf_and_mjcf_open_their_joints_alike(tmp_path: Path) -> None:
    scene = gathered("fittings", joints=True)
    write_urdf(scene, tmp_path / "room.urdf")
    write_mjcf(scene, tmp_path / "room.xml")
    names = [link.name for link in links_of(scene, physical_scene(scene)) if link.limb is not None]
    assert {n.split("_1_")[0] for n in names} == {"dresser", "door", "laptop", "chair", "desk"}
    centres = []
    for model, suffix in (
        (urdf_model(tmp_path / "room.urdf"), "_joint"),
        (mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml")), ""),
    ):
        data = mujoco.MjData(model)
        joints = {model.joint(k).name.rpartition("/")[2]: model.joint(k) for k in range(model.njnt)}
        bodies = {model.body(k).name.rpartition("/")[2]: k for k in range(model.nbody)}
        for name in names:
            joint = joints[f"{name}{suffix}"]
            data.qpos[joint.qposadr[0]] = joint.range[1] if joint.limited[0] else 1.0
        mujoco.mj_forward(model, data)
        centres.append(np.array([data.xipos[bodies[name]] for name in names]))
    np.testing.assert_allclose(centres[0], centres[1], atol=2e-3)


@pytest.mark.parametrize("source", ["example", "fittings"])
def test_every_file_that_is_named_exists(source: str, tmp_path: Path) -> None:
    scene = gathered(source, joints=True)
    write_urdf(scene, tmp_path / "room.urdf")
    named = {
        str((file.parent / m.get("filename", "")).relative_to(tmp_path))
        for file in tmp_path.rglob("*.urdf")
        for m in ElementTree.parse(file).iter("mesh")
    }
    write_sdf(scene, tmp_path / "room.sdf")
    named |= {u.text or "" for u in ElementTree.parse(tmp_path / "room.sdf").iter("uri")}
    assert len(named) > 50
    for name in named:
        assert (tmp_path / name).is_file(), name
    for mtl in (tmp_path / "room_urdf" / "meshes").glob("*.mtl"):
        for line in mtl.read_text().splitlines():
            if line.startswith("map_Kd"):
                assert (mtl.parent / line.split()[1]).is_file()


def test_the_sdf_world_says_where_everything_is(tmp_path: Path) -> None:
    scene = gathered("fittings", joints=True)
    write_sdf(scene, tmp_path / "room.sdf")
    world = ElementTree.parse(tmp_path / "room.sdf").find("world")
    assert world is not None
    models = {m.get("name"): m for m in world.findall("model")}
    assert set(models) == {"room", *(o.slug for o in scene.objects)}
    for item in scene.objects:
        pose = np.array((models[item.slug].findtext("pose") or "").split(), dtype=float)
        np.testing.assert_allclose(pose[:3], item.T_world[:3, 3], atol=1e-8)
        R = Rotation.from_euler("xyz", pose[3:]).as_matrix()
        np.testing.assert_allclose(R, item.T_world[:3, :3], atol=1e-8)
    assert models["window_1"].findtext("static") == "1"
    assert models["desk_1"].findtext("static") == "0"
    assert {j.get("type") for j in models["dresser_1"].iter("joint")} == {"prismatic"}
    soft = "{http://drake.mit.edu}compliant_hydroelastic"
    assert all(c.find(f".//{soft}") is not None for c in world.iter("collision"))  # Drake: contact over a face


def test_every_joint_moves_freely_through_its_range() -> None:
    """Pushed along each joint in turn, everything opens against gravity, friction and damping."""
    scene = gathered("fittings", joints=True)
    model = mujoco.MjModel.from_xml_string(mjcf_text(scene, physical_scene(scene)))
    joints = [j for j in map(model.joint, range(model.njnt)) if j.type[0] != mujoco.mjtJoint.mjJNT_FREE]
    assert len(joints) >= 9
    for joint in joints:
        data = mujoco.MjData(model)
        slide = joint.type[0] == mujoco.mjtJoint.mjJNT_SLIDE
        end = float(joint.range[1]) if joint.limited[0] else np.pi / 2
        reached = 0.0
        for _ in range(3000):
            data.qfrc_applied[joint.dofadr[0]] = 12.0 if slide else 4.0
            mujoco.mj_step(model, data)
            reached = max(reached, float(data.qpos[joint.qposadr[0]]))
            if reached > 0.97 * end:
                break
        assert reached > 0.97 * end, f"{joint.name} stops at {reached / end:.0%}"


def test_numbers_and_inertia_are_read_back() -> None:
    values = np.array([1.0, -0.25, 1e-7, 123456.789])
    np.testing.assert_allclose(np.array(numbers(values).split(), float), values, rtol=1e-8)
    tensor = np.array([[1.0, 0.1, 0.2], [0.1, 2.0, 0.3], [0.2, 0.3, 3.0]])
    assert {k: float(v) for k, v in inertia_terms(tensor).items()} == {
        "ixx": 1.0, "ixy": 0.1, "ixz": 0.2, "iyy": 2.0, "iyz": 0.3, "izz": 3.0,
    }  # fmt: skip


def test_colours_are_display_values() -> None:
    np.testing.assert_allclose(
        srgb_rgba(Material("x", (0.0, 0.2158605, 1.0), alpha=0.5)), [0, 0.50196, 1, 0.5], atol=1e-4
    )
