"""A scene as a MuJoCo model: static room, rigid bodies with convex colliders, visual meshes with their materials.

The main file refers to meshes and pictures in a folder beside it, or lies with them in one zip. World +Z up, metres,
quaternions wxyz, as MuJoCo has them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np
from jaxtyping import Float

from diorama_core.export.bodies import MovingPart, PhysicalScene, Points, RigidBody, StaticSlab
from diorama_core.export.colliders import physical_scene
from diorama_core.export.files import Entry, companion_folder, write_package
from diorama_core.export.gathering import ExportMesh, ExportObject, ExportScene, T_world_lens, rigid_inverse
from diorama_core.export.lights import ExportLight, MainLight, even_irradiance
from diorama_core.export.links import body_name, collider_file, collider_files, numbers, srgb_rgba, visual_file
from diorama_core.export.physics import FLOOR_FRICTION, Inertia
from diorama_core.export.pictures import OncePerPicture, png_bytes
from diorama_core.export.wavefront import obj_file
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.progress import SILENT, Progress
from diorama_core.render.lighting import MEAN_IRRADIANCE
from diorama_core.scene.types import Camera

SENSOR_M = 0.036
"""Width of the camera's sensor: any gives the same picture."""
SCREEN_GAMMA = 2.2
"""MuJoCo multiplies colours as screens have them by light, so its lights are powers of what falls."""


