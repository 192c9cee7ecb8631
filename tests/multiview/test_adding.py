"""One more photo comes into a scene: seen things join, new ones are inserted, what a person moved stays."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diorama_core.artefacts import FurtherPhoto, Inputs, Photo
from diorama_core.errors import InputError
from diorama_core.evaluation.benchmarks.cases import recipe as recipe_of_rooms
from diorama_core.evaluation.benchmarks.views import RoomView, photograph
from diorama_core.layout.recipes import recipe
from diorama_core.library.catalogue import built_in_library
from diorama_core.multiview import adding
from diorama_core.multiview.adding import AddedPhoto, with_photo
from diorama_core.multiview.registration import photos_of_scene
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.scene.edits import move, remove
from diorama_core.scene.room_edits import move_plane
from diorama_core.scene.types import Camera, Scene
from diorama_core.synthesis.artefacts import photo_only
from diorama_core.synthesis.splits import split_library
from tests.few_shapes import few_shapes
from tests.made_once import made_once
from tests.multiview.two_photos import SMALL, AsItIs, two_photos, with_camera


@pytest.fixture(autouse=True)
def _few_distances(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(adding, "DISTANCES", (0.8, 1.0, 1.25))


def choose(inputs: Inputs) -> Stages:
    return embedded_stages(inputs, few_shapes(of_a_kind=4))


def added(scene: Scene, movable: frozenset[str]) -> AddedPhoto:
    photos, library = two_photos(SMALL), few_shapes(scene, of_a_kind=4)
    known = photos_of_scene(scene, photos.first, ())
    return with_photo(
        scene, known, with_camera(photos), movable, movable, library, choose,
        lambda free: recipe("feasible", library, free, depth_measured=True),
    )  # fmt: skip


@pytest.mark.slow
def test_seen_things_join_new_ones_come_and_what_was_moved_stays() -> None:
    photos = two_photos(SMALL)
    first = next(o for o in photos.scene.objects if o.box_px is not None and o.category == "table")
    scene = move(photos.scene, first.id, replace(first.pose, position=first.pose.position + np.array([0.05, 0.0, 0.0])))
    found = added(scene, frozenset(o.id for o in scene.objects if o.id != first.id))
    new = [found.scene.object(i) for i in found.new]
    assert {o.category for o in new} >= set(photos.missing)
    assert len(found.joined) >= 4
    assert {o.id for o in scene.objects} <= {o.id for o in found.scene.objects}  # nothing is lost
    assert found.scene.object(first.id).pose == scene.object(first.id).pose
    for item in new:
        assert item.box_px is None
    assert {name for name, _ in found.photo.seen} == {*found.new, *found.joined}
    inside = np.array([p.polygon[:, :2] for p in found.scene.architecture.by_role("floor")]).reshape(-1, 2)
    for item in new:
        assert (item.pose.position[:2] > inside.min(axis=0) - 0.3).all()
        assert (item.pose.position[:2] < inside.max(axis=0) + 0.3).all()


def test_a_photo_in_which_nothing_is_found_is_one_line() -> None:
    photos, library = two_photos(SMALL), built_in_library()
    grey = Inputs(Photo(np.full((60, 80, 3), 128, np.uint8), "grey.png", (80, 60)))
    new = FurtherPhoto("grey", grey, replace(photos.camera, intrinsics=photos.camera.intrinsics.resize(80, 60)))
    with pytest.raises(InputError, match="nothing is marked in grey"):
        with_photo(
            photos.scene, (), new, frozenset(), frozenset(), library, choose,
            lambda free: recipe("feasible", library, free),
        )  # fmt: skip
    with pytest.raises(InputError, match="camera is not known"):
        with_photo(
            photos.scene, (), replace(new, camera=None), frozenset(), frozenset(), library, choose,
            lambda free: recipe("feasible", library, free),
        )  # fmt: skip


THERE = ("door_1", "clock_1", "chest_1", "tv_stand_1", "rug_1")
"""What is marked in the photos of the room, and in its scene: enough to tell where they were taken."""


def marked(view: RoomView, name: str, camera: Camera) -> FurtherPhoto:
    """A photo of a made room in which a few things are marked."""
    seen = {o.id: o.box_px for o in view.truth.scene.objects if o.id in THERE and o.box_px is not None}
    inputs = photo_only(view.truth)
    inputs = replace(inputs, boxes=tuple(b for b in inputs.boxes if b.box in seen.values()))
    return FurtherPhoto(name, inputs, camera, tuple(seen.items()))


@cache
def made_views() -> tuple[RoomView, ...]:
    """A room photographed from four places."""
    tested = split_library(built_in_library(), "test")
    return made_once("four views", lambda: tuple(photograph(recipe_of_rooms(3, 1, 101)[0], tested, 4, SMALL)))


def marked_photos() -> list[FurtherPhoto]:
    """Four photos of it, with their cameras in the first one's world."""
    views = made_views()
    first = views[0].truth
    to_first = first.camera.T_world_camera @ np.linalg.inv(views[0].camera.T_world_camera)
    return [
        marked(v, f"photo {n}", Camera(first.camera.intrinsics, to_first @ v.camera.T_world_camera))
        for n, v in enumerate(views)
    ]


def marked_scene() -> Scene:
    """The true room with what is marked."""
    scene = made_views()[0].truth.scene
    return remove(scene, [o.id for o in scene.objects if o.id not in THERE])


@pytest.mark.slow
def test_walls_that_nobody_moved_go_to_what_photos_show_on_them() -> None:
    """A wall that was built too far away comes back to its door; one that a person moved stays."""
    photos, there, library = marked_photos(), marked_scene(), built_in_library()
    wall = there.support_of("door_1").parent
    true_m = there.plane(wall).offset
    scene = move_plane(there, wall, 0.2)
    known = photos_of_scene(scene, photos[0].inputs, (photos[1],))
    free = frozenset([*(o.id for o in scene.objects), *(p.id for p in scene.architecture.planes)])

    def offset(movable: frozenset[str]) -> float:
        new = replace(photos[3], seen=())
        found = with_photo(scene, known, new, movable, movable, library, choose, lambda ids: AsItIs())
        return float(found.scene.plane(wall).offset)

    assert offset(free) == pytest.approx(true_m, abs=0.1)
    assert offset(free - {wall}) == pytest.approx(true_m - 0.2, abs=1e-9)


@pytest.mark.slow
def test_a_box_that_the_other_photos_contradict_does_not_move_an_object() -> None:
    """A clock's box is drawn beside it in one photo of three."""
    photos, scene = marked_photos(), marked_scene()
    right = dict(photos[3].seen)["clock_1"]
    x1, y1, x2, y2 = right
    aside_px = (3.0 if x1 < 320 else -3.0) * (x2 - x1)
    wrong = (x1 + aside_px, y1, x2 + aside_px, y2)
    inputs = photos[3].inputs
    inputs = replace(inputs, boxes=tuple(replace(b, box=wrong if b.box == right else b.box) for b in inputs.boxes))
    seen = tuple((name, wrong if name == "clock_1" else box) for name, box in photos[3].seen)
    known = photos_of_scene(scene, photos[0].inputs, tuple(photos[1:3]))
    free = frozenset({"clock_1"})
    new = replace(photos[3], inputs=inputs, seen=seen)
    found = with_photo(scene, known, new, free, free, built_in_library(), choose, lambda ids: AsItIs())
    moved_m = found.scene.object("clock_1").pose.position - scene.object("clock_1").pose.position
    assert np.linalg.norm(moved_m) < 0.1
    assert "clock_1" in found.joined
