"""A scene as USD: text, binary, or a package that AR Quick Look opens.

Objects lie side by side below one scope, because rigid bodies must not be nested; a relationship names each one's
supporter. Every shape is a prototype that its objects reference as instances, together with its materials. Attributes
of the default prim carry the whole scene document, those of each object its own entry, so that a file can be read back,
also where another program (Blender) saved it, which keeps attributes but no custom data.
"""

from __future__ import annotations

import json
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from pxr import Gf, Kind, Sdf, Tf, Usd, UsdGeom, UsdSemantics

from diorama_core.errors import ExportError
from diorama_core.export.colliders import physical_scene
from diorama_core.export.files import Entry, companion_folder, whole_file, write_package
from diorama_core.export.gathering import ExportObject, ExportPlane, ExportScene
from diorama_core.export.pictures import encode_picture
from diorama_core.export.usd_materials import (
    StageMaterials,
    add_camera,
    add_light,
    add_lights,
    add_surfaces,
    note,
    place,
)
from diorama_core.export.usd_physics import ROOT, add_physics, limb_path, object_path, plane_path
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.schema import scene_to_json

PROTOTYPES = "/Prototypes"


def write_layer(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write USD, text or binary by its ending, with pictures in a folder beside it; raises `ExportError`."""
    path = Path(path)
    with _export_errors(path):
        files = layer_files(gathered, path.name, f"{companion_folder(path, 'usd')}/textures", progress)
        write_package(path, path.name, files)


def write_usdz(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write one package: +Y up, binary, aligned and uncompressed, as AR Quick Look asks; raises `ExportError`."""
    with _export_errors(path), tempfile.TemporaryDirectory() as folder:
        stage, pictures = build_stage(gathered, "textures", progress, up_axis="Y")
        layer = Path(folder) / "scene.usdc"
        stage.GetRootLayer().Export(str(layer))
        with whole_file(path) as temporary:
            with Sdf.ZipFileWriter.CreateNew(str(temporary)) as package:
                package.AddFile(str(layer), layer.name)
                for name, content in pictures:
                    file = Path(folder) / Path(name).name
                    file.write_bytes(content)
                    package.AddFile(str(file), name)
            # USD says nothing where a disk is full: the package's table of contents, which comes last, is missing.
            if not zipfile.is_zipfile(temporary):
                raise ExportError(
                    f"cannot write {path}: the package is not whole; free some space or choose another disk"
                )


def layer_files(gathered: ExportScene, name: str, textures: str, progress: Progress) -> Iterator[Entry]:
    """Pictures, then the layer that refers to them.

    Args:
        gathered: The scene.
        name: Of the layer's file; its ending says whether it is text.
        textures: Folder of the pictures, relative to the layer.
        progress: Where it is reported and cancelling is noticed.
    """
    stage, pictures = build_stage(gathered, textures, progress, up_axis="Z")
    with tempfile.TemporaryDirectory() as folder:
        layer = Path(folder) / name
        stage.GetRootLayer().Export(str(layer))
        yield from pictures
        yield name, layer.read_bytes()


@contextmanager
def _export_errors(path: Path) -> Iterator[None]:
    """USD's own errors, such as a full disk, in one line."""
    try:
        yield
    except Tf.ErrorException as error:
        reasons = dict.fromkeys(str(one.commentary) for one in error.args)
        raise ExportError(f"cannot write {path}: {'; '.join(reasons)}") from error


def build_stage(
    gathered: ExportScene, textures: str, progress: Progress, *, up_axis: str
) -> tuple[Usd.Stage, list[Entry]]:
    """The stage, in memory, and the pictures it refers to.

    Args:
        gathered: The scene.
        textures: Folder of the pictures, relative to the stage's file.
        progress: Where it is reported and cancelling is noticed.
        up_axis: "Z" keeps the scene's numbers; "Y" turns the whole scene below its root.
    """
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageUpAxis(stage, up_axis)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetMetadata("comment", "written by Diorama")
    root = UsdGeom.Xform.Define(stage, ROOT)
    stage.SetDefaultPrim(root.GetPrim())
    Usd.ModelAPI(root).SetKind(Kind.Tokens.assembly)
    if up_axis == "Y":
        root.AddRotateXOp().Set(-90.0)
    _describe(root.GetPrim(), gathered)
    materials = StageMaterials(stage, textures)
    _prototypes(stage, gathered, materials, progress)
    _architecture(stage, gathered, materials)
    _objects(stage, gathered)
    if gathered.camera is not None:
        add_camera(stage, f"{ROOT}/PhotoCamera", gathered.camera)
    add_lights(stage, ROOT, gathered)
    for light in gathered.lights:
        add_light(stage, object_path(gathered.object(light.owner)), gathered, light)
    add_physics(stage, gathered, physical_scene(gathered))
    pictures: list[Entry] = []
    for name, picture in materials.pictures():
        progress.check()
        pictures.append((name, encode_picture(picture)))
    return stage, pictures


def _define_groups(stage: Usd.Stage, branch: str, things: Sequence[ExportObject | ExportPlane]) -> None:
    """A branch, and in it one group a storey and a room of a home."""
    paths = [f"{ROOT}/{branch}"]
    paths += ["/".join((ROOT, branch, *t.group[:depth])) for t in things for depth in range(1, len(t.group) + 1)]
    for path in dict.fromkeys(paths):
        Usd.ModelAPI(UsdGeom.Xform.Define(stage, path)).SetKind(Kind.Tokens.group)


def _describe(prim: Usd.Prim, gathered: ExportScene) -> None:
    prim.SetDisplayName(gathered.name)
    note(prim, "scene", scene_to_json(gathered.scene))
    note(prim, "objects", json.dumps([o.id for o in gathered.objects]))
    if gathered.photo_text is not None:
        note(prim, "photo", gathered.photo_text)
    if gathered.provenance:
        note(prim, "provenance", json.dumps(dict(gathered.provenance), ensure_ascii=False))


def _prototypes(stage: Usd.Stage, gathered: ExportScene, materials: StageMaterials, progress: Progress) -> None:
    stage.CreateClassPrim(PROTOTYPES)
    shapes = [m for m in gathered.meshes.values() if m.shape_id is not None]
    for done, mesh in enumerate(shapes):
        progress.report(0.9 * done / len(shapes), f"writing {mesh.name}")
        path = f"{PROTOTYPES}/{mesh.key}"
        UsdGeom.Xform.Define(stage, path)
        add_surfaces(stage, path, mesh.surfaces, materials)


def _architecture(stage: Usd.Stage, gathered: ExportScene, materials: StageMaterials) -> None:
    if not gathered.planes:
        return
    _define_groups(stage, "Architecture", gathered.planes)
    for slab in gathered.planes:
        prim = UsdGeom.Xform.Define(stage, plane_path(slab)).GetPrim()
        Usd.ModelAPI(prim).SetKind(Kind.Tokens.component)
        prim.SetDisplayName(slab.name)
        plane = {"id": slab.plane.id, "role": slab.plane.role, "confidence": slab.plane.confidence}
        note(prim, "plane", json.dumps(plane))
        add_surfaces(stage, str(prim.GetPath()), gathered.meshes[slab.mesh].surfaces, materials)


def _objects(stage: Usd.Stage, gathered: ExportScene) -> None:
    if not gathered.objects:
        return
    _define_groups(stage, "Objects", gathered.objects)
    entries = {o["id"]: o for o in json.loads(scene_to_json(gathered.scene))["objects"]}
    for item in gathered.objects:
        path = object_path(item)
        xform = UsdGeom.Xform.Define(stage, path)
        place(xform, item.T_world)
        prim = xform.GetPrim()
        Usd.ModelAPI(prim).SetKind(Kind.Tokens.component)
        prim.SetDisplayName(item.name)
        note(prim, "entry", json.dumps(entries[item.id], ensure_ascii=False))
        note(prim, "category", item.item.category)
        UsdSemantics.LabelsAPI.Apply(prim, "category").CreateLabelsAttr([item.item.category])
        if item.parent is not None:
            supporter = prim.CreateRelationship("diorama:supporter", custom=True)
            supporter.AddTarget(object_path(gathered.object(item.parent)))
        _shape(stage, path, item.mesh, item)
        for limb in item.limbs:
            beside = UsdGeom.Xform.Define(stage, limb_path(path, limb))
            place(beside, item.T_world @ limb.T_object_limb)
            Usd.ModelAPI(beside).SetKind(Kind.Tokens.component)
            beside.GetPrim().SetDisplayName(f"{item.name} {limb.name}")
            note(beside.GetPrim(), "limb", item.id)
            _shape(stage, limb_path(path, limb), limb.mesh, item)


def _shape(stage: Usd.Stage, path: str, mesh: str, item: ExportObject) -> None:
    """An instance of a prototype at the object's scale."""
    shape = UsdGeom.Xform.Define(stage, f"{path}/Shape")
    shape.AddScaleOp(UsdGeom.XformOp.PrecisionDouble).Set(Gf.Vec3d(*(float(v) for v in item.scale)))
    shape.GetPrim().GetReferences().AddInternalReference(f"{PROTOTYPES}/{mesh}")
    shape.GetPrim().SetInstanceable(True)
