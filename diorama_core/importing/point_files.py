"""Measured points: clouds in PLY, LAS, LAZ, E57, PCD, text and arrays, Gaussian splats, and scanner apps' folders.

LAS and LAZ need laspy, E57 needs pye57 (extra `scan`). `POINT_FORMS` is the table of what is read.

Of Gaussian splats those are points that are plainly there: faint and huge ones float around what was filmed. PLY is
read as Kerbl et al., 3D Gaussian Splatting (2023), write it (opacity as a logit, scales as logarithms), and `.splat`
(32 bytes a splat).
"""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Bool, Float

from diorama_core.errors import DioramaError, InputError, UnavailableError
from diorama_core.importing.array_clouds import is_array_cloud, is_float_dump, read_array_cloud, read_float_dump
from diorama_core.importing.depth_frames import FRAME_FORMS, UP_Y, UP_Z, cloud_of_frames
from diorama_core.importing.point_cloud import (
    MAX_POINTS,
    MIN_POINTS,
    PointCloud,
    likely_unit,
    points_of_mesh,
    to_metres,
    unit_note,
)
from diorama_core.io.bounded import megabytes, read_bytes, shorten
from diorama_core.io.contained import ContainedFiles
from diorama_core.io.file_heads import FileHead, head_of
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.references import GuardedResolver, References

MIN_OPACITY = 0.1
MAX_SCALE = 20.0
"""Times the usual splat's largest side: larger ones are sky and fog."""
SPLAT = np.dtype([("at", "<f4", 3), ("scale", "<f4", 3), ("colour", "u1", 4), ("turn", "u1", 4)])
_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip


def is_splat_ply(head: bytes) -> bool:
    """Whether a PLY's heading names what only splats have."""
    heading = head[: head.find(b"end_header")]
    return head.startswith(b"ply") and b" opacity" in heading and b" scale_0" in heading


def read_splat_ply(path: Path) -> Float[np.ndarray, "n 3"]:
    """The centres of the splats that are plainly there."""
    rows = _vertices(path)
    scales = np.exp(np.column_stack([rows[f"scale_{k}"] for k in range(3)]).astype(np.float64))
    points = np.column_stack([rows[axis] for axis in "xyz"]).astype(np.float64)
    opacity = 1.0 / (1.0 + np.exp(-np.clip(rows["opacity"].astype(np.float64), -60.0, 60.0)))
    return points[_plain(opacity, scales)]


