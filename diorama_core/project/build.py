"""A photo's way into a project: run the pipeline there and keep everything it found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from diorama_core.artefacts import Inputs
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.fallback import ChooseStages, with_usable_networks
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import SILENT, Progress
from diorama_core.project.further_photos import note_placed
from diorama_core.project.reasons import save_reasons
from diorama_core.project.storage import Project
from diorama_core.protocols import Preview


def build_project(
    project: Project,
    inputs: Inputs,
    library: ShapeLibrary,
    *,
    choose: ChooseStages | None = None,
    warnings: Sequence[str] = (),
    progress: Progress = SILENT,
    preview: Preview | None = None,
    save_scene: bool = True,
) -> Built:
    """Build the scene of `inputs` in the project's folder and save inputs, scene, textures and what was used.

    A network that fails is left out, and the project's notes say so. Boxes that a network found are saved with the
    inputs, so that people can correct them like their own. The inputs are saved first and stage results as they come,
    so an interrupted build resumes. The scene is replaced only when the build succeeded.

    Args:
        project: where.
        inputs: what the user gave.
        library: where shapes come from.
        choose: the stages; the auto profile without it.
        warnings: about the inputs, for the project's notes.
        progress: reports and cancellation.
        preview: receives the layout optimiser's intermediate scenes.
        save_scene: whether the scene is saved, too; otherwise the caller does, who may go on changing it.

    Raises:
        Cancelled: on request; the scene stays as it was.
        DioramaError: a stage cannot do its work, or the folder cannot be written.
    """
    project.save_inputs(inputs, warnings)
    built = build_with_usable_networks(
        inputs, library, choose, cache=project.stages_folder, progress=progress, preview=preview
    )
    save_artefacts(project, built, inputs, warnings)
    if save_scene:
        project.save_scene(built.scene)
    return built


def build_with_usable_networks(
    inputs: Inputs,
    library: ShapeLibrary,
    choose: ChooseStages | None = None,
    *,
    cache: Path | None = None,
    progress: Progress = SILENT,
    preview: Preview | None = None,
) -> Built:
    """`build_scene` with stages that are chosen again after a network failed; `Built.notes` names those left out.

    Args:
        inputs: as given.
        library: where shapes come from.
        choose: stages for the inputs; the best ones by default.
        cache: folder of stage results; None for none.
        progress: reports and cancellation.
        preview: called with the layout as it becomes.
    """

    def auto(store: ModelStore) -> Stages:
        return stages_for("auto", inputs, library, store=store)

    def build(stages: Stages) -> Built:
        return build_scene(inputs, library, stages=stages, cache=cache, progress=progress, preview=preview)

    built, left_out = with_usable_networks(choose or auto, build)
    return replace(built, notes=(*built.notes, *left_out))


def save_artefacts(project: Project, built: Built, given: Inputs, warnings: Sequence[str] = ()) -> None:
    """Save all of a build but its scene, in a project whose inputs are saved already.

    Args:
        project: whose folder is written.
        built: the build.
        given: the inputs before anything was chosen.
        warnings: to be kept with the project.

    Raises:
        ProjectError: the folder cannot be written.
    """
    corrected = with_found_boxes(given, built)
    if corrected is not given:
        project.save_inputs(corrected, warnings)
    project.save_textures(built.textures)
    note_placed(project, built.scene)
    project.save_stage_runs(built.runs)
    save_reasons(project, built.reasons)
    project.update_info(notes=[*warnings, *built.notes])


def with_found_boxes(given: Inputs, built: Built) -> Inputs:
    """The given inputs with the boxes that networks found, as they are saved; themselves where nothing was found.

    A build leaves guessed words out; they stay in what is saved.
    """
    is_given = [b.box for b in built.inputs.boxes] == [b.box for b in given.boxes]
    return given if is_given else replace(given, boxes=built.inputs.boxes)
