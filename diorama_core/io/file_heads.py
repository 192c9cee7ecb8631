"""The beginning of a file, or the names in a folder or an archive: what tells its form before anything reads it, and
what files are that nothing here reads.
"""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from diorama_core.errors import InputError

HEAD_BYTES = 65_536
MAX_NAMES = 20_000
MAX_DEPTH = 4
"""Folders below the one that is named."""


@dataclass(frozen=True)
class FileHead:
    """What can be known of a file or folder without reading it whole."""

    path: Path
    head: bytes = b""
    """Its first bytes; none of a folder."""
    names: tuple[str, ...] = ()
    """Files within a folder or a zip archive, with slashes."""
    size: int = 0

    @property
    def suffix(self) -> str:
        """Ending of its name, in small letters."""
        return self.path.suffix.lower()

    @property
    def is_folder(self) -> bool:
        """Whether it is a folder."""
        return self.path.is_dir()

    @property
    def is_zip(self) -> bool:
        """Whether it is a zip archive, whatever it is called."""
        return self.head[:4] in (b"PK\x03\x04", b"PK\x05\x06")

    @cached_property
    def text(self) -> str:
        """The first bytes as text; empty where they are none."""
        if b"\0" in self.head:
            return ""
        return self.head.decode("utf-8-sig", "replace").lstrip()

    def has(self, *endings: str) -> bool:
        """Whether a name within ends so: a path's last parts, or only an ending."""
        lower = tuple(e.lower() for e in endings)
        return any(f"/{name.lower()}".endswith(lower) for name in self.names)


def head_of(path: Path) -> FileHead:
    """The head of a file or a folder.

    Raises:
        InputError: there is no such file, or it cannot be opened.
    """
    try:
        if path.is_dir():
            return FileHead(path, names=_names_in(path))
        with path.open("rb") as stream:
            head = stream.read(HEAD_BYTES)
        file_head = FileHead(path, head, size=path.stat().st_size)
        return FileHead(path, head, _members(path), file_head.size) if file_head.is_zip else file_head
    except OSError as error:
        if not path.exists():
            raise InputError(f"{path} does not exist; check the path") from error
        raise InputError(f"{path} cannot be opened ({error.strerror or error})") from error


def _names_in(folder: Path) -> tuple[str, ...]:
    names: list[str] = []
    for here, folders, files in os.walk(folder):
        within = Path(here).relative_to(folder)
        if len(within.parts) >= MAX_DEPTH:
            folders.clear()
        folders[:] = sorted(f for f in folders if not f.startswith("."))
        names += [(within / name).as_posix() for name in sorted(files) if not name.startswith(".")]
        if len(names) >= MAX_NAMES:
            break
    return tuple(names[:MAX_NAMES])


def _members(path: Path) -> tuple[str, ...]:
    try:
        with zipfile.ZipFile(path) as archive:
            names = [i.filename for i in archive.infolist()[:MAX_NAMES] if not i.is_dir()]
    except (zipfile.BadZipFile, OSError, NotImplementedError, ValueError):
        return ()
    return tuple(n for n in names if not n.startswith("__MACOSX/") and not n.rsplit("/", 1)[-1].startswith("."))


@dataclass(frozen=True)
class OtherFile:
    """A form that is not read."""

    name: str
    advice: str
    tells: Callable[[FileHead], bool]


def what_else(head: FileHead) -> OtherFile | None:
    """What a file is that no reader takes; None where nobody knows."""
    return next((other for other in OTHER_FILES if other.tells(head)), None)


def _begins(*starts: bytes) -> Callable[[FileHead], bool]:
    return lambda head: head.head.startswith(starts)


def _ends(*suffixes: str) -> Callable[[FileHead], bool]:
    return lambda head: head.suffix in suffixes


def _says(*words: str) -> Callable[[FileHead], bool]:
    return lambda head: any(word in head.text[:4000] for word in words)


