"""Measured points: clouds in PLY, LAS, LAZ, E57, PCD, text and arrays, Gaussian splats, and scanner apps' folders.

LAS and LAZ need laspy, E57 needs pye57 (extra `scan`). `POINT_FORMS` is the table of what is read.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.errors import DioramaError, InputError, UnavailableError
from diorama_core.importing.array_clouds import is_array_cloud, is_float_dump, read_array_cloud, read_float_dump
from diorama_core.importing.cloud_units import likely_unit
from diorama_core.importing.data_set_frames import DATA_SET_FORMS
from diorama_core.importing.depth_frames import FRAME_FORMS, UP_Y, UP_Z, FrameForm, cloud_of_frames
from diorama_core.importing.point_cloud import MAX_POINTS, MIN_POINTS, PointCloud, in_metres, points_of_mesh, unit_note
from diorama_core.importing.splats import SPLAT, is_splat_ply, read_splat_ply, read_splats
from diorama_core.importing.text_clouds import TEXT_SUFFIXES, is_text_cloud, read_pcd, read_text_cloud
from diorama_core.io.bounded import megabytes, read_bytes, shortened
from diorama_core.io.contained import ContainedFiles
from diorama_core.io.file_heads import FileHead, head_of
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.references import GuardedResolver, References

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
    form = _form_of(head)
    if form is None:
        raise InputError(f"{path} holds no points that are read: {', '.join(f.name for f in POINT_FORMS)}")
    if head.size > MAX_BYTES:
        raise InputError(f"{path.name} has more than the {megabytes(MAX_BYTES)} that are read; thin it out first")
    try:
        cloud = form.read(path)
    except DioramaError:
        raise
    except Exception as error:  # readers of damaged files raise almost anything; it means the same
        reason = shortened(str(error), 120) or type(error).__name__
        raise InputError(f"{path.name}: the points cannot be read ({reason}); export them again") from error
    points = cloud.points[np.isfinite(cloud.points).all(axis=1)]
    if len(points) < MIN_POINTS:
        raise InputError(f"{path.name} has {len(points)} points; a room needs {MIN_POINTS} or more")
    step = -(-len(points) // MAX_POINTS)
    return replace(cloud, points=points[::step])


def _form_of(head: FileHead) -> PointForm | None:
    return next((form for form in POINT_FORMS if form.tells(head)), None)


def _from_ply(path: Path) -> PointCloud:
    with path.open("rb") as stream:
        is_diorama = OWN_PLY in stream.read(4096)
    loaded = _loaded(path)
    if is_diorama:
        return PointCloud(points_of_mesh(loaded), UP_Z)
    if isinstance(loaded, trimesh.Trimesh) and len(loaded.vertices):
        return _from_mesh(loaded, None)
    return in_metres(PointCloud(points_of_mesh(loaded), None))


def _loaded(path: Path) -> object:
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
    return in_metres(PointCloud(near, None, (note,) if note else ()))


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
    points = np.vstack(rows).astype(np.float64)
    return in_metres(PointCloud(points - np.append(np.median(points[:, :2], axis=0), 0.0), UP_Z))


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
    points = np.vstack(rows).astype(np.float64)
    return PointCloud(points - np.append(np.median(points[:, :2], axis=0), 0.0), UP_Z)


def _from_app_mesh(folder: Path) -> PointCloud:
    mesh = next(_meshes_in(folder))
    up = None if mesh.suffix == ".ply" else UP_Y  # glTF by its standard, the apps' OBJ as ARKit's world
    return PointCloud(points_of_mesh(_loaded(mesh)), up)


def _meshes_in(folder: Path) -> Iterator[Path]:
    files = ContainedFiles(folder, InputError)
    return (path for name in MESH_NAMES for path in sorted(folder.glob(name)) if files.holds(path))


def _is_ply(head: FileHead) -> bool:
    return head.head.startswith(b"ply") or (head.suffix == ".ply" and not head.is_folder)


def _framed(form: FrameForm) -> PointForm:
    return PointForm(form.name, "a folder, or its zip", form.tells, partial(cloud_of_frames, form=form))


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
    *(_framed(form) for form in (*FRAME_FORMS, *DATA_SET_FORMS)),
    PointForm(
        "the mesh of a scanner app", "a folder, or its zip",
        lambda h: h.is_folder and "scene.json" not in h.names and any(_meshes_in(h.path)), _from_app_mesh,
    ),
)  # fmt: skip
"""The first that tells a file is its form."""
