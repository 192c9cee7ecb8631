"""From solids and materials to a finished model, and the design that knows how to build it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np
import trimesh

from diorama_core.library.furniture.joints import Joint
from diorama_core.library.furniture.materials import Material, pbr
from diorama_core.library.furniture.solids import Solid, places, unit
from diorama_core.library.record import SymmetryFold

Size = tuple[float, float, float]
"""Extents along x (front-back), y (left-right), z (height), metres."""


@dataclass(frozen=True)
class Part:
    """One solid of one material."""

    material: Material
    solid: Solid
    joint: Joint | None = None
    """How it moves against the rest; None where it does not."""
    role: Literal["shown", "filler", "inside"] = "shown"
    """A filler closes a case that is not opened; what is inside is only there when the case can be opened."""

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Part:
        """Shifted by (x, y, z)."""
        joint = None if self.joint is None else self.joint.moved(x, y, z)
        return replace(self, solid=self.solid.moved(x, y, z), joint=joint)

    def turned(self, axis: str, angle_deg: float) -> Part:
        """Turned about a coordinate axis through the origin."""
        joint = None if self.joint is None else self.joint.turned(axis, angle_deg)
        return replace(self, solid=self.solid.turned(axis, angle_deg), joint=joint)


Parts = list[Part]


@runtime_checkable
class NamedStyle(Protocol):
    """What runs through every piece of one style (`styles.Style`)."""

    @property
    def name(self) -> str:
        """Value of `Shape.style`."""
        ...


@dataclass(frozen=True)
class Design:
    """What a shape is and how to build it. Building is deterministic and depends on nothing else."""

    id: str
    category: str
    caption: str
    size_m: Size
    style: str
    builder: Callable[..., Parts]
    """Called with the size and `options`: parts standing on z = 0, front toward +X, about as large as the size."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """What else the builder is told."""
    symmetry: SymmetryFold = 1
    mass_kg: float | None = None
    """None lets the catalogue guess from the category and the size."""

    def build(self, size_m: Size) -> Parts:
        """The parts at about a size; `built` makes them exact."""
        return self.builder(size_m, **self.options)


def design(
    category: str,
    name: str,
    caption: str,
    size_m: Size,
    style: str | NamedStyle,
    builder: Callable[..., Parts],
    symmetry: SymmetryFold = 1,
    *,
    id: str | None = None,
    mass_kg: float | None = None,
    **options: Any,
) -> Design:
    """One row of a table of designs.

    Args:
        category: Canonical category.
        name: What tells it from its siblings; the id is the category and the name.
        caption: One line a person would say of it.
        size_m: Extents along x, y and z.
        style: modern, classic, industrial, rustic or minimal; or a whole style, which the builder gets as `style`.
        builder: Called with the size and `options`.
        symmetry: Turns about up that leave it looking the same.
        id: The whole id, where it was once called otherwise.
        mass_kg: None lets the catalogue guess.
        options: What else the builder is told.
    """
    known_as = id or f"{category.replace(' ', '-')}-{name}"
    if isinstance(style, str):
        return Design(known_as, category, caption, size_m, style, builder, options, symmetry, mass_kg)
    options = {"style": style, **options}
    return Design(known_as, category, caption, size_m, style.name, builder, options, symmetry, mass_kg)


def designs_of(*kinds: ModuleType) -> tuple[Design, ...]:
    """The tables of several modules, `DESIGNS` in each, one after the other."""
    return tuple(row for kind in kinds for row in kind.DESIGNS)


def jointed(joint: Joint | None, parts: Iterable[Part]) -> Parts:
    """Parts that move together."""
    return [replace(p, joint=joint) for p in parts]


def with_role(role: Literal["filler", "inside"], parts: Iterable[Part]) -> Parts:
    """Parts that are there only while the piece is closed, or only when it can be opened."""
    return [replace(p, role=role) for p in parts]


def of(material: Material, *solids: Solid) -> Parts:
    """Parts of one material."""
    return [Part(material, s) for s in solids]


def shifted(parts: Iterable[Part], x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Parts:
    """Parts moved together."""
    return [p.moved(x, y, z) for p in parts]


def turned(parts: Iterable[Part], axis: str, angle_deg: float) -> Parts:
    """Parts turned together about a coordinate axis through the origin."""
    return [p.turned(axis, angle_deg) for p in parts]


def both_sides(*solids: Solid) -> tuple[Solid, ...]:
    """Solids and their mirror images in the plane y = 0."""
    return (*solids, *(s.mirrored() for s in solids))


def four(solid: Solid) -> tuple[Solid, ...]:
    """A solid at the front left, mirrored to all four corners."""
    front = (solid, solid.mirrored())
    return (*front, *(s.mirrored(0) for s in front))


def joined(solids: Sequence[Solid]) -> Solid:
    """Several solids as one mesh."""
    offsets = np.cumsum([0, *(len(s.vertices) for s in solids)])
    return Solid(
        np.concatenate([s.vertices for s in solids]),
        np.concatenate([s.faces + o for s, o in zip(solids, offsets, strict=False)]),
        np.concatenate([s.normals for s in solids]),
        np.concatenate([s.uv for s in solids]),
    )


def built(design: Design) -> list[tuple[Material, Solid]]:
    """The design's solids, one per material, centred, stretched to exactly the declared size."""
    parts = [p for p in design.build(design.size_m) if p.role != "inside"]
    points = np.concatenate([p.solid.vertices for p in parts])
    low, high = points.min(axis=0), points.max(axis=0)
    centre, factors = (low + high) / 2, np.asarray(design.size_m) / (high - low)
    grouped: dict[Material, list[Solid]] = {}
    for part in parts:
        grouped.setdefault(part.material, []).append(part.solid)
    out = []
    for material, solids in grouped.items():
        solid = joined(solids)
        out.append(
            (
                material,
                replace(solid, vertices=(solid.vertices - centre) * factors, normals=unit(solid.normals / factors)),
            )
        )
    return out


def scene_of(solids: Iterable[tuple[Material, Solid]]) -> trimesh.Scene:
    """Solids as a trimesh scene with one textured mesh per material."""
    scene = trimesh.Scene()
    for number, (material, solid) in enumerate(solids):
        visual = trimesh.visual.TextureVisuals(uv=solid.uv / material.tile_m, material=pbr(material))
        mesh = trimesh.Trimesh(solid.vertices, solid.faces, vertex_normals=solid.normals, visual=visual, process=False)
        name = f"{number:02d} {material.name}"
        scene.add_geometry(mesh, node_name=name, geom_name=name)
    return scene


def mesh_of(solids: Iterable[tuple[Material, Solid]]) -> trimesh.Trimesh:
    """Geometry only, equal positions welded."""
    solid = joined([s for _, s in solids])
    first, number = places(solid.vertices)
    faces = number[solid.faces]
    keep = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return trimesh.Trimesh(solid.vertices[first], faces[keep], process=False)