def read_splats(path: Path) -> Float[np.ndarray, "n 3"]:
    """The centres of the splats of a `.splat` file that are plainly there."""
    rows = np.fromfile(path, SPLAT, count=path.stat().st_size // SPLAT.itemsize)
    return rows["at"].astype(np.float64)[_plain(rows["colour"][:, 3] / 255.0, rows["scale"].astype(np.float64))]


def _plain(opacity: Float[np.ndarray, "n"], scales: Float[np.ndarray, "n 3"]) -> Bool[np.ndarray, "n"]:
    largest = scales.max(axis=1)
    is_visible = (opacity >= MIN_OPACITY) & np.isfinite(largest)
    usual = float(np.median(largest[is_visible])) if is_visible.any() else 0.0
    return is_visible & (largest <= MAX_SCALE * usual)


def _vertices(path: Path) -> np.ndarray:
    """The vertices of a PLY, by property."""
    with path.open("rb") as stream:
        heading = b""
        while not heading.endswith(b"end_header\n") and len(heading) < 65_536:
            line = stream.readline(4096)
            if not line:
                break
            heading += line.replace(b"\r\n", b"\n")
        lines = heading.decode("ascii", "replace").split("\n")
        kind = next((line.split()[1] for line in lines if line.startswith("format ")), "")
        elements = [k for k, line in enumerate(lines) if line.startswith("element ")]
        first = lines[elements[0]].split() if elements else []
        if (
            len(first) != 3
            or first[1] != "vertex"
            or kind not in ("ascii", "binary_little_endian", "binary_big_endian")
        ):
            raise InputError(f"{path.name} is no plain PLY of splats; export it uncompressed")
        ends = elements[1] if len(elements) > 1 else len(lines)
        properties = [line.split() for line in lines[elements[0] + 1 : ends] if line.startswith("property ")]
        order = ">" if kind == "binary_big_endian" else "<"
        types = np.dtype([(name, order + _TYPES[of]) for _, of, name in properties])
        if kind == "ascii":
            return np.loadtxt(stream, types, max_rows=int(first[2]), ndmin=1)
        return np.fromfile(stream, types, count=int(first[2]))


TEXT_SUFFIXES = (".xyz", ".pts", ".ptx", ".asc", ".txt", ".csv", ".xyzrgb", ".xyzn")
LOOKED_AT = 40
"""Lines that tell how a file is written."""
_NUMBER = r"[-+]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|(?i:nan))"
_AXIS = re.compile(r"(?:pos(?:ition)?|coord|points?)?[_: ]?([xyz])(?:[ _\[(].*)?")
"""Names of columns, as in X, pos_x, "y [m]"."""
_ROW = re.compile(rf"^\s*{_NUMBER}(?:[\s,;]+{_NUMBER}){{2,}}\s*[,;]?\s*$")


def is_text_cloud(text: str) -> bool:
    """Whether a text's lines are rows of three numbers or more, after at most a few lines of another kind."""
    lines = [line for line in text.splitlines()[:-1] or text.splitlines() if line.strip()][:LOOKED_AT]
    rows = [bool(_ROW.match(line)) for line in lines]
    return len(lines) >= 3 and sum(rows) >= 0.8 * len(rows) and all(rows[len(rows) // 2 :])


def read_text_cloud(path: Path) -> Float[np.ndarray, "n 3"]:
    """The points of a text file: the columns x, y and z where a heading names them, else the first three."""
    with path.open(encoding="utf-8-sig", errors="replace") as stream:
        beginning = list(islice(stream, LOOKED_AT))
    first = next((k for k, line in enumerate(beginning) if _ROW.match(line)), None)
    if first is None:
        raise InputError(f"{path.name} has no rows of three numbers; export the points as 'x y z' lines")
    delimiter = next((d for d in (";", ",") if d in beginning[first]), None)
    columns = _columns(beginning[first - 1] if first else "", delimiter)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        rows = np.loadtxt(
            path, np.float64, comments=("#", "//"), delimiter=delimiter, skiprows=first, usecols=columns, ndmin=2,
            encoding="utf-8-sig",
        )  # fmt: skip
    return np.asarray(rows, np.float64).reshape(-1, 3)


def _columns(heading: str, delimiter: str | None) -> tuple[int, ...]:
    words = [w.strip(" \t\r\n\"'/#").lower() for w in (heading.split(delimiter) if delimiter else heading.split())]
    names = [match[1] if (match := _AXIS.fullmatch(word)) else "" for word in words]
    return tuple(names.index(axis) for axis in "xyz") if {"x", "y", "z"} <= set(names) else (0, 1, 2)


def read_pcd(path: Path) -> Float[np.ndarray, "n 3"]:
    """The points of a PCD file in any of its three encodings."""
    from diorama_core.io.large_libraries import o3d

    cloud = o3d.io.read_point_cloud(str(path), format="pcd")
    return np.asarray(cloud.points, np.float64).reshape(-1, 3)


MESH_NAMES = ("raw.glb", "export.obj", "export_refined.obj", "textured_output.obj", "*.glb", "*.obj", "*.ply")
"""File names of a scanner app's mesh, likeliest first."""
MAX_BYTES = 2_000_000_000
OWN_PLY = b"comment Diorama: metres, +Z up"


@dataclass(frozen=True)
class PointForm:
    """A form in which measured points come."""

    name: str
    files: str
    """Endings, or what the folder is."""
    tells: Callable[[FileHead], bool]
    read: Callable[[Path], PointCloud]
    extra: str = ""


def read_points(path: Path) -> PointCloud:
    """The points of a file or of a scanner app's folder.

    Raises:
        InputError: it cannot be read, or holds too few points.
        UnavailableError: an optional library is missing.
    """
    head = head_of(path)
    form = next((form for form in POINT_FORMS if form.tells(head)), None)
    if form is None:
        raise InputError(f"{path} holds no points that are read: {', '.join(f.name for f in POINT_FORMS)}")
    if head.size > MAX_BYTES:
        raise InputError(f"{path.name} has more than the {megabytes(MAX_BYTES)} that are read; thin it out first")
    try:
        cloud = form.read(path)
    except DioramaError:
        raise
    except Exception as error:  # readers of damaged files raise almost anything; it means the same
        reason = shorten(str(error), 120) or type(error).__name__
        raise InputError(f"{path.name}: the points cannot be read ({reason}); export them again") from error
    points = cloud.points[np.isfinite(cloud.points).all(axis=1)]
    if len(points) < MIN_POINTS:
        raise InputError(f"{path.name} has {len(points)} points; a room needs {MIN_POINTS} or more")
    step = -(-len(points) // MAX_POINTS)
    return replace(cloud, points=points[::step])


def _from_ply(path: Path) -> PointCloud:
    with path.open("rb") as stream:
        is_diorama = OWN_PLY in stream.read(4096)
    loaded = _load(path)
    if is_diorama:
        return PointCloud(points_of_mesh(loaded), UP_Z)
    if isinstance(loaded, trimesh.Trimesh) and len(loaded.vertices):
        return _from_mesh(loaded, None)
    return to_metres(PointCloud(points_of_mesh(loaded), None))


def _load(path: Path) -> object:
    """A mesh or a point cloud; what it refers to is read below its own folder only."""
    references = References(path.parent, path.parent, DEFAULT_LIMITS)
    content = io.BytesIO(read_bytes(path, MAX_BYTES, InputError, "thin it out first"))
    return trimesh.load(content, file_type=path.suffix[1:].lower(), resolver=GuardedResolver(references), process=False)


def _from_mesh(mesh: trimesh.Trimesh, up: np.ndarray | None) -> PointCloud:
    """Points are spread by square metres, so the unit comes first."""
    unit = likely_unit(np.asarray(mesh.vertices, np.float64), up)
    mesh.apply_scale(unit.metres)
    return PointCloud(points_of_mesh(mesh), up, unit_note(unit), unit_m=unit.metres)


def _from_array(read: Callable[[Path], Float[np.ndarray, "n 3"]], note: str, path: Path) -> PointCloud:
    points = read(path)
    far = np.median(points, axis=0) if len(points) else np.zeros(3)
    near = points - np.where(np.abs(far) > 1e4, far, 0.0)  # surveyors' grids
    return to_metres(PointCloud(near, None, (note,) if note else ()))


def _from_las(path: Path) -> PointCloud:
    try:
        import laspy
    except ImportError as error:
        raise UnavailableError("LAS and LAZ need laspy: pip install 'diorama[scan]'") from error
    rows = []
    with laspy.open(path) as reader:
        step = max(1, -(-reader.header.point_count // MAX_POINTS))
        for chunk in reader.chunk_iterator(2_000_000):
            rows.append(np.column_stack([chunk.x, chunk.y, chunk.z])[::step])
    return to_metres(_recentre(rows))


def _from_e57(path: Path) -> PointCloud:
    try:
        import pye57
    except ImportError as error:
        raise UnavailableError("E57 needs pye57: pip install 'diorama[scan]'") from error
    opened = pye57.E57(str(path))
    try:
        rows = []
        for index in range(opened.scan_count):
            scan = opened.read_scan(index, ignore_missing_fields=True)  # in the file's common frame
            rows.append(np.column_stack([scan[f"cartesian{axis}"] for axis in "XYZ"]))
    finally:
        opened.close()
    return _recentre(rows)


def _recentre(rows: Sequence[np.ndarray]) -> PointCloud:
    """Points, +Z up, around the middle of their plan: grids of surveyors begin far away."""
    points = np.vstack(rows).astype(np.float64)
    return PointCloud(points - np.append(np.median(points[:, :2], axis=0), 0.0), UP_Z)


def _from_app_mesh(folder: Path) -> PointCloud:
    mesh = next(_meshes_in(folder))
    up = None if mesh.suffix == ".ply" else UP_Y  # glTF by its standard, the apps' OBJ as ARKit's world
    return PointCloud(points_of_mesh(_load(mesh)), up)


def _meshes_in(folder: Path) -> Iterator[Path]:
    files = ContainedFiles(folder, InputError)
    return (path for name in MESH_NAMES for path in sorted(folder.glob(name)) if files.holds(path))


def _is_ply(head: FileHead) -> bool:
    return head.head.startswith(b"ply") or (head.suffix == ".ply" and not head.is_folder)


POINT_FORMS = (
    PointForm(
        "Gaussian splats", ".ply of 3DGS", lambda h: is_splat_ply(h.head),
        partial(_from_array, read_splat_ply, "Gaussian splats: faint and huge ones were left out"),
    ),
    PointForm("points or a scan's mesh in PLY", ".ply", _is_ply, _from_ply),
    PointForm(
        "Gaussian splats", ".splat", lambda h: h.suffix == ".splat" and h.size > 0 and h.size % SPLAT.itemsize == 0,
        partial(_from_array, read_splats, "Gaussian splats: faint and huge ones were left out"),
    ),
    PointForm("LAS, LAZ", ".las, .laz", lambda h: h.head[:4] == b"LASF" or h.suffix in (".las", ".laz"), _from_las,
              "scan"),
    PointForm("E57", ".e57", lambda h: h.head[:8] == b"ASTM-E57" or h.suffix == ".e57", _from_e57, "scan"),
    PointForm(
        "PCD", ".pcd", lambda h: b"\nVERSION" in h.head[:200] or h.head.startswith((b"# .PCD", b"VERSION")),
        partial(_from_array, read_pcd, ""),
    ),
    PointForm(
        "points in plain text", ", ".join(TEXT_SUFFIXES), lambda h: h.suffix in TEXT_SUFFIXES and is_text_cloud(h.text),
        partial(_from_array, read_text_cloud, ""),
    ),
    PointForm("points as an array of numpy", ".npy, .npz", is_array_cloud, partial(_from_array, read_array_cloud, "")),
    PointForm(
        "points as bare floats, as of KITTI", ".bin", is_float_dump, partial(_from_array, read_float_dump, "")
    ),
    *(PointForm(form.name, "a folder, or its zip", form.tells, partial(cloud_of_frames, form=form))
      for form in FRAME_FORMS),
    PointForm(
        "the mesh of a scanner app", "a folder, or its zip",
        lambda h: h.is_folder and "scene.json" not in h.names and any(_meshes_in(h.path)), _from_app_mesh,
    ),
)  # fmt: skip
"""The first that tells a file is its form."""
