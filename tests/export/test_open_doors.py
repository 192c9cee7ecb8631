"""What stands open is written open; formats with joints say how far, and can close it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from diorama_core.export.gathering import ExportOptions, ExportScene, gather
from diorama_core.export.mjcf import write_mjcf
from diorama_core.export.sdf import write_sdf
from diorama_core.export.stability import urdf_model
from diorama_core.export.urdf import write_urdf
from diorama_core.importing.forms import read_mark
from diorama_core.importing.opening import open_marked
from diorama_core.library.catalogue import BuiltInLibrary, built_in_library
from diorama_core.library.opening import can_open
from diorama_core.scene.schema import scene_to_json
from diorama_core.scene.types import Pose, Scene, SceneObject
from tests.export.scenes import scene_of

OPEN = 0.6
"""Of the way."""
CLOSE_M = 1e-3


@pytest.fixture(scope="module")
def library() -> BuiltInLibrary:
    return built_in_library()


@pytest.fixture(scope="module")
def half_open() -> ExportScene:
    return opened_room(joints=True)


def opened_room(*, joints: bool) -> ExportScene:
    """The room with fittings: door, dresser, desk and laptop open, the dresser also stretched."""
    scene, library = scene_of("fittings")
    objects = [replace(o, open_share=OPEN) if can_open(library, o.shape_id) else o for o in scene.objects]
    dresser = next(k for k, o in enumerate(objects) if o.id == "dresser_1")
    wide = replace(objects[dresser].pose, scale=np.array([1.2, 0.9, 1.0]))
    objects[dresser] = replace(objects[dresser], pose=wide)
    return gather(replace(scene, objects=tuple(objects)), library, options=ExportOptions(joints=joints))


def standing(scene: ExportScene) -> dict[str, np.ndarray]:
    """World boxes of everything as it stands, without joints."""
    found = {}
    for item in scene.objects:
        points = np.concatenate([s.vertices for s in scene.meshes[item.mesh].surfaces]) * item.scale
        found[item.slug] = box(points @ item.T_world[:3, :3].T + item.T_world[:3, 3])
    return found


def box(points: np.ndarray) -> np.ndarray:
    return np.stack([points.min(axis=0), points.max(axis=0)])


def limbs(scene: ExportScene) -> list[tuple[str, float, float]]:
    """Names of moving parts that have limits, where they stand, and how far they go."""
    found = [(f"{o.slug}__{m.slug}", m.opened, m.upper) for o in scene.objects for m in o.limbs if m.kind != "swivel"]
    assert len(found) >= 9
    return found


def test_an_open_door_is_written_open_beside_a_closed_one_of_the_same_shape(library: BuiltInLibrary) -> None:
    shape = next(s for s in library.in_category("door") if can_open(library, s.id))
    closed = SceneObject("a", "door", "door", shape.id, shape.size_m, Pose.upright((0.0, 0.0, 1.0)))
    opened = replace(closed, id="b", pose=Pose.upright((3.0, 0.0, 1.0)), open_share=1.0)
    boxes = standing(gather(Scene(objects=(closed, opened)), library))
    depth = {name: float(np.ptp(corners[:, 0])) for name, corners in boxes.items()}
    assert depth["b"] > depth["a"] + 0.4


def test_mujoco_sees_everything_as_far_open_as_it_stands(half_open: ExportScene, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco", reason="needs the extra [sim]")
    write_mjcf(half_open, tmp_path / "room.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for name, opened, upper in limbs(half_open):
        joint = model.joint(name)
        assert opened == pytest.approx(OPEN * upper)
        assert data.qpos[joint.qposadr[0]] == pytest.approx(opened)
        np.testing.assert_allclose(joint.range, [0.0, upper], atol=1e-6)
    expected = standing(opened_room(joints=False))
    assert expected.keys() >= {"dresser_1", "door_1", "laptop_1"}
    for slug, corners in expected.items():
        np.testing.assert_allclose(box(shown_in_mujoco(model, data, slug)), corners, atol=CLOSE_M, err_msg=slug)
    for name, _, _ in limbs(half_open):  # closed again, everything is within its case
        data.qpos[model.joint(name).qposadr[0]] = 0.0
    mujoco.mj_forward(model, data)
    for slug, corners in standing(closed_room()).items():
        np.testing.assert_allclose(box(shown_in_mujoco(model, data, slug)), corners, atol=CLOSE_M, err_msg=slug)


def closed_room() -> ExportScene:
    opened = opened_room(joints=False)
    objects = tuple(replace(o, open_share=0.0) for o in opened.scene.objects)
    return gather(replace(opened.scene, objects=objects), opened.library)


def shown_in_mujoco(model: object, data: object, slug: str) -> np.ndarray:
    """World vertices of the visual meshes of an object and its moving parts."""
    points = []
    for number in range(model.ngeom):
        geom = model.geom(number)
        owner = model.body(int(geom.bodyid[0])).name
        if geom.group[0] == 1 and (owner == slug or owner.startswith(f"{slug}__")):
            mesh = model.mesh(int(geom.dataid[0]))
            start, count = int(mesh.vertadr[0]), int(mesh.vertnum[0])
            R, t = data.geom_xmat[number].reshape(3, 3), data.geom_xpos[number]
            points.append(model.mesh_vert[start : start + count] @ R.T + t)
    return np.concatenate(points)


def test_what_stands_open_stays_so_for_two_seconds(half_open: ExportScene, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco", reason="needs the extra [sim]")
    write_mjcf(half_open, tmp_path / "room.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml"))
    data = mujoco.MjData(model)
    for _ in range(round(2.0 / model.opt.timestep)):
        mujoco.mj_step(model, data)
    for name, opened, upper in limbs(half_open):
        assert data.qpos[model.joint(name).qposadr[0]] == pytest.approx(opened, abs=0.05 * upper), name


def test_urdf_places_it_open_with_the_travel_that_is_left(half_open: ExportScene, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco", reason="needs the extra [sim]")
    write_mjcf(half_open, tmp_path / "room.xml")
    write_urdf(half_open, tmp_path / "room.urdf")
    known, read = mujoco.MjModel.from_xml_path(str(tmp_path / "room.xml")), urdf_model(tmp_path / "room.urdf")
    joints = {read.joint(k).name.rpartition("/")[2]: read.joint(k) for k in range(read.njnt)}
    bodies = {read.body(k).name.rpartition("/")[2]: k for k in range(read.nbody)}
    states = [mujoco.MjData(model) for model in (known, read)]
    for where in (0.0, 1.0):  # as it stands, then as far open as it goes
        for name, opened, upper in limbs(half_open):
            left = joints[f"{name}_joint"]
            np.testing.assert_allclose(left.range, [-opened, upper - opened], atol=1e-6)
            states[0].qpos[known.joint(name).qposadr[0]] = opened + where * (upper - opened)
            states[1].qpos[left.qposadr[0]] = where * (upper - opened)
        for model, data in zip((known, read), states, strict=True):
            mujoco.mj_forward(model, data)
        for name, _, _ in limbs(half_open):
            np.testing.assert_allclose(states[1].xipos[bodies[name]], states[0].body(name).xipos, atol=2e-3)


def test_sdf_places_it_open_with_the_travel_that_is_left(half_open: ExportScene, tmp_path: Path) -> None:
    write_sdf(half_open, tmp_path / "room.sdf")
    root = ElementTree.parse(tmp_path / "room.sdf").getroot()
    links = {link.get("name"): link for link in root.iter("link")}
    joints = {joint.get("name"): joint for joint in root.iter("joint")}
    frames = {f"{o.slug}__{m.slug}": m.T_object_limb for o in half_open.objects for m in o.limbs}
    for name, opened, upper in limbs(half_open):
        assert float(joints[f"{name}_joint"].findtext("axis/limit/lower", "")) == pytest.approx(-opened, abs=1e-6)
        assert float(joints[f"{name}_joint"].findtext("axis/limit/upper", "")) == pytest.approx(upper - opened)
        own, case = (pose(links[key].findtext("pose", "")) for key in (name, name.split("__")[0]))
        np.testing.assert_allclose(np.linalg.inv(case) @ own, frames[name], atol=1e-5)


def pose(text: str) -> np.ndarray:
    values = np.array(text.split(), dtype=float)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_euler("xyz", values[3:]).as_matrix(), values[:3]
    return T


@pytest.mark.parametrize("suffix", ["usda", "usdz"])
def test_usd_places_it_open_and_its_joints_agree(half_open: ExportScene, suffix: str, tmp_path: Path) -> None:
    pytest.importorskip("pxr", reason="needs the extra [usd]")
    from pxr import Usd, UsdGeom, UsdPhysics

    from diorama_core.export.usd import write_layer, write_usdz
    from tests.export.validators import usd_findings

    path = tmp_path / f"room.{suffix}"
    {"usda": write_layer, "usdz": write_usdz}[suffix](half_open, path)
    assert usd_findings(path) == []
    stage = Usd.Stage.Open(str(path))
    cache = UsdGeom.XformCache()
    for name, opened, _ in limbs(half_open):
        prim = stage.GetPrimAtPath(f"/Scene/Objects/{name}/Joint")
        slides = prim.IsA(UsdPhysics.PrismaticJoint)
        joint = UsdPhysics.Joint(prim)
        frames = []
        for side in (0, 1):
            body = stage.GetPrimAtPath((joint.GetBody0Rel(), joint.GetBody1Rel())[side].GetTargets()[0])
            local = np.eye(4)
            turn = (joint.GetLocalRot0Attr(), joint.GetLocalRot1Attr())[side].Get()
            local[:3, :3] = Rotation.from_quat([*turn.GetImaginary(), turn.GetReal()]).as_matrix()
            local[:3, 3] = (joint.GetLocalPos0Attr(), joint.GetLocalPos1Attr())[side].Get()
            frames.append(np.array(cache.GetLocalToWorldTransform(body)).T @ local)
        between = np.linalg.inv(frames[0]) @ frames[1]
        expected = np.eye(4)
        if slides:
            expected[0, 3] = opened
        else:
            expected[:3, :3] = Rotation.from_rotvec([opened, 0.0, 0.0]).as_matrix()
        np.testing.assert_allclose(between, expected, atol=1e-5, err_msg=name)
    marked = read_mark(path)
    assert marked is not None
    assert scene_to_json(open_marked(marked).scene) == scene_to_json(half_open.scene)
