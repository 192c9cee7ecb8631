"""Photos and descriptions become scenes."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from diorama_core.api.reconstruction import Reconstruction, open_library
from diorama_core.errors import InputError
from diorama_core.layout.settings import RecipeName

if TYPE_CHECKING:
    from diorama_core.artefacts import Inputs
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.models.store import ModelStore
    from diorama_core.perception.inputs.arrays import Boxes, Depth, Masks, Picture
    from diorama_core.perception.inputs.depth.kinds import DepthKind
    from diorama_core.perception.inputs.depth.reading import DepthEncoding
    from diorama_core.pipeline.choices import NetworkChoice
    from diorama_core.pipeline.fallback import ChooseStages
    from diorama_core.pipeline.presets import Profile
    from diorama_core.pipeline.stages import Stages
    from diorama_core.progress import Progress

log = logging.getLogger(__name__)

CAMERA_HEIGHTS_M = (0.1, 20.0)
"""From a camera on the floor to one on a gallery of a hall."""


def build(
    photo: Path | str | bytes | Picture,
    *,
    boxes: Path | str | bytes | Boxes | None = None,
    masks: Path | str | bytes | Masks | None = None,
    depth: Path | str | bytes | Depth | None = None,
    depth_scale: float | None = None,
    depth_encoding: DepthEncoding = "linear",
    depth_kind: DepthKind = "auto",
    intrinsics: tuple[float, float, float, float] | None = None,
    fov_deg: float | None = None,
    camera_height_m: float | None = None,
    distortion: Sequence[float] = (),
    half_turn: bool = False,
    flat: bool = False,
    profile: Profile = "auto",
    networks: NetworkChoice | None = None,
    recipe: RecipeName = "feasible",
    library: str | ShapeLibrary = "built-in",
    stages: Callable[[Stages], Stages] | None = None,
    output: Path | str | None = None,
    progress: Progress | None = None,
    warn: Callable[[str], None] = log.warning,
) -> Reconstruction:
    """Build a scene from a photo.

    Args:
        photo: path or content of a picture file, or its sRGB pixels.
        boxes: path or content of a file of boxes (docs/what-goes-in.md), or a list of
            `{"bbox": [x1, y1, x2, y2], "class": "chair"}`; in pixels of the upright original photo.
        masks: path or content of a picture with one colour or one id per object, a folder of masks, or an array of ids.
        depth: path or content of a depth map (docs/what-goes-in.md), or an array of metres; 0 and NaN where missing.
        depth_scale: units of depth per metre; by default whole numbers are millimetres and others metres, unless the
            picture contradicts it.
        depth_encoding: "sunrgbd" where a PNG's bits are rotated as in SUN RGB-D.
        depth_kind: "depth" along the optical axis, "distance" along the rays, "inverse", or its
            "root" or "logarithm", or "shifted" by a constant; by default inferred.
        intrinsics: fx, fy, cx, cy in pixels of the upright original photo.
        fov_deg: horizontal field of view in degrees, instead of `intrinsics`.
        camera_height_m: of the camera above the floor in metres, which makes the scale certain.
        distortion: of the lens, in OpenCV's order: k1, k2, p1, p2, k3; the photo is straightened before it is used.
            By default its own lines say whether the lens bends them; 0 leaves the photo as it is.
        half_turn: whether the photo and all that belongs to it are upside down, and are turned by 180 degrees.
        flat: whether the photo shows one direction although it looks like a panorama.
        profile: "auto" uses the networks on this machine, "embedded" none, "foundation" insists on the paper's.
        networks: detector and depth network by id, instead of the best ones on this machine.
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
    from diorama_core.perception.inputs import arrays as input_arrays
    from diorama_core.perception.inputs import read_inputs
    from diorama_core.progress import Progress

    read = read_inputs(
        input_arrays.photo_file(photo),
        depth=input_arrays.depth_file(depth),
        depth_scale=depth_scale,
        depth_encoding=depth_encoding,
        depth_kind=depth_kind,
        intrinsics=intrinsics,
        fov_deg=fov_deg,
        boxes=input_arrays.boxes_file(boxes),
        masks=input_arrays.masks_file(masks),
        half_turn=half_turn,
        flat=flat,
    )
    inputs, straightened = _straight(_set_camera_height(read.inputs, camera_height_m), distortion)
    warnings = (*read.warnings, *straightened)
    for warning in warnings:
        warn(warning)
    opened, name = _open(library)
    choose = _choice(inputs, opened, profile, recipe, stages, networks)
    return _build(inputs, warnings, opened, name, choose, output, progress or Progress())


def _set_camera_height(inputs: Inputs, height_m: float | None) -> Inputs:
    low, high = CAMERA_HEIGHTS_M
    if height_m is not None and not low <= height_m <= high:
        raise InputError(f"a camera {height_m:g} m above the floor is not possible; give {low:g} to {high:g} m")
    return inputs if height_m is None else replace(inputs, camera_height_m=height_m)


