"""A built-in shape taken apart at its joints, in the same canonical frame as the whole."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import cast

import numpy as np
import trimesh

from diorama_core.library import furniture
from diorama_core.library.furniture.joints import Joint, Vector
from diorama_core.library.furniture.latest import latest_parts
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.measures import MARK, is_made, made_by_id
from diorama_core.library.furniture.model import Design, Part, joined, scene_of
from diorama_core.library.furniture.roles import with_roles
from diorama_core.library.furniture.solids import Solid, unit

_FIXED = "fixed"


@dataclass(frozen=True, eq=False)
class Articulation:
    """A shape whose parts move: what stays, and what each joint moves.

    `scene` names its geometry "fixed/..." or "NUMBER/..." after the joint's place in `joints`.
    """

    joints: tuple[Joint, ...]
    """In the canonical frame at scale 1, names made unique: "drawer 1", "drawer 2"."""
    scene: trimesh.Scene
    solids: tuple[tuple[int | None, Solid], ...]
    """Every solid with the index of its joint, None for what stays."""

    def of_joint(self, number: int | None) -> tuple[Solid, ...]:
        """Solids that one joint moves, or those that stay."""
        return tuple(s for k, s in self.solids if k == number)


def joint_of(geometry_name: str) -> int | None:
    """The joint that moves a geometry of `Articulation.scene`, by its name; None for what stays."""
    owner = geometry_name.split("/", 1)[0]
    return None if owner == _FIXED else int(owner)


_FURTHER = "+"
"""Begins what an id says beyond how the shape is made."""


@lru_cache(maxsize=1024)
def articulation(shape_id: str) -> Articulation | None:
    """The moving parts of a built-in shape, made to measure or not; None where it has none, or is not built in.

    A shape whose boards are elsewhere (`library.boards`) is stretched as a whole, and has none.
    """
    listed, _, made = shape_id.partition(MARK)
    design = _designs().get(listed)
    if design is None or _FURTHER in made:
        return None
    if not is_made(shape_id):
        return _articulated(design)
    return _articulated(made_by_id(shape_id, design))


@lru_cache(maxsize=1)
def _designs() -> dict[str, Design]:
    return {d.id: d for d in furniture.designs()}


def _articulated(design: Design) -> Articulation | None:
    parts = latest_parts(design)
    if all(p.joint is None for p in parts):
        return None
    whole = np.concatenate([p.solid.vertices for p in parts if p.role != "inside"])
    low, high = whole.min(axis=0), whole.max(axis=0)
    centre, factors = (low + high) / 2, np.asarray(design.size_m) / (high - low)
    present = [p for p in parts if p.role != "filler"]
    joints = list(dict.fromkeys(p.joint for p in present if p.joint is not None))
    solids = tuple(
        (None if p.joint is None else joints.index(p.joint), _stretched(p.solid, centre, factors)) for p in present
    )
    named = tuple(_placed(j, name, centre, factors) for j, name in zip(joints, _names(joints), strict=True))
    return Articulation(named, _scene(present, solids), solids)


def _stretched(solid: Solid, centre: np.ndarray, factors: np.ndarray) -> Solid:
    return replace(solid, vertices=(solid.vertices - centre) * factors, normals=unit(solid.normals / factors))


def _placed(joint: Joint, name: str, centre: np.ndarray, factors: np.ndarray) -> Joint:
    """The joint in the canonical frame; lengths along its axis are stretched with the shape."""
    origin = tuple(float(v) for v in (np.asarray(joint.origin) - centre) * factors)
    stretch = float(np.linalg.norm(np.asarray(joint.axis) * factors)) if joint.kind == "slide" else 1.0
    return replace(
        joint, name=name, origin=cast(Vector, origin), lower=joint.lower * stretch, upper=joint.upper * stretch
    )


def _names(joints: list[Joint]) -> list[str]:
    counts = {name: sum(j.name == name for j in joints) for name in {j.name for j in joints}}
    seen: dict[str, int] = {}
    out = []
    for joint in joints:
        seen[joint.name] = seen.get(joint.name, 0) + 1
        out.append(joint.name if counts[joint.name] == 1 else f"{joint.name} {seen[joint.name]}")
    return out


def _scene(parts: list[Part], solids: tuple[tuple[int | None, Solid], ...]) -> trimesh.Scene:
    """One mesh for each material of what stays and of what each joint moves."""
    grouped: dict[tuple[int | None, Material], list[Solid]] = {}
    for part, (number, solid) in zip(parts, solids, strict=True):
        grouped.setdefault((number, part.material), []).append(solid)
    scene = trimesh.Scene()
    for (number, material), group in grouped.items():
        single = with_roles(scene_of([(material, joined(group))]), [material])
        (name, mesh), *_ = single.geometry.items()
        label = f"{_FIXED if number is None else number}/{len(scene.geometry):02d} {name}"
        scene.add_geometry(mesh, node_name=label, geom_name=label)
    return scene
