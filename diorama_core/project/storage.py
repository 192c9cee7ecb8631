"""A project is a folder: `project.json`, `photo.jpg`, `scene.json`, `textures/`, `shapes/`, `stages/`, `backups/`,
`exports/`.

Every write goes to a temporary file that is renamed, so the folder is whole at any moment.
"""

from __future__ import annotations

import io
import logging
import shutil
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.artefacts import Inputs, Photo
from diorama_core.errors import ProjectError, SceneError
from diorama_core.io.atomic import write_atomically, write_document, write_json
from diorama_core.io.bounded import MAX_JSON_BYTES, parse_json, read_bytes, read_picture, shorten
from diorama_core.io.text import file_label
from diorama_core.library.library_names import BUILT_IN, ESCAPED_PLUS
from diorama_core.pipeline import codec
from diorama_core.pipeline.runner import StageRun
from diorama_core.project.backups import Backups
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.types import Scene

FORMAT = "diorama-project"
VERSION = 1
MAX_INFO_BYTES = 4_000_000
MAX_NAME = 120
JPEG_QUALITY = 92
MAX_UPLOAD_BYTES = 256 * 1024 * 1024
MAX_TEXTURE_PIXELS = 200_000_000
"""Texture pixels of a whole scene together; the rest are shown in their plain colour."""

