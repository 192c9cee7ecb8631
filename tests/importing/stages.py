"""Meshes in a USD stage, as other programs write them."""

from __future__ import annotations

from pathlib import Path

import trimesh


def write_stage(path: Path, meshes: dict[str, trimesh.Trimesh], unit_m: float = 1.0, up: str = "Z") -> Path:
    """A stage that calls its unit so many metres."""
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, unit_m)
    UsdGeom.SetStageUpAxis(stage, up)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/World").GetPrim())
    for name, mesh in meshes.items():
        prim = UsdGeom.Mesh.Define(stage, f"/World/{name}")
        prim.CreatePointsAttr(mesh.vertices.tolist())
        prim.CreateFaceVertexCountsAttr([3] * len(mesh.faces))
        prim.CreateFaceVertexIndicesAttr(mesh.faces.reshape(-1).tolist())
    stage.Save()
    return path
