"""Meshes of a USD stage, those of its point instancers included."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float, Int
from trimesh.visual.material import PBRMaterial
from trimesh.visual.texture import TextureVisuals

from diorama_core.errors import InputError
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.usd_stage import matrix_of

MAX_INSTANCES = 20_000
REACH = 1e8
"""Coordinates in the file's unit are smaller than this."""


def usd_scene(stage: Any) -> trimesh.Scene:
    """Meshes of a stage with one plain material each, as a scene in the stage's frame."""
    scene, triangles = trimesh.Scene(), 0
    for prim, node, M in _meshes(stage):
        mesh = _usd_mesh(prim, M)
        triangles += 0 if mesh is None else len(mesh.faces)
        if triangles > DEFAULT_LIMITS.triangles or len(scene.geometry) > DEFAULT_LIMITS.nodes:
            raise InputError(
                f"the file has more than {DEFAULT_LIMITS.triangles:,} triangles or {DEFAULT_LIMITS.nodes:,} meshes; "
                "export a part of it"
            )
        if mesh is not None:
            scene.add_geometry(mesh, node_name=node, geom_name=node, parent_node_name=_chain(scene, node))
    return scene


def _meshes(stage: Any) -> Iterator[tuple[Any, str, Float[np.ndarray, "4 4"]]]:
    """Every mesh that is drawn, the path it is drawn at, and its frame in the stage's; copies of instancers each."""
    from pxr import Usd, UsdGeom

    places = UsdGeom.XformCache()
    prims = iter(Usd.PrimRange(stage.GetPseudoRoot(), Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)))
    for prim in prims:
        if prim.IsA(UsdGeom.PointInstancer):
            prims.PruneChildren()  # prototypes are drawn where their instances are
            if _is_shown(prim):
                yield from _instances(UsdGeom.PointInstancer(prim), places)
        elif prim.IsA(UsdGeom.Mesh) and _is_shown(prim):
            yield prim, str(prim.GetPath()), matrix_of(places.GetLocalToWorldTransform(prim))


def _is_shown(prim: Any) -> bool:
    from pxr import UsdGeom

    imaged = UsdGeom.Imageable(prim)
    shown = imaged.ComputeVisibility() != UsdGeom.Tokens.invisible
    return bool(shown and imaged.ComputePurpose() in ("default", "render"))


def _instances(instancer: Any, places: Any) -> Iterator[tuple[Any, str, Float[np.ndarray, "4 4"]]]:
    from pxr import Usd, UsdGeom

    prim = instancer.GetPrim()
    prototypes = [prim.GetStage().GetPrimAtPath(path) for path in instancer.GetPrototypesRel().GetForwardedTargets()]
    indices, mask = list(instancer.GetProtoIndicesAttr().Get() or []), list(instancer.ComputeMaskAtTime(0.0))
    if len(indices) > MAX_INSTANCES:
        raise InputError(f"an instancer has more than {MAX_INSTANCES} copies; export a part of the scene")
    M_instancer = matrix_of(places.GetLocalToWorldTransform(prim))
    transforms = instancer.ComputeInstanceTransformsAtTime(
        Usd.TimeCode.Default(), Usd.TimeCode.Default(), UsdGeom.PointInstancer.ExcludeProtoXform,
        UsdGeom.PointInstancer.IgnoreMask,
    )  # fmt: skip
    for number, (index, transform) in enumerate(zip(indices, transforms or (), strict=False)):
        if not 0 <= index < len(prototypes) or not prototypes[index] or (mask and not mask[number]):
            continue
        prototype = prototypes[index]
        above = matrix_of(places.GetParentToWorldTransform(prototype))
        for mesh in Usd.PrimRange(prototype, Usd.TraverseInstanceProxies(Usd.PrimAllPrimsPredicate)):
            if mesh.IsA(UsdGeom.Mesh):
                M = np.linalg.inv(above) @ matrix_of(places.GetLocalToWorldTransform(mesh))
                name = f"{prim.GetPath()}/{prototype.GetName()}_{number}/{mesh.GetName()}"
                yield mesh, name, M_instancer @ matrix_of(transform) @ M


def _chain(scene: trimesh.Scene, path: str) -> str:
    """Nodes for the prims above a mesh, which keep the stage's groups; they carry no transform of their own."""
    above, names = scene.graph.base_frame, path.strip("/").split("/")
    for depth in range(1, len(names)):
        name = "/" + "/".join(names[:depth])
        if name not in scene.graph.nodes:
            scene.graph.update(frame_to=name, frame_from=above, matrix=np.eye(4))
        above = name
    return str(above)


def _usd_mesh(prim: Any, world: Float[np.ndarray, "4 4"]) -> trimesh.Trimesh | None:
    """A mesh in the stage's frame; `world` is its own frame there."""
    from pxr import UsdGeom

    mesh = UsdGeom.Mesh(prim)
    points = np.array(mesh.GetPointsAttr().Get() or [], dtype=np.float64).reshape(-1, 3)
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get() or [], dtype=int)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get() or [], dtype=int)
    if not len(points) or not len(counts):
        return None
    faces = _fans(counts, corners)
    if len(faces) and not 0 <= faces.min() <= faces.max() < len(points):
        raise ValueError("a mesh names points that it does not have")
    if (np.linalg.det(world[:3, :3]) < 0) != (mesh.GetOrientationAttr().Get() == "leftHanded"):
        faces = faces[:, ::-1]
    material = PBRMaterial(
        name="material", baseColorFactor=[*_usd_colour(mesh), 1.0], roughnessFactor=0.7, metallicFactor=0.0
    )
    placed = trimesh.transform_points(points, world)
    if not (np.abs(placed) < REACH).all():
        raise ValueError("a mesh is not anywhere near")
    return trimesh.Trimesh(
        placed, faces, visual=TextureVisuals(uv=np.zeros((len(points), 2)), material=material), process=False
    )


def _fans(counts: Int[np.ndarray, " n"], corners: Int[np.ndarray, " k"]) -> Int[np.ndarray, "m 3"]:
    """Polygons as triangles around their first corners.

    Args:
        counts: Corners of each polygon.
        corners: Vertices of all corners, one polygon after the other.

    Raises:
        ValueError: When there are not as many corners as counted.
    """
    if counts.min() < 0 or counts.sum() != len(corners):
        raise ValueError("a mesh does not have the corners that it counts")
    starts, triangles = np.cumsum(counts) - counts, np.maximum(counts - 2, 0)
    first = np.repeat(starts, triangles)
    nth = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.stack([corners[first], corners[first + nth + 1], corners[first + nth + 2]], axis=1)


def _usd_colour(mesh: Any) -> tuple[float, float, float]:
    """The bound preview material's colour, or the display colour, or grey."""
    from pxr import UsdShade

    bound = UsdShade.MaterialBindingAPI(mesh.GetPrim()).ComputeBoundMaterial()[0]
    shader = bound.ComputeSurfaceSource()[0] if bound else None
    colour = shader.GetInput("diffuseColor").Get() if shader and shader.GetInput("diffuseColor") else None
    if colour is None:
        shown = mesh.GetDisplayColorAttr().Get()
        colour = shown[0] if shown else (0.7, 0.7, 0.7)
    red, green, blue = (float(min(max(c, 0.0), 1.0)) for c in colour)
    return red, green, blue
