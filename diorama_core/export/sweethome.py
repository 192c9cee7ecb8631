"""A scene as a Sweet Home 3D home: walls, rooms, lights, and furniture as its own models. Centimetres, plan y downward.

The file is a zip with `Home.xml`, which Sweet Home 3D reads from version 5.3 on, and a folder per model (OBJ).
Document type: https://www.sweethome3d.com/SweetHome3D.dtd
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from diorama_core.export.files import add_entry, whole_file
from diorama_core.export.gathering import ExportMesh, ExportObject, ExportPlane, ExportScene, rigid_inverse
from diorama_core.export.lights import ExportLight
from diorama_core.export.pictures import TexturePictures, encode_picture, picture_suffix
from diorama_core.export.scene_state import R_SHAPE_FILE
from diorama_core.export.wavefront import MaterialFile, ObjText
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.geometry.rooms import storeys_of
from diorama_core.geometry.vectors import unit
from diorama_core.geometry.wall_lines import DrawnWall, wall_lines
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Camera, HomeRoom, Plane

CM_PER_M = 100.0
VERSION = "5300"
"""The first version that reads `Home.xml`; an older program than this warns that it may lose something."""
FULL_POWER_LM = 1600.0
"""Luminous flux of a light at full power: at half of it, the program's own default, it is a bulb of 60 W."""
UPRIGHT = 0.9999
SLACK_M = 0.02
"""Doors reach this far through their wall, so that Sweet Home 3D cuts it."""


