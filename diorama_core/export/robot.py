"""A room for robots in one zip: the same bodies as MJCF, URDF, SDF and USD, what they are, where things can be put, and
where a robot can drive."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement, fromstring, indent, tostring

import numpy as np
from jaxtyping import Float
from shapely.geometry import Polygon

from diorama_core.export.bodies import MovingPart, RigidBody
from diorama_core.export.colliders import physical_scene
from diorama_core.export.files import Entry, write_package
from diorama_core.export.gathering import ExportScene
from diorama_core.export.links import body_name, collider_files, links_of, mesh_files, numbers
from diorama_core.export.mjcf import mjcf_text, texture_files
from diorama_core.export.navigation import (
    HIGH_M,
    LOW_M,
    floor_area,
    free_spot,
    map_files,
    occupied_area,
    outlines,
    rings,
    standing_place,
    walkable,
)
from diorama_core.export.regions import Region, regions_of
from diorama_core.export.sdf import sdf_files
from diorama_core.export.urdf import urdf_files
from diorama_core.progress import SILENT, Progress

FOLDER = "files"
MAX_GRASP_M = 0.08
"""How far the usual two-finger grippers open (Franka Hand: 8 cm)."""
MAX_LIFT_KG = 3.0
"""What the usual arms of mobile robots carry (Franka: 3 kg)."""
REACH_M = 0.8
"""From the rim of the robot to what it reaches: such arms are 85 cm long."""
SITE_M = 0.002
HANDLE_M = 0.015
"""What reaches as far out of a front as this behind its outermost point is its handle."""

README = """# {name}

One room, written by Diorama. Metres, radians, +Z up; quaternions w, x, y, z. All files use the same names of bodies.

- `room.xml` MuJoCo, with a site for every region of `regions.json`
- `room.urdf` the room, `files/poses.json` the objects that may move, each a URDF of its own beside it
- `room.sdf` Gazebo, Drake; `room.usdc` Isaac Sim, newton, with semantic labels
- `objects.json` what each body is: category, size, mass, whether it can be grasped, its joints and their handles
- `regions.json` where objects can be put: outline, height, what stands there, what is free, where a robot stands for it
- `map.pgm`, `map.yaml` occupancy for ROS nav2: what stands between {low} m and {high} m above the floor
- `navigation.json` where the middle of a disc of radius {radius} m may be, with holes

Graspable: free to move, at most {lift} kg, smallest side at most {grasp} m. A robot reaches {reach} m from its rim.
"""


def write_robot(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the zip, whole or not at all; raises `ExportError`."""
    from diorama_core.export.usd import layer_files

    progress.report(0.0, "preparing colliders")
    physical, radius = physical_scene(gathered), gathered.options.robot_radius_m
    links, bodies = links_of(gathered, physical), outlines(physical)
    regions, floor = regions_of(gathered, physical, bodies), floor_area(gathered)
    occupied = occupied_area(gathered, bodies)
    walk = walkable(floor, occupied, radius)
    texts = urdf_files(gathered, physical, links, "room.urdf", FOLDER)
    texts |= sdf_files(gathered, physical, links, "room.sdf", FOLDER)
    texts["room.xml"] = with_sites(mjcf_text(gathered, physical, FOLDER), regions)
    texts["objects.json"] = _json({"objects": [_object(gathered, body) for body in physical.bodies]})
    texts["regions.json"] = _json({"regions": [_region(r, gathered.floor_m, walk, radius) for r in regions]})
    texts["navigation.json"] = _json({"radius_m": radius, "free": [rings(p) for p in walk]})
    limits = {"lift": MAX_LIFT_KG, "grasp": MAX_GRASP_M, "reach": REACH_M, "low": LOW_M, "high": HIGH_M}
    texts["README.md"] = README.format(name=gathered.name, radius=radius, **limits)

    def entries() -> Iterator[Entry]:
        yield from texture_files(gathered, FOLDER)
        yield from mesh_files(gathered, FOLDER, progress.part(0.2, 0.7))
        yield from collider_files(physical, FOLDER)
        yield from ((name, text.encode()) for name, text in texts.items())
        yield from map_files(floor, occupied).items() if not floor.is_empty else ()
        yield from layer_files(gathered, "room.usdc", f"{FOLDER}/usd", progress.part(0.7, 1.0))

    write_package(path, "README.md", entries())


