"""A scene as an SDFormat world, for Gazebo: the room as one static model, every object a model of its own.

What is welded to an object is a link of that object's model; moving parts are links on revolute and prismatic joints.
"""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from diorama_core.export.bodies import PhysicalScene
from diorama_core.export.gathering import ExportMesh, ExportScene
from diorama_core.export.lights import ExportLight, MainLight
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
from diorama_core.export.physics import FLOOR_FRICTION
from diorama_core.progress import SILENT, Progress

VERSION = "1.9"
ROOM = "room"
HYDROELASTIC_MODULUS = "1e8"
"""Stiffness of surfaces in Drake, pascals: what stands sinks in by less than a millimetre."""
FULL_LIGHT_LUX = 1000.0
"""Illuminance by a directional light of full intensity."""


def write_sdf(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write an SDF world: `.sdf` with a folder beside it, or everything as one `.zip`, as `Writer` says."""
    write_linked(gathered, path, progress, "sdf", sdf_files)


def sdf_files(
    gathered: ExportScene, physical: PhysicalScene, links: tuple[Link, ...], main: str, folder: str
) -> dict[str, str]:
    """The world by its name; meshes lie in `folder`, relative to it.

    Args:
        gathered: meshes, materials and lights of the scene.
        physical: masses, hulls and joints of its objects.
        links: bodies and their joints.
        main: name of the world's file.
        folder: that files are in, relative to the document.
    """
    root = Element("sdf", {"version": VERSION, "xmlns:drake": "http://drake.mit.edu"})
    world = SubElement(root, "world", name=gathered.name)
    _fill(world, gravity="0 0 -9.81")
    for light in gathered.lights:
        _light(world, f"{gathered.object(light.owner).slug}_light", light)
    if gathered.main_light is not None:
        _main_light(world, gathered.main_light)
    _room(world, gathered, physical, folder)
    for model in group(links).values():
        _model(world, model, folder)
    indent(root)
    return {main: '<?xml version="1.0"?>\n' + tostring(root, encoding="unicode") + "\n"}


def _room(world: Element, gathered: ExportScene, physical: PhysicalScene, folder: str) -> None:
    if not physical.slabs:
        return
    model = SubElement(world, "model", name=ROOM)
    _fill(model, static="1")  # PyBullet knows no other word
    link = SubElement(model, "link", name="link")
    for exported in gathered.planes:
        _visuals(link, gathered.meshes[exported.mesh], np.ones(3), folder)
    for slab in physical.slabs:
        _colliders(link, slab.slug, len(slab.pieces), FLOOR_FRICTION, folder)


def _fill(element: Element, **texts: str) -> None:
    """Add elements that hold a text, by their names."""
    for name, text in texts.items():
        SubElement(element, name).text = text


def _model(world: Element, links: tuple[Link, ...], folder: str) -> None:
    top = links[0]
    model = SubElement(world, "model", name=top.name)
    _fill(model, pose=_pose(top.T_parent), static="0" if top.joint == "free" or len(links) > 1 else "1")
    places: dict[str, Float[np.ndarray, "4 4"]] = {top.name: np.eye(4)}
    for link in links:
        if link is not top and link.parent is not None:
            places[link.name] = places[link.parent] @ link.T_parent
        _link(model, link, places[link.name], folder)
    if top.joint == "fixed" and len(links) > 1:  # its moving parts may move, so the model is not static
        _fill(SubElement(model, "joint", name="to_room", type="fixed"), parent="world", child=top.name)
    for link in links[1:]:
        _joint(model, link)


def _link(model: Element, link: Link, T_model: Float[np.ndarray, "4 4"], folder: str) -> None:
    element = SubElement(model, "link", name=link.name)
    _fill(element, pose=_pose(T_model))
    inertial = SubElement(element, "inertial")
    _fill(inertial, pose=f"{numbers(link.inertia.centre)} 0 0 0", mass=f"{link.inertia.mass_kg:.6g}")
    _fill(SubElement(inertial, "inertia"), **inertia_terms(link.inertia.tensor))
    _visuals(element, link.mesh, link.scale, folder)
    _colliders(element, link.name, len(link.parts), link.friction, folder)


def _joint(model: Element, link: Link) -> None:
    kinds = {"hinge": "revolute", "swivel": "continuous", "slide": "prismatic"}
    joint = SubElement(model, "joint", name=f"{link.name}_joint", type=kinds.get(link.joint, "fixed"))
    limb = link.limb
    if limb is not None:
        _fill(joint, pose=f"{numbers(limb.origin)} 0 0 0")
    _fill(joint, parent=str(link.parent), child=link.name)
    if limb is None:
        return
    axis = SubElement(joint, "axis")
    _fill(axis, xyz=numbers(limb.axis))
    if link.limits is not None:
        lower, upper = (f"{limit:.8g}" for limit in link.limits)
        _fill(SubElement(axis, "limit"), lower=lower, upper=upper)
    _fill(SubElement(axis, "dynamics"), damping="1.0", friction=f"{link.joint_friction:.4g}")


def _visuals(element: Element, mesh: ExportMesh, scale: Float[np.ndarray, "3"], folder: str) -> None:
    for number, surface in enumerate(mesh.surfaces):
        visual = SubElement(element, "visual", name=f"{mesh.key}_{number}")
        shape = SubElement(SubElement(visual, "geometry"), "mesh")
        _fill(shape, uri=visual_file(folder, mesh, number), scale=numbers(scale))
        if surface.material.texture is None:  # textured ones keep what their own file says
            colour = numbers(srgb_rgba(surface.material))
            _fill(SubElement(visual, "material"), ambient=colour, diffuse=colour)


def _colliders(element: Element, owner: str, count: int, friction: float, folder: str) -> None:
    for number in range(count):
        collision = SubElement(element, "collision", name=f"{owner}_part_{number}")
        shape = SubElement(SubElement(collision, "geometry"), "mesh")
        _fill(shape, uri=collider_file(folder, owner, number))
        SubElement(shape, "drake:declare_convex")
        drake = SubElement(collision, "drake:proximity_properties")  # else bodies touch at one point alone there
        SubElement(drake, "drake:compliant_hydroelastic")
        SubElement(drake, "drake:hydroelastic_modulus").text = HYDROELASTIC_MODULUS
        grip = SubElement(SubElement(SubElement(collision, "surface"), "friction"), "ode")
        _fill(grip, mu=f"{friction:.3g}", mu2=f"{friction:.3g}")


def _light(world: Element, name: str, light: ExportLight) -> None:
    element = SubElement(world, "light", name=name, type="point" if light.kind == "lamp" else "spot")
    _fill(element, pose=_pose(light.T_world), diffuse=f"{numbers(np.asarray(light.colour))} 1")
    _fill(SubElement(element, "attenuation"), range="20", constant="0.3", linear="0.1", quadratic="0.1")
    if light.kind == "window":
        _fill(element, direction="0 0 -1")
        _fill(SubElement(element, "spot"), inner_angle="0.5", outer_angle="1.5", falloff="1")


def _main_light(world: Element, light: MainLight) -> None:
    element = SubElement(world, "light", name="main_light", type="directional")
    strength = f"{min(light.lux / FULL_LIGHT_LUX, 1.0):.3g}"
    _fill(element, pose=_pose(light.T_world), diffuse=f"{numbers(np.asarray(light.colour))} 1")
    _fill(element, intensity=strength, direction="0 0 -1")


def _pose(T: Float[np.ndarray, "4 4"]) -> str:
    return numbers(np.concatenate([T[:3, 3], Rotation.from_matrix(T[:3, :3]).as_euler("xyz")]))
