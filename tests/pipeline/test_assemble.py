from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.artefacts import ArchitectureEstimate, PosedCandidates
from diorama_core.pipeline.assemble import assemble
from diorama_core.provenance import RoomMethod, RoomSource
from diorama_core.scene.types import Architecture, Candidate, Pose, Support
from tests.primitives import PrimitiveLibrary
from tests.synthetic_rooms import box_room, cuboid, look, shoot

LIBRARY = PrimitiveLibrary()
ITEMS = (
    cuboid("table", (0.0, 2.6, 0), (0.8, 1.4, 0.72)),
    cuboid("tray", (0.0, 2.6, 0.72), (0.4, 0.4, 0.05)),
    cuboid("ball", (0.0, 2.6, 0.77), (0.2, 0.2, 0.2)),
)
SHOT = shoot(look(0, 14, 1.5, 70, (160, 120)), box_room(-2.2, 2.2, 4.0, 2.6), ITEMS, ("table", "object", "toy"))
EDGES = (Support("table", "floor"), Support("tray", "table"), Support("ball", "tray"))


def posed(object_id: str, *shapes: str) -> PosedCandidates:
    """Ranked shapes, each where its rank says."""
    made = tuple(
        Candidate(s, LIBRARY.shape(s).size_m, 1.0 - k / 10, Pose.upright((k, 2.6, 0.5))) for k, s in enumerate(shapes)
    )
    return PosedCandidates(object_id, made, 0.7)


def scene_of(*found: PosedCandidates, edges=EDGES, colours=None):
    estimate = ArchitectureEstimate(Architecture(SHOT.planes), edges, 1.0, RoomSource(RoomMethod.GIVEN))
    return assemble(SHOT.objects, SHOT.geometry, estimate, found, LIBRARY, colours or {})


def test_every_object_is_its_best_candidate_with_all_it_came_from() -> None:
    colour = (0.1, 0.2, 0.3)
    scene = scene_of(
        posed("table", "table", "chair"), posed("tray", "ball"), posed("ball", "ball"), colours={"table": colour}
    )
    table = scene.object("table")
    assert (table.shape_id, table.confidence, table.colour) == ("table", 0.7, colour)
    assert [c.shape_id for c in table.candidates] == ["table", "chair"]
    assert table.pose == table.candidates[0].pose
    assert table.box_px == SHOT.objects[0].box
    assert table.mask_id == SHOT.objects[0].mask_id
    assert scene.supports == EDGES
    assert scene.camera == SHOT.camera
    assert scene.architecture.planes == SHOT.planes


def test_an_unknown_object_takes_the_category_and_the_name_of_its_shape() -> None:
    scene = scene_of(posed("tray", "ball"))
    assert scene.object("tray").category == "toy"
    assert (SHOT.objects[1].label, scene.object("tray").label) == ("object", "toy")


def test_what_found_no_shape_is_left_out_and_hands_on_what_it_held() -> None:
    scene = scene_of(posed("table", "table"), posed("ball", "ball"), PosedCandidates("tray", (), 0.0))
    assert not scene.has_object("tray")
    assert scene.support_of("ball").parent == "table"
    floor_only = scene_of(posed("ball", "ball"))
    assert floor_only.support_of("ball").parent == "floor"


def test_an_edge_that_leads_nowhere_is_dropped() -> None:
    lost = (replace(EDGES[0], parent="nowhere"), *EDGES[1:])
    scene = scene_of(posed("table", "table"), posed("ball", "ball"), edges=lost)
    assert scene.support_of("table") is None
    assert scene.support_of("ball").parent == "table"
    assert np.isfinite(scene.object("ball").pose.position).all()
