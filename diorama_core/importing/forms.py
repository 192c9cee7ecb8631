"""Every form in which a room, a scan or a scene comes: how it is told, and how it is read. `SCENE_FORMS` is the table.

A form is told by what is in the file, not by its name alone. What no form tells is said by `file_heads.what_else`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np
import trimesh

from diorama_core.errors import InputError, LibraryError
from diorama_core.importing.gltf import read_marked_gltf
from diorama_core.importing.marked import MarkedFile
from diorama_core.importing.measured_types import MeasuredRoom
from diorama_core.importing.parts import Part, parts_of_gltf, parts_of_usd, split_scene
from diorama_core.importing.point_cloud import PointCloud, frame_of_scene, points_of_mesh
from diorama_core.importing.point_files import POINT_FORMS, read_points
from diorama_core.importing.roomplan import read_room_plan
from diorama_core.importing.sweethome import parts_of_sweet_home
from diorama_core.importing.usd import read_marked_usd
from diorama_core.io.contained import content_of, unpack
from diorama_core.io.file_heads import FileHead, head_of, what_else
from diorama_core.library.ingest.models import form_of, read_model
from diorama_core.progress import Progress

MIN_SPAN_M, MIN_HEIGHT_M = 2.0, 1.5
"""Smallest room: the shorter side of its plan, and its height."""
MIN_TRIANGLES = 2000
LONG_EDGE_M = 0.6
"""Scanners make few larger triangles than this, unless the mesh was reduced."""
MIN_SMALL = 0.85
"""Share of the area in smaller triangles."""
EXACT_COS, EXACT_M, MIN_PLANE_M2 = 1e-3, 2e-3, 0.3
"""Steps of normals and offsets within which modelled faces lie in one plane, and the least such plane that counts."""
MAX_EXACT = 0.35
"""Share of the area in exact planes: a reduced scan has large triangles, but none of them are level or upright."""
MIN_SHARE = 0.7
"""Smallest share of the file's area in one scan; chairs modelled beside it leave less."""
SAID_NOTHING = re.compile(
    r"^(mesh|node|object|obj|geometry|geom|default|scan|chunk|group|root|scene|world|model|textured|output|material|mat|"
    r"polygon|part|piece|sub|tile|raw|export|[0-9a-f]{6,}|[\d_.\s-])*$",
    re.IGNORECASE,
)
"""Names that programs give: no word in them is anybody's."""


@dataclass(frozen=True, eq=False)
class SceneParts:
    """The objects of a file of another program, in the world."""

    parts: tuple[Part, ...]
    notes: tuple[str, ...] = ()


_SCENES = "GLB, USD, Sweet Home 3D, OBJ"
Content = MarkedFile | MeasuredRoom | PointCloud | SceneParts


@dataclass(frozen=True)
class SceneForm:
    """One form of a scene or a scan."""

    name: str
    files: str
    """Endings, or what the folder is."""
    becomes: str
    tells: Callable[[FileHead], bool]
    read: Callable[[Path, Progress, float | None], Content]
    """Reader of the file at a place; the last argument is the metres in one unit, where somebody said them."""
    extra: str = ""
    """Optional library that it needs."""


@contextmanager
def open_form(path: Path) -> Iterator[tuple[SceneForm, Path]]:
    """The form of a file or folder and where it lies; an archive is unpacked for the time of the context.

    Raises:
        InputError: it does not exist, or is of no form that is read: says what it is and what to do.
    """
    head = head_of(path)
    form = next((f for f in SCENE_FORMS if f.tells(head)), None)
    if form is not None:
        yield form, path
        return
    if head.is_zip and what_else(head) is None:
        with unpack(path) as folder, open_form(content_of(folder)) as recognised:
            yield recognised
        return
    other = what_else(head)
    if other is not None:
        raise InputError(f"{path.name} is {other.name}: {other.advice}")
    inside = f" (in it: {', '.join(head.names[:3])})" if head.names else ""
    raise InputError(
        f"{path.name} is nothing that is read as a room{inside}; give a scene ({_SCENES}), a scan or a home"
    )