_PICTURES = (b"\xff\xd8\xff", b"\x89PNG", b"GIF8", b"II*\x00", b"MM\x00*")
OTHER_FILES = (
    OtherFile("an empty file", "export it again", lambda h: not h.is_folder and h.size == 0),
    OtherFile("a pointer of Git LFS, not the file", "fetch it: git lfs pull", _begins(b"version https://git-lfs")),
    OtherFile("a web page", "download the file itself", lambda h: h.text[:200].lower().startswith(("<!doctype html", "<html"))),
    OtherFile("a Blender file", "open it in Blender and export GLB", lambda h: h.head.startswith(b"BLENDER") or h.suffix == ".blend"),
    OtherFile("a SketchUp model", "export it as DAE, GLB or OBJ", _ends(".skp")),
    OtherFile("a Maya scene", "export it as FBX or GLB", lambda h: h.suffix in (".ma", ".mb") or h.text.startswith("//Maya")),
    OtherFile("a 3ds Max scene", "export it as FBX or OBJ", _ends(".max")),
    OtherFile("a Cinema 4D scene", "export it as FBX or GLB", _ends(".c4d")),
    OtherFile("a Rhino model", "export it as OBJ or GLB", lambda h: h.head.startswith(b"3D Geometry File Format") or h.suffix == ".3dm"),
    OtherFile("a Revit or ArchiCAD project", "export the room as GLB or FBX", _ends(".rvt", ".rfa", ".pln")),
    OtherFile("a STEP model", "export it as STL or OBJ from the CAD program", lambda h: h.suffix in (".step", ".stp") or (h.text.startswith("ISO-10303-21") and "IFC" not in h.text[:4000])),
    OtherFile("an IFC building model", "export the room as GLB", _says("FILE_SCHEMA(('IFC", "FILE_SCHEMA (('IFC")),
    OtherFile("an IGES model", "export it as STL or OBJ", _ends(".iges", ".igs")),
    OtherFile("a VRML or X3D scene", "export it as GLB", lambda h: h.text.startswith("#VRML") or "<X3D" in h.text[:2000] or h.suffix in (".wrl", ".x3d")),
    OtherFile("a DWG or DXF drawing", "export the room as GLB or Sweet Home 3D", lambda h: h.head[:4] == b"AC10" or h.suffix in (".dwg", ".dxf")),
    OtherFile("a Recap or Faro scan project", "export it as E57", _ends(".rcp", ".rcs", ".fls", ".lsproj")),
    OtherFile("compressed Gaussian splats", "export them as a plain PLY (SuperSplat: Export, uncompressed PLY)", _ends(".ksplat", ".spz", ".sog", ".ssog")),
    OtherFile("a recording of Record3D", "in Record3D export it as a PLY point cloud or as EXR and JPG", lambda h: h.suffix == ".r3d" or h.has("rgbd/0.depth")),
    OtherFile("ScanNet's sensor stream", "export its frames with SensReader", lambda h: h.suffix == ".sens" or h.has(".sens")),
    OtherFile("a folder of Hypersim", "build from a picture of it: diorama build PHOTO --depth FILE, with depth_meters saved as .npy", lambda h: h.has(".depth_meters.hdf5")),
    OtherFile("a rosbag", "export its depth and poses as TUM RGB-D", _ends(".bag", ".mcap", ".db3")),
    OtherFile("poses of nerfstudio", "they go with photos: diorama build PHOTOS --poses FILE", _says('"transform_matrix"')),
    OtherFile("boxes of objects in a photo", "they go with the photo: diorama build PHOTO --boxes FILE", _says('"bbox"', '"annotations"')),
    OtherFile("Diorama's own scene file", "open its project folder instead", _says('"diorama-scene"')),
    OtherFile("a Diorama project already", "open it: diorama serve PROJECT", lambda h: h.is_folder and {"project.json", "scene.json"} <= set(h.names)),
    OtherFile("a COLMAP model", "it goes with photos: diorama build PHOTOS --poses FOLDER", lambda h: h.is_folder and h.has("/cameras.bin", "/cameras.txt")),
    OtherFile("a folder of photos", "build a room from it: diorama build FOLDER", lambda h: h.is_folder and h.has(".jpg", ".jpeg", ".heic") and not h.has(".glb", ".obj", ".ply", ".usdz")),
    OtherFile("a folder of depth pictures without cameras", "build from one of its photos: diorama build PHOTO --depth FILE", lambda h: h.is_folder and h.has(".pgm", ".depth.png", "/depth/0.png", "/depth/000000.png", "/depth/00000.png")),
    OtherFile("a picture", "build a room from it: diorama build PHOTO", lambda h: h.head.startswith(_PICTURES) or h.head[4:12] in (b"ftypheic", b"ftypavif", b"ftypmif1") or h.head[8:12] == b"WEBP"),
    OtherFile("a film", "build a room from it: diorama build FILM", lambda h: h.suffix in (".mp4", ".mov", ".avi", ".mkv")),
    OtherFile("an array of numbers", "depth goes with its photo: diorama build PHOTO --depth FILE; points need three columns", lambda h: h.head.startswith(b"\x93NUMPY") or (h.is_zip and bool(h.names) and all(n.endswith(".npy") for n in h.names))),
    OtherFile("a MATLAB file", "save depth as .npy or 16-bit PNG, points as XYZ", lambda h: h.head.startswith(b"MATLAB") or h.suffix == ".mat" or h.has(".mat")),
    OtherFile("an HDF5 file", "save depth as .npy or 16-bit PNG, points as XYZ", lambda h: h.head.startswith(b"\x89HDF") or h.suffix in (".h5", ".hdf5") or h.has(".h5", ".hdf5")),
    OtherFile("an archive that is not read", "unpack it first", lambda h: h.head.startswith((b"7z\xbc\xaf", b"Rar!", b"\x1f\x8b")) or h.suffix in (".tar", ".rar", ".7z")),
    OtherFile("a PDF", "a plan of it can be traced in the editor", _begins(b"%PDF")),
)  # fmt: skip
"""The first that tells a file says what it is."""
