"""A scene as a list of links with joints, which URDF and SDF both write.

Every object is a link, every moving part of it another; files of meshes are named once. Link frames are the objects'
rigid frames, moving parts share theirs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.export.bodies import PhysicalScene, Points, RigidBody
from diorama_core.export.files import Entry
from diorama_core.export.gathering import ExportMesh, ExportScene, rigid_inverse
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.physics import Inertia
from diorama_core.export.wavefront import hull_text, material_text, obj_text, png_bytes
from diorama_core.progress import Progress

LinkJoint = Literal["free", "fixed", "hinge", "slide", "swivel"]


@dataclass(frozen=True, eq=False)
class Link:
    """One rigid link and the joint that carries it."""

    name: str
    parent: str | None
    """Name of the link that carries it; None for the world."""
    joint: LinkJoint
    T_parent: Float[np.ndarray, "4 4"]
    """Rigid, in the parent's frame."""
    mesh: ExportMesh
    scale: Float[np.ndarray, "3"]
    parts: tuple[Points, ...]
    """Convex colliders in the link's frame."""
    inertia: Inertia
    friction: float
    limb: ExportLimb | None = None
    """What moves, for hinges, slides and swivels."""


def links_of(gathered: ExportScene, physical: PhysicalScene) -> tuple[Link, ...]:
    """Links of all objects, parents first."""
    slugs = {b.node.id: b.node.slug for b in physical.bodies}
    found = []
    for body in _carriers_first(physical.bodies):
        node = body.node
        parent = None if body.free or body.carrier is None else slugs[body.carrier]
        carrier = np.eye(4) if body.carrier is None or body.free else gathered.object(body.carrier).T_world
        found.append(
            Link(
                name=node.slug,
                parent=parent,
                joint="free" if body.free else "fixed",
                T_parent=rigid_inverse(carrier) @ node.T_world,
                mesh=gathered.meshes[node.mesh],
                scale=node.scale,
                parts=body.parts,
                inertia=body.inertia,
                friction=body.friction,
            )
        )
        for moving in body.moving:
            found.append(
                Link(
                    name=f"{node.slug}__{moving.limb.slug}",
                    parent=node.slug,
                    joint=moving.limb.kind,
                    T_parent=np.eye(4),
                    mesh=gathered.meshes[moving.limb.mesh],
                    scale=node.scale,
                    parts=moving.parts,
                    inertia=moving.inertia,
                    friction=body.friction,
                    limb=moving.limb,
                )
            )
    return tuple(found)


def _carriers_first(bodies: tuple[RigidBody, ...]) -> list[RigidBody]:
    done: list[RigidBody] = []
    names: set[str] = set()
    waiting = list(bodies)
    while waiting:
        ready = [b for b in waiting if b.free or b.carrier is None or b.carrier in names]
        done += ready
        names |= {b.node.id for b in ready}
        waiting = [b for b in waiting if b.node.id not in names]
    return done


def visual_file(folder: str, mesh: ExportMesh, number: int) -> str:
    """File of one surface of a mesh."""
    return f"{folder}/meshes/{mesh.key}_{number}.obj"


def collider_file(folder: str, owner: str, number: int) -> str:
    """File of one convex part."""
    return f"{folder}/colliders/{owner}_{number}.obj"


def mesh_files(
    gathered: ExportScene, physical: PhysicalScene, links: tuple[Link, ...], folder: str, progress: Progress
) -> Iterator[Entry]:
    """Visual meshes with their materials and pictures, and convex colliders."""
    numbers = {id(m): k for k, m in enumerate(gathered.materials)}
    for number, material in enumerate(gathered.materials):
        picture = f"{number}.png" if material.texture is not None else None
        if picture is not None and material.texture is not None:
            yield f"{folder}/meshes/{picture}", png_bytes(material.texture)
        yield f"{folder}/meshes/material_{number}.mtl", material_text(f"material_{number}", material, picture).encode()
    for done, mesh in enumerate(gathered.meshes.values()):
        progress.report(0.3 + 0.6 * done / len(gathered.meshes), f"writing {mesh.name}")
        for number, surface in enumerate(mesh.surfaces):
            text = obj_text(surface, f"material_{numbers[id(surface.material)]}")
            yield visual_file(folder, mesh, number), text.encode()
    owners = [(s.slug, s.pieces) for s in physical.slabs] + [(link.name, link.parts) for link in links]
    for owner, parts in owners:
        for number, part in enumerate(parts):
            yield collider_file(folder, owner, number), hull_text(*hull_faces(part)).encode()


def hull_faces(points: Points) -> tuple[Points, np.ndarray]:
    """Vertices and outward triangles of a convex body."""
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return points, np.array([[0, 1, 2]])
    faces = np.array(hull.simplices)
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    used = np.unique(faces)
    return points[used], np.searchsorted(used, faces)