def read_mark(path: Path) -> MarkedFile | None:
    """What Diorama wrote into a file; None when it comes from another program.

    Raises:
        InputError: the file is missing, of a kind that is not read, or damaged.
        UnavailableError: an optional library is missing.
    """
    with open_form(path) as (form, place):
        content = form.read(place, Progress(), None)
    return content if isinstance(content, MarkedFile) else None


R = TypeVar("R", MarkedFile | None, MeasuredRoom | None)


def _refuse_unit(content: R, path: Path, unit_m: float | None) -> R:
    """Content that says its own unit; raises `InputError` where somebody gives another."""
    if content is not None and unit_m is not None:
        raise InputError(f"{path.name} says its unit itself; leave out --unit")
    return content


def _gltf(path: Path, progress: Progress, unit_m: float | None) -> Content:
    marked = _refuse_unit(read_marked_gltf(path), path, unit_m)
    return marked or _scan_or_parts(*parts_of_gltf(path, unit_m))


def _usd(path: Path, progress: Progress, unit_m: float | None) -> Content:
    marked = _refuse_unit(read_marked_usd(path), path, unit_m)
    return marked or _refuse_unit(read_room_plan(path), path, unit_m) or _scan_or_parts(*parts_of_usd(path, unit_m))


def _room_plan(path: Path, progress: Progress, unit_m: float | None) -> Content:
    room = _refuse_unit(read_room_plan(path), path, unit_m)
    if room is None:
        raise InputError(f"{path.name} is no scan of RoomPlan (there are no walls in it); export the scan again")
    return room


def _home(path: Path, progress: Progress, unit_m: float | None) -> Content:
    if unit_m is not None:
        raise InputError(f"{path.name} is in centimetres, as all homes are; leave out --unit")
    return SceneParts(*parts_of_sweet_home(path, progress))


def _model(path: Path, progress: Progress, unit_m: float | None) -> Content:
    """A scene in a format that does not say its frame: its levels and its size tell."""
    try:
        raw = read_model(path, path.parent)
    except LibraryError as error:
        raise InputError(f"{path.name}: {error}") from error
    if not any(isinstance(g, trimesh.Trimesh) and len(g.faces) for g in raw.scene.geometry.values()):
        points = [np.asarray(g.vertices, float) for g in raw.scene.geometry.values() if hasattr(g, "vertices")]
        cloud = PointCloud(np.vstack(points) if points else np.zeros((0, 3)), None)
        return cloud if unit_m is None else cloud.to_unit(unit_m)
    to_world, notes = frame_of_scene(raw, unit_m)
    return _scan_or_parts(split_scene(raw.scene, to_world), notes)


def _scan_or_parts(parts: tuple[Part, ...], notes: tuple[str, ...]) -> Content:
    return scan_in(parts) or SceneParts(parts, notes)


def _cloud(path: Path, progress: Progress, unit_m: float | None) -> Content:
    cloud = read_points(path)
    return cloud if unit_m is None else cloud.to_unit(unit_m)


def _is_room_plan(head: FileHead) -> bool:
    if head.is_folder:
        captures = [head.path / name for name in head.names if name.lower().endswith(".json")]
        readable = [p for p in captures[:MAX_ROOMS] if p.is_file() and p.stat().st_size <= MAX_LOOKED_AT]
        return any('"referenceOriginTransform"' in p.read_text("utf-8", "replace") for p in readable)
    if not head.text.startswith("{"):
        return False
    text = _whole_text(head)
    return '"walls"' in text or ('"dimensions"' in text and '"transform"' in text)


def _whole_text(head: FileHead) -> str:
    """The text of a small JSON is looked at whole: its keys may come in any order."""
    if head.suffix != ".json" or head.size > MAX_LOOKED_AT:
        return head.text
    return head.path.read_text("utf-8", "replace")


