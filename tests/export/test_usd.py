"""USD files against the validators of usd-core, and against the scene they were made from."""

from __future__ import annotations

import json
import struct
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("pxr", reason="usd-core is not installed (optional extra 'usd')")

from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdPhysics, UsdShade

from diorama_core.export.colliders import physical_scene
from diorama_core.export.gathering import gather
from diorama_core.export.usd import write_layer, write_usdz
from diorama_core.export.usd_materials import extent, integers, place, quaternion, vectors
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.scene.schema import scene_from_json
from tests.export.scenes import SOURCES, gathered, scene_of
from tests.export.validators import usd_findings

WRITERS = {"usda": write_layer, "usdc": write_layer, "usdz": write_usdz}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The example in every format, by suffix."""
    folder = tmp_path_factory.mktemp("usd")
    for suffix, write in WRITERS.items():
        write(gathered("example"), folder / f"room.{suffix}")
    return {suffix: folder / f"room.{suffix}" for suffix in WRITERS}


@pytest.fixture(scope="module")
def example(written: dict[str, Path]) -> Usd.Stage:
    return Usd.Stage.Open(str(written["usda"]))


@pytest.fixture(scope="module")
def fittings(tmp_path_factory: pytest.TempPathFactory) -> Usd.Stage:
    """The room of what opens, with its joints."""
    path = tmp_path_factory.mktemp("fittings") / "room.usdc"
    write_layer(gathered("fittings", joints=True), path)
    return Usd.Stage.Open(str(path))


@pytest.mark.parametrize("suffix", list(WRITERS))
def test_all_validators_find_nothing_in_any_format(suffix: str, written: dict[str, Path]) -> None:
    assert usd_findings(written[suffix]) == []


@pytest.mark.parametrize("source", [s for s in SOURCES if s != "example"])
def test_all_validators_find_nothing_in_any_room(source: str, tmp_path: Path) -> None:
    write_usdz(gathered(source), tmp_path / "room.usdz")
    assert usd_findings(tmp_path / "room.usdz") == []


def test_the_validators_do_find_something_wrong(tmp_path: Path) -> None:
    path = tmp_path / "room.usda"
    write_layer(gathered("primitives"), path)
    stage = Usd.Stage.Open(str(path))
    stage.GetRootLayer().ClearDefaultPrim()
    UsdGeom.Xform.Define(stage, "/Scene/Objects/t/Colliders/Part_0/Inside")
    UsdGeom.Mesh.Define(stage, "/Scene/Objects/t/Colliders/Part_0/Nested")
    stage.GetRootLayer().Save()
    assert usd_findings(path)


def test_objects_stand_where_the_scene_says(written: dict[str, Path]) -> None:
    scene = gathered("example")
    for path in written.values():
        stage = Usd.Stage.Open(str(path))
        assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
        upright = UsdGeom.GetStageUpAxis(stage) == "Z"
        for item in scene.objects:
            prim = stage.GetPrimAtPath(f"/Scene/Objects/{item.slug}")
            shown = _world_points(prim)
            points = np.concatenate([s.vertices for s in scene.meshes[item.mesh].surfaces]) * item.scale
            world = points @ item.T_world[:3, :3].T + item.T_world[:3, 3]
            if not upright:
                world = np.stack([world[:, 0], world[:, 2], -world[:, 1]], axis=1)
            np.testing.assert_allclose(shown.min(axis=0), world.min(axis=0), atol=1e-5)
            np.testing.assert_allclose(shown.max(axis=0), world.max(axis=0), atol=1e-5)


def _world_points(prim: Usd.Prim) -> np.ndarray:
    """World positions of everything that is drawn of an object."""
    found, cache = [], UsdGeom.XformCache()
    for mesh in Usd.PrimRange(prim.GetChild("Shape"), Usd.TraverseInstanceProxies()):
        if mesh.IsA(UsdGeom.Mesh):
            T = np.array(cache.GetLocalToWorldTransform(mesh))
            found.append(np.array(UsdGeom.Mesh(mesh).GetPointsAttr().Get()) @ T[:3, :3] + T[3, :3])
    return np.concatenate(found)


def test_the_package_is_aligned_stored_and_starts_with_its_layer(written: dict[str, Path]) -> None:
    data = written["usdz"].read_bytes()
    with zipfile.ZipFile(written["usdz"]) as package:
        entries = package.infolist()
    assert entries[0].filename.endswith(".usdc")
    for entry in entries:
        name, extra = struct.unpack_from("<HH", data, entry.header_offset + 26)
        assert entry.compress_type == zipfile.ZIP_STORED
        assert (entry.header_offset + 30 + name + extra) % 64 == 0
    assert UsdGeom.GetStageUpAxis(Usd.Stage.Open(str(written["usdz"]))) == "Y"


def test_shapes_are_instances_of_shared_prototypes(example: Usd.Stage, tmp_path: Path) -> None:
    """Chairs of one shape share one, where the photo's materials do not tell them apart."""
    scene, library = scene_of("example")
    plain = replace(scene, objects=tuple(replace(o, colour=None, material_source="library") for o in scene.objects))
    write_layer(gather(plain, library), tmp_path / "room.usda")
    stage = Usd.Stage.Open(str(tmp_path / "room.usda"))
    chairs = [stage.GetPrimAtPath(f"/Scene/Objects/chair_{k}/Shape") for k in (1, 2, 3)]
    assert all(c.IsInstance() for c in chairs)
    assert len({str(c.GetPrototype().GetPath()) for c in chairs}) == 1
    for prim in Usd.PrimRange.Stage(example, Usd.TraverseInstanceProxies()):
        if prim.IsA(UsdGeom.Mesh) and "Surface_" in prim.GetName():
            material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
            assert material, prim.GetPath()


