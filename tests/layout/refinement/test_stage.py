from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import LayoutReport
from diorama_core.errors import Cancelled
from diorama_core.layout.exact import mesh_overlap_m3
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.refinement.stage import MaskRefinement
from diorama_core.progress import CancelToken, Progress
from diorama_core.protocols import RefinementStage
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene
from diorama_core.synthesis.layout_rooms import box_library, generate_room
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.refinement.views import agreement, looking_down, seen_objects
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def refined(settled: Scene, observed: Scene, objects: tuple, report: LayoutReport | None = None) -> Scene:
    report = report or LayoutReport("feasible", {}, {}, 0.0)
    stage = MaskRefinement.of(LIBRARY, depth_measured=True)
    return stage.refine(settled, report, observed, objects, Progress())[0]


@pytest.mark.parametrize("seed", [1, 3])
def test_rooms_agree_better_with_their_masks_and_are_as_sound(seed: int) -> None:
    made = generate_room(seed, 14)
    truth, observed = (replace(scene, camera=looking_down()) for scene in (made.truth, made.observed))
    objects = seen_objects(truth, LIBRARY)
    settled, report = FeasibleRecipe(LIBRARY).optimise(observed, Progress())
    stage = MaskRefinement.of(LIBRARY, depth_measured=True)
    assert isinstance(stage, RefinementStage)
    after, updated = stage.refine(settled, report, observed, objects, Progress())
    assert agreement(after, objects, LIBRARY) > agreement(settled, objects, LIBRARY) + 0.03
    for figure in ("orientation", "placement", "in_support"):
        assert updated.after[figure] >= report.after[figure]
    assert updated.after["part_overlap_m"] <= report.after["part_overlap_m"] + 1e-5
    assert mesh_overlap_m3(after, LIBRARY) <= mesh_overlap_m3(settled, LIBRARY) + 1e-6
    assert updated.seconds > report.seconds


def test_a_moved_box_returns_to_where_its_mask_is(room: Room) -> None:
    room.put("box_24", (0.0, 0.4, 0.15), id="box")
    scene = room.scene(camera=looking_down())
    settled, _ = FeasibleRecipe(LIBRARY).optimise(scene, Progress())
    pose = settled.object("box").pose
    aside = edits.place(settled, {"box": pose.move((0.12, 0.0, 0.0))})
    back = refined(aside, scene, seen_objects(settled, LIBRARY)).object("box").pose
    assert abs(back.position[0] - pose.position[0]) < 0.04


def test_what_is_locked_or_has_no_mask_stays(room: Room) -> None:
    for k, more in enumerate(({"locked": True}, {}, {})):
        room.put("box_24", (k - 1.0, 0.4, 0.15), id=f"box {k}", **more)
    scene = room.scene(camera=looking_down())
    settled, _ = FeasibleRecipe(LIBRARY).optimise(scene, Progress())
    objects = seen_objects(settled, LIBRARY)[:2]
    aside = edits.place(settled, {o.id: o.pose.move((0.1, 0.0, 0.0)) for o in settled.objects})
    after = refined(aside, scene, objects)
    moved = {o.id: o.pose.position[0] - aside.object(o.id).pose.position[0] for o in after.objects}
    assert moved["box 0"] == moved["box 2"] == 0.0
    assert moved["box 1"] < -0.03
    assert refined(aside, scene, ()) == aside


def test_things_of_one_set_keep_their_common_size(room: Room) -> None:
    for k in range(2):
        room.put("box_24", (k - 0.5, 0.4, 0.15), id=f"box {k}")
    room.put("box_24", (1.5, 0.4, 0.15), id="alone", scale=(1.1, 1.1, 1.1))
    scene = room.scene(camera=looking_down())
    settled, _ = FeasibleRecipe(LIBRARY).optimise(scene, Progress())
    larger = {
        o.id: Pose(o.pose.R_world_object, o.pose.position, 1.15 * np.array(o.pose.scale)) for o in settled.objects
    }
    objects = seen_objects(edits.place(settled, larger), LIBRARY)
    after = refined(settled, settled, objects)
    assert np.array_equal(after.object("box 0").pose.scale, settled.object("box 0").pose.scale)
    assert np.mean(after.object("alone").pose.scale) > 1.03 * np.mean(settled.object("alone").pose.scale)


def test_it_can_be_cancelled(room: Room) -> None:
    room.put("box_24", (0.0, 0.4, 0.15))
    scene, token = room.scene(camera=looking_down()), CancelToken()
    token.cancel()
    objects, stage = seen_objects(scene, LIBRARY), MaskRefinement.of(LIBRARY, depth_measured=False)
    with pytest.raises(Cancelled):
        stage.refine(scene, LayoutReport("feasible", {}, {}, 0.0), scene, objects, Progress(token=token))


def test_a_height_that_the_layout_gave_is_not_taken_back(room: Room) -> None:
    """The photo cuts both of its ends: what was seen of its height says nothing against the floor below it."""
    room.put("wardrobe_12", (0.0, -0.4, 1.0), id="wardrobe", yaw=-np.pi / 2, scale=(1.0, 1.0, 0.93))
    observed = room.scene(camera=looking_north(height_m=1.0))
    settled = edits.place(observed, {"wardrobe": Pose.upright((0.0, -0.4, 1.0), -np.pi / 2)})
    after = refined(settled, observed, seen_objects(settled, LIBRARY)).object("wardrobe").pose
    assert after.scale[2] == pytest.approx(1.0, abs=0.01)
