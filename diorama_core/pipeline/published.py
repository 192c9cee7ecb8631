"""The paper's system as published, out of the networks on this machine: what its table is measured with."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.architecture.plainrecon.stage import PlainRecon
from diorama_core.artefacts import Inputs
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.store import ModelStore
from diorama_core.perception.foundation.empty_room import EmptyRoomArchitecture
from diorama_core.pipeline.acdc import acdc_stages
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.stages import Stages
from diorama_core.protocols import ArchitectureStage


def with_room(stages: Stages, room: ArchitectureStage) -> Stages:
    """`stages` with another room solver; where furniture is painted out first, it still is."""
    own = stages.architecture
    return replace(stages, architecture=replace(own, room=room) if isinstance(own, EmptyRoomArchitecture) else room)


def published_stages(inputs: Inputs, library: ShapeLibrary, store: ModelStore | None = None) -> Stages:
    """Networks for perception, retrieval and poses by correspondences, PlainRecon, the four stages of layout.

    Args:
        inputs: what the user gave.
        library: where shapes come from.
        store: where networks lie; this machine's by default.

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
