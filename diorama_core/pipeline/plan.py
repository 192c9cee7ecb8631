"""The one order of the pipeline, as data: what each step takes, and what it gives.

A full build, a build after a correction, reconstructing one object, outlining and the benchmarks all evaluate this
plan, each restricted to the artefacts it wants. An artefact that the caller gives is not computed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

import numpy as np

from diorama_core.architecture.along_sight import move_in_front_of_walls, snap_mounted_objects
from diorama_core.architecture.texture.plane_textures import plane_textures
from diorama_core.architecture.walls.passages import without_openings
from diorama_core.arrangement.explain import SCALE, reasons_of_change
from diorama_core.arrangement.out_of_reach import detach_out_of_reach
from diorama_core.arrangement.support_hypotheses import ObservationNoise
from diorama_core.artefacts import (
    ArchitectureEstimate,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    PosedCandidates,
    Reason,
    SceneGraph,
)
from diorama_core.layout.clear_shapes import clear_shapes
from diorama_core.library.labels import is_named, meanings, with_article
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN
from diorama_core.perception.language.relations import with_graph
from diorama_core.pipeline.beliefs import with_beliefs
from diorama_core.pipeline.beside import looking_ahead
from diorama_core.pipeline.colours import room_illuminant
from diorama_core.pipeline.findings import drawing, finding, graph_sentence
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.scene_steps import (
    appearance,
    apply_appearance,
    apply_supports,
    decide_supports,
    enclose_objects,
    finish_scene,
    floor_object_ids,
    object_colours,
    position_noise,
    white_balance_inputs,
    white_balance_room,
    with_network_inputs,
)
from diorama_core.pipeline.stages import ProposalStages, Stages
from diorama_core.pipeline.steps import (
    Artefacts,
    Corrected,
    Correction,
    Derivation,
    LaidOut,
    LayoutStep,
    StageStep,
    Step,
)
from diorama_core.progress import SILENT, Progress
from diorama_core.retrieval.seen_kinds import as_it_looks, with_seen_kinds
from diorama_core.retrieval.word_senses import with_word_senses
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Scene, SceneObject


def assemble(
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    architecture: ArchitectureEstimate,
    posed: tuple[PosedCandidates, ...],
    library: ShapeLibrary,
    colours: Mapping[str, tuple[float, float, float]],
) -> Scene:
    """The scene before layout optimisation: every object in its best candidate's pose, in its colour of the photo.

    Objects without candidates are left out, and objects on them are reassigned to their supporter.

    Args:
        objects: what was found in the photo, with masks.
        geometry: the objects' cuboids, the camera, and what supports what.
        architecture: the room.
        posed: candidates in their poses.
        library: where shapes come from.
        colours: sRGB 0 to 1, by object id.
    """
    candidates: Mapping[str, PosedCandidates] = {p.object_id: p for p in posed if p.candidates}
    items = tuple(_scene_object(o, candidates[o.id], library, colours.get(o.id)) for o in objects if o.id in candidates)
    ids = {item.id for item in items} | {p.id for p in architecture.architecture.planes}
    parent_of = {edge.child: edge.parent for edge in architecture.supports}
    supports = []
    for edge in architecture.supports:
        parent: str | None = edge.parent
        while parent is not None and parent not in ids:
            parent = parent_of.get(parent)
        if edge.child in ids and parent is not None:
            supports.append(replace(edge, parent=parent))
    scene = Scene(
        camera=geometry.camera, architecture=architecture.architecture, objects=items, supports=tuple(supports)
    )
    check_scene(scene)
    return scene


def _scene_object(
    item: DetectedObject,
    posed: PosedCandidates,
    library: ShapeLibrary,
    colour: tuple[float, float, float] | None,
) -> SceneObject:
    best = posed.candidates[0]
    kind = record_of(library, best.shape_id).category  # a chair that looks like an office chair is one
    category = kind if item.category == UNKNOWN.name or kind in meanings(item.label, item.category) else item.category
    return SceneObject(
        id=item.id,
        label=category if item.label == UNKNOWN.name else item.label,
        category=category,
        shape_id=best.shape_id,
        shape_size_m=best.shape_size_m,
        pose=best.pose,
        candidates=posed.candidates,
        mask_id=item.mask_id,
        box_px=item.box,
        confidence=posed.confidence,
        colour=colour,
    )


def reasons_of_build(
    given: Inputs,
    inputs: Inputs,
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    graph: SceneGraph | None,
    posed: Sequence[PosedCandidates],
    noise: ObservationNoise,
    corrected: Corrected,
    settled: LaidOut,
    refined: LaidOut,
) -> tuple[Reason, ...]:
    """The reasons for everything that was decided about the objects of the scene, by object.

    Args:
        given: what the user gave.
        inputs: the same, with what networks added.
        objects: what was outlined.
        geometry: cuboids, with the reasons of the stage that measured them.
        graph: what holds up what, where a stage decided that.
        posed: candidates, with the reasons of the stage that posed them.
        noise: of observed positions.
        corrected: the scene before its layout, with the reasons of the rules that changed it.
        settled: the scene after the layout.
        refined: the scene after the refinement.
    """
    named_by = "you" if given.boxes or given.instances is not None else "the detector"
    scene, kinds = refined.scene, {item.id: item.category for item in refined.scene.objects}
    reasons = [r for o in objects if o.id in kinds for r in _kind_reasons(o, kinds[o.id], named_by)]
    reasons += [r for p in posed for r in p.reasons or ()]
    reasons += geometry.reasons or ()
    if inputs.depth_m is not None:
        nats = min(0.5 * (SCALE.change / noise.along) ** 2, SCALE.max_nats)
        word = "depth was measured there"
        reasons += [Reason(c.object_id, "place", "depth", nats, "nats", word) for c in geometry.cuboids]
    reasons += _support_reasons(graph, scene)
    reasons += corrected.reasons
    reasons += reasons_of_change(corrected.scene, settled.scene, "layout", "it rests on something, clear of the others")
    reasons += reasons_of_change(settled.scene, scene, "refinement", "its outline fits the photo better there")
    order = {item.id: k for k, item in enumerate(scene.objects)}
    return tuple(sorted((r for r in reasons if r.object_id in order), key=lambda r: order[r.object_id]))


def _kind_reasons(item: DetectedObject, kind: str, named_by: str) -> list[Reason]:
    """Evidence of an object's word, picture and place for a kind, against kinds on average."""
    named, reasons = is_named(item.label), []
    by_word: Mapping[str, float] = meanings(item.label, item.category)
    if named and kind in by_word:
        nats = float(np.log(by_word[kind] * len(CATEGORIES)))
        reasons.append(_kind_reason(item, "word", nats, f"named “{item.label}” by {named_by}"))
    seen = dict(item.looks_like)
    if seen:
        share = seen.get(kind, 0.0)
        nats = float(np.log(max(share, SCALE.rare) * len(seen)))
        looks = f"looks like {with_article(kind)}" if nats > 0 else f"hardly looks like {with_article(kind)}"
        reasons.append(_kind_reason(item, "picture", nats, f"it {looks} in the photo"))
    before, after = as_it_looks(by_word, item.looks_like, named), dict(item.meanings)
    if kind in after and before.get(kind, 0.0) > 0:
        nats = float(np.log(max(after[kind], SCALE.rare) / max(before[kind], SCALE.rare)))
        fits = "fit" if nats > 0 else "speak against"
        reasons.append(_kind_reason(item, "box", nats, f"its place and size in the photo {fits} {with_article(kind)}"))
    return reasons


