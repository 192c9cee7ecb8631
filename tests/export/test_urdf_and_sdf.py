"""URDF against MuJoCo's reader, SDF against the scene, joints against gravity and force."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from diorama_core.export.colliders import physical_scene
from diorama_core.export.links import links_of
from diorama_core.export.mjcf import mjcf_text, write_mjcf
from diorama_core.export.sdf import write_sdf
from diorama_core.export.urdf import write_urdf
from tests.export.scenes import gathered

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed (optional extra 'sim')")


@pytest.mark.parametrize("source", ["example", "fittings", "boxes", "empty shell"])
def test_mujoco_reads_the_urdf(source: str, tmp_path: Path) -> None:
    scene = gathered(source, joints=True)
    write_urdf(scene, tmp_path / "room.urdf")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "room.urdf"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for body in physical_scene(scene).bodies:
        np.testing.assert_allclose(data.body(body.node.slug).xpos, body.node.T_world[:3, 3], atol=1e-5)
        np.testing.assert_allclose(data.body(body.node.slug).xmat.reshape(3, 3), body.node.T_world[:3, :3], atol=1e-5)
        assert model.body(body.node.slug).mass[0] == pytest.approx(body.mass_kg, rel=1e-3)


def test_urdf_and_mjcf_open_their_joints_alike(tmp_path: Path) -> None:
    scene = gathered("fittings", joints=True)
    write_urdf(scene, tmp_path / "room.urdf")
    write_mjcf(scene, tmp_path / "room.xml")
    names = [link.name for link in links_of(scene, physical_scene(scene)) if link.limb is not None]
    assert {n.split("_1_")[0] for n in names} == {"dresser", "door", "laptop", "chair", "desk"}
    centres = []
    for file, suffix in (("room.urdf", "_joint"), ("room.xml", "")):
        model = mujoco.MjModel.from_xml_path(str(tmp_path / file))
        data = mujoco.MjData(model)
        for name in names:
            joint = model.joint(f"{name}{suffix}")
            data.qpos[joint.qposadr[0]] = joint.range[1] if joint.limited[0] else 1.0
        mujoco.mj_forward(model, data)
        centres.append(np.array([data.body(name).xipos for name in names]))
    np.testing.assert_allclose(centres[0], centres[1], atol=2e-3)


@pytest.mark.parametrize("source", ["example", "fittings"])
def test_every_file_that_is_named_exists(source: str, tmp_path: Path) -> None:
    scene = gathered(source, joints=True)
    write_urdf(scene, tmp_path / "room.urdf")
    urdf = ElementTree.parse(tmp_path / "room.urdf")
    named = {m.get("filename", "") for m in urdf.iter("mesh")}
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
    assert models["window_1"].findtext("static") == "true"
    assert models["desk_1"].findtext("static") == "false"
    assert {j.get("type") for j in models["dresser_1"].iter("joint")} == {"prismatic"}


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
