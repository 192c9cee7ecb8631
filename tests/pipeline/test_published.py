from __future__ import annotations

from pathlib import Path

import pytest

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.architecture.plainrecon.stage import PlainRecon
from diorama_core.errors import UnavailableError
from diorama_core.models.store import ModelStore
from diorama_core.perception.foundation.empty_room import EmptyRoomArchitecture
from diorama_core.pipeline.published import published_acdc_stages, published_stages, with_room
from diorama_core.pipeline.stages import embedded_stages
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