def _kind_reason(item: DetectedObject, term: str, nats: float, sentence: str) -> Reason:
    return Reason(item.id, "kind", term, nats, "nats", sentence)


def _support_reasons(graph: SceneGraph | None, scene: Scene) -> list[Reason]:
    """Evidence of the graph for what holds an object, where it still is what the graph says."""
    if graph is None:
        return []
    parents = {edge.child: edge.parent for edge in scene.supports}
    roles = {p.id: p.role for p in scene.architecture.planes}
    reasons = []
    for edge, score in zip(graph.supports, graph.scores, strict=True):
        now = parents.get(edge.child)
        if now is not None and edge.parent in (now, roles.get(now)):
            share = float(np.clip(score, SCALE.rare, 1.0 - SCALE.rare))
            nats = float(np.log(share / (1.0 - share)))
            reasons.append(Reason(edge.child, "support", "graph", nats, "nats", graph_sentence(graph)))
    return reasons


def lacks_boxes(given: Inputs) -> bool:
    """Whether the user gave neither boxes nor masks."""
    return not given.boxes and given.instances is None


def lacks_depth(given: Inputs) -> bool:
    """Whether the user measured no depth."""
    return given.depth_m is None


LOOKS_AHEAD = "shapes"
"""The artefact whose stage loads what it will need while earlier steps leave a processor idle."""


