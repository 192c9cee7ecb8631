"""Measured points: point clouds in PLY, LAS, LAZ and E57, and the folders that Polycam and 3D Scanner App export.

LAS and LAZ need laspy, E57 needs pye57 (extra `scan`). Folders hold ARKit frames: cameras (`posed_photos`), depth in
16-bit PNGs of millimetres, and how sure each pixel's depth is; Polycam (raw data: `keyframes/depth` and
`keyframes/confidence`, 0, 127, 255) and 3D Scanner App (all data: `depth_00000.png`, `conf_00000.png`, 0, 1, 2).
Without depth, the mesh beside them is taken.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float
from PIL import Image

from diorama_core.errors import DioramaError, InputError, UnavailableError
from diorama_core.importing.cloud_units import Unit, likely_unit
from diorama_core.io.bounded import megabytes, read_bytes, shortened
from diorama_core.io.contained import ContainedFiles
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.references import GuardedResolver, References
from diorama_core.multiview.posed_photos import PosedPhoto, read_poses
from diorama_core.scene.types import Camera

CLOUD_SUFFIXES = (".ply", ".las", ".laz", ".e57")
MESH_NAMES = ("raw.glb", "export.obj", "export_refined.obj", "textured_output.obj", "*.glb", "*.obj", "*.ply")
"""Of a scanner app's mesh, the likeliest first."""
MAX_BYTES = 2_000_000_000
MAX_POINTS = 4_000_000
"""More are thinned out evenly."""
MESH_POINTS_M2 = 1500.0
"""Points that stand for a square metre of a mesh."""
MIN_POINTS = 2000
MAX_DEPTH_M = 6.0
"""Of a phone's depth: what is farther is guessed."""
MAX_FRAMES = 400
SURE_SMALL, SURE_LARGE = 1, 100
"""Least confidence of a pixel, where it is a level (0 to 2) and where it is a grey value (0 to 255)."""
Up = Float[np.ndarray, "3"]


