"""From the user's inputs to a scene: the whole plan, then the layout optimiser."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import UInt8

from diorama_core.appearance.photo_appearance import photo_appearance
from diorama_core.architecture.room_extent import containing_room, without_floor_behind_walls
from diorama_core.architecture.texture.plane_textures import plane_textures
from diorama_core.architecture.texture.refit import refitted_textures
from diorama_core.artefacts import (
    ArchitectureEstimate,
    CameraEstimate,
    DepthMap,
    DetectedObject,
    Inputs,
    LayoutReport,
    ObjectGeometry,
    SceneGraph,
)
from diorama_core.layout.backs_to_walls import with_backs_to_walls
from diorama_core.layout.clear_shapes import clear_shapes
from diorama_core.layout.fitted_boards import fitted_boards
from diorama_core.layout.holding_shapes import holding_shapes
from diorama_core.layout.noise import MEASURED, REASONED, ObservationNoise
from diorama_core.layout.support_check import checked_supports
from diorama_core.layout.unmarked_supporters import left_where_seen, over_what_may_hold_them
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.illuminant import Illuminant
from diorama_core.pipeline.assemble import assemble
from diorama_core.pipeline.beside import prepare_processes
from diorama_core.pipeline.colours import photo_colours, room_illuminant, shared_by_sets
from diorama_core.pipeline.look_ahead import looking_ahead
from diorama_core.pipeline.plan import Artefacts, evaluate
from diorama_core.pipeline.provenance_text import camera_sentence, geometry_sentence, graph_sentence, room_sentence
from diorama_core.pipeline.runner import Runner, StageRun
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.processes import there
from diorama_core.progress import Progress
from diorama_core.protocols import Preview
from diorama_core.scene.edits import set_metrics
from diorama_core.scene.room_edits import floor_height, rescale_to_length
from diorama_core.scene.types import Architecture, Scene


@dataclass(frozen=True)
class Built:
    """A scene and everything it was derived from."""

    scene: Scene
    camera: CameraEstimate
    objects: tuple[DetectedObject, ...]
    geometry: ObjectGeometry
    graph: SceneGraph | None
    """What holds up what; None where no graph stage ran."""
    architecture: ArchitectureEstimate
    depth: DepthMap
    observed: Scene
    """The scene before the layout optimiser."""
    layout: LayoutReport | None
    """None when the scene has no objects."""
    textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
    """The pictures of planes and of objects' materials, by name."""
    illuminant: Illuminant
    """The photo's light, of which colours and pictures of the scene are free."""
    inputs: Inputs
    """What the user gave, with the boxes and the depth that networks added."""
    runs: tuple[StageRun, ...]
    """Which stage used what, and how long it took."""
    notes: tuple[str, ...] = ()
    """What the user should know, in plain words."""
    stages: Stages | None = None
    """The implementations that ran."""


def build_scene(
    inputs: Inputs,
    library: ShapeLibrary,
    *,
    stages: Stages | None = None,
    cache: Path | None = None,
    progress: Progress | None = None,
    preview: Preview | None = None,
    plane_pictures: bool = True,
) -> Built:
    """Run every stage.

    Args:
        inputs: what the user gave.
        library: where shapes come from.
        stages: implementations; the embedded ones by default.
        cache: folder for stage results; an interrupted run resumes from it.
        progress: reports and cancellation.
        preview: receives the layout optimiser's intermediate scenes.
        plane_pictures: whether floor, walls and ceiling get pictures.

    Raises:
        Cancelled: on request; finished stages stay in the cache.
        DioramaError: with the reason, when a stage cannot do its work.
    """
    prepare_processes()
    stages = stages or embedded_stages(inputs, library)
    progress = progress or Progress()
    runner = Runner(cache)
    with looking_ahead(stages.retrieval, inputs.boxes):
        found = evaluate(stages, {"given": inputs}, ("graph", "furniture"), runner, progress.part(0.0, 0.45))
    inputs, room = found["inputs"], found["architecture"]
    geometry: ObjectGeometry = found["furniture"][1]
    illuminant = room_illuminant(inputs, found["objects"], room.architecture, geometry.camera)
    balanced = replace(inputs, photo=replace(inputs.photo, rgb=illuminant.balanced(inputs.photo.rgb)))
    room = replace(room, architecture=_in_white_light(room.architecture, illuminant))
    floors = {p.id for p in room.architecture.by_role("floor")}
    standing = {edge.child for edge in room.supports if edge.parent in floors}
    found = evaluate(stages, found, ("posed",), runner, progress.part(0.45, 0.85))
    shaped = _observed({**found, "architecture": room}, balanced, library)
    feet_seen = frozenset(c.object_id for c in geometry.cuboids if c.foot_seen)
    observed, changed = prepared(shaped, library, REASONED if inputs.depth_m is None else MEASURED, feet_seen)
    with ThreadPoolExecutor(2) as beside:  # what things look like is all the same to the layout
        seen = beside.submit(
            there, photo_appearance, balanced.photo.rgb, found["furniture_objects"], observed, library, illuminant.rgb
        )
        painted = beside.submit(
            plane_textures,
            balanced,
            found["objects"],
            geometry.camera,
            observed.architecture,
            stages.filler,
            standing,
            None if plane_pictures else (),
        )
        scene, report = observed, None
        if observed.objects:
            step = progress.part(0.85, 1.0)
            step.report(0.0, "layout…")
            scene, report = stages.layout.optimise(observed, step.part(0.0, 0.5), preview)
            runner.runs.append(StageRun("layout", repr(stages.layout), report.seconds, cached=False))
            if stages.refinement is not None:
                step.report(0.5, "refinement…")
                settled_s, seen_objects = report.seconds, found["furniture_objects"]
                scene, report = stages.refinement.refine(scene, report, observed, seen_objects, step.part(0.5, 1.0))
                took = report.seconds - settled_s
                runner.runs.append(StageRun("refinement", repr(stages.refinement), took, cached=False))
            scene = set_metrics(scene, report.after)
        appearance = seen.result()
        textures = painted.result()
    scene, observed = (_textured(appearance.applied(s), textures) for s in (scene, observed))
    if room.architecture.floor is not None:
        trimmed = without_floor_behind_walls(scene, room.architecture.floor)
        scene, cut = refitted_textures(scene, trimmed, textures)
        textures |= cut
    textures |= appearance.pictures
    scene = _at_given_height(scene, inputs.camera_height_m)
    progress.report(1.0, "done")
    return Built(
        scene=scene,
        camera=found["camera"],
        objects=found["furniture_objects"],
        geometry=geometry,
        graph=found["graph"],
        architecture=room,
        depth=found["depth"],
        observed=observed,
        layout=report,
        textures=textures,
        illuminant=illuminant,
        inputs=inputs,
        runs=tuple(runner.runs),
        stages=stages,
        notes=(*_notes(found, changed, report), *runner.lost),
    )


