"""A scene with what belongs to it: its project folders, and how a notebook shows it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from diorama_core.artefacts import Inputs, LayoutReport
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.perception.inputs.arrays import Picture
    from diorama_core.pipeline.run import Built
    from diorama_core.pipeline.stages import Stages
    from diorama_core.project.storage import Project
    from diorama_core.scene.types import Scene

import base64
import html
import io
from typing import TYPE_CHECKING

from diorama_core.io.text import number_of

if TYPE_CHECKING:
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.perception.inputs.arrays import Picture
    from diorama_core.scene.types import Scene

SIZE, WITHOUT_PHOTO = (480, 360), "orbit:35"
"""A picture of this size takes a second or two."""
QUALITY = 85


def notebook_html(scene: Scene, library: ShapeLibrary, textures: Mapping[str, Picture]) -> str:
    """The scene as HTML.

    Args:
        scene: what is shown.
        library: where its shapes are.
        textures: pictures of its planes.
    """
    head = html.escape(f"{number_of(len(scene.objects))}, {number_of(len(scene.architecture.planes), 'plane')}")
    if not scene.objects and not scene.architecture.planes:
        return f"<p>{head}</p>"
    rows = "".join(
        f"<tr><td>{html.escape(o.id)}</td><td>{html.escape(o.label)}</td>"
        f"<td>{' × '.join(f'{side:.2f}' for side in o.size_m)}</td></tr>"
        for o in scene.objects
    )
    table = f"<table><tr><th>id</th><th>name</th><th>depth × width × height, m</th></tr>{rows}</table>"
    picture = f'<img alt="{head}" src="data:image/jpeg;base64,{_picture(scene, library, textures)}">'
    return f"<div>{picture}<details><summary>{head}</summary>{table}</details></div>"


def _picture(scene: Scene, library: ShapeLibrary, textures: Mapping[str, Picture]) -> str:
    from PIL import Image

    from diorama_core.render.picture import picture

    content = io.BytesIO()
    view = "photo" if scene.camera is not None else WITHOUT_PHOTO
    Image.fromarray(picture(scene, library, view=view, size=SIZE, textures=textures)).save(
        content, "JPEG", quality=QUALITY
    )
    return base64.b64encode(content.getvalue()).decode()


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """A scene with the library of its shapes, the pictures of its planes and what it was made from.

    A value: `optimise` returns a new one, and `dataclasses.replace(room, scene=...)` gives one with another scene.
    """

    scene: Scene
    """Camera, architecture, objects and support graph; frames and units as in `diorama_core.scene.frames`."""
    library: ShapeLibrary
    """Where the shapes of the scene's objects are."""
    textures: Mapping[str, Picture]
    """Pictures of the planes, sRGB, by `Plane.texture`."""
    given: Inputs | None = None
    """What the user gave and the boxes that a network found, where this was built; see `inputs`."""
    built: Built | None = None
    """Artefacts of all stages, where this was built; None where it was loaded."""
    stages: Stages | None = None
    """The implementations that built it; None where it was loaded."""
    layout: LayoutReport | None = None
    """Report of the last layout run; None where none ran."""
    warnings: tuple[str, ...] = ()
    """Warnings about the inputs."""
    library_name: str | None = None
    """Name that opens the library again; None where a library itself was given."""
    project: Project | None = None
    """The project folder that it was loaded from or built in."""

    @property
    def inputs(self) -> Inputs | None:
        """The photo and what was given with it; None for a scene without a photo.

        Raises:
            ProjectError: the project's copy is damaged.
        """
        if self.given is not None or self.project is None:
            return self.given
        return self.project.load_inputs()

    def _repr_html_(self) -> str:
        """The scene as notebooks show it."""

        return notebook_html(self.scene, self.library, self.textures)

    def save(self, folder: Path | str) -> None:
        """Write a project folder; see `diorama_core.save`."""
        save(self, folder)


def open_library(name: str = "built-in") -> ShapeLibrary:
    """A library of shapes by name.

    Args:
        name: `built-in`; the name or the path of a stored library; or several joined by `+`.

    Raises:
        LibraryError: one of them does not exist.
    """
    from diorama_core.library import store

    return store.open_library(name)


def load(folder: Path | str, *, library: ShapeLibrary | None = None) -> Reconstruction:
    """The scene of a project folder.

    Args:
        folder: written by `save`, `build`, the command line or the editor.
        library: where its shapes are; by default the library that the project was built with.

    Raises:
        ProjectError: the folder is not a project, or has no scene.
        SceneError: the scene file is not valid.
        LibraryError: the project's library does not exist.
    """
    from diorama_core.project.storage import Project

    project = Project.open(Path(folder))
    scene, name = project.load_scene(), project.library_name
    return Reconstruction(
        scene=scene,
        library=library or open_library(name),
        textures=project.textures(scene),
        library_name=name,
        project=project,
    )


def save(reconstruction: Reconstruction, folder: Path | str) -> None:
    """Write a project folder, which `load`, the command line and the editor open.

    Args:
        reconstruction: what to save.
        folder: a new or empty folder, or a project, whose scene is replaced and remains among its backups.

    Raises:
        ProjectError: the folder cannot be written, or holds something else.
    """
    from diorama_core.project.build import save_artefacts
    from diorama_core.project.storage import Project

    project, source = Project.create(Path(folder)), reconstruction.project
    if source is not None and source.folder.resolve() == project.folder.resolve():
        project.save_scene(reconstruction.scene)
        return
    inputs, built = reconstruction.inputs, reconstruction.built
    if source is not None:
        project.take_shapes(source)
    elif reconstruction.library_name is not None:
        project.update_info(library=reconstruction.library_name)
    if inputs is not None:
        project.save_inputs(inputs, reconstruction.warnings)
    if inputs is not None and built is not None:
        save_artefacts(project, replace(built, scene=reconstruction.scene), inputs, reconstruction.warnings)
    else:
        project.save_textures(reconstruction.textures)
    project.save_scene(reconstruction.scene)