DEFAULTS: Artefacts = {"preview": None}
"""What a caller need not give."""


PLAN: tuple[Step, ...] = (
    Derivation(lambda given: given.photo, ("given",), "photo"),
    Derivation(lambda given: given.intrinsics, ("given",), "given_intrinsics"),
    StageStep("recognition", "recognise", ("photo",), "words", 0.01, lacks_boxes, dispensable=True),
    Derivation(lambda words: words or (), ("words",), "phrases"),
    StageStep("detection", "detect", ("photo", "phrases"), "detected_boxes", 0.02, lacks_boxes),
    StageStep("depth_prediction", "predict", ("photo", "given_intrinsics"), "predicted_depth", 0.02, lacks_depth),
    Derivation(with_network_inputs, ("given", "detected_boxes", "predicted_depth"), "inputs"),
    StageStep("camera", "estimate", ("inputs",), "camera", 0.05),
    # Outlines do not depend on the camera: correcting its field of view must not look for them again.
    Derivation(lambda inputs: inputs.without_camera, ("inputs",), "camera_free_inputs"),
    StageStep("objects", "segment", ("camera_free_inputs",), "outlined_objects", 0.15),
    StageStep("naming", "name", ("photo", "outlined_objects"), "seen_kinds", 0.01, dispensable=True),
    Derivation(with_seen_kinds, ("outlined_objects", "seen_kinds"), "seen_objects"),
    Derivation(with_word_senses, ("seen_objects", "camera"), "objects"),
    StageStep("geometry", "measure", ("inputs", "camera", "objects"), "measured_geometry", 0.13),
    StageStep("graph", "relate", ("inputs", "objects", "measured_geometry"), "graph", 0.02),
    Derivation(with_graph, ("measured_geometry", "graph"), "supported_geometry"),
    StageStep("architecture", "reconstruct", ("inputs", "objects", "supported_geometry"), "architecture", 0.1),
    Derivation(move_in_front_of_walls, ("supported_geometry", "architecture"), "standing_geometry"),
    Derivation(snap_mounted_objects, ("standing_geometry", "architecture"), "mounted_geometry"),
    Derivation(without_openings, ("objects", "mounted_geometry", "architecture"), "furniture"),
    Derivation(lambda furniture: furniture[0], ("furniture",), "furniture_objects"),
    Derivation(lambda furniture: furniture[1], ("furniture",), "geometry"),
    StageStep("depth", "depth", ("inputs", "furniture_objects", "geometry", "architecture"), "depth", 0.05),
    StageStep("retrieval", "retrieve", ("inputs", "furniture_objects", "geometry"), "shapes", 0.1),
    StageStep("pose", "pose", ("inputs", "furniture_objects", "geometry", "depth", "shapes"), "posed", 0.2),
    # The room's and the objects' colours are those that white light would show.
    Derivation(
        lambda inputs, objects, room, geometry: room_illuminant(inputs, objects, room.architecture, geometry.camera),
        ("inputs", "objects", "architecture", "geometry"),
        "illuminant",
    ),
    Derivation(white_balance_inputs, ("inputs", "illuminant"), "balanced_inputs"),
    Derivation(white_balance_room, ("architecture", "illuminant"), "white_room"),
    Derivation(object_colours, ("balanced_inputs", "furniture_objects", "posed"), "colours"),
    Derivation(assemble, ("furniture_objects", "geometry", "white_room", "posed", "library", "colours"), "posed_scene"),
    # What holds what is decided for all objects together, now that their shapes and the walls are known.
    Derivation(position_noise, ("geometry",), "noise"),
    Derivation(decide_supports, ("posed_scene", "library", "noise", "furniture_objects"), "supports"),
    Derivation(apply_supports, ("posed_scene", "supports"), "supported"),
    Correction(
        clear_shapes,
        ("supported", "library", "noise"),
        "in_clear_shapes",
        "shapes do not lie within one another",
        measured=True,
    ),
    Correction(
        detach_out_of_reach,
        ("in_clear_shapes", "library", "noise"),
        "on_near_supports",
        "nothing reaches it where it was seen",
    ),
    Correction(
        enclose_objects,
        ("on_near_supports", "library", "noise", "geometry", "architecture"),
        "corrected",
        "the room is around everything",
    ),
    Derivation(lambda corrected: corrected.scene, ("corrected",), "observed"),
    # What things look like is all the same to the layout.
    Derivation(
        appearance,
        ("balanced_inputs", "furniture_objects", "observed", "library", "illuminant"),
        "appearance",
        beside=True,
    ),
    Derivation(floor_object_ids, ("white_room",), "standing"),
    Derivation(lambda stages: stages.filler, ("stages",), "filler"),
    Derivation(
        lambda balanced, objects, geometry, scene, filler, standing: plane_textures(
            balanced, objects, geometry.camera, scene.architecture, filler, standing
        ),
        ("balanced_inputs", "objects", "geometry", "observed", "filler", "standing"),
        "plane_pictures",
        beside=True,
    ),
    Derivation(LaidOut, ("observed",), "not_laid_out"),
    LayoutStep(
        "layout",
        lambda stage, observed, preview, progress: stage.optimise(observed.scene, progress, preview),
        ("not_laid_out", "preview"),
        "laid_out",
        0.08,
    ),
    LayoutStep(
        "refinement",
        lambda stage, laid_out, *others: stage.refine(laid_out.scene, laid_out.report, *others),
        ("laid_out", "observed", "furniture_objects"),
        "refined",
        0.06,
    ),
    Derivation(finish_scene, ("refined", "appearance", "plane_pictures", "white_room", "inputs"), "finished"),
    Derivation(with_beliefs, ("finished", "inputs", "geometry", "posed", "supports", "noise", "library"), "scene"),
    Derivation(lambda finished: finished.textures, ("finished",), "textures"),
    Derivation(apply_appearance, ("observed", "appearance", "plane_pictures"), "dressed_observed"),
    Derivation(
        reasons_of_build,
        (
            *("given", "inputs", "objects", "geometry", "graph", "posed", "noise"),
            *("corrected", "laid_out", "refined"),
        ),
        "reasons",
    ),
)


