from __future__ import annotations

from diorama_core.architecture.acdc import AcdcRoom
from diorama_core.artefacts import Inputs, Photo
from diorama_core.layout.settled import Settled
from diorama_core.pipeline.acdc import acdc_stages
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.pose.discrete_turns import DiscreteTurns
from diorama_core.retrieval.matched import MatchedByLooks
from tests.pose.rooms import LIBRARY, random_room


def test_rooms_shapes_poses_and_layout_are_replaced_and_perception_stays() -> None:
    inputs = random_room(0).inputs
    base = embedded_stages(inputs, LIBRARY)
    stages = acdc_stages(base, True, LIBRARY)
    assert isinstance(stages.architecture, AcdcRoom)
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
