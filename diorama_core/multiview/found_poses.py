"""Cameras of photos of one room, found by what the photos have in common.

SIFT features (Lowe 2004) are matched between all pairs, and COLMAP's incremental mapper (Schönberger and Frahm 2016)
places the cameras. Needs the extra `photos` (pycolmap).
"""

from __future__ import annotations

import tempfile
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image

from diorama_core.errors import InputError, UnavailableError
from diorama_core.multiview.posed_photos import MAX_PHOTOS, Poses, read_poses
from diorama_core.progress import SILENT, Progress

LONGEST_PX = 1600
"""Photos are matched at most at this size."""
LIKELY_FOV_RAD = 1.1
"""Horizontal field of view that a photo is taken to have until the photos tell: a phone's."""
SEED = 20


@dataclass(frozen=True, eq=False)
class UnposedPhoto:
    """A photo of which it is not known where it was taken."""

    name: str
    rgb: UInt8[np.ndarray, "h w 3"]
    """Upright."""
    focal_px: float | None
    """Focal length, where it is known."""


def find_poses(photos: Sequence[UnposedPhoto], progress: Progress = SILENT) -> Poses:
    """Cameras of photos, in a world without metres or gravity; a note names the photos that do not join.

    Photos of one size without a focal length are taken to be of one camera.

    Args:
        photos: of one room, at least two.
        progress: reports and cancellation.

    Raises:
        UnavailableError: pycolmap is not installed.
        InputError: fewer than two photos join.
        Cancelled: on request.
    """
    colmap = _pycolmap()
    if not 2 <= len(photos) <= MAX_PHOTOS:
        raise InputError(f"{len(photos)} photos; cameras are found for 2 to {MAX_PHOTOS} photos of one room")
    with tempfile.TemporaryDirectory(prefix="diorama-photos-") as temporary:
        folder = Path(temporary)
        database, pictures = folder / "database.db", folder / "pictures"
        names = _match_photos(colmap, photos, database, pictures, progress.part(0.0, 0.8))
        progress.report(0.8, "Placing the cameras")
        place = partial(colmap.incremental_mapping, database, pictures, folder, options=_mapping(colmap))
        models = _cancellable(colmap, progress, place)
        best = max(models, key=lambda n: (models[n].num_reg_images(), -n), default=None)
        if best is None:
            raise InputError("the photos have too little in common to find their cameras; take them from nearer places")
        model = folder / "model"
        model.mkdir()
        models[best].write(str(model))
        poses = read_poses(model)
        groups = [frozenset(names[m.image(i).name] for i in m.reg_image_ids()) for m in models.values()]
    joined = {names[p.name]: p for p in poses.photos}
    left_out = [p.name for p in photos if p.name not in joined]
    notes = _describe_excluded(left_out, groups)
    placed = tuple(replace(joined[p.name], name=p.name) for p in photos if p.name in joined)
    return replace(poses, photos=placed, notes=(*poses.notes, *notes), left_out=tuple(left_out))


def _describe_excluded(names: Sequence[str], groups: Sequence[frozenset[str]]) -> tuple[str, ...]:
    """A line for photos that join one another, and one for those that join none."""
    rest, lines = list(names), []
    for group in sorted(groups, key=lambda g: (-len(g), sorted(g))):
        alike = [name for name in rest if name in group]
        if len(alike) > 1:
            lines.append(f"{', '.join(alike)}: join one another only, as photos of another room do; left out")
            rest = [name for name in rest if name not in group]
    if rest:
        lines.append(f"{', '.join(rest)}: too little in common with the other photos to find the camera; left out")
    return tuple(lines)


def common_points(
    new: UnposedPhoto, photos: Sequence[UnposedPhoto], progress: Progress = SILENT
) -> tuple[Float[np.ndarray, "_ 4"], ...]:
    """What a photo has in common with others: pixels of the same places, as far as epipolar geometry verifies them.

    Args:
        new: the photo.
        photos: the others.
        progress: reports and cancellation.

    Returns:
        For each of the others rows of x, y in it and x, y in the new one.

    Raises:
        UnavailableError: pycolmap is not installed.
        Cancelled: on request.
    """
    colmap = _pycolmap()
    points_of_photos = {p.name: np.zeros((0, 4)) for p in photos}
    with tempfile.TemporaryDirectory(prefix="diorama-photos-") as temporary:
        database = Path(temporary) / "database.db"
        names = _match_photos(colmap, (*photos, new), database, Path(temporary) / "pictures", progress)
        scales = {p.name: _scale(*p.rgb.shape[:2]) for p in (*photos, new)}
        with colmap.Database.open(str(database)) as opened:
            images = {i.image_id: names[i.name] for i in opened.read_all_images()}
            points = {n: opened.read_keypoints(i)[:, :2] / scales[n] for i, n in images.items()}
            for pair, geometry in zip(*opened.read_two_view_geometries(), strict=True):
                a, b = (images[i] for i in colmap.pair_id_to_image_pair(pair))
                matches = np.asarray(geometry.inlier_matches).reshape(-1, 2)
                if a == new.name:
                    a, b, matches = b, a, matches[:, ::-1]
                if b == new.name:
                    both = np.hstack([points[a][matches[:, 0]], points[b][matches[:, 1]]])
                    points_of_photos[a] = both.astype(np.float64)
    return tuple(points_of_photos[p.name] for p in photos)


