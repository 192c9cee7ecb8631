from __future__ import annotations

from pathlib import Path

import pytest

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.architecture.plainrecon.stage import PlainRecon
from diorama_core.artefacts import Inputs, Photo
from diorama_core.errors import UnavailableError
from diorama_core.layout.settled import Settled
from diorama_core.models.store import ModelStore
from diorama_core.perception.foundation.empty_room import EmptyRoomArchitecture
from diorama_core.pipeline.published import acdc_stages, published_acdc_stages, published_stages, with_room
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.pose.discrete_turns import DiscreteTurns
from diorama_core.provenance import RoomMethod
from diorama_core.retrieval.published import MatchedByLooks
from tests.pose.rooms import LIBRARY, random_room


class _Nothing:
    """Stands for networks that are not asked."""

    def fill(self, *_: object) -> None: ...

    def predict(self, *_: object) -> None: ...


def test_furniture_is_painted_out_for_another_room_solver_too() -> None:
    plain = embedded_stages(random_room(0).inputs, LIBRARY)
    assert with_room(plain, PlainRecon()).architecture == PlainRecon()
    filler = _Nothing()
    emptied = with_room(plain, EmptyRoomArchitecture(PlanarRoom(), filler, filler))
    assert isinstance(emptied.architecture, EmptyRoomArchitecture)
    other = with_room(emptied, PlainRecon()).architecture
    assert isinstance(other, EmptyRoomArchitecture)
    assert (other.room, other.filler) == (PlainRecon(), filler)


@pytest.mark.parametrize("stages", [published_stages, published_acdc_stages])
def test_networks_that_are_missing_are_named(stages, tmp_path: Path) -> None:
    with pytest.raises(UnavailableError, match="diorama models pull"):
        stages(random_room(0).inputs, LIBRARY, ModelStore(tmp_path))


def test_rooms_shapes_poses_and_layout_are_replaced_and_perception_stays() -> None:
    inputs = random_room(0).inputs
    base = embedded_stages(inputs, LIBRARY)
    stages = acdc_stages(base, True, LIBRARY)
    assert stages.architecture == PlainRecon(method=RoomMethod.ACDC)
    assert isinstance(stages.retrieval, MatchedByLooks)
    assert isinstance(stages.pose, DiscreteTurns)
    assert isinstance(stages.layout, Settled)
    assert (stages.objects, stages.geometry, stages.depth, stages.graph) == (
        base.objects,
        base.geometry,
        base.depth,
        base.graph,
    )


def test_a_photo_alone_keeps_its_room() -> None:
    inputs = Inputs(Photo(random_room(0).inputs.photo.rgb, "room", (480, 360)))
    base = embedded_stages(inputs, LIBRARY)
    assert acdc_stages(base, False, LIBRARY).architecture == base.architecture