def test_every_picture_exists(example: Usd.Stage) -> None:
    folder, count = Path(example.GetRootLayer().realPath).parent, 0
    for prim in Usd.PrimRange.Stage(example, Usd.TraverseInstanceProxies()):
        shader = UsdShade.Shader(prim)
        if shader and shader.GetIdAttr().Get() == "UsdUVTexture":
            assert (folder / shader.GetInput("file").Get().path).is_file()
            count += 1
    assert count > 20


def test_bodies_masses_and_lights_are_those_of_the_scene(example: Usd.Stage) -> None:
    physical = physical_scene(gathered("example"))
    for body in physical.bodies:
        prim = example.GetPrimAtPath(f"/Scene/Objects/{body.node.slug}")
        assert prim.HasAPI(UsdPhysics.RigidBodyAPI) == (body.free or body.carrier is not None)
        if body.free:
            assert UsdPhysics.MassAPI(prim).GetMassAttr().Get() == pytest.approx(body.mass_kg, rel=1e-5)
        colliders = [c for c in Usd.PrimRange(prim) if c.HasAPI(UsdPhysics.CollisionAPI)]
        assert len(colliders) == len(body.parts)
    assert example.GetPrimAtPath("/Scene/Physics").GetAttribute("mjc:flag:multiccd").Get()
    lamps = [p for p in example.Traverse() if p.IsA(UsdLux.SphereLight) and "Objects" in str(p.GetPath())]
    assert len(lamps) == 3


@pytest.mark.parametrize("suffix", ["usdc", "usdz"])
def test_joints_have_limits_and_validate(suffix: str, fittings: Usd.Stage, tmp_path: Path) -> None:
    """In the frame of the scene, and turned to Y up."""
    stage = fittings
    if suffix == "usdz":
        write_usdz(gathered("fittings", joints=True), tmp_path / "room.usdz")
        stage = Usd.Stage.Open(str(tmp_path / "room.usdz"))
    assert usd_findings(Path(stage.GetRootLayer().realPath)) == []
    slides = [UsdPhysics.PrismaticJoint(p) for p in stage.Traverse() if p.IsA(UsdPhysics.PrismaticJoint)]
    hinges = [UsdPhysics.RevoluteJoint(p) for p in stage.Traverse() if p.IsA(UsdPhysics.RevoluteJoint)]
    owners = [str(s.GetPath()).split("/")[3].split("__")[0] for s in slides]
    assert {name: owners.count(name) for name in owners} == {"dresser_1": 6, "desk_1": 3}
    assert all(0.2 < s.GetUpperLimitAttr().Get() < 0.5 for s in slides)
    assert {round(h.GetUpperLimitAttr().Get()) for h in hinges if h.GetUpperLimitAttr().HasAuthoredValue()} >= {90}
    drawer = stage.GetPrimAtPath("/Scene/Objects/dresser_1__drawer_1")
    assert drawer.HasAPI(UsdPhysics.RigidBodyAPI)
    dresser = stage.GetPrimAtPath("/Scene/Objects/dresser_1")
    assert not np.allclose(_world_points(drawer).max(axis=0), _world_points(dresser).max(axis=0))


