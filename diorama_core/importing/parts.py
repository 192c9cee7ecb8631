"""Geometry of a file cut into the parts that a person would call objects."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.errors import InputError, LibraryError
from diorama_core.importing.marked import MarkedFile
from diorama_core.library.ingest.models import read_model
from diorama_core.library.ingest.usd_meshes import usd_scene
from diorama_core.library.ingest.usd_stage import Z_UP, open_stage, usd_errors, world_of
from diorama_core.scene.types import SceneObject, yaw_rotation

LARGEST_OBJECT_M = 3.5
"""Groups wider than this are rooms or collections, not one object."""
TOUCH_M = 0.03
"""Parts of one object are no farther apart than this."""
UPRIGHT = 0.999
HUGE_M, USUAL_M = 100.0, 60.0
SUBUNITS = {1.0: "metres", 0.01: "centimetres", 0.001: "millimetres"}


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
    room: str | None = None
    """Name of the room whose floor it is, where the file has rooms; None for everything else."""

    @cached_property
    def whole(self) -> trimesh.Trimesh:
        """All geometry as one mesh."""
        return self.scene.to_geometry()

    @property
    def turn(self) -> Float[np.ndarray, "3 3"]:
        """Own axes to the world's."""
        return yaw_rotation(self.yaw_rad)

    @property
    def local_scene(self) -> trimesh.Scene:
        """The geometry along the part's own axes."""
        scene, T = self.scene.copy(), np.eye(4)
        T[:3, :3] = self.turn.T
        scene.apply_transform(T)
        return scene


def parts_of_gltf(path: Path, unit_m: float | None = None) -> tuple[tuple[Part, ...], tuple[str, ...]]:
    """Objects of a GLB or glTF file, and notes; raises `InputError` when it cannot be read.

    Without `unit_m` the format is believed, unless the scene would be larger than a hall.

    Args:
        path: The file.
        unit_m: Metres in one unit of it; None believes the format, unless the scene would be larger than a hall.
    """
    return _to_metres(_model(path), Z_UP, unit_m)


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
    nodes = [n for n in _subtree(children, root, others) if n in scene.graph.nodes_geometry]
    to_shape = np.linalg.inv(node.M_world_shape) @ Z_UP
    return _part(scene, item.category, nodes, root, to_shape) if nodes else None


def parts_of_usd(path: Path, unit_m: float | None = None) -> tuple[tuple[Part, ...], tuple[str, ...]]:
    """Objects of a USD or USDZ file, and notes; `parts_of_gltf` says the arguments and errors."""
    stage = open_stage(path)
    with usd_errors(path):
        return _to_metres(usd_scene(stage), world_of(stage), unit_m)


def _model(path: Path) -> trimesh.Scene:
    try:
        return read_model(path, path.parent).scene
    except LibraryError as error:
        raise InputError(f"{path.name}: {error}") from error


def _to_metres(
    scene: trimesh.Scene, to_world: Float[np.ndarray, "4 4"], unit_m: float | None
) -> tuple[tuple[Part, ...], tuple[str, ...]]:
    """The parts of a scene, and a note where its unit is not the one it says.

    What would be larger than a hall was written in centimetres or millimetres.
    """
    if unit_m is not None:
        factor = unit_m / float(np.linalg.norm(to_world[:3, 0]))
        return split_scene(scene, np.diag([factor, factor, factor, 1.0]) @ to_world), ()
    largest = 1.0 if scene.extents is None else float(np.max(scene.extents)) * float(np.linalg.norm(to_world[:3, 0]))
    factor = next((f for f in SUBUNITS if largest * f <= (HUGE_M if f == 1.0 else USUAL_M)), 0.001)
    parts = split_scene(scene, np.diag([factor, factor, factor, 1.0]) @ to_world)
    note = f"it would be {largest:.0f} m large: its lengths were taken for {SUBUNITS[factor]}"
    return parts, () if factor == 1.0 else (note,)


