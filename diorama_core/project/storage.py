"""A project is a folder: `project.json`, `photo.jpg`, `scene.json`, `textures/`, `stages/`, `backups/`, `exports/`.

Every write goes to a temporary file that is renamed, so the folder is whole at any moment.
"""

from __future__ import annotations

import io
import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.artefacts import Inputs, Photo
from diorama_core.errors import ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.pipeline import codec
from diorama_core.pipeline.runner import StageRun
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.types import Scene

FORMAT = "diorama-project"
VERSION = 1
MAX_BACKUPS = 20
BACKUP_EVERY_S = 60.0


@dataclass(frozen=True)
class Project:
    """One project's folder. Holds no state besides its place; safe to open twice."""

    folder: Path

    @classmethod
    def create(cls, folder: Path, *, name: str | None = None) -> Project:
        """Make the folder a project; one that already is stays as it is.

        Raises:
            ProjectError: the folder cannot be written, or holds other things.
        """
        project = cls(Path(folder))
        if project._info_path.exists():
            return cls.open(folder)
        if project.folder.exists() and not project.folder.is_dir():
            raise ProjectError(f"{folder} is a file, not a folder; choose another place for the project")
        if project.folder.exists() and any(project.folder.iterdir()):
            raise ProjectError(f"{folder} holds other files and is not a project; choose a new or an empty folder")
        project._write_info({"name": name or project.folder.name, "created": time.strftime("%Y-%m-%dT%H:%M:%S")})
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
        return str(self.info().get("name", self.folder.name))

    @property
    def library_name(self) -> str:
        """The library that it was built with; the built-in one where none is noted."""
        return str(self.info().get("library", "built-in"))

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
            info = json.loads(self._info_path.read_text())
        except (OSError, json.JSONDecodeError) as error:
            raise ProjectError(
                f"{self._info_path} cannot be read ({error}); restore it or build the project again"
            ) from error
        if not isinstance(info, dict) or info.get("format") != FORMAT:
            raise ProjectError(f"{self._info_path} is not a Diorama project file")
        if info.get("version", 0) > VERSION:
            raise ProjectError(f"{self.folder} was written by a newer Diorama; update the program to open it")
        return info

    def update_info(self, **changes: Any) -> None:
        """Change entries of `project.json`."""
        self._write_info({**self.info(), **changes})

    def save_inputs(self, inputs: Inputs, warnings: Sequence[str] = ()) -> None:
        """Keep what the user gave, the photo also as a picture for people."""
        write_atomically(self.stages_folder / "inputs.zip", codec.dump(inputs), error=ProjectError)
        write_atomically(self.folder / "photo.jpg", _jpeg(inputs.photo.rgb), error=ProjectError)
        self.update_info(photo=inputs.photo.name, warnings=list(warnings))

    def load_inputs(self) -> Inputs | None:
        """What the user gave, or None for a project without a photo."""
        path = self.stages_folder / "inputs.zip"
        if not path.exists():
            return None
        inputs = codec.load(path.read_bytes())
        if not isinstance(inputs, Inputs):
            raise ProjectError(f"{path} does not hold a photo; build the project again")
        return inputs

    def photo(self) -> Photo | None:
        """The photo the project was made from."""
        inputs = self.load_inputs()
        return None if inputs is None else inputs.photo

    def save_scene(self, scene: Scene) -> None:
        """Write `scene.json`; the previous one is kept among the backups (at most one a minute)."""
        text = scene_to_json(scene)
        self._back_up(emptied=not scene.objects)
        write_atomically(self.scene_path, text.encode(), error=ProjectError)

    def load_scene(self) -> Scene:
        """Read `scene.json`; raises `ProjectError` when there is none yet, `SceneError` when it is wrong."""
        if not self.scene_path.exists():
            raise ProjectError(f"{self.folder} has no scene yet; run 'diorama build' with this project's photo")
        return scene_from_json(self.scene_path.read_text())

    def backups(self) -> tuple[Path, ...]:
        """Earlier scene files, newest first."""
        return tuple(sorted((self.folder / "backups").glob("scene-*.json"), reverse=True))

    def save_stage_runs(self, runs: Sequence[StageRun]) -> None:
        """Record which stage used what, and how long it took."""
        self.update_info(stages=[asdict(r) for r in runs])

    def save_textures(self, textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]) -> None:
        """Keep the planes' pictures under their names."""
        for name, picture in textures.items():
            write_atomically(self._texture_path(name), _jpeg(picture), error=ProjectError)

    def texture(self, name: str) -> UInt8[np.ndarray, "h w 3"] | None:
        """A plane's picture, or None when it is missing."""
        path = self._texture_path(name)
        return np.asarray(Image.open(path).convert("RGB")) if path.exists() else None

    def textures(self, scene: Scene) -> dict[str, UInt8[np.ndarray, "_ _ 3"]]:
        """All pictures that the scene's planes name."""
        names = {p.texture for p in scene.architecture.planes if p.texture is not None}
        found = {name: self.texture(name) for name in sorted(names)}
        return {name: picture for name, picture in found.items() if picture is not None}

    def _texture_path(self, name: str) -> Path:
        # A scene file from elsewhere must not reach outside the project.
        return self.folder / "textures" / f"{Path(name).name}.jpg"

    def _write_info(self, info: Mapping[str, Any]) -> None:
        document = {
            "format": FORMAT,
            "version": VERSION,
            **{k: v for k, v in info.items() if k not in ("format", "version")},
        }
        write_atomically(self._info_path, json.dumps(document, indent=1).encode(), error=ProjectError)

    def _back_up(self, *, emptied: bool) -> None:
        if not self.scene_path.exists():
            return
        known = self.backups()
        recent = bool(known) and time.time() - known[0].stat().st_mtime < BACKUP_EVERY_S
        if recent and not emptied:
            return
        stamp = time.strftime("%Y%m%d-%H%M%S") + f"-{time.time_ns() % 1_000_000_000:09d}"
        backup = self.folder / "backups" / f"scene-{stamp}.json"
        write_atomically(backup, self.scene_path.read_bytes(), error=ProjectError)
        for old in self.backups()[MAX_BACKUPS:]:
            old.unlink(missing_ok=True)


def _jpeg(rgb: UInt8[np.ndarray, "h w 3"]) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(rgb).save(buffer, "JPEG", quality=92)
    return buffer.getvalue()
