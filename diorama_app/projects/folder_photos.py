"""Which photos a folder holds, what lies beside each, and what its project is called.

Beside `NAME.jpg` (or .png, .heic...) may lie `NAME.boxes.json`, `NAME.masks.png`, `NAME.depth.png` (or .npy, .exr...)
and `NAME.camera.json`, which holds `{"intrinsics": [fx, fy, cx, cy]}` or `{"fov_deg": 60}`.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from diorama_app.projects.options import BuildOptions, PhotoFiles
from diorama_core.errors import InputError
from diorama_core.io.bounded import read_json, shorten
from diorama_core.io.code_key import code_key

PHOTOS = frozenset(
    (
        ".jpg", ".jpeg", ".jpe", ".jfif", ".png", ".webp", ".avif", ".bmp", ".tif", ".tiff", ".gif", ".ppm", ".jp2",
        ".heic", ".heif", ".hif", ".dng", ".cr2", ".cr3", ".nef", ".arw", ".raf", ".rw2", ".orf", ".pef", ".srw",
    )
)  # fmt: skip
"""Ends of the names of photos, camera raw files included."""
DATA = frozenset(
    (
        ".json", ".txt", ".csv", ".xml", ".yaml", ".yml", ".bin", ".md", ".html", ".log", ".ini", ".db", ".aae", ".npy",
        ".npz", ".exr", ".ply", ".zip",
    )
)  # fmt: skip
"""Ends of the names of what nobody takes for a photo; everything else that is left out is named."""
SIDE_FILES = {
    "boxes": (".boxes.json", ".boxes.xml", ".boxes.txt"),
    "masks": (".masks.png", ".masks.npy", ".masks.npz", ".masks.tif"),
    "depth": (".depth.png", ".depth.npy", ".depth.exr", ".depth.npz", ".depth.tif", ".depth.raw"),
    "camera": (".camera.json",),
}
_BUILDERS = ("diorama_core.pipeline.presets", "diorama_core.pipeline.run")
"""Modules that choose and run the stages of a build."""
MAX_NAMED = 8
MAX_CAMERA_BYTES = 100_000
MAX_NUMBER = 1e9
"""Largest number of pixels or degrees."""


@dataclass(frozen=True)
class FolderPhoto:
    """One photo of a folder."""

    photo: Path
    project: str
    """Name of its project's folder."""
    side_files: tuple[tuple[str, Path], ...]
    """What of `SIDE_FILES` lies beside it."""

    def files(self) -> PhotoFiles:
        """What to build from.

        Raises:
            InputError: the camera's file is not valid.
        """
        beside = dict(self.side_files)
        intrinsics, fov_deg = read_camera(beside["camera"]) if "camera" in beside else (None, None)
        return PhotoFiles(
            self.photo, beside.get("boxes"), beside.get("masks"), beside.get("depth"), intrinsics, fov_deg
        )

    def key(self, options: BuildOptions) -> str:
        """Changes with the content of the files, the options and what the program makes of them.

        Raises:
            InputError: a file cannot be read.
        """
        content = hashlib.sha256(f"{code_key(*_BUILDERS)} {options!r}".encode())
        try:
            for kind, path in (("photo", self.photo), *self.side_files):
                with path.open("rb") as stream:
                    content.update(f" {kind} {path.suffix} ".encode())
                    content.update(hashlib.file_digest(stream, "sha256").digest())
        except OSError as error:
            raise InputError(f"{error.filename}: cannot be read ({error.strerror})") from error
        return content.hexdigest()[:32]


def photos_of(folder: Path) -> tuple[tuple[FolderPhoto, ...], tuple[str, ...]]:
    """The photos that lie in a folder (not in folders within it), and a remark for each side file without one.

    Raises:
        InputError: the folder cannot be read, or holds no photo.
    """
    try:
        names = sorted(p for p in folder.iterdir() if p.is_file() and not p.name.startswith("."))
    except OSError as error:
        raise InputError(f"{folder} cannot be read ({error.strerror}); name a folder of photos") from error
    beside = {p for p in names if _side_of(p) is not None}
    photos = [p for p in names if p not in beside and p.suffix.lower() in PHOTOS]
    if not photos:
        raise InputError(f"{folder} holds no photo; JPEG, PNG, HEIC, WebP and TIFF are read, among others")
    stems = Counter(p.stem for p in photos)
    folder_photos = tuple(FolderPhoto(p, p.stem if stems[p.stem] == 1 else p.name, _side_files(p)) for p in photos)
    alone = sorted(beside - {path for photo in folder_photos for _, path in photo.side_files})
    remarks = tuple(f"{p.name}: there is no photo of this name; it is not used" for p in alone)
    others = [p.name for p in names if p not in beside and p not in photos and p.suffix.lower() not in DATA]
    return folder_photos, remarks + _remark(others)


def _remark(names: list[str]) -> tuple[str, ...]:
    """A remark about files that are no photos."""
    if not names:
        return ()
    more = f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else ""
    files = "1 file is" if len(names) == 1 else f"{len(names)} files are"
    return (f"{files} no photo that is read and left out: {', '.join(names[:MAX_NAMED])}{more}",)


def read_camera(path: Path) -> tuple[tuple[float, float, float, float] | None, float | None]:
    """Intrinsics or field of view in degrees, whichever a `NAME.camera.json` gives.

    Raises:
        InputError: it holds something else.
    """
    camera = read_json(path, InputError, most=MAX_CAMERA_BYTES, advice="write it again")
    advice = '; write {"intrinsics": [fx, fy, cx, cy]} or {"fov_deg": 60}'
    if not isinstance(camera, dict) or len(camera) != 1:
        raise InputError(f"{path}: one of intrinsics and fov_deg is expected{advice}")
    (name, value), *_ = camera.items()
    if name == "fov_deg" and _is_number(value):
        return None, float(value)
    if name == "intrinsics" and isinstance(value, list) and len(value) == 4 and all(map(_is_number, value)):
        fx, fy, cx, cy = (float(v) for v in value)
        return (fx, fy, cx, cy), None
    raise InputError(f"{path}: {shorten(name)} is not valid{advice}")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < MAX_NUMBER


def _side_of(path: Path) -> str | None:
    return next((kind for kind, ends in SIDE_FILES.items() if path.name.endswith(ends)), None)


def _side_files(photo: Path) -> tuple[tuple[str, Path], ...]:
    here = [(kind, photo.with_name(photo.stem + end)) for kind, ends in SIDE_FILES.items() for end in ends]
    side_files = [(kind, path) for kind, path in here if path.is_file()]
    twice = next((k for k, n in Counter(kind for kind, _ in side_files).items() if n > 1), None)
    if twice is not None:
        raise InputError(f"{photo}: there are two files of its {twice}; keep one of them")
    return tuple(side_files)