def write_mjcf(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write a MuJoCo model: `.xml` with a folder beside it, or everything as one `.zip`, as `Writer` says."""
    progress.report(0.0, "preparing colliders")
    physical = physical_scene(gathered)
    main, folder = f"{Path(path).stem}.xml", companion_folder(path, "mjcf")
    content = mjcf_text(gathered, physical, folder).encode()

    def entries() -> Iterator[Entry]:
        yield from texture_files(gathered, folder)
        yield from _meshes(gathered, folder, progress)
        yield from collider_files(physical, folder)
        yield main, content

    write_package(path, main, entries())


def mjcf_text(gathered: ExportScene, physical: PhysicalScene, folder: str | None = None) -> str:
    """The model's XML.

    Args:
        gathered: The scene.
        physical: The same as rigid bodies.
        folder: Where visual meshes and pictures lie, relative to the model; None writes colliders only.
    """
    root = Element("mujoco", model=gathered.name)
    SubElement(root, "compiler", angle="radian", autolimits="true")
    SubElement(root, "option", timestep="0.002", integrator="implicitfast", cone="elliptic", impratio="10")
    even, from_viewer = _ambient_irradiance(gathered)
    headlight = {
        "ambient": numbers(np.full(3, _brightness(0.0, even))),
        "diffuse": numbers(np.full(3, _brightness(even, from_viewer))),
    }
    SubElement(SubElement(root, "visual"), "headlight", headlight)
    _defaults(SubElement(root, "default"))
    assets, world = SubElement(root, "asset"), SubElement(root, "worldbody")
    if folder is not None:
        _materials(assets, gathered, folder)
    _room(world, assets, gathered, physical.slabs, folder)
    if gathered.camera is not None:
        _camera(world, gathered.camera)
    if gathered.main_light is not None:
        _main_light(world, gathered.main_light, even)
    below: dict[str | None, list[RigidBody]] = {}
    for body in physical.bodies:
        below.setdefault(None if body.free else body.carrier, []).append(body)
    writer = _BodyWriter(gathered, assets, below, even, folder)
    for body in below.get(None, ()):
        writer.write(world, body, np.eye(4))
    # A part and the case it sits in touch; MuJoCo knows that by itself only where the case can move.
    pairs = [(b.node.slug, body_name(b.node.slug, m.limb)) for b in physical.bodies for m in b.moving]
    contact = SubElement(root, "contact")
    for first, second in pairs:
        SubElement(contact, "exclude", body1=first, body2=second)
    indent(root)
    return tostring(root, encoding="unicode", xml_declaration=False) + "\n"


@dataclass(frozen=True)
class _BodyWriter:
    """Writes bodies with what is welded to them."""

    gathered: ExportScene
    assets: Element
    below: dict[str | None, list[RigidBody]]
    even: float
    folder: str | None

    def write(self, parent: Element, body: RigidBody, T_world_parent: Float[np.ndarray, "4 4"]) -> None:
        """Add a body, what moves in it, and the bodies on it to an element of the model."""
        node = body.node
        T = rigid_inverse(T_world_parent) @ node.T_world
        element = SubElement(parent, "body", {"name": node.slug, **_placement(T)})
        if body.free:
            SubElement(element, "freejoint", name=f"{node.slug}_free")
        _inertial(element, body.inertia)
        self._colliders(element, body, body.parts, node.slug)
        if self.folder is not None:
            _visuals(element, self.assets, self.gathered.meshes[node.mesh], node, self.folder)
            for light in self.gathered.lights_of(node.id):
                _light(element, rigid_inverse(node.T_world) @ light.T_world, light, self.even)
        for moving in body.moving:
            self._limb(element, body, moving)
        for child in self.below.get(node.id, ()):
            self.write(element, child, node.T_world)

    def _limb(self, parent: Element, body: RigidBody, moving: MovingPart) -> None:
        """A body that coincides with its object's frame when closed, so that its geometry needs no other."""
        limb = moving.limb
        name = body_name(body.node.slug, limb)
        opened = _placement(limb.T_object_limb) if limb.opened else {}
        element = SubElement(parent, "body", {"name": name, **opened})
        kind = "slide" if limb.kind == "slide" else "hinge"
        joint = {"name": name, "class": kind, "pos": numbers(limb.origin), "axis": numbers(limb.axis)}
        joint["frictionloss"] = f"{moving.friction:.4g}"
        if limb.kind != "swivel":
            joint["range"] = f"{limb.lower:.8g} {limb.upper:.8g}"
        if limb.opened:
            joint["ref"] = f"{limb.opened:.8g}"
        SubElement(element, "joint", joint)
        _inertial(element, moving.inertia)
        self._colliders(element, body, moving.parts, name)
        if self.folder is not None:
            mesh = self.gathered.meshes[limb.mesh]
            _visuals(element, self.assets, mesh, body.node, self.folder, name)

    def _colliders(self, element: Element, body: RigidBody, parts: tuple[Points, ...], name: str) -> None:
        for number, part in enumerate(parts):
            mesh = _hull(self.assets, part, name, number, self.folder)
            attributes = {"type": "mesh", "mesh": mesh, "friction": f"{body.friction:.3g}"}
            SubElement(element, "geom", {"name": mesh, "class": "collider", **attributes})


def _hull(assets: Element, part: Points, owner: str, number: int, folder: str | None) -> str:
    """A convex mesh, and its name: as a file, which Drake asks for too, or in place where there is no folder."""
    name = f"{owner}_part_{number}"
    content = {"vertex": numbers(part.ravel())} if folder is None else {"file": collider_file(folder, owner, number)}
    SubElement(assets, "mesh", {"name": name, **content, "inertia": "convex"})
    return name


def _inertial(element: Element, inertia: Inertia) -> None:
    moments, axes = inertia.principal
    values = {"pos": inertia.centre, "quat": quaternion_wxyz(axes), "diaginertia": moments}
    attributes = {name: numbers(value) for name, value in values.items()}
    SubElement(element, "inertial", {"mass": f"{inertia.mass_kg:.8g}", **attributes})


def _defaults(root: Element) -> None:
    collider = SubElement(root, "default", {"class": "collider"})
    SubElement(collider, "geom", group="3", solref="0.01 1", condim="4", rgba="0.4 0.6 0.9 0.4")
    visual = SubElement(root, "default", {"class": "visual"})
    SubElement(visual, "geom", group="1", contype="0", conaffinity="0", mass="0")
    for kind in ("hinge", "slide"):
        moving = SubElement(root, "default", {"class": kind})
        SubElement(moving, "joint", type=kind, damping="1", solimpfriction="0.999 0.9999 0.001")


def _room(
    world: Element,
    assets: Element,
    gathered: ExportScene,
    slabs: Iterable[StaticSlab],
    folder: str | None,
) -> None:
    """Floors are endless planes, so that nothing falls beside them; walls and ceilings are slabs."""
    for slab in slabs:
        plane = slab.plane
        if plane.role == "floor":
            level = {"pos": numbers(plane.centre), "zaxis": numbers(plane.normal), "size": "20 20 1"}
            geom = {"name": slab.slug, "class": "collider", "type": "plane", "friction": str(FLOOR_FRICTION)}
            SubElement(world, "geom", {**geom, **level})
        for number, piece in enumerate(() if plane.role == "floor" else slab.pieces):
            name = _hull(assets, piece, slab.slug, number, folder)
            SubElement(world, "geom", {"name": name, "class": "collider", "type": "mesh", "mesh": name})
    if folder is not None:
        for exported in gathered.planes:
            _visuals(world, assets, gathered.meshes[exported.mesh], None, folder)


def _visuals(
    element: Element,
    assets: Element,
    mesh: ExportMesh,
    node: ExportObject | None,
    folder: str,
    label: str | None = None,
) -> None:
    label = label or (mesh.key if node is None else node.slug)
    for number, surface in enumerate(mesh.surfaces):
        name = f"{label}_shape_{number}"
        scale = {} if node is None else {"scale": numbers(node.scale)}
        file = visual_file(folder, mesh, number)
        SubElement(assets, "mesh", {"name": name, "file": file, "inertia": "shell", **scale})
        attributes = {"type": "mesh", "mesh": name, "material": surface.material.name}
        SubElement(element, "geom", {"name": name, "class": "visual", **attributes})


def _materials(assets: Element, gathered: ExportScene, folder: str) -> None:
    for number, material in enumerate(gathered.materials):
        attributes = {"name": material.name, "rgba": numbers(srgb_rgba(material))}
        if material.texture is not None:
            SubElement(assets, "texture", name=material.name, type="2d", file=f"{folder}/textures/{number}.png")
            attributes["texture"] = material.name
        attributes |= {"metallic": f"{material.metallic:.3g}", "roughness": f"{material.roughness:.3g}"}
        attributes |= {"specular": f"{0.5 * (1 - material.roughness):.3g}", "emission": f"{max(material.emissive):.3g}"}
        SubElement(assets, "material", attributes)


def texture_files(gathered: ExportScene, folder: str) -> Iterator[Entry]:
    """Pictures of the materials, in a folder."""
    encoded = OncePerPicture(png_bytes)
    for number, material in enumerate(gathered.materials):
        if material.texture is not None:
            yield f"{folder}/textures/{number}.png", encoded(material.texture)


def _meshes(gathered: ExportScene, folder: str, progress: Progress) -> Iterator[Entry]:
    for done, mesh in enumerate(gathered.meshes.values()):
        progress.report(0.3 + 0.7 * done / len(gathered.meshes), f"writing {mesh.name}")
        for number, surface in enumerate(mesh.surfaces):
            yield visual_file(folder, mesh, number), obj_file(surface)


def _ambient_irradiance(gathered: ExportScene) -> tuple[float, float]:
    """Irradiance from all sides, and from the viewer: where no main light is known, that one shapes what is seen."""
    even = even_irradiance(gathered.scene, gathered.lights) if gathered.planes else MEAN_IRRADIANCE
    # Parallel light E has the mean E / 4 over all directions.
    return (even, 0.0) if gathered.main_light is not None else (0.8 * even, 0.8 * even)


def _brightness(before: float, added: float) -> float:
    """Brightness that a light adds in MuJoCo where there is other light before."""
    return float((before + added) ** (1 / SCREEN_GAMMA) - before ** (1 / SCREEN_GAMMA))


def _light(element: Element, T: Float[np.ndarray, "4 4"], light: ExportLight, even: float) -> None:
    strength = _brightness(even, light.candela / light.white_nits / np.pi) * np.asarray(light.colour)
    kind = {"type": "point"} if light.kind == "lamp" else {"type": "spot", "cutoff": "80", "exponent": "1"}
    place = {"pos": numbers(T[:3, 3]), "dir": numbers(-T[:3, 2]), "attenuation": "0 0 1"}
    SubElement(element, "light", {**kind, **place, "diffuse": numbers(strength), "castshadow": "false"})


def _main_light(world: Element, light: MainLight, even: float) -> None:
    diffuse = _brightness(even, light.lux / light.white_nits / np.pi) * np.asarray(light.colour)
    place = {"pos": numbers(light.T_world[:3, 3]), "dir": numbers(-light.T_world[:3, 2])}
    about = {"name": "main_light", "type": "directional", "diffuse": numbers(diffuse), "castshadow": "false"}
    SubElement(world, "light", {**about, **place})


def _camera(world: Element, camera: Camera) -> None:
    k = camera.intrinsics
    lens = {
        "resolution": f"{k.width} {k.height}",
        "sensorsize": numbers(SENSOR_M * np.array([1.0, k.height / k.width])),
        "focalpixel": numbers(np.array([k.fx, k.fy])),
        "principalpixel": numbers(np.array([0.5 * k.width - k.cx, 0.5 * k.height - k.cy])),
    }
    SubElement(world, "camera", {"name": "photo", **lens, **_placement(T_world_lens(camera))})


def _placement(T: Float[np.ndarray, "4 4"]) -> dict[str, str]:
    return {"pos": numbers(T[:3, 3]), "quat": numbers(quaternion_wxyz(T[:3, :3]))}
