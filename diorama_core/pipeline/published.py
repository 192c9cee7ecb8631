"""The paper's system and ACDC (Dai et al. 2024), each out of its own stages, to compare with."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.architecture.plainrecon.stage import PlainRecon
from diorama_core.artefacts import Inputs
from diorama_core.layout.settled import Settled
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.store import ModelStore
from diorama_core.perception.foundation.empty_room import EmptyRoomArchitecture
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.stages import Stages
from diorama_core.pose.correspondence.solvers import HALF_GRID, CorrespondencePose
from diorama_core.pose.discrete_turns import DiscreteTurns
from diorama_core.protocols import ArchitectureStage
from diorama_core.provenance import RoomMethod
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.retrieval.published import MatchedByLooks


def acdc_stages(base: Stages, has_depth: bool, library: ShapeLibrary) -> Stages:
    """`base` with ACDC's architecture, retrieval, poses and layout.

    Looks are compared as `base` compares them: in a joint embedding where its networks are on this machine. Without
    depth, measured or predicted, the room of `base` stays.
    """
    similarity = base.retrieval.similarity if isinstance(base.retrieval, HierarchicalRetrieval) else None
    views = base.pose if isinstance(base.pose, CorrespondencePose) else CorrespondencePose(library, grid=HALF_GRID)
    return replace(
        base,
        architecture=PlainRecon(method=RoomMethod.ACDC) if has_depth else base.architecture,
        retrieval=MatchedByLooks(library, similarity),
        pose=DiscreteTurns(views),
        layout=Settled(),
        refinement=None,
    )


def with_room(stages: Stages, room: ArchitectureStage) -> Stages:
    """`stages` with another room solver; where furniture is painted out first, it still is."""
    architecture = stages.architecture
    return replace(
        stages,
        architecture=replace(architecture, room=room) if isinstance(architecture, EmptyRoomArchitecture) else room,
    )


def published_stages(inputs: Inputs, library: ShapeLibrary, store: ModelStore | None = None) -> Stages:
    """Networks for perception, retrieval and poses by correspondences, PlainRecon, the four stages of layout.

    Raises:
        UnavailableError: a network that this needs is not on this machine.
    """
    base = stages_for("foundation", inputs, library, recipe="paper", store=store)
    return with_room(base, PlainRecon())


def published_acdc_stages(inputs: Inputs, library: ShapeLibrary, store: ModelStore | None = None) -> Stages:
    """ACDC on the same networks.

    Raises:
        UnavailableError: as `published_stages`.
    """
    base = stages_for("foundation", inputs, library, store=store)
    return acdc_stages(base, inputs.depth_m is not None or base.depth_prediction is not None, library)