def _match_photos(
    colmap: ModuleType, photos: Sequence[UnposedPhoto], database: Path, pictures: Path, progress: Progress
) -> Mapping[str, str]:
    """Features of all photos and matches of all pairs in a database; the name of each photo by its picture's."""
    names = _write_pictures(photos, pictures)
    colmap.set_random_seed(SEED)
    _extract(colmap, photos, names, database, pictures, progress.part(0.0, 0.6))
    progress.report(0.6, "Matching the photos")
    _cancellable(colmap, progress, partial(colmap.match_exhaustive, database))
    return names


def _pycolmap() -> ModuleType:
    try:
        import pycolmap
    except ImportError as error:
        raise UnavailableError("finding cameras of photos needs pycolmap: pip install 'diorama[photos]'") from error
    pycolmap.logging.minloglevel = pycolmap.logging.ERROR
    module: ModuleType = pycolmap
    return module


def _cancellable(colmap: ModuleType, progress: Progress, step: Callable[..., Any]) -> Any:
    """The step's result; it is stopped where it is when the job is cancelled."""
    token = colmap.CancellationToken()
    with ThreadPoolExecutor(1) as pool:
        running = pool.submit(step, cancellation_token=token)
        while not running.done():
            wait([running], timeout=0.2)  # seconds, then it is looked whether the job was cancelled
            if progress.token.is_cancelled:
                token.cancel()
        progress.check()
        return running.result()


def _write_pictures(photos: Sequence[UnposedPhoto], folder: Path) -> Mapping[str, str]:
    """Upright pictures as files of plain names; the name of each photo by its file's."""
    folder.mkdir()
    names = {}
    for number, photo in enumerate(photos):
        height, width = photo.rgb.shape[:2]
        scale = _scale(width, height)
        size = (round(width * scale), round(height * scale))
        rgb = cv2.resize(photo.rgb, size, interpolation=cv2.INTER_AREA) if scale < 1.0 else photo.rgb
        file = f"{number:05d}.png"
        Image.fromarray(rgb).save(folder / file, compress_level=1)
        names[file] = photo.name
    return names


def _scale(width: int, height: int) -> float:
    return min(1.0, LONGEST_PX / max(width, height))


def _extract(
    colmap: ModuleType,
    photos: Sequence[UnposedPhoto],
    names: Mapping[str, str],
    database: Path,
    pictures: Path,
    progress: Progress,
) -> None:
    """Features of all pictures; those of one size and focal length share a camera."""
    cameras: dict[tuple[int, int, float | None], list[str]] = defaultdict(list)
    for file, photo in zip(names, photos, strict=True):
        height, width = photo.rgb.shape[:2]
        cameras[width, height, photo.focal_px].append(file)
    done = 0
    for (width, height, focal_px), files in cameras.items():
        progress.report(done / len(names), f"Looking for features in {len(files)} photos")
        scale = _scale(width, height)
        w, h = round(width * scale), round(height * scale)
        f = w / (2 * np.tan(LIKELY_FOV_RAD / 2)) if focal_px is None else focal_px * scale
        reader = colmap.ImageReaderOptions()
        reader.camera_model = "SIMPLE_RADIAL"
        reader.camera_params = f"{f},{w / 2},{h / 2},0"
        extract = partial(
            colmap.extract_features,
            database,
            pictures,
            image_names=files,
            camera_mode=colmap.CameraMode.SINGLE,
            reader_options=reader,
            extraction_options=_extraction(colmap),
        )
        _cancellable(colmap, progress, extract)
        done += len(files)


def _extraction(colmap: ModuleType) -> Any:
    options = colmap.FeatureExtractionOptions()
    options.use_gpu = False
    options.sift.peak_threshold = 0.004  # indoor walls and furniture have little contrast
    return options


def _mapping(colmap: ModuleType) -> Any:
    """A handful of photos of one room, not hundreds of a monument."""
    options = colmap.IncrementalPipelineOptions()
    options.min_model_size = 2
    options.mapper.init_min_num_inliers = 50
    options.mapper.init_min_tri_angle = 6.0
    options.mapper.abs_pose_min_num_inliers = 20
    options.random_seed = SEED
    return options
