"""Geometry of a file cut into the parts that a person would call objects."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float, Int
from trimesh.visual.material import PBRMaterial
from trimesh.visual.texture import TextureVisuals

from diorama_core.errors import InputError, LibraryError
from diorama_core.importing.gltf import Z_UP
from diorama_core.importing.marked import MarkedFile
from diorama_core.importing.usd import matrix_of, opened_stage, usd_errors, world_of
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.models import read_model
from diorama_core.scene.types import SceneObject

LARGEST_OBJECT_M = 3.5
"""Groups wider than this are rooms or collections, not one object."""
TOUCH_M = 0.03
"""Parts of one object are no farther apart than this."""
UPRIGHT = 0.999
HUGE_M, USUAL_M = 100.0, 60.0
REACH = 1e8
"""Coordinates in the file's unit are smaller than this."""


@dataclass(frozen=True, eq=False)
class Part:
    """One object of a file."""

    name: str
    scene: trimesh.Scene
    """Geometry in the world: +Z up, metres."""
    M_world: Float[np.ndarray, "4 4"]
    """The node's frame to the world."""
    key: str | None = None
    """Equal for copies of one geometry; None where unknown."""
    yaw_rad: float = 0.0
    """How far its own axes are turned about up: shapes are taken in along their own axes."""
    front: str | None = None
    """Own axis that its front looks along, where the file says so."""
    category: str | None = None

    @cached_property
    def whole(self) -> trimesh.Trimesh:
        """All geometry as one mesh."""
        return self.scene.to_geometry()

    @property
    def turn(self) -> Float[np.ndarray, "3 3"]:
        """Own axes to the world's."""
        c, s = np.cos(self.yaw_rad), np.sin(self.yaw_rad)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    @property
    def unturned(self) -> trimesh.Scene:
        """The geometry along the part's own axes."""
        scene, T = self.scene.copy(), np.eye(4)
        T[:3, :3] = self.turn.T
        scene.apply_transform(T)
        return scene


def parts_of_gltf(path: Path) -> tuple[Part, ...]:
    """Objects of a GLB or glTF file; raises `InputError` when it cannot be read."""
    scene = _model(path)
    return _split(scene, Z_UP @ _unit(scene))


def shape_parts(path: Path, marked: MarkedFile, item: SceneObject) -> Part | None:
    """The geometry of one object of a marked GLB in its shape's frame; None where the file does not hold it."""
    node = next((n for n in marked.nodes if n.id == item.id), None)
    if node is None or path.suffix.lower() not in (".glb", ".gltf"):
        return None
    scene = _model(path)
    others = {n.name for n in marked.nodes if n.id != item.id}
    children = scene.graph.transforms.children
    root = f"{node.name} shape" if f"{node.name} shape" in scene.graph.nodes else node.name
    if root not in scene.graph.nodes:
        return None
    nodes = [n for n in _below(children, root, others) if n in scene.graph.nodes_geometry]
    to_shape = np.linalg.inv(node.M_world_shape) @ Z_UP
    return _part(scene, item.category, nodes, root, to_shape) if nodes else None


def parts_of_usd(path: Path) -> tuple[Part, ...]:
    """Objects of a USD or USDZ file; raises `InputError` when it cannot be read."""
    stage = opened_stage(path)
    with usd_errors(path):
        return _split(_usd_scene(stage), world_of(stage))


def _model(path: Path) -> trimesh.Scene:
    try:
        return read_model(path, path.parent).scene
    except LibraryError as error:
        raise InputError(f"{path.name}: {error}") from error


def _unit(scene: trimesh.Scene) -> Float[np.ndarray, "4 4"]:
    """glTF says metres; files that would be larger than a hall were written in centimetres or millimetres."""
    largest = float(np.max(scene.extents)) if scene.extents is not None else 1.0
    factor = next((f for f in (1.0, 0.01, 0.001) if largest * f <= (HUGE_M if f == 1.0 else USUAL_M)), 0.001)
    return np.diag([factor, factor, factor, 1.0])


