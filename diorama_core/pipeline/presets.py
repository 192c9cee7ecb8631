"""Chooses an implementation for each stage: the best installed network, or the embedded method.

`auto` mixes stage by stage and needs nothing; `embedded` downloads none; `foundation` insists on the paper's networks
and takes the paper's way to poses, by correspondences of patch features.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Literal, TypeVar

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.artefacts import Box, Inputs, LabelledBox, Photo
from diorama_core.errors import UnavailableError
from diorama_core.io.assets import has_own_recogniser
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.fast_depth import FastDepth
from diorama_core.models.foreground import Foreground
from diorama_core.models.manifest import network
from diorama_core.models.network import Network
from diorama_core.models.own_files import FileDepth, FileDetector
from diorama_core.models.recogniser import own_recogniser
from diorama_core.models.seen_depth import GeometryNetwork
from diorama_core.models.store import ModelStore, how_to_get
from diorama_core.perception.camera.estimate import with_given_attitude
from diorama_core.perception.foundation.depth_prediction import (
    NetworkCamera,
    NetworkDepth,
    NetworkDepthPrediction,
)
from diorama_core.perception.foundation.detection import (
    EverydayDetection,
    FileDetection,
    OpenVocabularyDetection,
    PromptedMasks,
)
from diorama_core.perception.foundation.empty_room import EmptyRoomArchitecture
from diorama_core.perception.foundation.proposals import (
    CONFIDENT,
    LIKELY,
    MOST,
    MOST_SHOWN,
    JoinedDetection,
    OwnDetection,
    clickable,
    find_clicked_box,
    names_of,
)
from diorama_core.perception.language.client import LmmSettings
from diorama_core.perception.language.stages import LanguageGraph, LanguageRecognition
from diorama_core.perception.measured import MeasuredGeometry
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.pipeline import network_stages
from diorama_core.pipeline.choices import (
    DEPTH_NETWORKS,
    DETECTORS,
    FOREGROUNDS,
    INPAINTERS,
    OWN_DETECTOR,
    PATCH_FEATURES,
    SEGMENTERS,
    NetworkChoice,
    best_here,
)
from diorama_core.pipeline.network_stages import with_joint_retrieval
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import DEFAULT_RECIPE, ProposalStages, Stages, embedded_stages
from diorama_core.pose.correspondence.features import NetworkFeatures
from diorama_core.pose.correspondence.solvers import CorrespondencePose
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import DetectionStage

Profile = Literal["auto", "embedded", "foundation"]
T = TypeVar("T")


def stages_for(
    profile: Profile,
    inputs: Inputs,
    library: ShapeLibrary,
    *,
    recipe: str = DEFAULT_RECIPE,
    store: ModelStore | None = None,
    lmm: LmmSettings | None = None,
    choice: NetworkChoice | None = None,
) -> Stages:
    """The stages of a profile for what the user gave.

    Args:
        profile: see the module.
        inputs: boxes, masks, depth and intrinsics that are given are never replaced by a network's.
        library: where shapes come from.
        recipe: of the layout optimiser.
        store: where networks lie; this machine's by default.
        lmm: a language model to ask; by default the one that the environment names, if any.
        choice: networks that the user names; the best ones on this machine by default.

    Raises:
        UnavailableError: a network that the user names or the foundation profile needs is not on this machine.
        InputError: a network that the user names cannot take the stage.
    """
    choice = choice or NetworkChoice()
    base = embedded_stages(inputs, library, recipe=recipe)
    if not inputs.boxes and inputs.instances is None:
        base = replace(base, detection=own_detection())
    if profile == "embedded":
        return base
    store = store or ModelStore.default()
    _insist_on(store, choice)
    base = with_joint_retrieval(base, library, store)
    if profile == "foundation":
        _insist(inputs, store)
        base = _with_published_poses(base, library, store)
    return foundation_stages(base, inputs, store, lmm or LmmSettings.from_environment(), choice)


def foundation_stages(
    base: Stages, inputs: Inputs, store: ModelStore, lmm: LmmSettings | None, choice: NetworkChoice
) -> Stages:
    """`base` with every stage replaced for which a network is on this machine.

    Args:
        base: embedded stages.
        inputs: as given.
        store: where networks lie.
        lmm: a language model; None for none.
        choice: networks that the user names.
    """
    stages = base
    if not inputs.boxes and inputs.instances is None:
        stages = replace(stages, detection=detection_stage(store, choice))
        if lmm is not None and isinstance(stages.detection, OpenVocabularyDetection):
            stages = replace(stages, recognition=LanguageRecognition(lmm))
    segmenter = _best(store, SEGMENTERS, network_stages.segmenter)
    if segmenter is not None:
        stages = replace(stages, objects=PromptedMasks(segmenter))
    filler = _best(store, INPAINTERS, network_stages.inpainter)
    stages = replace(stages, filler=filler)
    depth_prediction = _depth_network(store, choice) if inputs.depth_m is None else None
    if isinstance(depth_prediction, FastDepth):
        stages = replace(stages, geometry=SingleViewMetrology(depth=depth_prediction))
    elif depth_prediction is not None:
        stages = replace(
            stages,
            depth_prediction=NetworkDepthPrediction(depth_prediction),
            camera=with_given_attitude(NetworkCamera(), inputs.camera_attitude),
            geometry=MeasuredGeometry(),
            architecture=PlanarRoom()
            if filler is None
            else EmptyRoomArchitecture(PlanarRoom(), filler, depth_prediction, _foregrounds(store)),
            depth=NetworkDepth(),
        )
    return stages if lmm is None else replace(stages, graph=LanguageGraph(lmm))


def _depth_network(store: ModelStore, choice: NetworkChoice) -> GeometryNetwork | None:
    if choice.depth_file is not None:
        return FileDepth.of(choice.depth_file)
    return _best(store, choice.depth_networks(), network_stages.depth_network)


def detection_stage(store: ModelStore, choice: NetworkChoice | None = None) -> DetectionStage | None:
    """The named detector or the best one on this machine, as a stage; the one that comes with Diorama without any."""
    if choice is not None and choice.detector_file is not None:
        return FileDetection(FileDetector.of(choice.detector_file))
    detectors = (choice or NetworkChoice()).detectors()
    detector = None if detectors == (OWN_DETECTOR,) else _best(store, detectors, network_stages.detector)
    embedded = own_detection()
    if isinstance(detector, EverydayDetection) and embedded is not None and (choice is None or choice.detector is None):
        return JoinedDetection(detector, embedded)
    return detector or embedded


def own_detection(threshold: float = CONFIDENT, most: int = MOST) -> OwnDetection | None:
    """The detector that comes with Diorama; None where its weights were left out."""
    return OwnDetection(own_recogniser(), threshold, most) if has_own_recogniser() else None


def detection_routes() -> Mapping[str, DetectionStage]:
    """Every way to boxes on this machine, by name, to be compared: each detector, and the one that is used."""
    store = ModelStore.default()
    routes = {i: network_stages.detector(store, network(i)) for i in DETECTORS if store.has(network(i))}
    embedded = own_detection(LIKELY, MOST_SHOWN)
    if embedded is not None:
        routes["own, likely"], routes["own, confident"] = embedded, replace(embedded, threshold=CONFIDENT)
    used = detection_stage(store)
    return routes if used is None else {**routes, "used": used}


def namers(
    store: ModelStore | None = None,
) -> Mapping[str, Callable[[Photo, Float[np.ndarray, "n 4"]], Sequence[Sequence[str]]]]:
    """Every way to name given boxes, by name: alone, and with the words of what finds everyday objects."""
    if not has_own_recogniser():
        return {}
    return {way: partial(_name_boxes, finder) for way, finder in _everyday_detectors(store).items()}


def clickers(
    store: ModelStore | None = None,
) -> Mapping[str, Callable[[Photo, Float[np.ndarray, "n 2"]], Sequence[Box | None]]]:
    """Every way from clicks on a photo to boxes, by name: alone, and with the boxes of what finds everyday objects."""
    if not has_own_recogniser():
        return {}
    return {way: partial(_find_clicked_boxes, finder) for way, finder in _everyday_detectors(store).items()}


def _everyday_detectors(store: ModelStore | None) -> Mapping[str, DetectionStage | None]:
    everyday = network_stages.everyday_detector(store or ModelStore.default())
    return {"own": None} if everyday is None else {"own": None, "own, everyday objects known": everyday}


def _name_boxes(
    finder: DetectionStage | None, photo: Photo, boxes: Float[np.ndarray, "n 4"]
) -> Sequence[Sequence[str]]:
    return names_of(own_recogniser(), photo, boxes, () if finder is None else finder.detect(photo, (), Progress()))


def _find_clicked_boxes(
    finder: DetectionStage | None, photo: Photo, pixels: Float[np.ndarray, "n 2"]
) -> Sequence[Box | None]:
    known = () if finder is None else finder.detect(photo, (), Progress())
    boxes = clickable(own_recogniser(), photo, known)
    return [find_clicked_box(boxes, float(x), float(y)) for x, y in pixels]


def propose_boxes(
    photo: Photo, *, store: ModelStore | None = None, progress: Progress = SILENT
) -> tuple[LabelledBox, ...] | None:
    """Boxes for a photo, to be corrected by a person; None where there is no detector at all.

    The detector that comes with Diorama proposes more than a build would use unseen.

    Raises:
        UnavailableError: when a network is damaged.
        Cancelled: on request.
    """
    store = store or ModelStore.default()
    stage = detection_stage(store)
    if stage is None:
        return None
    likely = own_detection(LIKELY, MOST_SHOWN)
    if isinstance(stage, OwnDetection) and likely is not None:
        stage = likely
    elif isinstance(stage, JoinedDetection) and likely is not None:
        stage = replace(stage, own=likely)
    lmm = LmmSettings.from_environment()
    recognition = LanguageRecognition(lmm) if lmm is not None and isinstance(stage, OpenVocabularyDetection) else None
    stages = ProposalStages(stage, recognition)
    artefacts = evaluate(stages, {"given": Inputs(photo)}, ("detected_boxes",), Runner(None), progress)
    boxes: tuple[LabelledBox, ...] = artefacts["detected_boxes"]
    return boxes


def _insist_on(store: ModelStore, choice: NetworkChoice) -> None:
    """Refuse a network that the user names and that is not here, instead of doing without."""
    named_ones = (
        choice.detector and choice.detector_file is None and choice.detectors()[0],
        choice.depth and choice.depth_file is None and choice.depth_networks()[0],
    )
    for named in filter(None, named_ones):
        if isinstance(named, str) and named != OWN_DETECTOR and not store.has(network(named)):
            raise UnavailableError(f"{named} is not on this machine; run: diorama models pull {named}")


def _insist(inputs: Inputs, store: ModelStore) -> None:
    needed: list[tuple[str, ...]] = [SEGMENTERS]
    if not inputs.boxes and inputs.instances is None:
        needed.append(DETECTORS)
    if inputs.depth_m is None:
        needed.append(DEPTH_NETWORKS)
    for choices in needed:
        if not any(store.has(network(i)) for i in choices):
            smallest = next(network(i) for i in reversed(choices) if "lite" in network(i).tiers)
            raise UnavailableError(
                f"the foundation profile needs {smallest.title} or better, which is not on this machine; "
                f"{how_to_get(smallest)} (or use --profile auto)"
            )


def _with_published_poses(base: Stages, library: ShapeLibrary, store: ModelStore) -> Stages:
    """Poses by DINOv2's patches, and the scale network's where the user has converted one."""
    features = _best(store, PATCH_FEATURES, network_stages.patch_features)
    if features is None:
        return base
    scale = _best(store, ("gigapose-scale",), network_stages.scale_network)
    return replace(base, pose=CorrespondencePose(library, features=NetworkFeatures(features), scale_network=scale))


def _foregrounds(store: ModelStore) -> tuple[Foreground, ...]:
    stages = (_best(store, kinds, network_stages.foreground) for kinds in FOREGROUNDS)
    return tuple(f for f in stages if f is not None)


def _best(store: ModelStore, choices: tuple[str, ...], make: Callable[[ModelStore, Network], T]) -> T | None:
    here = best_here(store, choices)
    return None if here is None else make(store, here)