OWN_SHAPES = "./shapes"
"""Part of a library's name in `project.json`: the shapes in the project's own folder."""
Upload = Literal["photo", "depth", "confidence", "masks"]
UPLOADS: tuple[Upload, ...] = ("photo", "depth", "confidence", "masks")

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Project:
    """One project's folder. Holds no state besides its place; safe to open twice."""

    folder: Path

    @classmethod
    def create(cls, folder: Path, *, name: str | None = None) -> Project:
        """Make the folder a project; one that already is stays as it is.

        Raises:
            ProjectError: the folder cannot be written, or holds other objects.
        """
        project = cls(Path(folder))
        if project._info_path.exists():
            return cls.open(folder)
        if project.folder.exists() and not project.folder.is_dir():
            raise ProjectError(f"{folder} is a file, not a folder; choose another place for the project")
        if project.folder.exists() and not all(_is_leftover(f) for f in project.folder.iterdir()):
            raise ProjectError(f"{folder} holds other files and is not a project; choose a new or an empty folder")
        project._write_info(
            {"name": name or file_label(project.folder.name), "created": time.strftime("%Y-%m-%dT%H:%M:%S")}
        )
        return project

    @classmethod
    def open(cls, folder: Path) -> Project:
        """An existing project.

        Raises:
            ProjectError: there is none, or a newer program wrote it.
        """
        project = cls(Path(folder))
        if not project._info_path.exists():
            raise ProjectError(
                f"{folder} is not a project (no project.json); make one with 'diorama build IMAGE -o {folder}'"
            )
        project.info()
        return project

    @property
    def name(self) -> str:
        """What people call the project."""
        name = self.info().get("name")
        given = shorten(name, MAX_NAME) if isinstance(name, str) else ""
        return given or shorten(file_label(self.folder.name), MAX_NAME)

    @property
    def library_name(self) -> str:
        """The library that it was built with, its own shapes included; the built-in one where none is noted."""
        path = str(self.shapes_folder.resolve()).replace("+", ESCAPED_PLUS)
        return "+".join(path if part == OWN_SHAPES else part for part in self._library_parts())

    @property
    def shared_library_name(self) -> str:
        """The library without the shapes that belong to this project alone."""
        return "+".join(part for part in self._library_parts() if part != OWN_SHAPES) or BUILT_IN

    @property
    def shapes_folder(self) -> Path:
        """The library of the shapes that came with an imported scene, where one did."""
        return self.folder / Path(OWN_SHAPES)

    def _library_parts(self) -> list[str]:
        return str(self.info().get("library", BUILT_IN)).split("+")

    @property
    def stages_folder(self) -> Path:
        """Where stage results are kept."""
        return self.folder / "stages"

    @property
    def scene_path(self) -> Path:
        """The documented scene file."""
        return self.folder / "scene.json"

    @property
    def _info_path(self) -> Path:
        return self.folder / "project.json"

    def info(self) -> dict[str, Any]:
        """The content of `project.json`."""
        try:
            about = self._info_path.stat()
        except OSError as error:
            raise ProjectError(
                f"{self._info_path} cannot be read ({error.strerror}); restore it or build the project again"
            ) from error
        return dict(_info(self._info_path, about.st_mtime_ns, about.st_size, about.st_ino))

    def update_info(self, **changes: Any) -> None:
        """Change entries of `project.json`."""
        self._write_info({**self.info(), **changes})

    def save_inputs(self, inputs: Inputs, warnings: Sequence[str] = ()) -> None:
        """Keep what the user gave, the photo also as a picture for people."""
        path = self.stages_folder / "inputs.zip"
        write_document(path, codec.dump(inputs), _inputs_of, ProjectError, most=codec.MAX_BYTES)
        write_atomically(self.folder / "photo.jpg", jpeg(inputs.photo.rgb), error=ProjectError)
        self.update_info(photo=inputs.photo.name, warnings=list(warnings))

    def load_inputs(self) -> Inputs | None:
        """What the user gave, or None for a project without a photo."""
        path = self.stages_folder / "inputs.zip"
        if not path.exists():
            return None
        try:
            return _inputs_of(read_bytes(path, codec.MAX_BYTES, ProjectError))
        except ProjectError as error:
            raise ProjectError(f"{path}: the photo cannot be read back ({error}); build the project again") from error

    @property
    def has_scene(self) -> bool:
        """Whether a scene was built or saved here; a project begins with a photo alone."""
        return self.scene_path.exists()

    @property
    def has_photo(self) -> bool:
        """Whether there is a photo to build from."""
        return (self.stages_folder / "inputs.zip").exists()

    def take_shapes(self, other: Project) -> None:
        """Use another project's library, with a copy of the shapes that belong to it alone beside one's own.

        Raises:
            ProjectError: both have a shape of one name that are not the same.
        """
        if all((p.shapes_folder / "library.sqlite").exists() for p in (self, other)):
            from diorama_core.library.ingest.sink import Ingested
            from diorama_core.library.store.stored import StoredLibrary

            mine, theirs = StoredLibrary(self.shapes_folder), StoredLibrary(other.shapes_folder)
            known, shapes = {s.id: s.content_hash for s in mine.shapes()}, theirs.shapes()
            if clash := next((s.id for s in shapes if known.get(s.id, s.content_hash) != s.content_hash), None):
                raise ProjectError(f"both projects brought another model called {clash!r}; import one of them again")
            mine.add_all(
                Ingested(s, theirs.glb(s.id), theirs.thumbnail(s.id), theirs.source_key(s.id), theirs.warnings(s.id))
                for s in shapes
                if s.id not in known
            )
        elif other.shapes_folder.is_dir():
            shutil.copytree(other.shapes_folder, self.shapes_folder, dirs_exist_ok=True)
        self.update_info(library="+".join(other._library_parts()))

    def save_upload(self, kind: Upload, content: bytes | None) -> None:
        """Keep a file as it was given, so that others can be read together with it later; None forgets it."""
        if content is None:
            (self.folder / "uploads" / kind).unlink(missing_ok=True)
            return
        write_atomically(self.folder / "uploads" / kind, content, error=ProjectError)

    def uploads(self) -> dict[Upload, bytes]:
        """The files that were given, as they came."""
        paths: dict[Upload, Path] = {kind: self.folder / "uploads" / kind for kind in UPLOADS}
        return {kind: read_bytes(path, MAX_UPLOAD_BYTES, ProjectError) for kind, path in paths.items() if path.exists()}

    def has_upload(self, kind: Upload) -> bool:
        """Whether such a file was given."""
        return (self.folder / "uploads" / kind).exists()

    def photo(self) -> Photo | None:
        """The photo the project was made from."""
        inputs = self.load_inputs()
        return None if inputs is None else inputs.photo

    def save_scene(self, scene: Scene) -> bool:
        """Write `scene.json`; the previous one is kept among the backups (at most one a minute): True when it is.

        Raises:
            SceneError: the scene would not open again; nothing is written.
            ProjectError: the folder cannot be written.
        """
        content = scene_to_json(scene).encode()
        emptied = not scene.objects
        new_version = self.has_scene and Backups(self.folder / "backups").keep(self.scene_path, at_once=emptied)
        write_document(self.scene_path, content, scene_from_json, ProjectError)
        return new_version

    def load_scene(self) -> Scene:
        """Read `scene.json`; raises `ProjectError` when there is none yet, `SceneError` when it is wrong."""
        if not self.scene_path.exists():
            raise ProjectError(f"{self.folder} has no scene yet; run 'diorama build' with this project's photo")
        return read_scene(self.scene_path)

    def newest_scene(self) -> tuple[Scene, str]:
        """The scene, or of a damaged file the newest earlier version that can be read, and a line that says so.

        Raises:
            ProjectError, SceneError: as `load_scene`, when no version can be read.
        """
        try:
            return self.load_scene(), ""
        except SceneError as error:
            for path in self.backups():
                try:
                    scene = read_scene(path)
                except SceneError:
                    continue
                when = time.strftime("%d %b %H:%M", time.localtime(path.stat().st_mtime))
                return scene, f"{self.name}: the version of {when} is shown, since {error}"
            raise

    def backups(self) -> tuple[Path, ...]:
        """Earlier scene files, newest first."""
        return Backups(self.folder / "backups").paths()

    def save_stage_runs(self, runs: Sequence[StageRun]) -> None:
        """Record which stage used what, and how long it took."""
        self.update_info(stages=[asdict(r) for r in runs])

    def save_textures(self, textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]) -> None:
        """Keep the pictures of planes and objects under their names."""
        for name, picture in textures.items():
            write_atomically(self._texture_path(name), jpeg(picture), error=ProjectError)

    def texture(self, name: str) -> UInt8[np.ndarray, "h w 3"] | None:
        """A picture, or None when it is missing."""
        path = self._texture_path(name)
        return read_picture(path, ProjectError) if path.exists() else None

    def textures(self, scene: Scene) -> dict[str, UInt8[np.ndarray, "_ _ 3"]]:
        """All pictures that the scene's planes name, and its objects' materials from the photo."""
        names = {p.texture for p in scene.architecture.planes if p.texture is not None}
        names |= {p.photo_texture for p in scene.architecture.planes if p.photo_texture is not None}
        names |= {m.texture for o in scene.objects for m in o.photo_materials if m.texture is not None}
        textures: dict[str, UInt8[np.ndarray, "h w 3"]] = {}
        pixels = 0
        for name in sorted(names):
            try:
                picture = self.texture(name)
            except ProjectError as error:
                log.warning("a plane or an object is shown without its picture: %s", error)
                continue
            if picture is not None:
                pixels += picture.size // 3
                if pixels <= MAX_TEXTURE_PIXELS:
                    textures[name] = picture
        return textures

    def _texture_path(self, name: str) -> Path:
        # A scene file from elsewhere must not reach outside the project.
        return self.folder / "textures" / f"{Path(name).name}.jpg"

    def _write_info(self, info: Mapping[str, Any]) -> None:
        document = {
            "format": FORMAT,
            "version": VERSION,
            **{k: v for k, v in info.items() if k not in ("format", "version")},
        }
        write_json(self._info_path, document, ProjectError, most=MAX_INFO_BYTES, indent=1)


