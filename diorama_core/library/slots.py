"""Material slots of a shape: which of its surfaces are of one material, and what that material is.

A slot is named by its role and its rank among the slots of that role, largest first: "fabric", "wood", "wood 2". The
same names on another shape are what a material from a photo is carried over by.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

import numpy as np
import trimesh
from jaxtyping import Float
from trimesh.visual.material import PBRMaterial

from diorama_core.scene.types import PhotoMaterial, TextureLayout

Role = Literal[
    "fabric", "leather", "wood", "metal", "stone", "paint", "glass", "wicker", "paper", "leaf",
    "picture", "screen", "pane", "dial", "mirror", "material",
]  # fmt: skip
PLAIN = "vertex or face colours"
ROLE, TILE_M = "_role", "_tile_m"
"""Keys of a mesh's metadata, internal to the program: files do not carry them."""
WORDS: Mapping[Role, str] = {
    "leather": "leather|hide",
    "fabric": "fabric|cloth|cotton|linen|wool|velvet|textile|cushion|pillow|upholster|sheet|curtain|carpet",
    "wood": "wood|oak|walnut|pine|birch|cherry|mahogany|teak|timber|plywood|bamboo",
    "metal": "metal|steel|iron|chrome|brass|copper|gold|silver|alumin",
    "glass": "glass",
    "stone": "stone|marble|granite|concrete|ceramic|porcelain|tile|clay|brick",
    "screen": "screen|display",
    "mirror": "mirror",
    "picture": "picture|painting|poster|canvas|print|artwork",
    "leaf": "leaf|leaves|foliage|grass",
    "paint": "paint|lacquer|plastic|enamel",
}
METALNESS, CLEAR = 0.6, 0.7
"""A material that is at least so metallic, or at most so opaque, is metal or glass."""
SURFACE_ROLES = frozenset(get_args(Role)) - {"picture", "screen", "pane", "dial", "mirror", "glass", "leaf"}
"""Roles of plain surfaces: the main one of a shape stands for the main one of another, whatever it is made of."""
_FACING = 0.5
_MIN_EXTENT_M = 1e-6


@dataclass(frozen=True)
class Slot:
    """Surfaces of one material."""

    name: str
    role: Role
    geometry: tuple[str, ...]
    """Names of its meshes in the shape's parts."""
    area_m2: float
    main: bool
    """Whether no other slot covers more of the shape."""
    tile_m: float | None = None
    """Metres that one unit of its texture coordinates covers; None where that is not known."""