def with_sites(model: str, regions: tuple[Region, ...]) -> str:
    """MuJoCo's model with a thin box as site of each region, in the body that carries it."""
    root = fromstring(model)
    bodies: dict[str | None, Element] = {b.get("name"): b for b in root.iter("body")}
    bodies[None] = next(root.iter("worldbody"))
    for region in regions:
        half = numbers(np.array([region.size_m[0] / 2, region.size_m[1] / 2, SITE_M]))
        about = {"name": region.name, "type": "box", "size": half, "group": "4", "rgba": "0.2 0.8 0.3 0.3"}
        SubElement(bodies[region.body], "site", {**about, "pos": numbers(region.T_body[:3, 3])})
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def _object(gathered: ExportScene, body: RigidBody) -> dict[str, Any]:
    """What a body is, for planners and for labels."""
    node, item = body.node, body.node.item
    mass = body.mass_kg + sum(m.inertia.mass_kg for m in body.moving)
    narrowest = float(item.size_m.min())
    return {
        "body": node.slug,
        "id": node.id,
        "label": item.label,
        "category": item.category,
        "supporter": None if node.support is None else node.support.parent,
        "position_m": _round(node.T_world[:3, 3]),
        "rotation": _round(node.T_world[:3, :3], 6),
        "size_m": _round(item.size_m),
        "mass_kg": round(mass, 4),
        "friction": body.friction,
        "free": body.free,
        "grasp_width_m": round(narrowest, 4),
        "graspable": body.free and narrowest <= MAX_GRASP_M and mass <= MAX_LIFT_KG,
        "joints": [_joint(gathered, body, moving) for moving in body.moving],
    }


def _joint(gathered: ExportScene, body: RigidBody, moving: MovingPart) -> dict[str, Any]:
    limb, node = moving.limb, body.node
    T = node.T_world @ limb.T_object_limb
    handle, pull = handle_of(moving, gathered.points_of(limb.mesh, node.scale))
    return {
        "name": body_name(node.slug, limb),
        "kind": limb.kind,
        "origin_m": _round(T[:3, :3] @ limb.origin + T[:3, 3]),
        "axis": _round(T[:3, :3] @ limb.axis, 6),
        "lower": limb.lower,
        "upper": limb.upper,
        "open": limb.opened,
        "handle_m": _round(T[:3, :3] @ handle + T[:3, 3]),
        "pull": _round(T[:3, :3] @ pull, 6),
    }


def handle_of(
    moving: MovingPart, vertices: Float[np.ndarray, "n 3"]
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Where a hand takes hold of a moving part, and the unit direction in which it opens there; in the part's frame.

    What reaches out farthest in that direction is the handle, or the front itself; of a leaf, the half away from its
    hinge counts.
    """
    limb = moving.limb
    opens = 1.0 if limb.upper >= -limb.lower else -1.0
    lever = vertices.min(axis=0) / 2 + vertices.max(axis=0) / 2 - limb.origin
    lever = lever - limb.axis * float(lever @ limb.axis)
    pull = opens * (limb.axis if limb.kind == "slide" else np.cross(limb.axis, lever))
    pull = pull / max(float(np.linalg.norm(pull)), 1e-9)
    if limb.kind != "slide":
        vertices = vertices[(vertices - limb.origin) @ lever >= lever @ lever]
    along = vertices @ pull
    outermost = vertices[along > along.max() - HANDLE_M]
    return (outermost.min(axis=0) + outermost.max(axis=0)) / 2, pull


def _region(region: Region, level: float, walk: tuple[Polygon, ...], radius_m: float) -> dict[str, Any]:
    """A region as JSON; `level` is the height of the floor, and the middle of a robot may be in `walk`."""
    height = float(region.polygon[:, 2].mean())
    spot = None
    if not region.free.is_empty:
        at, free_m = free_spot(region.free)
        spot = {"position_m": _round(np.array([*at.coords[0], height])), "radius_m": round(free_m, 4)}
    stand = standing_place(walk, region.free, radius_m, 0.0 if region.owner is None else REACH_M)
    return {
        "name": region.name,
        "object": region.owner,
        "body": region.body,
        "outline_m": _round(region.polygon),
        "size_m": _round(np.array(region.size_m)),
        "height_m": round(height - level, 4),
        "clearance_m": None if np.isinf(region.clearance_m) else round(region.clearance_m, 4),
        "holds": list(region.holds),
        "free_m2": round(float(region.free.area), 4),
        "free_spot": spot,
        "stand": None if stand is None else dict(zip(("x", "y", "yaw"), np.round(stand, 4).tolist(), strict=True)),
    }


def _round(values: Float[np.ndarray, "..."], digits: int = 4) -> list:
    return np.round(np.asarray(values, dtype=float), digits).tolist()


def _json(content: dict[str, Any]) -> str:
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"
