"""Scenes that come back from USD files."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

pytest.importorskip("pxr", reason="needs the extra [usd]")

from pxr import Gf, Sdf, Usd, UsdGeom

from diorama_core.errors import InputError
from diorama_core.export import export_scene
from diorama_core.importing.opening import open_marked
from diorama_core.importing.parts import parts_of_usd
from diorama_core.importing.scene_import import import_scene
from diorama_core.importing.usd import read_marked_usd
from diorama_core.library.ingest.usd_meshes import _fans
from tests.importing.stages import write_stage
from tests.importing.test_gltf import LIBRARY, edited_room
from tests.primitives import furnished_room


def back(path):
    marked = read_marked_usd(path)
    return open_marked(marked)


@pytest.mark.parametrize("kind", ["usda", "usdc", "usdz"])
def test_an_untouched_file_gives_the_same_scene(tmp_path, kind: str) -> None:
    scene = edited_room()
    export_scene(scene, LIBRARY, tmp_path / f"room.{kind}", kind)
    found = back(tmp_path / f"room.{kind}")
    assert found.changes == ()
    assert found.scene == scene


def test_moved_and_deleted_prims(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    path = tmp_path / "room.usda"
    export_scene(scene, LIBRARY, path, "usda")
    stage = Usd.Stage.Open(str(path))
    ops = UsdGeom.Xformable(stage.GetPrimAtPath("/Scene/Objects/c1")).GetOrderedXformOps()
    next(o for o in ops if o.GetOpName() == "xformOp:translate").Set(Gf.Vec3d(0.0, 1.5, 0.45))
    stage.RemovePrim("/Scene/Objects/c2")
    stage.Save()
    found = back(path).scene
    np.testing.assert_allclose(found.object("c1").pose.position, [0.0, 1.5, 0.45], atol=1e-6)
    assert not found.has_object("c2")
    assert found.object("b") == scene.object("b")


def test_another_unit_and_up_axis(tmp_path) -> None:
    """A stage in centimetres with +Y up, as other programs write it, gives the same places."""
    scene = furnished_room(LIBRARY)
    path = tmp_path / "room.usda"
    export_scene(scene, LIBRARY, path, "usda")
    stage = Usd.Stage.Open(str(path))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    root = UsdGeom.Xformable(stage.GetDefaultPrim())
    root.AddTransformOp().Set(Gf.Matrix4d(100, 0, 0, 0, 0, 0, -100, 0, 0, 100, 0, 0, 0, 0, 0, 1))
    stage.Save()
    found = back(path)
    assert found.changes == ()
    assert found.scene == scene


def test_centimetres_that_a_stage_calls_metres_are_said_and_read(tmp_path) -> None:
    boxes = {"floor": ((500, 400, 10), (0, 0, -5)), "table": ((120, 80, 74), (50, 0, 37))}
    meshes = {name: trimesh.creation.box(size).apply_translation(place) for name, (size, place) in boxes.items()}
    write_stage(tmp_path / "room.usda", meshes)
    found = import_scene(tmp_path / "room.usda", tmp_path / "shapes").opened
    (table,) = found.scene.objects
    np.testing.assert_allclose(sorted(table.size_m), [0.74, 0.8, 1.2], atol=1e-6)
    assert "it would be 500 m large: its lengths were taken for centimetres" in found.changes


def test_blender_keeps_the_scene(tmp_path) -> None:
    """Blender writes everything below a root of its own, numbers names, and forgets custom data."""
    scene = furnished_room(LIBRARY)
    export_scene(scene, LIBRARY, tmp_path / "room.usda", "usda")
    written = Usd.Stage.Open(str(tmp_path / "room.usda")).Flatten()
    saved = Usd.Stage.CreateNew(str(tmp_path / "saved.usda"))
    saved.SetDefaultPrim(saved.DefinePrim("/root", "Xform"))
    for key in ("metersPerUnit", "upAxis"):
        saved.SetMetadata(key, written.pseudoRoot.GetInfo(key))
    Sdf.CopySpec(written, "/Scene", saved.GetRootLayer(), "/root/Scene")
    for number, prim in enumerate([p for p in saved.Traverse() if p.GetName() == "Shape"]):
        prim.SetInstanceable(False)
        editor = Usd.NamespaceEditor(saved)
        editor.RenamePrim(prim, f"Shape_{number:03d}")
        editor.ApplyEdits()
    for prim in saved.Traverse():
        prim.ClearCustomData()
    saved.Save()
    found = back(tmp_path / "saved.usda")
    assert found.changes == ()
    assert found.scene == scene


def test_foreign_and_broken_files(tmp_path) -> None:
    stage = Usd.Stage.CreateNew(str(tmp_path / "foreign.usda"))
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/World").GetPrim())
    stage.Save()
    assert read_marked_usd(tmp_path / "foreign.usda") is None
    (tmp_path / "broken.usda").write_text("no usd")
    with pytest.raises(
        InputError, match=r"^broken\.usda cannot be read as USD \(<broken\.usda> is not a valid usda layer\); export it"
    ):
        read_marked_usd(tmp_path / "broken.usda")


def test_layers_are_read_beside_the_file_only(tmp_path) -> None:
    folder = tmp_path / "received"
    folder.mkdir()
    for place in (tmp_path / "secret.usda", folder / "chair.usda"):
        Sdf.Layer.CreateNew(str(place)).Save()
    layer = Sdf.Layer.CreateNew(str(folder / "room.usda"))
    layer.subLayerPaths = ["./chair.usda", "./missing.usda"]
    layer.Save()
    assert read_marked_usd(folder / "room.usda") is None
    layer.subLayerPaths = ["../secret.usda"]
    layer.Save()
    with pytest.raises(InputError, match=r"^room\.usda refers to a file outside its folder \(\.\./secret\.usda\)"):
        read_marked_usd(folder / "room.usda")


def test_values_that_make_no_sense_are_one_line(tmp_path) -> None:
    for number, (points, corners) in enumerate(
        [
            ([(0, 0, 0), (1, 0, 0), (0, 1, float("inf"))], [0, 1, 2]),
            ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [0, 1, 7]),
            ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [0, 1]),
        ]
    ):
        path = tmp_path / f"{number}.usda"
        stage = Usd.Stage.CreateNew(str(path))
        mesh = UsdGeom.Mesh.Define(stage, "/chair")
        mesh.CreatePointsAttr(points)
        mesh.CreateFaceVertexCountsAttr([3])
        mesh.CreateFaceVertexIndicesAttr(corners)
        stage.Save()
        with pytest.raises(InputError, match=rf"^{number}\.usda: something in it makes no sense"):
            parts_of_usd(path)


def test_polygons_become_fans() -> None:
    found = _fans(np.array([3, 5, 2, 4]), np.arange(14))
    assert found.tolist() == [[0, 1, 2], [3, 4, 5], [3, 5, 6], [3, 6, 7], [10, 11, 12], [10, 12, 13]]


def test_copies_of_copies_are_counted_before_they_fill_the_memory(tmp_path) -> None:
    """A small file whose instances hold instances: ten to the seventh meshes."""
    path = tmp_path / "bomb.usda"
    stage = Usd.Stage.CreateNew(str(path))
    mesh = UsdGeom.Mesh.Define(stage, "/Level0/mesh")
    mesh.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    mesh.CreateFaceVertexCountsAttr([3] * 20_000)
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2] * 20_000)
    for level in range(1, 8):
        for copy in range(10):
            prim = UsdGeom.Xform.Define(stage, f"/Level{level}/copy{copy}").GetPrim()
            prim.GetReferences().AddInternalReference(f"/Level{level - 1}")
            prim.SetInstanceable(True)
    stage.Save()
    with pytest.raises(InputError, match="has more than"):
        parts_of_usd(path)