def _split(scene: trimesh.Scene, to_world: Float[np.ndarray, "4 4"]) -> tuple[Part, ...]:
    """Nodes that are one object each: what touches and is not larger than furniture stays together."""
    children = scene.graph.transforms.children
    boxes = {str(n): _box(scene, n, to_world) for n in scene.graph.nodes_geometry}
    parts: list[Part] = []
    waiting = [str(scene.graph.base_frame)]
    while waiting:
        node = waiting.pop()
        own = _own(children, node, boxes)
        loose = [str(c) for c in children.get(node, ()) if c not in own]
        if own:
            top = max(boxes[n][1, 2] for n in own)
            stands = [c for c in loose if _bottom(children, c, boxes) > top - TOUCH_M]
        else:
            stands = []
        below = [n for n in _below(children, node, set(stands)) if n in boxes]
        if not below:
            waiting += reversed(loose)
        elif len(below) == len(own) or (node != scene.graph.base_frame and _is_object([boxes[n] for n in below])):
            parts.append(_part(scene, node, below, node, to_world))
            waiting += reversed(stands)
        else:
            if own:
                parts.append(_part(scene, node, own, node, to_world))
            waiting += reversed(loose)
    return tuple(parts)


def _own(children: dict[str, Sequence[str]], node: str, boxes: Mapping[str, object]) -> list[str]:
    """A node's own geometry: the loader gives each material of a mesh a node below, with a number at its name."""
    pieces = [str(c) for c in children.get(node, ()) if re.fullmatch(re.escape(node) + r"_[0-9a-f]{6}", str(c))]
    return [n for n in (node, *pieces) if n in boxes]


def _bottom(children: dict[str, Sequence[str]], node: str, boxes: Mapping[str, Float[np.ndarray, "2 3"]]) -> float:
    return min((float(boxes[n][0, 2]) for n in _below(children, node, frozenset()) if n in boxes), default=-np.inf)


def _below(children: dict[str, Sequence[str]], node: str, without: frozenset[str] | set[str]) -> Iterator[str]:
    waiting = [node]
    while waiting:
        here = waiting.pop()
        yield here
        waiting += [c for c in children.get(here, ()) if c not in without]


def _box(scene: trimesh.Scene, node: str, to_world: Float[np.ndarray, "4 4"]) -> Float[np.ndarray, "2 3"]:
    matrix, name = scene.graph[node]
    corners = trimesh.bounds.corners(scene.geometry[name].bounds)
    placed = trimesh.transform_points(corners, to_world @ matrix)
    return np.stack([placed.min(axis=0), placed.max(axis=0)])


def _is_object(boxes: Sequence[Float[np.ndarray, "2 3"]]) -> bool:
    """Whether boxes are together small enough and hang together."""
    low, high = np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)
    if (high - low).max() > LARGEST_OBJECT_M:
        return False
    reached, rest = [boxes[0]], list(boxes[1:])
    while reached and rest:
        box = reached.pop()
        near = [(box[0] - TOUCH_M <= b[1]).all() and (b[0] - TOUCH_M <= box[1]).all() for b in rest]
        reached += [b for b, n in zip(rest, near, strict=True) if n]
        rest = [b for b, n in zip(rest, near, strict=True) if not n]
    return not rest


def _part(scene: trimesh.Scene, name: str, nodes: Sequence[str], root: str, to_world: Float[np.ndarray, "4 4"]) -> Part:
    part, M_root = trimesh.Scene(), to_world @ scene.graph[root][0]
    words = []
    for node in sorted(nodes):
        matrix, geometry = scene.graph[node]
        mesh = scene.geometry[geometry].copy()
        mesh.apply_transform(to_world @ matrix)
        part.add_geometry(mesh, node_name=str(node), geom_name=str(node))
        words.append(_fingerprint(trimesh.transform_points(mesh.vertices, np.linalg.inv(M_root)), mesh.faces))
    return Part(name, part, M_root, " ".join(sorted(words)), yaw_rad=_yaw(M_root, to_world))