@dataclass(frozen=True, eq=False)
class SlotRectangle:
    """The rectangle over a slot that a picture is spread on, in the shape's frame at scale 1.

    A point of the picture is `origin + u * across + v * up`, u and v from 0 to 1, v upward in the picture.
    """

    origin: Float[np.ndarray, "3"]
    across: Float[np.ndarray, "3"]
    up: Float[np.ndarray, "3"]

    @property
    def corners(self) -> Float[np.ndarray, "4 3"]:
        """Clockwise from the picture's top left."""
        top = self.origin + self.up
        return np.array([top, top + self.across, self.origin + self.across, self.origin])

    def uv(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 2"]:
        """Texture coordinates of points, projected at a right angle."""
        away = points - self.origin
        return np.stack([away @ self.across / (self.across**2).sum(), away @ self.up / (self.up**2).sum()], axis=1)


def slots_of(parts: trimesh.Scene) -> tuple[Slot, ...]:
    """The slots of a shape's parts, largest first."""
    grouped: dict[str, list[str]] = {}
    for name, mesh in parts.geometry.items():
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            grouped.setdefault(material_key(mesh), []).append(str(name))
    areas = {key: sum(float(parts.geometry[n].area) for n in names) for key, names in grouped.items()}
    slots: list[Slot] = []
    ranks: dict[str, int] = {}
    for key in sorted(grouped, key=lambda k: (-areas[k], k)):
        mesh = parts.geometry[grouped[key][0]]
        role = role_of(mesh)
        ranks[role] = ranks.get(role, 0) + 1
        name = role if ranks[role] == 1 else f"{role} {ranks[role]}"
        slots.append(Slot(name, role, tuple(grouped[key]), areas[key], not slots, mesh.metadata.get(TILE_M)))
    return tuple(slots)


def role_of(mesh: trimesh.Trimesh) -> Role:
    """What a mesh is made of: as its design says, else told by its material's name and properties."""
    stated: Role | None = mesh.metadata.get(ROLE)
    if stated is not None:
        return stated
    material: Any = getattr(mesh.visual, "material", None)
    name = str(getattr(material, "name", "") or "").lower()
    named = next((role for role, words in WORDS.items() if re.search(words, name)), None)
    if named is not None or not isinstance(material, PBRMaterial):
        return named or "material"
    factor = material.baseColorFactor
    if material.alphaMode == "BLEND" and factor is not None and factor[3] < 255 * CLEAR:
        return "glass"
    return "metal" if (material.metallicFactor or 0.0) >= METALNESS else "material"


def match(slots: Sequence[Slot], materials: Sequence[PhotoMaterial]) -> dict[str, PhotoMaterial]:
    """The material for every slot that has one: of its own name, main for main, else the first of its role."""
    by_name = {m.slot: m for m in materials}
    main = next((m for m in materials if m.main and _role(m.slot) in SURFACE_ROLES), None)
    matches: dict[str, PhotoMaterial] = {}
    for slot in slots:
        material = by_name.get(slot.name)
        if slot.main and slot.role in SURFACE_ROLES and main is not None and (material is None or not material.main):
            material = main
        material = material or by_name.get(slot.role)
        if material is not None:
            matches[slot.name] = replace(material, slot=slot.name)
    return matches


def rectangle_of(parts: trimesh.Scene, slot: Slot, layout: TextureLayout) -> SlotRectangle:
    """The rectangle that a picture over the slot is spread on: flat on what faces the front, or upward."""
    toward = np.array([1.0, 0.0, 0.0]) if layout == "front" else np.array([0.0, 0.0, 1.0])
    points, normals, centres, areas = _triangles(parts, slot)
    facing = np.maximum(normals @ toward - _FACING, 0.0) * areas
    normal = facing @ normals if facing.sum() > 0 else toward
    normal = normal / np.linalg.norm(normal)
    across = np.array([0.0, 1.0, 0.0]) - normal[1] * normal
    across /= np.linalg.norm(across)
    up = np.cross(normal, across)
    u, v, depth = points @ across, points @ up, centres @ normal
    at = float(np.average(depth, weights=facing)) if facing.sum() > 0 else float(depth.max())
    width, height = max(float(np.ptp(u)), _MIN_EXTENT_M), max(float(np.ptp(v)), _MIN_EXTENT_M)
    return SlotRectangle(across * u.min() + up * v.min() + normal * at, across * width, up * height)


def place_vertices(parts: trimesh.Scene, name: str) -> Float[np.ndarray, "n 3"]:
    """Vertices of one mesh of a shape's parts, in the shape's frame."""
    return trimesh.transform_points(parts.geometry[name].vertices, transform_of(parts, name))


def transform_of(parts: trimesh.Scene, name: str) -> Float[np.ndarray, "4 4"]:
    """From a mesh's own frame to the shape's; of the first place where a mesh is used several times."""
    node = next((n for n in parts.graph.nodes_geometry if parts.graph[n][1] == name), None)
    return np.eye(4) if node is None else np.asarray(parts.graph[node][0], dtype=np.float64)


def _triangles(
    parts: trimesh.Scene, slot: Slot
) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"], Float[np.ndarray, "m"]]:
    """Points, and unit normals, centres and areas of the triangles of a slot."""
    points, normals, centres, areas = [], [], [], []
    for name in slot.geometry:
        vertices = place_vertices(parts, name)
        corners = vertices[parts.geometry[name].faces]
        cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(cross, axis=1)
        points.append(vertices)
        normals.append(cross / np.maximum(length, 1e-15)[:, None])
        centres.append(corners.mean(axis=1))
        areas.append(length / 2)
    return np.concatenate(points), np.concatenate(normals), np.concatenate(centres), np.concatenate(areas)


def _role(slot_name: str) -> str:
    return slot_name.rstrip("0123456789 ")


def material_key(mesh: trimesh.Trimesh) -> str:
    """Tells a mesh's material from others; `PLAIN` where it only has colours."""
    material = getattr(mesh.visual, "material", None)
    if material is None:
        return PLAIN
    return str(material.name or hash(material))
