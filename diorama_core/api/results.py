"""Scenes are optimised, drawn and exported."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from diorama_core.api.reconstruction import Reconstruction
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.export import Format
    from diorama_core.export.gathering import ExportOptions, ExportScene
    from diorama_core.layout.settings import RecipeName
    from diorama_core.perception.inputs.arrays import Picture
    from diorama_core.progress import Progress
    from diorama_core.protocols import LayoutStage, Preview


def optimise(
    reconstruction: Reconstruction,
    *,
    recipe: RecipeName | LayoutStage = "feasible",
    progress: Progress | None = None,
    preview: Preview | None = None,
) -> Reconstruction:
    """Lay out a reconstruction so that objects rest on their supports and do not overlap.

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
    scene, report = recipes.RoomByRoom(recipe).optimise(reconstruction.scene, progress or Progress(), preview)
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
    from diorama_core.progress import Progress

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
        progress=progress or Progress(),
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