def build_from_text(
    prompt: str,
    *,
    seed: int = 0,
    profile: Profile = "auto",
    recipe: RecipeName = "feasible",
    library: str | ShapeLibrary = "built-in",
    stages: Callable[[Stages], Stages] | None = None,
    output: Path | str | None = None,
    progress: Progress | None = None,
    warn: Callable[[str], None] = log.warning,
) -> Reconstruction:
    """Build a scene from a description: a room composed from the library's shapes, with every unmet wish named.

    A language model, where the environment names one (DIORAMA_LMM_BASE_URL), lists what the room holds and mends the
    result. Where it names an image endpoint (DIORAMA_IMAGE_BASE_URL), that draws a picture, which `build` reads like a
    photo.

    Args:
        prompt: description of the room and its furniture, in English.
        seed: random seed of the room.
        profile, recipe, stages: as for `build`, for the picture of an image endpoint; a composed room needs none.
        library, output, progress, warn: as for `build`.

    Raises:
        InputError: the prompt cannot be used.
        UnavailableError: the endpoint does not answer.
        LibraryError, ProjectError, Cancelled: as for `build`.
    """
    from diorama_core.progress import Progress
    from diorama_core.text.pictures import ImageSettings, picture_of

    progress = progress or Progress()
    opened, name = _open(library)
    endpoint = ImageSettings.from_environment()
    if endpoint is None:
        return _compose(prompt, opened, name, seed, output, progress, warn)
    made = picture_of(prompt, endpoint, progress.part(0.0, 0.2))
    for note in made.notes:
        warn(note)
    choose = _choice(made.inputs, opened, profile, recipe, stages)
    return _build(made.inputs, made.notes, opened, name, choose, output, progress.part(0.2, 1.0))


def _compose(
    prompt: str,
    library: ShapeLibrary,
    library_name: str | None,
    seed: int,
    output: Path | str | None,
    progress: Progress,
    warn: Callable[[str], None],
) -> Reconstruction:
    """The composed room of a description, saved in a project folder where one is given."""
    from diorama_core.perception.language.client import LmmSettings
    from diorama_core.project.lock import ProjectLock
    from diorama_core.project.storage import Project
    from diorama_core.text.scene_from_text import scene_from_text

    made = scene_from_text(prompt, library, seed=seed, language_model=LmmSettings.from_environment(), progress=progress)
    for note in made.notes:
        warn(note)
    project = None if output is None else Project.create(Path(output))
    if project is not None:
        with ProjectLock(project.folder, "diorama text"):
            if library_name is not None:
                project.update_info(library=library_name)
            project.save_textures(made.textures)
            project.save_scene(made.scene)
            project.update_info(notes=list(made.notes))
    return Reconstruction(
        scene=made.scene,
        library=library,
        textures=made.textures,
        warnings=made.notes,
        library_name=library_name,
        project=project,
    )


def _straight(inputs: Inputs, distortion: Sequence[float]) -> tuple[Inputs, tuple[str, ...]]:
    """The inputs without the distortion that is given, or that the photo's own lines tell; and what was done."""
    from diorama_core.multiview.lens import lens_of, without_distortion
    from diorama_core.multiview.plumb_lines import undistort_by_lines

    if not distortion:
        straight, notes = undistort_by_lines(inputs)
        return straight, tuple(f"{note}: --distortion 0 leaves it as it is" for note in notes)
    lens = lens_of(distortion)
    return (without_distortion(inputs, lens) if lens.bends else inputs), ()


def _open(library: str | ShapeLibrary) -> tuple[ShapeLibrary, str | None]:
    """A library and the name that opens it again, if it has one."""
    return (open_library(library), library) if isinstance(library, str) else (library, None)


def _choice(
    inputs: Inputs,
    library: ShapeLibrary,
    profile: Profile,
    recipe: str,
    change: Callable[[Stages], Stages] | None,
    networks: NetworkChoice | None = None,
) -> ChooseStages:
    """How the stages are chosen for the networks that can be used."""
    from diorama_core.pipeline.presets import stages_for

    def choose(store: ModelStore) -> Stages:
        stages = stages_for(profile, inputs, library, recipe=recipe, store=store, choice=networks)
        return stages if change is None else change(stages)

    return choose


def _build(
    inputs: Inputs,
    warnings: tuple[str, ...],
    library: ShapeLibrary,
    library_name: str | None,
    choose: ChooseStages,
    output: Path | str | None,
    progress: Progress,
) -> Reconstruction:
    """The scene of `inputs`, built in a project folder or, without one, in memory.

    Small products are sooner done by one thread than by several that wait for each other; and all machines and the
    command line add in one order.
    """
    from threadpoolctl import threadpool_limits

    from diorama_core.project.build import build_project, build_with_usable_networks
    from diorama_core.project.lock import ProjectLock
    from diorama_core.project.storage import Project

    project = None if output is None else Project.create(Path(output))
    with threadpool_limits(1, "blas"):
        if project is None:
            built = build_with_usable_networks(inputs, library, choose, progress=progress)
        else:
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
