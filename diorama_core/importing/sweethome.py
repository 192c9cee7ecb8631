"""Sweet Home 3D files (.sh3d): walls, floors and furniture of all visible levels as parts.

Centimetres, plan y downward. What a piece is, its catalogue's name for it says in any language (`catalogId`), then its
own name, then its tag.
"""

from __future__ import annotations

import lzma
import math
import re
import tempfile
import xml.etree.ElementTree as ET
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.errors import DioramaError, InputError
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.importing.parts import Part
from diorama_core.io.bounded import shorten
from diorama_core.io.contained import ContainedFiles
from diorama_core.io.text import parse_xml
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.models import SUFFIXES, read_model
from diorama_core.library.ingest.names import kind_in
from diorama_core.library.kinds import is_possible
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.schema import MAX_ITEMS
from diorama_core.scene.types import yaw_rotation

M_PER_CM = 0.01
MODEL_TO_PART = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""Models have +Y up and +Z front; parts +Z up and, unturned, -Y front."""
FURNITURE = ("pieceOfFurniture", "doorOrWindow", "light")
SILL_CM = 30.0
"""Openings that begin higher are windows."""
THIN_M = 0.02
XML_BYTES = 64 * 2**20
MAX_FILES = 5000
"""That are taken out of the archive: models, and what lies beside them in it."""


def parts_of_sweet_home(path: Path, progress: Progress = SILENT) -> tuple[tuple[Part, ...], tuple[str, ...]]:
    """Objects, walls and floors of a home, and notes about what is read otherwise than it is drawn.

    Raises:
        InputError: it cannot be read, or holds more than a scene does.
        Cancelled: on request.
    """
    try:
        with zipfile.ZipFile(path) as archive, tempfile.TemporaryDirectory() as folder:
            home = _home(archive, path)
            levels = _levels(home)
            furniture = [p for p in home.iter() if p.tag in FURNITURE and _visible(p) and _is_shown(p, home, levels)]
            _take_out(archive, furniture, Path(folder), path)
            pieces = []
            for piece in furniture:
                progress.report(0.0, f"reading {shorten(piece.get('name', piece.tag))}")
                pieces.append(_piece(piece, ContainedFiles(Path(folder), InputError), _level_m(piece, levels)))
    except (
        zipfile.BadZipFile,
        zlib.error,
        OSError,
        RuntimeError,
        NotImplementedError,
        EOFError,
        lzma.LZMAError,
    ) as error:
        # Damaged, encrypted, compressed in an unknown way, or with names that cannot be files beside each other.
        raise InputError(f"{path.name} is no Sweet Home 3D file ({shorten(str(error))}); save it again") from error
    height = _number(home, "wallHeight", 250.0)
    walls = [_wall(w, height, _level_m(w, levels)) for w in home.iter("wall") if _is_shown(w, home, levels)]
    outlined = [r for r in home.iter("room") if len(r.findall("point")) >= 3 and _is_shown(r, home, levels)]
    rooms = [_room(r, _level_m(r, levels)) for r in outlined]
    return (*pieces, *walls, *rooms), _notes(home, levels)


def _levels(home: ET.Element) -> dict[str, float]:
    """Heights of the visible levels in metres, by id; none where the home has but one."""
    shown = [e for e in home.iter("level") if e.get("viewable", "true") != "false" and _visible(e)]
    return {e.get("id", ""): _number(e, "elevation", 0.0) * M_PER_CM for e in shown}


def _level_m(element: ET.Element, levels: Mapping[str, float]) -> float:
    return levels.get(element.get("level", ""), 0.0)


def _is_shown(element: ET.Element, home: ET.Element, levels: Mapping[str, float]) -> bool:
    """Whether an element is on a visible level, or on none."""
    level = element.get("level", "")
    return level in levels or all(level != e.get("id", "") for e in home.iter("level"))


def _notes(home: ET.Element, levels: Mapping[str, float]) -> tuple[str, ...]:
    names = [
        (shorten(str(e.get("name") or e.get("id", "")), 40), e.get("id", "") in levels) for e in home.iter("level")
    ]
    hidden = [name for name, shown in names if not shown]
    notes = [f"hidden levels were left out: {', '.join(hidden)}"] if hidden else []
    if len(levels) > 1:
        listed = ", ".join(name for name, shown in names if shown)
        notes.append(f"{len(levels)} levels, each at its own height: {listed}")
    round_walls = sum(w.get("arcExtent") is not None for w in home.iter("wall"))
    sloping = sum(w.get("heightAtEnd") is not None for w in home.iter("wall"))
    notes += [f"{round_walls} round walls are straight from end to end"] if round_walls else []
    notes += [f"{sloping} sloping walls are as high as at their start"] if sloping else []
    return tuple(notes)


def _take_out(archive: zipfile.ZipFile, furniture: Sequence[ET.Element], folder: Path, path: Path) -> None:
    """Put the models of the furniture, and what lies beside them in the archive, into a folder."""
    places = {PurePosixPath(unquote(p.get("model", ""))).parent for p in furniture if p.get("model")}
    wanted = [e for e in archive.infolist() if not e.is_dir() and PurePosixPath(e.filename).parent in places]
    if len(wanted) > MAX_FILES:
        raise InputError(f"{path.name} has {len(wanted):,} files beside its models; up to {MAX_FILES:,} are read")
    size = sum(entry.file_size for entry in wanted)
    if size > DEFAULT_LIMITS.file_bytes:
        raise InputError(f"{path.name} unpacks to {size / 2**20:.0f} MB; the limit is 512 MB")
    archive.extractall(folder, wanted)  # zipfile keeps names inside the folder


def _home(archive: zipfile.ZipFile, path: Path) -> ET.Element:
    if "Home.xml" not in archive.namelist():
        raise InputError(f"{path.name} has no Home.xml; save it with Sweet Home 3D 5.3 or newer")
    if archive.getinfo("Home.xml").file_size > XML_BYTES:
        raise InputError(f"{path.name}: its Home.xml is too large")
    home = parse_xml(archive.read("Home.xml"), f"{path.name}: its Home.xml", InputError)
    count = sum(e.tag in (*FURNITURE, "wall", "room") for e in home.iter())
    if count > MAX_ITEMS:
        raise InputError(
            f"{path.name} has {count:,} pieces, walls and rooms; up to {MAX_ITEMS:,} are read: save a part"
        )
    return home


def _visible(piece: ET.Element) -> bool:
    return piece.get("visible", "true") != "false"


def _number(element: ET.Element, name: str, default: float | None = None) -> float:
    value = element.get(name)
    if value is None and default is not None:
        return default
    try:
        number = float(value if value is not None else "")
    except ValueError:
        number = float("nan")
    if not math.isfinite(number):
        raise InputError(f"its Home.xml has a {element.tag} without a usable {name}")
    return number


def _piece(piece: ET.Element, files: ContainedFiles, level_m: float) -> Part:
    """A piece's model, turned upright and stretched to the size that the home gives it."""
    sides = [_number(piece, k) * M_PER_CM for k in ("width", "depth", "height")]
    scene = _model(piece, files)
    low, high = scene.bounds
    stretch = np.eye(4)
    stretch[:3, :3] = np.diag(np.array(sides) / np.maximum(high - low, 1e-6))
    stretch[:3, 3] = -stretch[:3, :3] @ ((low + high) / 2)
    yaw = -_number(piece, "angle", 0.0)
    T = np.eye(4)
    T[:3, :3] = yaw_rotation(yaw)
    bottom = level_m + _number(piece, "elevation", 0.0) * M_PER_CM
    T[:3, 3] = [_number(piece, "x") * M_PER_CM, -_number(piece, "y") * M_PER_CM, bottom + sides[2] / 2]
    scene.apply_transform(T @ stretch)
    name = piece.get("name") or piece.tag
    return Part(name, scene, T, yaw_rad=yaw, front="-y", category=_category(piece, sides))