def _is_model(*names: str) -> Callable[[FileHead], bool]:
    return lambda head: not head.is_folder and (form := form_of(head)) is not None and form.name in names


MAX_LOOKED_AT = 64_000_000
MAX_ROOMS = 200
"""Files of a folder that are looked at."""
OBJECTS = "Diorama's own comes back as it was; else floor, walls and objects, or a scan"

SCENE_FORMS = (
    SceneForm("glTF", ".glb, .gltf", OBJECTS, _is_model("glTF"), _gltf),
    SceneForm("Sweet Home 3D", ".sh3d", "its walls, floors and furniture, level by level",
              lambda h: h.is_zip and (h.has("/Home.xml", "/Home") or h.suffix == ".sh3d"), _home),
    SceneForm("USD", ".usd, .usda, .usdc, .usdz", f"{OBJECTS}; RoomPlan's rooms", _is_model("USD"), _usd, "usd"),
    SceneForm("RoomPlan", ".json, a folder of captured rooms",
              "walls, doors and windows as measured, furniture in the boxes, a home's rooms by name", _is_room_plan,
              _room_plan),
    *(SceneForm(form.name, form.files, "walls from the points, boxes of what stands in them", form.tells, _cloud,
                form.extra) for form in POINT_FORMS),
    SceneForm("OBJ, FBX, Collada, 3DS", ".obj, .fbx, .dae, .3ds", "floor, walls and objects, or a scan",
              _is_model("OBJ", "FBX", "Collada", "3DS", "OFF", "STL"), _model),
)  # fmt: skip
"""The first that tells a file or folder is its form."""


SUFFIXES = (
    *dict.fromkeys(s for form in SCENE_FORMS for s in form.files.split(", ") if s.startswith(".") and " " not in s),
    ".zip",
)
"""Endings of files that may be opened; their content decides."""


def scan_in(parts: Sequence[Part]) -> PointCloud | None:
    """The points of a scan, where the parts of a file, in the world, are one; None where they are modelled.

    Args:
        parts: in the world, +Z up, metres.
    """
    meshes = [p.whole for p in parts]
    if not meshes:
        return None
    largest = max(range(len(parts)), key=lambda k: meshes[k].area)
    nameless = all(SAID_NOTHING.match(p.name) for p in parts)
    whole = trimesh.util.concatenate(meshes) if nameless and len(meshes) > 1 else meshes[largest]
    if whole.area < MIN_SHARE * sum(m.area for m in meshes) or not is_scanned(whole):
        return None
    return PointCloud(points_of_mesh(whole), np.array([0.0, 0.0, 1.0]), ("the mesh was read as a scan of a room",))


def is_scanned(mesh: trimesh.Trimesh) -> bool:
    """Whether a mesh is as large as a room and made of small triangles all over."""
    x, y, height = mesh.extents
    if min(x, y) < MIN_SPAN_M or height < MIN_HEIGHT_M or len(mesh.faces) < MIN_TRIANGLES:
        return False
    corners = mesh.triangles
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    small = float(mesh.area_faces[longest < LONG_EDGE_M].sum() / max(mesh.area, 1e-12))
    return small > MIN_SMALL or _exact_share(mesh) < MAX_EXACT


def _exact_share(mesh: trimesh.Trimesh) -> float:
    """Share of the area that lies in exact planes of some size."""
    offsets = (mesh.face_normals * mesh.triangles_center).sum(axis=1)
    keys = np.column_stack([np.round(mesh.face_normals / EXACT_COS), np.round(offsets / EXACT_M)])
    _, which = np.unique(keys, axis=0, return_inverse=True)
    areas = np.bincount(which.reshape(-1), mesh.area_faces)
    return float(areas[areas > MIN_PLANE_M2].sum() / max(mesh.area, 1e-12))