def read_scene(path: Path) -> Scene:
    """A scene file.

    Raises:
        SceneError: unreadable, too large or wrong; says where.
    """
    return scene_from_json(read_bytes(path, MAX_JSON_BYTES, SceneError, "restore a backup"))


@lru_cache(maxsize=128)
def _info(path: Path, written_ns: int, size: int, inode: int) -> Mapping[str, Any]:
    """The content of a `project.json` as it was written then; asked for at every redraw of a page."""
    data = read_bytes(path, MAX_INFO_BYTES, ProjectError)
    info = parse_json(data, str(path), ProjectError, advice="restore it or build the project again")
    if not isinstance(info, dict) or info.get("format") != FORMAT:
        raise ProjectError(f"{path} is not a Diorama project file; restore it from a copy")
    version = info.get("version")
    if not isinstance(version, int) or isinstance(version, bool):
        raise ProjectError(f"{path} has no version number; restore it from a copy")
    if version > VERSION:
        raise ProjectError(f"{path.parent} was written by a newer Diorama; update the program to open it")
    return info


def _inputs_of(data: bytes) -> Inputs:
    """What the user gave, where everything that lies pixel on pixel over the photo has its size."""
    inputs: Inputs = codec.load(data, Inputs)
    size = inputs.photo.rgb.shape[:2]
    maps = (inputs.depth_m, inputs.instances, inputs.normals_camera)
    if min(size) < 1 or any(m is not None and m.shape[:2] != size for m in maps):
        raise ProjectError("depth or masks have another size than the photo")
    return inputs


def _is_leftover(path: Path) -> bool:
    """What a program that was killed left behind, or a lock: nothing of anybody's."""
    return path.name.startswith(".") and path.suffix in (".part", ".lock")


def jpeg(rgb: UInt8[np.ndarray, "h w 3"]) -> bytes:
    """A picture as a JPEG file of high quality."""
    buffer = io.BytesIO()
    Image.fromarray(rgb).save(buffer, "JPEG", quality=JPEG_QUALITY)
    return buffer.getvalue()