def _category(piece: ET.Element, size_m: Sequence[float]) -> str | None:
    """What a piece is by its catalogue's word, its name or its tag, where it can be so large; None where none says."""
    width, depth, height = size_m
    catalogue = re.sub(r"\d+x\d+.*$", "", piece.get("catalogId", "").partition("#")[2])
    for name in (catalogue, piece.get("name", "")):
        kind = kind_in(name) if name else None
        if kind is not None and kind != UNKNOWN.name and is_possible(kind, np.array([depth, width, height])):
            return kind
    if piece.tag == "doorOrWindow":
        door, window = OPENING_CATEGORIES
        return window if _number(piece, "elevation", 0.0) > SILL_CM else door
    return None


def _model(piece: ET.Element, files: ContainedFiles) -> trimesh.Scene:
    """The model in the part's frame; a box where the home keeps it in a format that is not read."""
    name = piece.get("model", "")
    if PurePosixPath(name).suffix.lower() in SUFFIXES:
        try:
            scene = read_model(files.path(name), files.root).scene
            turn = np.eye(4)
            turn[:3, :3] = np.array(piece.get("modelRotation", "1 0 0 0 1 0 0 0 1").split(), float).reshape(3, 3)
            if scene.bounds is not None and np.isfinite(turn).all():
                scene.apply_transform(MODEL_TO_PART @ turn)
                return scene
        except (DioramaError, ValueError):
            pass  # the home is more than one broken model: its size is known, so a box stands for it
    return trimesh.Scene({"box": trimesh.creation.box((1.0, 1.0, 1.0))})


def _wall(wall: ET.Element, usual_cm: float, level_m: float) -> Part:
    start, end = (np.array([_number(wall, f"x{k}"), -_number(wall, f"y{k}")]) * M_PER_CM for k in ("Start", "End"))
    length = float(np.linalg.norm(end - start))
    thick, high = _number(wall, "thickness") * M_PER_CM, _number(wall, "height", usual_cm) * M_PER_CM
    along = (end - start) / max(length, 1e-9)
    T = np.eye(4)
    T[:2, 0], T[:2, 1] = along, [-along[1], along[0]]
    T[:3, 3] = [*(start + end) / 2, level_m + high / 2]
    return Part("wall", trimesh.Scene({"wall": trimesh.creation.box((length, thick, high), T)}), T)


def _room(room: ET.Element, level_m: float) -> Part:
    points = np.array([[_number(p, "x"), -_number(p, "y")] for p in room.findall("point")]) * M_PER_CM
    slab = _slab(points)
    slab.apply_translation([0.0, 0.0, level_m])
    return Part("floor", trimesh.Scene({"floor": slab}), np.eye(4), room=shorten(room.get("name", ""), 60))


def _slab(points: Float[np.ndarray, "n 2"]) -> trimesh.Trimesh:
    import manifold3d

    solid = manifold3d.CrossSection([points], manifold3d.FillRule.NonZero)
    if solid.is_empty():
        solid = manifold3d.CrossSection([points[::-1]], manifold3d.FillRule.NonZero)
    mesh = manifold3d.Manifold.extrude(solid, THIN_M).translate((0.0, 0.0, -THIN_M)).to_mesh()
    return trimesh.Trimesh(mesh.vert_properties[:, :3], mesh.tri_verts, process=False)
