"""Steps of the plan: network predictions added to the inputs, posed candidates made a finished scene."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import UInt8

from diorama_core.appearance.photo_appearance import PhotoAppearance, photo_appearance
from diorama_core.architecture.room_extent import containing_room, without_floor_behind_walls
from diorama_core.architecture.texture.refit import refit_textures
from diorama_core.arrangement.explain import SCALE, reasons_of_change
from diorama_core.arrangement.support_hypotheses import (
    MEASURED,
    REASONED,
    ObservationNoise,
    SupportEvidence,
    visible_shares_below,
)
from diorama_core.arrangement.support_terms import sentence_of
from diorama_core.arrangement.supports import DecidedSupports, SupportChoice, with_decided_supports
from diorama_core.artefacts import (
    ArchitectureEstimate,
    DepthPrediction,
    DetectedObject,
    Inputs,
    LabelledBox,
    ObjectGeometry,
    PosedCandidates,
    Reason,
)
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.perception.foundation.depth_prediction import with_depth
from diorama_core.perception.illuminant import Illuminant
from diorama_core.pipeline.colours import photo_colours, share_set_colours
from diorama_core.pipeline.steps import Corrected, LaidOut
from diorama_core.processes import call_beside
from diorama_core.scene.edits import set_metrics
from diorama_core.scene.room_edits import floor_height, rescale_to_length
from diorama_core.scene.types import Scene

Pictures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]


@dataclass(frozen=True)
class FinishedScene:
    """The scene and the pictures of its planes and materials, by name."""

    scene: Scene
    textures: Pictures


def white_balance_inputs(inputs: Inputs, light: Illuminant) -> Inputs:
    """The inputs with the photo as white light would have it."""
    return replace(inputs, photo=replace(inputs.photo, rgb=light.white_balance(inputs.photo.rgb)))


def white_balance_room(room: ArchitectureEstimate, light: Illuminant) -> ArchitectureEstimate:
    """The room in the colours that it would have in white light."""
    coloured = [(plane, light.albedo(np.array(plane.colour))) for plane in room.architecture.planes]
    planes = tuple(replace(p, colour=(float(c[0]), float(c[1]), float(c[2]))) for p, c in coloured)
    return replace(room, architecture=replace(room.architecture, planes=planes))


def object_colours(
    balanced: Inputs, objects: tuple[DetectedObject, ...], posed: Sequence[PosedCandidates]
) -> dict[str, tuple[float, float, float]]:
    """The colours of objects in the photo in white light, shared by sets, by object id."""
    shape_of = {p.object_id: p.candidates[0].shape_id for p in posed if p.candidates}
    return share_set_colours(photo_colours(balanced.photo.rgb, objects), objects, shape_of)


def position_noise(geometry: ObjectGeometry) -> ObservationNoise:
    """How far observed positions can be trusted."""
    return MEASURED if geometry.source.is_measured else REASONED


def decide_supports(
    scene: Scene, library: ShapeLibrary, noise: ObservationNoise, objects: tuple[DetectedObject, ...]
) -> DecidedSupports:
    """What holds each object of a posed scene.

    Args:
        scene: every object in its best candidate's pose, with the supports that were believed so far.
        library: where shapes come from.
        noise: of the observed positions.
        objects: of the photo, with their masks.
    """
    below = visible_shares_below({item.id: item.mask for item in objects})
    return with_decided_supports(scene, library, noise, SupportEvidence.of(scene, below))


def apply_supports(posed: Scene, supports: DecidedSupports) -> Corrected:
    """The scene with its supports decided, and what that changed."""
    changes = reasons_of_change(posed, supports.scene, "supports", "what holds it agrees with where it was seen")
    terms = (reason for name, choice in supports.choices.items() for reason in _support_reasons(name, choice))
    return Corrected(supports.scene, supports.notes, (*changes, *terms))


def _support_reasons(object_id: str, choice: SupportChoice) -> Iterator[Reason]:
    """Evidence for the chosen supporter rather than for the next likeliest, term by term."""
    for term, nats in choice.shares.items():
        sentence = sentence_of(term, choice.hypothesis)
        if sentence and nats >= SCALE.least_nats:
            yield Reason(object_id, "support", term, nats, "nats", sentence)


def enclose_objects(
    scene: Scene, library: ShapeLibrary, noise: ObservationNoise, geometry: ObjectGeometry, room: ArchitectureEstimate
) -> Scene:
    """The scene in a room around all of its objects.

    Args:
        scene: before its layout.
        library: where shapes come from.
        noise: of the observed positions.
        geometry: says whose lower ends the photo shows.
        room: says how walls were found.
    """
    feet_seen = frozenset(c.object_id for c in geometry.cuboids if c.foot_seen)
    return containing_room(
        scene, objects_measured=noise.measured, walls_reasoned=room.source.method.is_reasoned, feet_seen=feet_seen
    )


def floor_object_ids(room: ArchitectureEstimate) -> frozenset[str]:
    """Ids of the objects that the room's estimate puts on a floor."""
    floors = {p.id for p in room.architecture.by_role("floor")}
    return frozenset(edge.child for edge in room.supports if edge.parent in floors)