def split_scene(scene: trimesh.Scene, to_world: Float[np.ndarray, "4 4"]) -> tuple[Part, ...]:
    """Nodes that are one object each: what touches and is not larger than furniture stays together.

    A flat part flush with a side or the top of another part is a piece of it: the screen of a television.
    """
    children = scene.graph.transforms.children
    boxes = {str(n): _box(scene, n, to_world) for n in scene.graph.nodes_geometry}
    parts: list[Part] = []
    waiting = [str(scene.graph.base_frame)]
    while waiting:
        node = waiting.pop()
        nodes = _own(children, node, boxes)
        loose = [str(c) for c in children.get(node, ()) if c not in nodes]
        top = max((boxes[n][1, 2] for n in nodes), default=np.inf)
        stands = [c for c in loose if _bottom(children, c, boxes) > top - TOUCH_M] if nodes else []
        below = [n for n in _subtree(children, node, set(stands)) if n in boxes]
        if not below:
            waiting += reversed(loose)
        elif len(below) == len(nodes) or (node != scene.graph.base_frame and _is_object([boxes[n] for n in below])):
            parts.append(_part(scene, node, below, node, to_world))
            waiting += reversed(stands)
        else:
            if nodes:
                parts.append(_part(scene, node, nodes, node, to_world))
            waiting += reversed(loose)
    return join_flat_parts(parts)


def _own(children: dict[str, Sequence[str]], node: str, boxes: Mapping[str, object]) -> list[str]:
    """A node's own geometry: the loader gives each material of a mesh a node below, with a number at its name."""
    pieces = [str(c) for c in children.get(node, ()) if re.fullmatch(re.escape(node) + r"_[0-9a-f]{6}", str(c))]
    return [n for n in (node, *pieces) if n in boxes]


def _bottom(children: dict[str, Sequence[str]], node: str, boxes: Mapping[str, Float[np.ndarray, "2 3"]]) -> float:
    return min((float(boxes[n][0, 2]) for n in _subtree(children, node, frozenset()) if n in boxes), default=-np.inf)


def _subtree(children: dict[str, Sequence[str]], node: str, without: frozenset[str] | set[str]) -> Iterator[str]:
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
    digest = hashlib.sha256((np.round(points, 4) + 0.0).tobytes() + np.asarray(faces, np.int64).tobytes())
    return digest.hexdigest()[:16]


def _yaw(M_root: Float[np.ndarray, "4 4"], to_world: Float[np.ndarray, "4 4"]) -> float:
    """A node's turn about up, for nodes whose own up is the world's or the file's; 0 for tilted ones."""
    for M in (M_root, M_root @ np.linalg.inv(to_world)):
        axes = M[:3, :3] / np.maximum(np.linalg.norm(M[:3, :3], axis=0), 1e-12)
        if axes[2, 2] > UPRIGHT:
            return float(np.arctan2(axes[1, 0], axes[0, 0]))
    return 0.0


FLAT_M = 1e-3
FLUSH_M = 0.03
"""So near to a face a flat part lies on it."""
MIN_SHARE = 0.3
"""Smallest covered share of a face; a mat on a table covers less and is an object of its own."""


def join_flat_parts(parts: Sequence[Part]) -> tuple[Part, ...]:
    """The parts, those without thickness that cover a face of another one (not its foot) joined to it."""
    bounds = [p.whole.bounds for p in parts]
    owners = {k: owner for k in range(len(parts)) if (owner := _owner(k, bounds)) is not None}
    joined = []
    for index, part in enumerate(parts):
        pieces = [parts[k] for k, owner in owners.items() if owner == index]
        if index not in owners:
            joined.append(_with_pieces(part, pieces) if pieces else part)
    return tuple(joined)


def _owner(index: int, bounds: Sequence[Float[np.ndarray, "2 3"]]) -> int | None:
    """The part whose face a flat part covers most of."""
    low, high = bounds[index]
    axis = int((high - low).argmin())
    if (high - low)[axis] > FLAT_M:
        return None
    across = [k for k in range(3) if k != axis]
    owners = []
    for other, (below, above) in enumerate(bounds):
        if other == index or (above - below)[axis] <= FLAT_M:
            continue
        faces = [above[axis]] if axis == 2 else [below[axis], above[axis]]
        flush = any(abs(low[axis] - face) < FLUSH_M for face in faces)
        inside = (low[across] > below[across] - FLUSH_M).all() and (high[across] < above[across] + FLUSH_M).all()
        share = float(np.prod((high - low)[across]) / max(np.prod((above - below)[across]), 1e-12))
        if flush and inside and share > MIN_SHARE:
            owners.append((share, other))
    return max(owners)[1] if owners else None


def _with_pieces(part: Part, pieces: Sequence[Part]) -> Part:
    scene = part.scene.copy()
    for piece in pieces:
        for node in piece.scene.graph.nodes_geometry:
            T, name = piece.scene.graph[node]
            scene.add_geometry(piece.scene.geometry[name], node_name=str(node), geom_name=str(name), transform=T)
    key = None if part.key is None else " ".join([part.key, *(str(p.key) for p in pieces)])
    return replace(part, scene=scene, key=key)
