from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from diorama_core.evaluation.benchmarks.scans import WAYS, ScanResult, ScansBench, open_all_ways, score
from diorama_core.scene.types import Pose, yaw_rotation
from diorama_core.synthesis.scan import write_scan
from tests.importing.furnished_scans import living_room, searched


def test_a_room_is_right_in_its_own_measure_whichever_way_round_it_lies() -> None:
    truth, _ = living_room()
    R = yaw_rotation(np.pi / 2)
    turned = tuple(
        replace(o, pose=Pose(R @ o.pose.R_world_object, R @ o.pose.position, o.pose.scale)) for o in truth.objects
    )
    found = score("room", "turned", truth, replace(truth, objects=turned), 0.0)
    assert (found.found, found.right) == (found.things, found.things)
    assert (found.openings_found, found.openings_false) == (found.openings, 0)


def test_wrong_kinds_missing_things_and_false_doors_count() -> None:
    truth, _ = living_room()
    sofa = next(o for o in truth.objects if o.category == "sofa")
    others = [o for o in truth.objects if o.category not in ("sofa", "tv stand", "window")]
    window = next(o for o in truth.objects if o.category == "window")
    wrong = replace(truth, objects=(*others, replace(sofa, category="bed"), replace(window, category="door")))
    found = score("room", "wrong", truth, wrong, 0.0)
    assert found.found == found.things - 1
    assert found.right == found.found - 1
    assert (found.openings_found, found.openings_false) == (found.openings - 1, 1)


def test_photos_help_and_the_table_has_a_row_for_each_way(tmp_path: Path) -> None:
    truth, frames = living_room()
    results = open_all_ways("room", truth, write_scan(tmp_path / "scan", frames), searched())
    assert [r.way for r in results] == list(WAYS)
    assert results[2].right > results[0].right
    assert results[0].openings_found == results[0].openings == 2
    (table,) = ScansBench(results).tables()
    assert [row.name for row in table.rows] == list(WAYS)
    share = ScanResult("a", "w", 4, 2, 1, 1, 1, 0, 1.0)
    assert ScansBench((share,)).tables()[0].rows[0].values[0] == 0.5