def evaluate(
    stages: Stages | ProposalStages,
    given: Artefacts,
    wanted: Iterable[str],
    runner: Runner,
    progress: Progress = SILENT,
) -> dict[str, Any]:
    """The wanted artefacts, everything given, and what had to be computed between them.

    Args:
        stages: implementations; `ProposalStages` are enough for `detected_boxes`.
        given: artefacts that are known already; at least `given`, what the user gave.
        wanted: names of artefacts.
        runner: caches stages' results and records what they took.
        progress: reports and cancellation.

    Raises:
        Cancelled: on request; finished stages stay in the cache.
        DioramaError: with the reason, when a stage cannot do its work.
        KeyError: an artefact is wanted that no step gives.
    """
    known: dict[str, Any] = {**DEFAULTS, "stages": stages, **given}
    steps = _steps_for(set(wanted), known)
    whole = sum(step.share for step in steps) or 1.0
    done, begun = 0.0, dict[str, Future[Any]]()
    # There are two steps beside the others.
    with _looking_ahead(stages, steps, known) as ahead, ThreadPoolExecutor(2) as threads:
        for step in steps:
            known |= {name: begun.pop(name).result() for name in step.takes if name in begun}
            part = progress.part(done / whole, (done + step.share) / whole)
            done += step.share
            if step.beside:
                begun[step.gives] = threads.submit(step.evaluate, dict(known), runner, part)
                continue
            if step.gives == LOOKS_AHEAD:
                ahead.close()
            known[step.gives] = step.evaluate(known, runner, part)
            part.report_finding(finding(step.gives, known[step.gives]), drawing(step.gives, known))
        known |= {name: future.result() for name, future in begun.items()}
    return known


def _looking_ahead(stages: Stages | ProposalStages, steps: Sequence[Step], known: Artefacts) -> ExitStack:
    """While it lasts, what retrieval will need is loaded; nothing where retrieval is not among the later steps."""
    stack = ExitStack()
    if isinstance(stages, Stages) and any(step.gives == LOOKS_AHEAD for step in steps[1:]):
        stack.enter_context(looking_ahead(stages.retrieval, known["given"].boxes))
    return stack


def _steps_for(wanted: set[str], known: Artefacts) -> list[Step]:
    """The steps that lead to the wanted artefacts, in the plan's order."""
    missing = wanted - known.keys()
    steps: list[Step] = []
    for step in reversed(PLAN):
        if step.gives in missing:
            missing = (missing - {step.gives}) | (set(step.takes) - known.keys())
            steps.append(step)
    if missing:
        raise KeyError(f"no step gives {', '.join(sorted(missing))}")
    return steps[::-1]
