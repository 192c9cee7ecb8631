"""The implementations that one run of the pipeline uses, and the embedded defaults."""

from __future__ import annotations

from dataclasses import dataclass

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.architecture.single_view.stage import PhotoRoom
from diorama_core.artefacts import Inputs
from diorama_core.layout.recipes import recipe as layout_recipe
from diorama_core.layout.refinement.stage import MaskRefinement
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.camera.estimate import EmbeddedCamera, with_given_attitude
from diorama_core.perception.depth import MeasuredDepth, RenderedDepth
from diorama_core.perception.foundation.proposals import own_naming
from diorama_core.perception.masks import EmbeddedMasks
from diorama_core.perception.measured import MeasuredGeometry
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.pose import MadeToMeasure, RenderAndCompare
from diorama_core.protocols import (
    ArchitectureStage,
    CameraStage,
    DepthPredictionStage,
    DepthStage,
    DetectionStage,
    EmptyRoomFiller,
    GeometryStage,
    GraphStage,
    LayoutStage,
    NamingStage,
    ObjectStage,
    PoseStage,
    RecognitionStage,
    RefinementStage,
    RetrievalStage,
)
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval

DEFAULT_RECIPE = "feasible"


@dataclass(frozen=True)
class Stages:
    """The implementations that one run uses. Replace one with `dataclasses.replace(stages, pose=MyPose())`."""

    camera: CameraStage
    objects: ObjectStage
    geometry: GeometryStage
    architecture: ArchitectureStage
    depth: DepthStage
    retrieval: RetrievalStage
    pose: PoseStage
    layout: LayoutStage
    recognition: RecognitionStage | None = None
    """Names kinds of objects to detect; optional, as are the next six."""
    detection: DetectionStage | None = None
    """Proposes boxes where the user gave none."""
    depth_prediction: DepthPredictionStage | None = None
    """Predicts depth from the photo where the user measured none."""
    graph: GraphStage | None = None
    """Decides what supports what; without it the geometry stage does."""
    naming: NamingStage | None = None
    """Says what objects look like; without it, words, sizes and places decide."""
    filler: EmptyRoomFiller | None = None
    """Inpaints furniture for the planes' textures; without it each plane is continued by itself."""
    refinement: RefinementStage | None = None
    """Fits the finished layout to the photo's masks; without it the layout stays as its recipe left it."""


@dataclass(frozen=True)
class ProposalStages:
    """The stages that propose boxes for a photo without boxes."""

    detection: DetectionStage
    recognition: RecognitionStage | None = None


def embedded_stages(inputs: Inputs, library: ShapeLibrary, *, recipe: str = DEFAULT_RECIPE) -> Stages:
    """The stages that need no download, chosen by what the user gave: measured depth or a photo alone."""
    measured = inputs.depth_m is not None
    return Stages(
        camera=with_given_attitude(EmbeddedCamera(), inputs.camera_attitude),
        objects=EmbeddedMasks(),
        geometry=MeasuredGeometry() if measured else SingleViewMetrology(),
        architecture=PlanarRoom() if measured else PhotoRoom(),
        depth=MeasuredDepth() if measured else RenderedDepth(),
        retrieval=HierarchicalRetrieval(library),
        pose=MadeToMeasure(RenderAndCompare(library), library),
        layout=layout_recipe(recipe, library, depth_measured=measured, sizes_reasoned=not measured),
        naming=own_naming(),
        refinement=MaskRefinement.of(library, depth_measured=measured) if recipe == DEFAULT_RECIPE else None,
    )
