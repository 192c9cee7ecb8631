from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.single_view.box_search import around_objects, find_box
from diorama_core.architecture.single_view.room_cues import PRIOR_MEDIAN_M, gather_room_cues
from diorama_core.architecture.single_view.settings import SETTINGS
from tests.architecture.single_view.plain_cues import CAMERA, cues
from tests.synthetic_rooms import box_room, cuboid, look, shoot


def test_the_photographed_box_is_found() -> None:
    camera = look(15.0, 4.0, fov_deg=75.0, size=(320, 240))
    shot = shoot(camera, box_room(-1.8, 2.2, 4.0, 2.5), (cuboid("table", (-0.6, 2.8, 0), (0.8, 1.0, 0.7)),))
    found = gather_room_cues(shot.inputs.photo.rgb, camera, shot.objects, shot.cuboids)
    box, score = find_box(found)
    assert box[[0, 2]] == pytest.approx([-1.8, 4.0], abs=0.12)
    assert score == pytest.approx(float(found.score(box[None])[0]))
    assert score >= float(found.score(np.array([[-1.8, 2.2, 4.0, 2.5]]))[0]) - 0.05
    again, _ = find_box(found)
    assert again.tolist() == box.tolist()


def test_without_evidence_the_usual_room_is_found() -> None:
    box, _ = find_box(cues())
    sizes = np.array([box[1] - box[0], box[2] - CAMERA.position[1], box[3]])
    np.testing.assert_allclose(sizes, PRIOR_MEDIAN_M, rtol=0.05)


def test_boxes_grow_around_objects_and_never_shrink() -> None:
    item = {"object_low": np.array([[-3.0, 1.0, 0.0]]), "object_high": np.array([[1.0, 5.0, 3.0]])}
    found = around_objects(cues(**item, object_weights=np.ones(1)), np.array([-2.0, 2.0, 4.0, 2.6]))
    np.testing.assert_allclose(
        found, [-3.0 - SETTINGS.search.margin_m, 2.0, 5.0 + SETTINGS.search.margin_m, 3.0 + SETTINGS.search.margin_m]
    )
    box = np.array([-2.0, 2.0, 4.0, 2.6])
    assert around_objects(cues(), box) is box