def appearance(
    balanced: Inputs, objects: tuple[DetectedObject, ...], scene: Scene, library: ShapeLibrary, light: Illuminant
) -> PhotoAppearance:
    """What the photo shows of the objects, from a process beside this one where there is one.

    Args:
        balanced: the photo in white light.
        objects: what was found in the photo, with masks.
        scene: in the poses in which the photo shows it.
        library: where shapes come from.
        light: that the photo was freed of.
    """
    return call_beside(photo_appearance, balanced.photo.rgb, objects, scene, library, light.rgb)


def apply_appearance(scene: Scene, look: PhotoAppearance, of_planes: Pictures) -> Scene:
    """The scene with the photo's materials, whose planes show the pictures that there are, by plane id."""
    scene = look.apply(scene)
    planes = tuple(replace(p, texture=p.id if p.id in of_planes else None) for p in scene.architecture.planes)
    return replace(scene, architecture=replace(scene.architecture, planes=planes))


def finish_scene(
    refined: LaidOut, look: PhotoAppearance, of_planes: Pictures, room: ArchitectureEstimate, inputs: Inputs
) -> FinishedScene:
    """The scene as a person gets it: measured, in the photo's materials, its floor trimmed, in the given scale.

    Args:
        refined: after its layout.
        look: what the photo shows of the objects.
        of_planes: the pictures of planes, by plane id.
        room: before it was drawn out around the objects.
        inputs: may give the camera's height.
    """
    scene = refined.scene if refined.report is None else set_metrics(refined.scene, refined.report.after)
    scene, textures = apply_appearance(scene, look, of_planes), dict(of_planes)
    if room.architecture.floor is not None:
        trimmed = without_floor_behind_walls(scene, room.architecture.floor)
        scene, cut = refit_textures(scene, trimmed, textures)
        textures |= cut
    return FinishedScene(_rescale_to_height(scene, inputs.camera_height_m), textures | dict(look.pictures))


def _rescale_to_height(scene: Scene, camera_height_m: float | None) -> Scene:
    """The scene in the scale that a person gave."""
    if camera_height_m is None or scene.camera is None:
        return scene
    return rescale_to_length(scene, float(scene.camera.position[2]) - floor_height(scene), camera_height_m)


def with_network_inputs(
    given: Inputs, detected: tuple[LabelledBox, ...] | None, predicted: DepthPrediction | None
) -> Inputs:
    """The inputs with detected boxes and predicted depth; None adds nothing.

    A guessed word is left out: what a box looks like is asked again of its outline, and with it everything else.
    """
    boxes = tuple(_nameless(box) if box.guessed else box for box in (given.boxes if detected is None else detected))
    inputs = given if boxes == given.boxes else replace(given, boxes=boxes)
    return inputs if predicted is None else with_depth(inputs, predicted)


def _nameless(box: LabelledBox) -> LabelledBox:
    return replace(box, category=UNKNOWN.name, label=UNKNOWN.name)