def write_sweet_home(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the home, as `Writer` says."""
    with whole_file(Path(path)) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        models: dict[str, str] = {}
        for number, (key, name, content) in enumerate(_model_files(scene)):
            progress.report(min(number / (3 * len(scene.objects) + 1), 1.0), "writing models")
            models.setdefault(key, name)
            add_entry(archive, name, content)
        used = {str(p.plane.texture) for p in scene.planes} & scene.textures.keys()
        pictures = {name: f"textures/{n}{picture_suffix(scene.textures[name])}" for n, name in enumerate(sorted(used))}
        for name, entry in pictures.items():
            add_entry(archive, entry, encode_picture(scene.textures[name]))
        add_entry(archive, "Home.xml", home_xml(scene, models, pictures))


def home_xml(scene: ExportScene, models: Mapping[str, str], pictures: Mapping[str, str]) -> bytes:
    """The home's description.

    Args:
        scene: What is described.
        models: Entry of each object's model by `model_key`.
        pictures: Entry of each picture by its name in the scene.
    """
    walls = wall_lines([p.plane for p in scene.planes], [o.item for o in scene.objects], scene.scene)
    height = max((w.top_m - w.bottom_m for w in walls), default=2.5)
    attributes = {"version": VERSION, "name": scene.name, "camera": "topCamera", "wallHeight": _cm(height)}
    home = ET.Element("home", attributes)
    if scene.camera is not None:
        ET.SubElement(home, "observerCamera", _observer(scene.camera))
    levels = {n: _add_level(home, scene, n, rooms) for n, rooms in storeys_of(scene.scene).items()}
    depth = {o.object_id: w.plane.thickness for w in walls for o in w.openings if o.object_id}
    for item in scene.objects:
        light = next((k for k in scene.lights if k.owner == item.id and k.kind == "lamp"), None)
        tag = "doorOrWindow" if item.item.category in OPENING_CATEGORIES else "light" if light else "pieceOfFurniture"
        level, low_m = _level_of(scene, item.id, levels)
        about = _piece(scene, item, models[model_key(item)], depth.get(item.id), low_m)
        piece = ET.SubElement(home, tag, level | about)
        if light is not None:
            _shine(piece, item, light)
    for number, wall in enumerate(walls):
        element = ET.SubElement(home, "wall", _level_of(scene, wall.plane.id, levels)[0] | _wall(wall, number))
        for side in ("leftSideTexture", "rightSideTexture"):
            _picture(element, side, wall.plane, wall.length_m, wall.top_m - wall.bottom_m, pictures)
    for plane in scene.planes:
        if plane.plane.role == "floor":
            _add_room(home, plane, pictures, _level_of(scene, plane.id, levels)[0] | _name_of(scene, plane.id))
    ET.indent(home)
    return ET.tostring(home, encoding="utf-8", xml_declaration=True)


def model_key(item: ExportObject) -> str:
    """Names the model of an object: its mesh, or its own where it is tilted, which plans cannot say."""
    return item.mesh if item.T_world[2, 2] > UPRIGHT else f"{item.mesh} {item.id}"


def _cm(metres: float) -> str:
    return f"{metres * CM_PER_M:.4f}"


def _piece(scene: ExportScene, item: ExportObject, model: str, wall_m: float | None, floor_m: float) -> dict[str, str]:
    upright = item.T_world[2, 2] > UPRIGHT
    corners = item.item.corners_world
    low, high = corners.min(axis=0), corners.max(axis=0)
    if upright:
        depth, width, height = (float(v) for v in item.item.size_m)
        x, y, _ = item.T_world[:3, 3]
        yaw = float(np.arctan2(item.T_world[1, 0], item.T_world[0, 0]))
    else:
        points = scene.points_of(item.mesh, item.scale) @ item.T_world[:3, :3].T + item.T_world[:3, 3]
        low, high = points.min(axis=0), points.max(axis=0)
        depth, width, height = (float(v) for v in high - low)
        (x, y, _), yaw = (low + high) / 2, 0.0
    attributes = {
        "id": f"piece-{item.slug}",
        "name": " ".join(item.item.label.split()) or item.id,
        "angle": f"{(-np.pi / 2 - yaw) % (2 * np.pi):.7f}",
        "x": _cm(float(x)),
        "y": _cm(-float(y)),
        "elevation": _cm(float(low[2]) - floor_m),
        "width": _cm(width),
        "depth": _cm(max(depth, (wall_m or 0.0) + SLACK_M) if wall_m else depth),
        "height": _cm(height),
        "model": model,
        "movable": "false" if item.item.locked else "true",
    }
    return attributes | ({"doorOrWindow": "true"} if item.item.category in OPENING_CATEGORIES else {})


def _shine(piece: ET.Element, item: ExportObject, light: ExportLight) -> None:
    """Where a lamp's light comes from, as shares of its width, depth and height from its left, back and bottom."""
    depth, width, height = (float(v) for v in item.item.size_m)
    x, y, z = (rigid_inverse(item.T_world) @ light.T_world)[:3, 3] / (depth, width, height) + 0.5
    piece.set("power", f"{min(light.lumens / FULL_POWER_LM, 1.0):.3f}")
    place = {"x": f"{y:.4f}", "y": f"{x:.4f}", "z": f"{z:.4f}", "diameter": _cm(2 * light.radius_m)}
    ET.SubElement(piece, "lightSource", {**place, "color": _colour(linear_to_srgb(np.array(light.colour)))})


def _picture(
    element: ET.Element, side: str, plane: Plane, width_m: float, height_m: float, pictures: Mapping[str, str]
) -> None:
    """The picture of a plane, which covers it once, on a side of a wall or room."""
    if plane.texture is not None and plane.texture in pictures:
        size = {"width": _cm(width_m), "height": _cm(height_m), "fittingArea": "true"}
        ET.SubElement(
            element, "texture", {"attribute": side, "name": plane.id, **size, "image": pictures[plane.texture]}
        )


def _colour(srgb: Iterable[float]) -> str:
    return "FF" + "".join(f"{round(255 * min(max(c, 0.0), 1.0)):02X}" for c in srgb)


def _wall(wall: DrawnWall, number: int) -> dict[str, str]:
    """The wall's middle line; its inner face is where the scene has it."""
    half = wall.plane.thickness / 2
    (x0, y0), (x1, y1) = wall.point_at(0.0, half), wall.point_at(wall.length_m, half)
    colour = _colour(wall.plane.colour)
    return {
        "id": f"wall{number}",
        "xStart": _cm(x0),
        "yStart": _cm(-y0),
        "xEnd": _cm(x1),
        "yEnd": _cm(-y1),
        "height": _cm(wall.top_m - wall.bottom_m),
        "thickness": _cm(wall.plane.thickness),
        "leftSideColor": colour,
        "rightSideColor": colour,
    }


def _add_level(home: ET.Element, scene: ExportScene, storey: int, rooms: Sequence[HomeRoom]) -> tuple[str, float]:
    """A level of a home; its id, and the height of its floor in the world (m)."""
    floors = [scene.scene.plane(r.floor) for r in rooms]
    low_m = min(float(f.centre[2]) for f in floors)
    name = f"storey {storey}"
    tops = [float(p.plane.polygon[:, 2].max()) for p in scene.planes if scene.room_of.get(p.id) in rooms]
    attributes = {
        "id": f"level{storey}",
        "name": name,
        "elevation": _cm(low_m - scene.floor_m),
        "floorThickness": _cm(floors[0].thickness),
        "height": _cm(max(tops, default=low_m) - low_m),
        "elevationIndex": "0",
    }
    ET.SubElement(home, "level", attributes)
    return attributes["id"], low_m


def _level_of(scene: ExportScene, part: str, levels: Mapping[int, tuple[str, float]]) -> tuple[dict[str, str], float]:
    """The level attribute of a plane or an object, and the height that it is measured from (m)."""
    if not levels:
        return {}, scene.floor_m
    room = scene.room_of.get(part)
    level, low_m = levels[min(levels) if room is None else room.storey]
    return {"level": level}, low_m


def _name_of(scene: ExportScene, floor: str) -> dict[str, str]:
    room = scene.room_of.get(floor)
    return {} if room is None else {"name": room.name}


def _add_room(home: ET.Element, plane: ExportPlane, pictures: Mapping[str, str], more: Mapping[str, str]) -> None:
    attributes = {"id": f"room-{plane.slug}", "areaVisible": "true", "floorColor": _colour(plane.plane.colour)}
    room = ET.SubElement(home, "room", {**more, **attributes})
    width, depth, _ = np.ptp(plane.plane.polygon, axis=0)
    _picture(room, "floorTexture", plane.plane, float(width), float(depth), pictures)
    for x, y, _ in plane.plane.polygon:
        ET.SubElement(room, "point", {"x": _cm(float(x)), "y": _cm(-float(y))})


def _observer(camera: Camera) -> dict[str, str]:
    """The photo's camera: yaw turns from the plan's y downward, pitch looks down, the field of view is horizontal."""
    x, y, z = camera.position
    forward = camera.T_world_camera[:3, 2]
    return {
        "attribute": "observerCamera",
        "lens": "PINHOLE",
        "x": _cm(float(x)),
        "y": _cm(-float(y)),
        "z": _cm(float(z)),
        "yaw": f"{float(np.arctan2(-forward[0], -forward[1])):.6f}",
        "pitch": f"{float(np.arcsin(np.clip(-forward[2], -1, 1))):.6f}",
        "fieldOfView": f"{camera.intrinsics.horizontal_fov_rad:.6f}",
        "time": "0",
    }


def _model_files(scene: ExportScene) -> Iterator[tuple[str, str, bytes]]:
    """Key of the model, entry and content of each of its files; the OBJ comes first."""
    done: set[str] = set()
    pictures = TexturePictures()
    for item in scene.objects:
        key = model_key(item)
        if key in done:
            continue
        folder = str(len(done) + 1)
        done.add(key)
        turn = np.eye(3) if key == item.mesh else item.T_world[:3, :3] * item.scale
        files = _obj_files(scene.meshes[item.mesh], turn, pictures)
        yield from ((key, f"{folder}/{name}", content) for name, content in files)


def _obj_files(
    mesh: ExportMesh, turn: Float[np.ndarray, "3 3"], pictures: TexturePictures
) -> Iterator[tuple[str, bytes]]:
    """A model in Sweet Home 3D's usual frame: +Y up, +Z front. Colours are sRGB, as it shows them."""
    shown = {id(s.material): s.material for s in mesh.surfaces}.values()
    materials = MaterialFile(shown, display=True, maps=False, made=pictures)
    linear = R_SHAPE_FILE.T @ turn
    back = np.linalg.inv(linear)
    text, content = ObjText(decimals=4), b"mtllib model.mtl\n"
    for surface in mesh.surfaces:
        points = (surface.vertices @ linear.T * CM_PER_M).astype(np.float32)
        placed = replace(surface, vertices=points, normals=unit(surface.normals @ back).astype(np.float32))
        content += text.add(placed, materials.name(surface.material))
    yield "model.obj", content
    yield "model.mtl", materials.text()
    yield from materials.pictures()