def prepared(
    shaped: Scene, library: ShapeLibrary, noise: ObservationNoise, feet_seen: frozenset[str]
) -> tuple[Scene, tuple[str, ...]]:
    """The scene as the layout takes it, and what was changed: supports, shapes and the room agree with the objects.

    Args:
        shaped: every object in its best candidate's pose.
        library: where shapes come from.
        noise: of the observed positions.
        feet_seen: ids of the objects whose lower ends the photo shows.
    """
    changed: tuple[str, ...] = ()
    if noise.measured:  # heights reasoned from a photo alone do not tell boards from one another
        shaped = over_what_may_hold_them(shaped, library)
        shaped, holding = holding_shapes(shaped, library, noise)
        shaped, contradicted = checked_supports(shaped, library, noise, shapes_clear=False)
        shaped, clear = clear_shapes(shaped, library, noise)
        changed = holding + contradicted + clear
    checked, corrected = checked_supports(shaped, library, noise)
    checked = checked if noise.measured else with_backs_to_walls(checked, noise)
    fitted, moved = fitted_boards(checked, library, reasoned=not noise.measured)
    fitted, loose = left_where_seen(fitted, library, noise)
    room = containing_room(fitted, reasoned=not noise.measured, feet_seen=feet_seen)
    return room, changed + corrected + moved + loose


def _in_white_light(room: Architecture, illuminant: Illuminant) -> Architecture:
    """The room in the colours that it would have in white light."""
    coloured = [(plane, illuminant.albedo(np.array(plane.colour))) for plane in room.planes]
    return Architecture(tuple(replace(p, colour=(float(c[0]), float(c[1]), float(c[2]))) for p, c in coloured))


def _observed(found: Artefacts, balanced: Inputs, library: ShapeLibrary) -> Scene:
    """The scene as the picture shows it, in the colours of the photo in white light, before layout."""
    objects, posed = found["furniture_objects"], found["posed"]
    shape_of = {p.object_id: p.candidates[0].shape_id for p in posed if p.candidates}
    colours = shared_by_sets(photo_colours(balanced.photo.rgb, objects), objects, shape_of)
    return assemble(objects, found["geometry"], found["architecture"], posed, library, colours)


def _at_given_height(scene: Scene, camera_height_m: float | None) -> Scene:
    """The scene in the scale that a person gave."""
    if camera_height_m is None or scene.camera is None:
        return scene
    return rescale_to_length(scene, float(scene.camera.position[2]) - floor_height(scene), camera_height_m)


def _textured(scene: Scene, textures: Mapping[str, object]) -> Scene:
    """The scene whose planes show the pictures that there are, by plane id."""
    planes = tuple(replace(p, texture=p.id if p.id in textures else None) for p in scene.architecture.planes)
    return replace(scene, architecture=replace(scene.architecture, planes=planes))


def _notes(found: Artefacts, changed: tuple[str, ...], report: LayoutReport | None) -> tuple[str, ...]:
    depth, graph = found["inputs"].depth_source, found["graph"]
    sources = [
        f"camera: {camera_sentence(found['camera'], depth)}",
        f"objects: {geometry_sentence(found['geometry'], depth)}",
        f"room: {room_sentence(found['architecture'], depth)}",
    ]
    if graph is not None:
        sources.append(f"what stands on what: {graph_sentence(graph)}")
    notes = (*(s.note for s in found["shapes"] if s.note), *changed)
    return (*sources, *notes, *(report.reasons if report else ()))