def _fingerprint(points: Float[np.ndarray, "n 3"], faces: np.ndarray) -> str:
    """Equal for equal geometry in its node's frame."""
    return hashlib.sha256((np.round(points, 4) + 0.0).tobytes() + np.asarray(faces, np.int64).tobytes()).hexdigest()[
        :16
    ]


def _yaw(M_root: Float[np.ndarray, "4 4"], to_world: Float[np.ndarray, "4 4"]) -> float:
    """A node's turn about up, for nodes whose own up is the world's or the file's; 0 for tilted ones."""
    for M in (M_root, M_root @ np.linalg.inv(to_world)):
        axes = M[:3, :3] / np.maximum(np.linalg.norm(M[:3, :3], axis=0), 1e-12)
        if axes[2, 2] > UPRIGHT:
            return float(np.arctan2(axes[1, 0], axes[0, 0]))
    return 0.0


def _usd_scene(stage: Any) -> trimesh.Scene:
    """Meshes of a stage with one plain material each, as a scene in the stage's frame."""
    from pxr import Usd, UsdGeom

    scene, triangles = trimesh.Scene(), 0
    scope = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)
    for prim in Usd.PrimRange(stage.GetPseudoRoot(), scope):
        imaged = UsdGeom.Imageable(prim)
        if not prim.IsA(UsdGeom.Mesh) or imaged.ComputePurpose() not in ("default", "render"):
            continue
        if imaged.ComputeVisibility() == UsdGeom.Tokens.invisible:
            continue
        mesh = _usd_mesh(UsdGeom.Mesh(prim))
        triangles += 0 if mesh is None else len(mesh.faces)
        if triangles > DEFAULT_LIMITS.triangles or len(scene.geometry) > DEFAULT_LIMITS.nodes:
            raise InputError(
                f"the file has more than {DEFAULT_LIMITS.triangles:,} triangles or {DEFAULT_LIMITS.nodes:,} meshes; "
                "export a part of it"
            )
        if mesh is not None:
            parent = _chain(scene, prim)
            scene.add_geometry(
                mesh, node_name=str(prim.GetPath()), geom_name=str(prim.GetPath()), parent_node_name=parent
            )
    return scene


def _chain(scene: trimesh.Scene, prim: Any) -> str:
    """Nodes for the prims above a mesh, which keep the stage's groups; they carry no transform of their own."""
    paths = list(prim.GetPath().GetPrefixes())
    above = scene.graph.base_frame
    for path in paths[:-1]:
        if str(path) not in scene.graph.nodes:
            scene.graph.update(frame_to=str(path), frame_from=above, matrix=np.eye(4))
        above = str(path)
    return str(above)


def _usd_mesh(mesh: Any) -> trimesh.Trimesh | None:
    from pxr import UsdGeom

    points = np.array(mesh.GetPointsAttr().Get() or [], dtype=np.float64).reshape(-1, 3)
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get() or [], dtype=int)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get() or [], dtype=int)
    if not len(points) or not len(counts):
        return None
    faces = _fans(counts, corners)
    if len(faces) and not 0 <= faces.min() <= faces.max() < len(points):
        raise ValueError("a mesh names points that it does not have")
    world = matrix_of(UsdGeom.XformCache().GetLocalToWorldTransform(mesh.GetPrim()))
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
    found = shader.GetInput("diffuseColor").Get() if shader and shader.GetInput("diffuseColor") else None
    if found is None:
        shown = mesh.GetDisplayColorAttr().Get()
        found = shown[0] if shown else (0.7, 0.7, 0.7)
    red, green, blue = (float(min(max(c, 0.0), 1.0)) for c in found)
    return red, green, blue