def test_every_joint_belongs_to_an_articulation(fittings: Usd.Stage) -> None:
    """Reached from a root over joints, or a root itself: newton refuses a stage with any other."""
    prims = list(fittings.Traverse())
    roots = {p.GetPath() for p in prims if p.HasAPI(UsdPhysics.ArticulationRootAPI)}
    joints = [UsdPhysics.Joint(p) for p in prims if p.IsA(UsdPhysics.Joint)]
    assert joints
    for joint in joints:
        above = joint.GetBody0Rel().GetTargets()[0]
        moves = fittings.GetPrimAtPath(above).HasAPI(UsdPhysics.RigidBodyAPI)
        assert (above if moves else joint.GetPath()) in roots, joint.GetPath()


def test_a_lens_is_in_tenths_of_a_metre(example: Usd.Stage) -> None:
    """As the schema says: programs that go by it otherwise read one of 2.6 m."""
    camera = UsdGeom.Camera(example.GetPrimAtPath("/Scene/PhotoCamera"))
    assert 100 * camera.GetHorizontalApertureAttr().Get() == pytest.approx(36.0)
    assert 15 < 100 * camera.GetFocalLengthAttr().Get() < 60


def test_a_moving_part_does_not_collide_with_its_case(fittings: Usd.Stage) -> None:
    """Engines know that of joined bodies, but not where the case cannot move and so is no body."""
    leaf = fittings.GetPrimAtPath("/Scene/Objects/door_1__door/Colliders/Part_0")
    assert leaf.HasAPI(UsdPhysics.FilteredPairsAPI)
    apart = {str(path) for path in UsdPhysics.FilteredPairsAPI(leaf).GetFilteredPairsRel().GetTargets()}
    case = fittings.GetPrimAtPath("/Scene/Objects/door_1/Colliders").GetChildren()
    assert apart == {str(part.GetPath()) for part in case}


def test_the_scene_comes_along(example: Usd.Stage) -> None:
    document = example.GetDefaultPrim().GetAttribute("diorama:scene").Get()
    assert scene_from_json(document) == gathered("example").scene
    cup = example.GetPrimAtPath("/Scene/Objects/cup_1")
    assert json.loads(cup.GetAttribute("diorama:entry").Get())["candidates"]
    assert cup.GetRelationship("diorama:supporter").GetTargets() == [Sdf.Path("/Scene/Objects/coffee_table_1")]


def test_the_camera_sees_what_the_photo_saw(example: Usd.Stage) -> None:
    camera = gathered("example").camera
    assert camera is not None
    frustum = UsdGeom.Camera(example.GetPrimAtPath("/Scene/PhotoCamera")).GetCamera().frustum
    seen = frustum.ComputeViewMatrix() * frustum.ComputeProjectionMatrix()
    for point in ((0.5, 3.0, 0.4), (-1.0, 4.0, 1.2)):
        x, y, _ = seen.Transform(point)
        k = camera.intrinsics
        pixel = [(x + 1) / 2 * k.width, (1 - y) / 2 * k.height]
        np.testing.assert_allclose(pixel, camera.project(np.array(point)), atol=0.05)


@given(st.tuples(*[st.floats(-3, 3)] * 3).map(np.array), st.tuples(*[st.floats(-9, 9)] * 3).map(np.array))
def test_a_prim_is_placed_as_the_matrix_says(turn, position) -> None:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation_from_vector(turn), position
    stage = Usd.Stage.CreateInMemory()
    prim = UsdGeom.Xform.Define(stage, "/x")
    place(prim, T)
    # USD's matrices act on rows.
    np.testing.assert_allclose(np.array(prim.GetLocalTransformation()).T, T, atol=1e-6)
    q = quaternion(T[:3, :3])
    assert q.GetReal() >= -1e-12
    v = Gf.Rotation(q).TransformDir(Gf.Vec3d(1, 2, 3))
    np.testing.assert_allclose(v, T[:3, :3] @ [1, 2, 3], atol=1e-6)


def test_arrays_keep_their_numbers() -> None:
    points = np.array([[1.0, -2.0, 3.0], [0.5, 4.0, -1.0]])
    np.testing.assert_array_equal(np.array(vectors(points)), points)
    np.testing.assert_array_equal(np.array(extent(points)), [[0.5, -2, -1], [1, 4, 3]])
    assert list(integers(np.array([3, 1, 2], np.int64))) == [3, 1, 2]
    np.testing.assert_array_equal(np.array(vectors(points[:, ::-1])), points[:, ::-1])
