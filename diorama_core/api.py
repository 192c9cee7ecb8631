"""The public interface: photos and descriptions become scenes, which are optimised, drawn, saved and exported.

Each function imports what it needs when it is called: loading a project costs nothing of what building one does.
`diorama_core.__all__` lists what of this module is public.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.artefacts import Inputs, LayoutReport
    from diorama_core.export import Format
    from diorama_core.export.gathering import ExportOptions, ExportScene
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.models.store import ModelStore
    from diorama_core.perception.input_arrays import Boxes, Depth, Masks, Picture
    from diorama_core.perception.input_depth import DepthEncoding
    from diorama_core.pipeline.fallback import ChooseStages
    from diorama_core.pipeline.presets import Profile
    from diorama_core.pipeline.run import Built
    from diorama_core.pipeline.stages import Stages
    from diorama_core.progress import Progress
    from diorama_core.project.storage import Project
    from diorama_core.protocols import LayoutStage, Preview
    from diorama_core.scene.types import Scene

log = logging.getLogger(__name__)

Recipe = Literal["feasible", "paper", "all-in-one"]


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


def build(
    photo: Path | str | bytes | Picture,
    *,
    boxes: Path | str | bytes | Boxes | None = None,
    masks: Path | str | bytes | Masks | None = None,
    depth: Path | str | bytes | Depth | None = None,
    depth_scale: float = 1000.0,
    depth_encoding: DepthEncoding = "linear",
    intrinsics: tuple[float, float, float, float] | None = None,
    fov_deg: float | None = None,
    profile: Profile = "auto",
    recipe: Recipe = "feasible",
    library: str | ShapeLibrary = "built-in",
    stages: Callable[[Stages], Stages] | None = None,
    output: Path | str | None = None,
    progress: Progress | None = None,
    warn: Callable[[str], None] = log.warning,
) -> Reconstruction:
    """Build a scene from a photo.

    Args:
        photo: path or content of a picture file, or its sRGB pixels.
        boxes: path or content of a JSON list of `{"bbox": [x1, y1, x2, y2], "class": "chair"}`, or that list; in pixels
            of the upright original photo.
        masks: PNG with one colour or one id per object, black or 0 for background; or an array of ids.
        depth: z in camera: 16-bit PNG in 1 / `depth_scale` metres, `.npy` or EXR in metres, or an array of metres; 0
            and NaN where missing.
        depth_scale: units per metre of a PNG.
        depth_encoding: "sunrgbd" where a PNG's bits are rotated as in SUN RGB-D.
        intrinsics: fx, fy, cx, cy in pixels of the upright original photo.
        fov_deg: horizontal field of view in degrees, instead of `intrinsics`.
        profile: "auto" uses the networks on this machine, "embedded" none, "foundation" insists on the paper's.
        recipe: of the layout optimiser.
        library: where shapes come from: a library, or a name that `open_library` understands.
        stages: maps the profile's stages to those that run:
            `lambda stages: dataclasses.replace(stages, camera=MyCamera())`.
        output: project folder to build in. Stage results are cached there, and an interrupted build resumes.
        progress: reports and cancellation.
        warn: receives each warning about the inputs; logs it by default.

    Raises:
        InputError: an input cannot be used.
        LibraryError: the library does not exist.
        UnavailableError: the foundation profile lacks a network.
        ProjectError: `output` cannot be written, or holds something else.
        Cancelled: on request; finished stages stay in the cache of `output`.
    """
    from diorama_core.perception import input_arrays
    from diorama_core.perception.inputs import read_inputs

    read = read_inputs(
        input_arrays.photo_file(photo),
        depth=input_arrays.depth_file(depth),
        depth_scale=depth_scale,
        depth_encoding=depth_encoding,
        intrinsics=intrinsics,
        fov_deg=fov_deg,
        boxes=input_arrays.boxes_file(boxes),
        masks=input_arrays.masks_file(masks),
    )
    for warning in read.warnings:
        warn(warning)
    opened, name = _opened(library)
    choose = _choice(read.inputs, opened, profile, recipe, stages)
    return _built(read.inputs, read.warnings, opened, name, choose, output, progress)


def build_from_text(
    prompt: str,
    *,
    seed: int = 0,
    profile: Profile = "auto",
    recipe: Recipe = "feasible",
    library: str | ShapeLibrary = "built-in",
    stages: Callable[[Stages], Stages] | None = None,
    output: Path | str | None = None,
    progress: Progress | None = None,
    warn: Callable[[str], None] = log.warning,
) -> Reconstruction:
    """Build a scene from a description: a picture is made first, then `build` reads it like a photo.

    The picture comes from the image endpoint that the environment names (DIORAMA_IMAGE_BASE_URL), or else is composed
    of the library's shapes and rendered.

    Args:
        prompt: description of the room and its furniture, in English.
        seed: random seed of the room.
        profile, recipe, library, stages, output, progress, warn: as for `build`.

    Raises:
        InputError: the prompt cannot be used.
        UnavailableError: the endpoint does not answer.
        LibraryError, ProjectError, Cancelled: as for `build`.
    """
    from diorama_core.progress import Progress
    from diorama_core.text.pictures import ImageSettings, picture_of

    progress = progress or Progress()
    opened, name = _opened(library)
    endpoint = ImageSettings.from_environment()
    made = picture_of(prompt, opened, seed=seed, endpoint=endpoint, progress=progress.part(0.0, 0.2))
    for note in made.notes:
        warn(note)
    choose = _choice(made.inputs, opened, profile, recipe, stages)
    return _built(made.inputs, made.notes, opened, name, choose, output, progress.part(0.2, 1.0))


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
    from diorama_core.project.build import save_built
    from diorama_core.project.storage import Project

    project, own = Project.create(Path(folder)), reconstruction.project
    if own is not None and own.folder.resolve() == project.folder.resolve():
        project.save_scene(reconstruction.scene)
        return
    inputs, built = reconstruction.inputs, reconstruction.built
    if reconstruction.library_name is not None:
        project.update_info(library=reconstruction.library_name)
    if inputs is not None:
        project.save_inputs(inputs, reconstruction.warnings)
    if inputs is not None and built is not None:
        save_built(project, replace(built, scene=reconstruction.scene), inputs, reconstruction.warnings)
    else:
        project.save_textures(reconstruction.textures)
        project.save_scene(reconstruction.scene)


def optimise(
    reconstruction: Reconstruction,
    *,
    recipe: Recipe | LayoutStage = "feasible",
    progress: Progress | None = None,
    preview: Preview | None = None,
) -> Reconstruction:
    """The same with a layout in which objects rest on their supports and do not overlap.

    Args:
        reconstruction: its scene is optimised.
        recipe: "feasible" (exact and fast), "paper" (the published four stages), "all-in-one" (its ablation), or an
            implementation of `diorama_core.protocols.LayoutStage`.
        progress: reports and cancellation.
        preview: receives intermediate scenes and their costs.

    Returns:
        The optimised scene, with costs before and after in `.layout`.

    Raises:
        InputError: there is no such recipe.
        Cancelled: on request.
    """
    from diorama_core.layout import recipes
    from diorama_core.progress import Progress
    from diorama_core.scene.edits import set_metrics

    if isinstance(recipe, str):
        inputs = reconstruction.inputs
        measured = inputs is not None and inputs.depth_m is not None
        recipe = recipes.recipe(recipe, reconstruction.library, depth_measured=measured)
    scene, report = recipe.optimise(reconstruction.scene, progress or Progress(), preview)
    return replace(reconstruction, scene=set_metrics(scene, report.after), layout=report)


def export(
    reconstruction: Reconstruction,
    path: Path | str,
    *,
    format: str | Format | None = None,
    options: ExportOptions | None = None,
    progress: Progress | None = None,
) -> ExportScene:
    """Write the scene as a file for other programs, whole or not at all, and return what was written.

    Args:
        reconstruction: what to write; hidden objects are left out.
        path: the file; an existing one is replaced.
        format: a key of `diorama_core.export.FORMATS`; by default the one whose files usually end like this one.
        options: what of the scene is written, and how; see `diorama_core.export.gathering.ExportOptions`.
        progress: reports and cancellation.

    Raises:
        ExportError: the format does not exist, or the file cannot be written.
        UnavailableError: an optional library is missing.
        LibraryError: a shape is missing.
        Cancelled: on request; an older file at `path` stays as it was.
    """
    from diorama_core.export import export_scene

    path, project, inputs = Path(path), reconstruction.project, reconstruction.inputs
    return export_scene(
        reconstruction.scene,
        reconstruction.library,
        path,
        format or _usual_format(path),
        options=options,
        textures=reconstruction.textures,
        photo=None if inputs is None else inputs.photo.rgb,
        name=None if project is None else project.name,
        provenance=None if project is None else project.info(),
        progress=progress,
    )


def render(reconstruction: Reconstruction, *, view: str = "photo", size: tuple[int, int] | None = None) -> Picture:
    """A picture of the scene, sRGB.

    Args:
        reconstruction: what to draw; hidden objects are left out.
        view: "photo" (the photo's camera), "top", "front", "orbit:DEG" (from outside, DEG degrees around from the
            front), or "planes" (floor, walls and ceiling drawn over the photo).
        size: width and height in pixels; by default the photo's, at most 1280 wide, or 1024 x 768.

    Raises:
        InputError: there is no such view or size, or the scene has no photo for "planes".
        SceneError: the scene has no camera for "photo".
        LibraryError: a shape is missing.
    """
    if view == "planes":
        return _planes_over_photo(reconstruction, size)
    from diorama_core.render.picture import picture

    return picture(reconstruction.scene, reconstruction.library, view=view, size=size, textures=reconstruction.textures)


def _planes_over_photo(reconstruction: Reconstruction, size: tuple[int, int] | None) -> Picture:
    import cv2

    from diorama_core.render.planes_over_photo import planes_over_photo

    inputs, scene = reconstruction.inputs, reconstruction.scene
    if inputs is None or scene.camera is None:
        raise InputError("this scene has no photo to draw over; choose another view, such as top")
    rgb = inputs.photo.rgb if size is None else cv2.resize(inputs.photo.rgb, size, interpolation=cv2.INTER_AREA)
    return planes_over_photo(rgb, scene.architecture.planes, scene.camera)


def _usual_format(path: Path) -> str:
    from diorama_core.export import FORMATS

    ending = path.suffix.lower()
    return next((name for name, f in FORMATS.items() if f.suffixes[0] == ending), ending.removeprefix("."))


def _opened(library: str | ShapeLibrary) -> tuple[ShapeLibrary, str | None]:
    """A library and the name that opens it again, if it has one."""
    return (open_library(library), library) if isinstance(library, str) else (library, None)


def _choice(
    inputs: Inputs,
    library: ShapeLibrary,
    profile: Profile,
    recipe: str,
    change: Callable[[Stages], Stages] | None,
) -> ChooseStages:
    """How the stages are chosen for the networks that can be used."""
    from diorama_core.pipeline.presets import stages_for

    def choose(store: ModelStore) -> Stages:
        stages = stages_for(profile, inputs, library, recipe=recipe, store=store)
        return stages if change is None else change(stages)

    return choose


def _built(
    inputs: Inputs,
    warnings: tuple[str, ...],
    library: ShapeLibrary,
    library_name: str | None,
    choose: ChooseStages,
    output: Path | str | None,
    progress: Progress | None,
) -> Reconstruction:
    """The scene of `inputs`, built in a project folder or, without one, in memory."""
    from diorama_core.project.build import build_project, build_with_usable_networks
    from diorama_core.project.lock import ProjectLock
    from diorama_core.project.storage import Project

    project = None
    if output is None:
        built = build_with_usable_networks(inputs, library, choose, progress=progress)
    else:
        project = Project.create(Path(output))
        with ProjectLock(project.folder, "diorama build"):
            if library_name is not None:
                project.update_info(library=library_name)
            built = build_project(project, inputs, library, choose=choose, warnings=warnings, progress=progress)
    return Reconstruction(
        scene=built.scene,
        library=library,
        textures=built.textures,
        given=replace(inputs, boxes=built.inputs.boxes),
        built=built,
        stages=built.stages,
        layout=built.layout,
        warnings=warnings,
        library_name=library_name,
        project=project,
    )
