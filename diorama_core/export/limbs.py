"""The moving parts of objects: what each joint moves, posed and scaled like its object."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.geometry.convex import ConvexPart, convex_parts
from diorama_core.library.furniture.articulation import Articulation, articulation, joint_of
from diorama_core.library.furniture.joints import Joint, JointKind
from diorama_core.library.paint import Colour
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.render.appearance import Surface, part_surfaces
from diorama_core.scene.types import Finish, SceneObject

BUILT_IN = "built in"


@dataclass(frozen=True, eq=False)
class ExportLimb:
    """One moving part of an object, in the object's rigid frame with its scale applied."""

    name: str
    """"drawer 1", unique within the object."""
    slug: str
    """Unique within the object: letters, digits and underscores."""
    kind: JointKind
    origin: Float[np.ndarray, "3"]
    axis: Float[np.ndarray, "3"]
    """Unit."""
    lower: float
    upper: float
    mesh: str
    """Key of its mesh, in the shape's canonical frame at scale 1 like that of its object."""
    number: int
    """Which joint of the shape's articulation it is."""


def articulation_of(library: ShapeLibrary, shape_id: str) -> Articulation | None:
    """The moving parts of a shape; None for shapes that are not built in, whose joints are unknown."""
    return articulation(shape_id) if record_of(library, shape_id).source == BUILT_IN else None


def surfaces_of(
    pieces: Articulation, colour: Colour | None, finish: Finish | None
) -> dict[int | None, tuple[Surface, ...]]:
    """Surfaces of what stays (None) and of what each joint moves, painted as one shape."""
    grouped: dict[int | None, tuple[Surface, ...]] = {}
    for surface in part_surfaces(pieces.scene, colour, finish):
        number = joint_of(surface.name)
        grouped[number] = (*grouped.get(number, ()), surface)
    return grouped


def limb_of(item: SceneObject, joint: Joint, number: int, mesh: str) -> ExportLimb:
    """A joint at an object's scale. A turning part keeps its form, so a stretched one turns rigidly."""
    scale = np.asarray(item.pose.scale)
    axis = np.asarray(joint.axis) * scale
    stretch = float(np.linalg.norm(axis)) if joint.kind == "slide" else 1.0
    return ExportLimb(
        name=joint.name,
        slug=joint.name.replace(" ", "_"),
        kind=joint.kind,
        origin=np.asarray(joint.origin) * scale,
        axis=axis / np.linalg.norm(axis),
        lower=joint.lower * stretch,
        upper=joint.upper * stretch,
        mesh=mesh,
        number=number,
    )


@lru_cache(maxsize=512)
def limb_parts(shape_id: str, number: int | None) -> tuple[ConvexPart, ...]:
    """Convex bodies of what one joint of a built-in shape moves, or of what stays; canonical frame, scale 1."""
    pieces = articulation(shape_id)
    solids = () if pieces is None else pieces.of_joint(number)
    if not solids:
        return ()
    meshes = [trimesh.Trimesh(s.vertices, s.faces, process=False) for s in solids]
    return convex_parts(trimesh.util.concatenate(meshes))