@dataclass(frozen=True, eq=False)
class ScanPhoto:
    """A picture that was taken with the depth beside it."""

    picture: Path
    depth: Path
    """Millimetres, of any size."""
    camera: Camera
    """In the world of the points; its intrinsics are the picture's."""

    def moved(self, T_to_from: Float[np.ndarray, "4 4"]) -> ScanPhoto:
        """The same photo in another frame: `p_to = T_to_from @ p_from`, rigid."""
        return replace(self, camera=Camera(self.camera.intrinsics, T_to_from @ self.camera.T_world_camera))


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points of surfaces, in metres."""

    points: Float[np.ndarray, "n 3"]
    up: Up | None
    """Direction against gravity, where the format says it."""
    notes: tuple[str, ...] = ()
    photos: tuple[ScanPhoto, ...] = ()


def is_scan_folder(path: Path) -> bool:
    """Whether a folder is what a scanner app exports."""
    return path.is_dir() and (bool(_frames(path)) or _mesh_in(path) is not None)


def read_points(path: Path) -> PointCloud:
    """The points of a file or of a scanner app's folder.

    Raises:
        InputError: it cannot be read, or holds too few points.
        UnavailableError: an optional library is missing.
    """
    reader = _from_folder if path.is_dir() else _readers().get(path.suffix.lower())
    if reader is None:
        raise InputError(f"{path}: point clouds are read from {', '.join(CLOUD_SUFFIXES)}")
    if path.is_file() and path.stat().st_size > MAX_BYTES:
        raise InputError(f"{path.name} has more than the {megabytes(MAX_BYTES)} that are read; thin it out first")
    try:
        cloud = reader(path)
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


def _readers() -> Mapping[str, Callable[[Path], PointCloud]]:
    return {".ply": _from_ply, ".las": _from_las, ".laz": _from_las, ".e57": _from_e57}


def _from_ply(path: Path) -> PointCloud:
    loaded = _loaded(path)
    if isinstance(loaded, trimesh.Trimesh) and len(loaded.vertices):  # points are spread by square metres
        unit = likely_unit(np.asarray(loaded.vertices, np.float64), None)
        loaded.apply_scale(unit.metres)
        return PointCloud(_points_of(loaded), None, _unit_note(unit))
    return _in_metres(PointCloud(_points_of(loaded), None))


def _loaded(path: Path) -> object:
    """A mesh or a point cloud; what it refers to is read below its own folder only."""
    references = References(path.parent, path.parent, DEFAULT_LIMITS)
    content = io.BytesIO(read_bytes(path, MAX_BYTES, InputError, "thin it out first"))
    return trimesh.load(content, file_type=path.suffix[1:].lower(), resolver=GuardedResolver(references), process=False)


def _in_metres(cloud: PointCloud) -> PointCloud:
    """The cloud of a format that does not say its unit."""
    finite = cloud.points[np.isfinite(cloud.points).all(axis=1)]
    if not len(finite):
        return cloud
    unit = likely_unit(finite, cloud.up)
    return replace(cloud, points=cloud.points * unit.metres, notes=(*cloud.notes, *_unit_note(unit)))


def _unit_note(unit: Unit) -> tuple[str, ...]:
    if unit.metres == 1.0:
        return ()
    return (f"lengths were taken for {unit.name}: only so the points are about as large as a room",)


def _points_of(loaded: object) -> Float[np.ndarray, "n 3"]:
    """Vertices of a point cloud; of a mesh, points spread evenly over its faces."""
    if isinstance(loaded, trimesh.Scene):
        loaded = loaded.to_geometry()
    if isinstance(loaded, trimesh.Trimesh) and len(loaded.faces):
        count = int(np.clip(loaded.area * MESH_POINTS_M2, MIN_POINTS, MAX_POINTS))
        return np.asarray(trimesh.sample.sample_surface(loaded, count, seed=20)[0], np.float64)
    return np.asarray(getattr(loaded, "vertices", np.zeros((0, 3))), np.float64).reshape(-1, 3)


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
    return _in_metres(PointCloud(points - np.append(np.median(points[:, :2], axis=0), 0.0), np.array([0.0, 0.0, 1.0])))


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
    return PointCloud(points - np.append(np.median(points[:, :2], axis=0), 0.0), np.array([0.0, 0.0, 1.0]))


@dataclass(frozen=True)
class _Frame:
    depth: Path
    confidence: Path | None
    picture: Path
    """May be missing."""


def _frames(folder: Path) -> dict[str, _Frame]:
    """Depth by the name of its photo."""
    files, found = ContainedFiles(folder, InputError), {}
    for path in filter(files.holds, sorted((folder / "keyframes" / "depth").glob("*.png"))):
        sure = folder / "keyframes" / "confidence" / path.name
        frames = folder / "keyframes"
        pictures = [frames / name / f"{path.stem}.jpg" for name in ("corrected_images", "images")]
        picture = next(filter(files.holds, pictures), pictures[-1])
        found[path.stem] = _Frame(path, sure if files.holds(sure) else None, picture)
    for path in filter(files.holds, sorted(folder.glob("depth_*.png"))):
        number = path.stem.removeprefix("depth_")
        sure = folder / f"conf_{number}.png"
        picture = folder / f"frame_{number}.jpg"
        found[f"frame_{number}"] = _Frame(path, sure if files.holds(sure) else None, picture)
    return found


def _mesh_in(folder: Path) -> Path | None:
    files = ContainedFiles(folder, InputError)
    return next((path for name in MESH_NAMES for path in sorted(folder.glob(name)) if files.holds(path)), None)


def _from_folder(folder: Path) -> PointCloud:
    frames = _frames(folder)
    if frames:
        return _from_depth(folder, frames)
    mesh = _mesh_in(folder)
    if mesh is None:
        raise InputError(f"{folder} holds neither depth nor a mesh of a scanner app; export 'raw data' or 'all data'")
    up = np.array([0.0, 1.0, 0.0])  # glTF by its standard, the apps' OBJ as ARKit's world
    return PointCloud(_points_of(_loaded(mesh)), None if mesh.suffix == ".ply" else up)


def _from_depth(folder: Path, frames: Mapping[str, _Frame]) -> PointCloud:
    """Points of all frames whose cameras are known, as far as the sensor was sure of them."""
    poses = read_poses(folder)
    used = [p for p in poses.photos if Path(p.name).stem in frames]
    if not used:
        raise InputError(f"{folder}: no depth has a camera of its name; export the scan again")
    used = used[:: -(-len(used) // MAX_FRAMES)]
    step = max(1, round(np.sqrt(len(used) * 256 * 192 / MAX_POINTS)))
    rows = [_points_of_frame(p, frames[Path(p.name).stem], step) for p in used]
    photos = [ScanPhoto(frame.picture, frame.depth, p.camera) for p in used if (frame := frames[Path(p.name).stem])]
    files = ContainedFiles(folder, InputError)
    pictured = tuple(p for p in photos if files.holds(p.picture))
    return PointCloud(np.vstack(rows), poses.up, (f"{len(used)} frames with depth", *poses.notes), pictured)


def read_depth(path: Path) -> Float[np.ndarray, "h w"]:
    """Depth along the viewing axis in metres, from a PNG of millimetres; 0 where the sensor saw nothing."""
    with Image.open(path, formats=("PNG",)) as opened:
        return np.asarray(opened).astype(np.float64) / 1000.0


def _points_of_frame(photo: PosedPhoto, frame: _Frame, step: int) -> Float[np.ndarray, "n 3"]:
    depth = read_depth(frame.depth)
    good = (depth > 0.05) & (depth < MAX_DEPTH_M)
    if frame.confidence is not None:
        with Image.open(frame.confidence, formats=("PNG",)) as opened:
            sure = np.asarray(opened)
        if sure.shape != depth.shape:
            raise InputError(f"{frame.confidence.name} has another size than its depth; export the scan again")
        good &= sure >= (SURE_SMALL if sure.max() <= 2 else SURE_LARGE)
    rows, columns = np.nonzero(good)
    rows, columns = rows[::step], columns[::step]
    height, width = depth.shape
    camera = photo.camera
    k = camera.intrinsics.scaled(width, height)
    z = depth[rows, columns]
    local = np.column_stack([(columns + 0.5 - k.cx) / k.fx * z, (rows + 0.5 - k.cy) / k.fy * z, z])
    return local @ camera.T_world_camera[:3, :3].T + camera.position
