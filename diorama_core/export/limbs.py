"""The moving parts of objects: what each joint moves, posed and scaled like its object."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from diorama_core.geometry.convex import ConvexPart
from diorama_core.layout.problem.parts import parts_of_solids
from diorama_core.library.furniture.articulation import Articulation, joint_of
from diorama_core.library.furniture.joints import Joint, JointKind
from diorama_core.library.furniture.model import joined
from diorama_core.library.opening import articulation_of, travel_at
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.appearance import Surface
from diorama_core.scene.types import SceneObject


@dataclass(frozen=True, eq=False)
class ExportLimb:
    """One moving part of an object, in the object's rigid frame with its scale applied.

    Its own frame is that of its object when it is closed. Origin and axis are the same in both.
    """

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
    opened: float = 0.0
    """Where it stands between `lower` and `upper`: radians or metres."""

    @property
    def T_object_limb(self) -> Float[np.ndarray, "4 4"]:
        """Its frame in that of its object, as it stands."""
        out = np.eye(4)
        if self.kind == "slide":
            out[:3, 3] = self.opened * self.axis
            return out
        out[:3, :3] = Rotation.from_rotvec(self.opened * self.axis).as_matrix()
        out[:3, 3] = self.origin - out[:3, :3] @ self.origin
        return out


def group_by_joint(surfaces: Iterable[Surface]) -> dict[int | None, tuple[Surface, ...]]:
    """Group the surfaces of a jointed shape (`OneShape`): what stays (None) and what each joint moves."""
    grouped: dict[int | None, tuple[Surface, ...]] = {}
    for surface in surfaces:
        number = joint_of(surface.name)
        grouped[number] = (*grouped.get(number, ()), surface)
    return grouped


def limb_of(item: SceneObject, joint: Joint, number: int, mesh: str) -> ExportLimb:
    """A joint at an object's scale. A turning part keeps its form, so a stretched one turns rigidly.

    Args:
        item: the object.
        joint: at scale 1.
        number: among the object's joints.
        mesh: name of its part.
    """
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
        opened=travel_at(joint, item.open_share) * stretch,
    )


def limb_parts(library: ShapeLibrary, shape_id: str, number: int | None) -> tuple[ConvexPart, ...]:
    """Convex bodies of what one joint of a shape moves, or of what stays; canonical frame, scale 1."""
    pieces = articulation_of(library, shape_id)
    solids = () if pieces is None else pieces.of_joint(number)
    if not solids:
        return ()
    whole = joined(solids)
    return parts_of_solids(whole.vertices, whole.faces)


@dataclass(frozen=True)
class OneShape:
    """Lets a scene of moving parts be read like the parts of a library's shape."""

    pieces: Articulation

    def parts(self, shape_id: str) -> trimesh.Scene:
        """All of them, whichever the shape is called."""
        return self.pieces.scene
