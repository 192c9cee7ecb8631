"""A scene as a list of links with joints, which URDF and SDF both write.

Every object is a link, every moving part of it another; files of meshes are named once. Link frames are the objects'
rigid frames, moving parts share theirs when they are closed. Neither format says how far a joint is open at the start:
what stands open is placed open, its joint is at zero there, and the limits are what is left on both sides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from jaxtyping import Float

from diorama_core.export.bodies import PhysicalScene, Points, RigidBody, hull_faces
from diorama_core.export.colliders import physical_scene
from diorama_core.export.files import Entry, companion_folder, write_package
from diorama_core.export.gathering import ExportMesh, ExportScene, rigid_inverse
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.physics import Inertia
from diorama_core.export.wavefront import MaterialFile, hull_file, obj_file
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.progress import Progress
from diorama_core.render.appearance import Material

MATERIALS = "materials.mtl"
_TERMS = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
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
    joint_friction: float = 0.0
    """Newtons or newton metres."""

    @property
    def limits(self) -> tuple[float, float] | None:
        """How far the joint goes back and on from where it stands, radians or metres; None without limits."""
        if self.limb is None or self.limb.kind == "swivel":
            return None
        return self.limb.lower - self.limb.opened, self.limb.upper - self.limb.opened


def links_of(gathered: ExportScene, physical: PhysicalScene) -> tuple[Link, ...]:
    """Links of all objects, parents first."""
    slugs = {b.node.id: b.node.slug for b in physical.bodies}
    links = []
    for body in _carriers_first(physical.bodies):
        node = body.node
        parent = None if body.free or body.carrier is None else slugs[body.carrier]
        carrier = np.eye(4) if body.carrier is None or body.free else gathered.object(body.carrier).T_world
        top = Link(
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
        links.append(top)
        for moving in body.moving:
            limb = moving.limb
            part = replace(top, name=body_name(node.slug, limb), parent=node.slug, joint=limb.kind, limb=limb)
            part = replace(part, T_parent=limb.T_object_limb, mesh=gathered.meshes[limb.mesh], parts=moving.parts)
            links.append(replace(part, inertia=moving.inertia, joint_friction=moving.friction))
    return tuple(links)


def body_name(slug: str, limb: ExportLimb | None) -> str:
    """The name of an object's link or body, or of a moving part of it."""
    return slug if limb is None else f"{slug}__{limb.slug}"


def _carriers_first(bodies: tuple[RigidBody, ...]) -> list[RigidBody]:
    done: dict[str, RigidBody] = {}
    while len(done) < len(bodies):
        waiting = (b for b in bodies if b.node.id not in done)
        done |= {b.node.id: b for b in waiting if b.free or b.carrier is None or b.carrier in done}
    return list(done.values())


def group(links: tuple[Link, ...]) -> dict[str, tuple[Link, ...]]:
    """Links by the one that carries them all, first that one, then what is joined to it; in the order of the links."""
    groups: dict[str, tuple[Link, ...]] = {}
    top: dict[str, str] = {}
    for link in links:
        name = top[link.name] = link.name if link.parent is None else top[link.parent]
        groups[name] = (*groups.get(name, ()), link)
    return groups


def write_linked(
    gathered: ExportScene, path: Path, progress: Progress, kind: str, describe: Callable[..., Mapping[str, str]]
) -> None:
    """Write the files that `describe` makes and the meshes they name: side by side, or everything as one `.zip`.

    Args:
        gathered: The scene.
        path: The main file, or the `.zip`.
        progress: Where it is reported and cancelling is noticed.
        kind: Ending of the main file without its dot.
        describe: Called with the scene, its bodies, its links, the main file's name and the folder of the meshes;
            gives the text of each file by its name, the main one last.

    Raises:
        ExportError: when it cannot be written.
    """
    progress.report(0.0, "preparing colliders")
    physical = physical_scene(gathered)
    links = links_of(gathered, physical)
    main, folder = f"{Path(path).stem}.{kind}", companion_folder(path, kind)
    texts = describe(gathered, physical, links, main, folder)

    def entries() -> Iterator[Entry]:
        yield from mesh_files(gathered, folder, progress)
        yield from collider_files(physical, folder)
        for name, text in texts.items():
            yield name, text.encode()

    write_package(path, main, entries())


def visual_file(folder: str, mesh: ExportMesh, number: int) -> str:
    """File of one surface of a mesh."""
    return f"{folder}/meshes/{mesh.key}_{number}.obj"


def collider_file(folder: str, owner: str, number: int) -> str:
    """File of one convex part."""
    return f"{folder}/colliders/{owner}_{number}.obj"


def mesh_files(gathered: ExportScene, folder: str, progress: Progress) -> Iterator[Entry]:
    """Visual meshes with their materials and pictures, in a folder."""
    materials = MaterialFile(gathered.materials, display=True, maps=False)
    yield f"{folder}/meshes/{MATERIALS}", materials.text()
    for name, content in materials.pictures():
        yield f"{folder}/meshes/{name}", content
    for done, mesh in enumerate(gathered.meshes.values()):
        progress.report(0.3 + 0.6 * done / len(gathered.meshes), f"writing {mesh.name}")
        for number, surface in enumerate(mesh.surfaces):
            yield visual_file(folder, mesh, number), obj_file(surface, MATERIALS, materials.name(surface.material))


def collider_files(physical: PhysicalScene, folder: str) -> Iterator[Entry]:
    """Convex parts of the room, the objects and their moving parts, in a folder."""
    owners = [(s.slug, s.pieces) for s in physical.slabs] + [(b.node.slug, b.parts) for b in physical.bodies]
    owners += [(body_name(b.node.slug, m.limb), m.parts) for b in physical.bodies for m in b.moving]
    for owner, parts in owners:
        for number, part in enumerate(parts):
            yield collider_file(folder, owner, number), hull_file(*hull_faces(part))


def numbers(values: Float[np.ndarray, " n"]) -> str:
    """Numbers side by side, with nine significant digits."""
    return " ".join([f"{value:.9g}" for value in np.asarray(values, dtype=float).tolist()])


def inertia_terms(tensor: Float[np.ndarray, "3 3"]) -> dict[str, str]:
    """The six different entries of an inertia tensor, by the names that URDF and SDF give them."""
    return {name: f"{float(tensor[at]):.8g}" for name, at in _TERMS.items()}


def srgb_rgba(material: Material) -> Float[np.ndarray, "4"]:
    """A material's colour as programs without linear light expect it."""
    return np.append(linear_to_srgb(np.asarray(material.colour)), material.alpha)
