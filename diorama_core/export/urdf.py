"""A scene as URDF: the room with all that is fixed to it, one file for each object that may move, and their poses.

Few programs read floating joints, so each object is loaded by itself at its pose. Moving parts are on revolute,
prismatic and continuous joints with limits.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from diorama_core.export.bodies import PhysicalScene
from diorama_core.export.gathering import ExportMesh, ExportScene, shift
from diorama_core.export.links import (
    Link,
    collider_file,
    group,
    inertia_terms,
    numbers,
    srgb_rgba,
    visual_file,
    write_linked,
)
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.progress import SILENT, Progress

WORLD, POSES = "world", "poses.json"
EFFORT_N, VELOCITY = "50", "2"
_TYPES = {"fixed": "fixed", "hinge": "revolute", "slide": "prismatic", "swivel": "continuous"}


def write_urdf(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write a URDF: `.urdf` with a folder beside it, or everything as one `.zip`, as `Writer` says."""
    write_linked(gathered, path, progress, "urdf", urdf_files)


def urdf_files(
    gathered: ExportScene, physical: PhysicalScene, links: tuple[Link, ...], main: str, folder: str
) -> dict[str, str]:
    """The room, each object that may move, and `poses.json`, by their names relative to the room's file.

    Args:
        gathered: meshes, materials and lights of the scene.
        physical: masses, hulls and joints of its objects.
        links: bodies and their joints.
        main: name of the room's file.
        folder: of meshes and objects, relative to the room's file.
    """
    models = group(links)
    free = {name: model for name, model in models.items() if model[0].joint == "free"}
    fixed = [link for name, model in models.items() if name not in free for link in model]
    files = {f"{folder}/{name}.urdf": _text(_robot(name), model, ".") for name, model in free.items()}
    poses = [
        {
            "name": name,
            "file": f"{name}.urdf",
            "position_m": [float(v) for v in model[0].T_parent[:3, 3]],
            "quaternion_wxyz": quaternion_wxyz(model[0].T_parent[:3, :3]).tolist(),
        }
        for name, model in free.items()
    ]
    files[f"{folder}/{POSES}"] = json.dumps({"objects": poses}, indent=1) + "\n"
    files[main] = _room(gathered, physical, fixed, folder)
    return files


def _room(gathered: ExportScene, physical: PhysicalScene, links: list[Link], folder: str) -> str:
    """The room and what cannot move, below the link of the world."""
    robot = _robot(gathered.name)
    world = SubElement(robot, "link", name=WORLD)
    for exported in gathered.planes:
        _visuals(world, gathered.meshes[exported.mesh], np.ones(3), folder)
    for slab in physical.slabs:
        _colliders(world, slab.slug, len(slab.pieces), folder)
    return _text(robot, links, folder)


def _robot(name: str) -> Element:
    robot = Element("robot", name=name)
    # MuJoCo would drop folders from file names and merge what is fixed.
    SubElement(SubElement(robot, "mujoco"), "compiler", strippath="false", fusestatic="false", discardvisual="true")
    return robot


def _text(robot: Element, links: Iterable[Link], folder: str) -> str:
    """A file with some links."""
    for link in links:
        _link(robot, link, folder)
    indent(robot)
    return '<?xml version="1.0"?>\n' + tostring(robot, encoding="unicode") + "\n"


def _link(robot: Element, link: Link, folder: str) -> None:
    element = SubElement(robot, "link", name=link.name)
    inertial = SubElement(element, "inertial")
    SubElement(inertial, "origin", xyz=numbers(link.inertia.centre), rpy="0 0 0")
    SubElement(inertial, "mass", value=f"{link.inertia.mass_kg:.6g}")
    SubElement(inertial, "inertia", inertia_terms(link.inertia.tensor))
    _visuals(element, link.mesh, link.scale, folder)
    _colliders(element, link.name, len(link.parts), folder)
    contact = SubElement(element, "contact")
    SubElement(contact, "lateral_friction", value=f"{link.friction:.3g}")
    if link.joint == "free":
        return
    joint = SubElement(robot, "joint", name=f"{link.name}_joint", type=_TYPES[link.joint])
    SubElement(joint, "parent", link=link.parent or WORLD)
    SubElement(joint, "child", link=link.name)
    limb = link.limb
    if limb is None:
        SubElement(joint, "origin", _origin(link.T_parent))
        return
    # A moving link's frame lies on its axis: its geometry is shifted back by as much.
    SubElement(joint, "origin", _origin(link.T_parent @ shift(limb.origin)))
    SubElement(joint, "axis", xyz=numbers(limb.axis))
    SubElement(joint, "dynamics", damping="1.0", friction=f"{link.joint_friction:.4g}")
    limits = {"effort": EFFORT_N, "velocity": VELOCITY}
    if link.limits is not None:
        limits |= {"lower": f"{link.limits[0]:.8g}", "upper": f"{link.limits[1]:.8g}"}
    SubElement(joint, "limit", limits)
    for origin in element.iter("origin"):
        origin.set("xyz", numbers(np.array(origin.get("xyz", "").split(), dtype=float) - limb.origin))


def _visuals(element: Element, mesh: ExportMesh, scale: Float[np.ndarray, "3"], folder: str) -> None:
    for number, surface in enumerate(mesh.surfaces):
        visual = SubElement(element, "visual")
        SubElement(visual, "origin", xyz="0 0 0", rpy="0 0 0")
        SubElement(
            SubElement(visual, "geometry"), "mesh", filename=visual_file(folder, mesh, number), scale=numbers(scale)
        )
        material = SubElement(visual, "material", name=f"{mesh.key}_{number}")
        seen = surface.material
        if seen.texture is not None:  # its colour is in the picture, by which programs multiply this one
            seen = replace(seen, colour=(1.0, 1.0, 1.0))
        SubElement(material, "color", rgba=numbers(srgb_rgba(seen)))


def _colliders(element: Element, owner: str, count: int, folder: str) -> None:
    for number in range(count):
        collision = SubElement(element, "collision", name=f"{owner}_part_{number}")
        SubElement(collision, "origin", xyz="0 0 0", rpy="0 0 0")
        SubElement(SubElement(collision, "geometry"), "mesh", filename=collider_file(folder, owner, number))


def _origin(T: Float[np.ndarray, "4 4"]) -> dict[str, str]:
    return {"xyz": numbers(T[:3, 3]), "rpy": numbers(Rotation.from_matrix(T[:3, :3]).as_euler("xyz"))}
