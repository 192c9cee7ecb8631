from __future__ import annotations

import numpy as np

from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.refinement.freedom import MEASURED, PosePrior
from diorama_core.layout.refinement.pixel_grid import PixelGrid
from diorama_core.layout.refinement.posed_picture import PosedPicture
from diorama_core.layout.refinement.search import Search
from diorama_core.layout.settings import REFINEMENT
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene
from tests.layout.refinement.views import looking_down, seen_objects
from tests.layout.small_rooms import Room


def settled(room: Room) -> Scene:
    return FeasibleRecipe(room.library).optimise(room.scene(camera=looking_down()), Progress())[0]


def found(
    room: Room, scene: Scene, masks: dict[str, np.ndarray], trust: float = 1.0, observed: Scene | None = None
) -> dict[str, np.ndarray]:
    """Where each object is after the search."""
    assert scene.camera is not None
    problem = build_problem(scene, room.library, adherence_m=0.004)
    items = [scene.object(name) for name in problem.ids]
    grid = PixelGrid.of(scene.camera, 320, 240)
    poses = PoseBatch(problem.R, problem.p, problem.scale)
    casters = [ShapeCaster(room.library.mesh(o.shape_id)) for o in items]
    picture = PosedPicture.of(grid, grid.labels([masks[o.id] for o in items]), casters, poses)
    boxes = np.zeros((len(items), 4))
    for row, item in zip(boxes, items, strict=True):
        rows, columns = np.nonzero(masks[item.id])
        if len(rows):
            row[:] = columns.min(), rows.min(), columns.max() + 1, rows.max() + 1
    seen = [(observed or scene).object(o.id).pose for o in items]
    priors = [PosePrior(scene.camera.position, pose, MEASURED) for pose in seen]
    sized = [False] * len(items)
    after = Search(problem, picture, priors, boxes, np.full(len(items), trust), sized).poses(Progress())
    return dict(zip(problem.ids, after.position, strict=True))


def masks_of(scene: Scene, room: Room) -> dict[str, np.ndarray]:
    return {o.id: o.mask for o in seen_objects(scene, room.library)}


def test_what_covers_its_mask_stays_and_what_does_not_comes_nearer(room: Room) -> None:
    room.put("box_24", (-0.6, 0.4, 0.15), id="right")
    room.put("box_24", (0.6, 0.4, 0.15), id="wrong")
    scene = settled(room)
    aside = edits.place(scene, {"wrong": scene.object("wrong").pose.move((0.1, 0.0, 0.0))})
    for trust in (1.0, 0.4):
        after = found(room, aside, masks_of(scene, room), trust)
        np.testing.assert_allclose(after["right"], scene.object("right").pose.position, atol=0.01)
        left = np.linalg.norm(after["wrong"] - scene.object("wrong").pose.position)
        assert left < 0.06


def test_what_is_hidden_by_what_moves_counts_too(room: Room) -> None:
    room.put("box_24", (0.0, 0.0, 0.15), id="before", scale=(1.0, 1.0, 1.0))
    room.put("box_24", (0.0, 0.9, 0.15), id="behind", scale=(1.0, 1.5, 3.0))
    scene = settled(room)
    masks = masks_of(scene, room)
    empty = np.zeros_like(masks["before"])
    aside = edits.place(scene, {"before": scene.object("before").pose.move((0.2, 0.0, 0.0))})
    # Nothing is known of the nearer one but what it hides of the other.
    assert found(room, aside, {**masks, "before": empty})["before"][0] == aside.object("before").pose.position[0]
    few = empty.copy()
    few[masks["before"]] = np.arange(masks["before"].sum()) % 3 == 0
    assert found(room, aside, {**masks, "before": few})["before"][0] < aside.object("before").pose.position[0] - 0.05


def test_no_mask_makes_an_object_much_larger_than_the_layout_did(room: Room) -> None:
    room.put("box_24", (0.0, 0.4, 0.15), id="box")
    scene = settled(room)
    pose = scene.object("box").pose
    larger = edits.place(scene, {"box": Pose(pose.R_world_object, pose.position, 1.8 * np.array(pose.scale))})
    height = 2.0 * found(room, scene, masks_of(larger, room), observed=larger)["box"][2]
    as_it_was = room.library.shape("box_24").size_m[2]
    assert 1.15 * as_it_was < height <= REFINEMENT.max_growth * as_it_was + 1e-9
