from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.support import check_scene, descendants
from diorama_core.scene.types import Architecture, Candidate, Pose, Scene, SceneObject, Support
from tests.scene.strategies import FLOOR, candidates, objects, poses, scenes, words


@st.composite
def edit_calls(draw: st.DrawFn):
    """A function that applies one random edit to any scene; ids may be missing, as stale clicks are."""
    some_id = st.sampled_from([f"item_{i}" for i in range(6)] + ["floor", "wall_1", "nothing", "chair_1"])
    kind = draw(st.integers(0, 10))
    a, b = draw(some_id), draw(some_id)
    if kind == 0:
        pose = draw(poses())
        return lambda s: edits.move(s, a, pose)
    if kind == 1:
        candidate, keep = draw(candidates()), draw(st.booleans())
        return lambda s: edits.swap(s, a, candidate, keep_pose=keep)
    if kind == 2:
        item = draw(objects(draw(st.sampled_from(["item_0", "item_7", "item_8"]))))
        return lambda s: edits.insert(s, item, Support(item.id, b))
    if kind == 3:
        return lambda s: edits.remove(s, [a, b])
    if kind == 4:
        return lambda s: edits.duplicate(s, a)[0]
    if kind == 5:
        return lambda s: edits.attach(s, Support(a, b))
    if kind == 6:
        return lambda s: edits.detach(s, a)
    if kind == 7:
        locked = draw(st.booleans())
        return lambda s: edits.set_locked(s, a, locked)
    if kind == 8:
        name = draw(words)
        return lambda s: edits.rename(s, a, name)
    if kind == 9:
        return lambda s: edits.set_planes(s, s.architecture.planes[:1])
    return lambda s: edits.recolour(s, a, (0.1, 2.0, -1.0))


@given(scenes(), st.lists(edit_calls(), max_size=10))
def test_any_sequence_of_edits_keeps_the_scene_valid(scene: Scene, calls: list) -> None:
    for call in calls:
        with suppress(EditRefused):
            scene = call(scene)
        check_scene(scene)


@given(scenes().filter(lambda s: len(s.objects) > 1), poses(), st.data())
def test_moving_carries_what_is_supported_up(scene: Scene, pose: Pose, data: st.DataObject) -> None:
    moved_id = data.draw(st.sampled_from([o.id for o in scene.objects]))
    moved = edits.move(scene, moved_id, pose)
    followers = set(descendants(scene, moved_id))
    old_parent, new_parent = scene.object(moved_id).pose, moved.object(moved_id).pose
    for item in scene.objects:
        after = moved.object(item.id).pose
        if item.id in followers:
            relative_before = np.linalg.inv(old_parent.T_world_object) @ item.pose.T_world_object
            relative_after = np.linalg.inv(new_parent.T_world_object) @ after.T_world_object
            np.testing.assert_allclose(relative_after, relative_before, atol=1e-9)
        elif item.id != moved_id:
            assert after == item.pose


def _stack() -> Scene:
    scene = Scene(architecture=Architecture((FLOOR,)))
    size = (0.4, 0.4, 0.4)
    for i, name in enumerate(["table_1", "tray_1", "cup_1"]):
        item = SceneObject(name, name, "table", f"shape_{name}", size, Pose.upright((0, 1, 0.2 + 0.4 * i)))
        parent = "floor" if i == 0 else ["table_1", "tray_1"][i - 1]
        scene = edits.insert(scene, item, Support(name, parent))
    return scene


def test_removing_hands_children_to_the_remaining_supporter() -> None:
    scene = edits.remove(_stack(), ["tray_1"])
    edge = scene.support_of("cup_1")
    assert edge is not None
    assert edge.parent == "table_1"


def test_a_cycle_is_refused_with_the_reason() -> None:
    with pytest.raises(EditRefused, match="already holds up"):
        edits.attach(_stack(), Support("table_1", "cup_1"))


def test_a_locked_object_does_not_move_or_vanish() -> None:
    scene = edits.set_locked(_stack(), "tray_1", True)
    with pytest.raises(EditRefused, match="locked"):
        edits.move(scene, "tray_1", Pose.upright((0, 0, 0)))
    with pytest.raises(EditRefused, match="locked"):
        edits.remove(scene, ["tray_1"])


def test_swapping_to_a_taller_shape_keeps_the_base_and_lifts_what_stands_on_it() -> None:
    scene = _stack()
    taller = Candidate("tall", (0.4, 0.4, 0.6), 1.0, Pose.upright((9, 9, 9)))
    swapped = edits.swap(scene, "table_1", taller, keep_pose=True)
    table = swapped.object("table_1")
    assert table.corners_world[:, 2].min() == pytest.approx(0.0)
    assert table.pose.position[:2] == pytest.approx([0, 1])
    assert swapped.object("cup_1").pose.position[2] == pytest.approx(1.0 + 0.2)


def test_a_duplicate_has_its_own_id_and_the_same_supporter() -> None:
    scene, copy_id = edits.duplicate(_stack(), "tray_1")
    edge = scene.support_of(copy_id)
    assert copy_id != "tray_1"
    assert edge is not None
    assert edge.parent == "table_1"


def test_absurd_sizes_are_refused() -> None:
    with pytest.raises(EditRefused, match="keep every side between"):
        edits.move(_stack(), "cup_1", Pose.upright((0, 0, 0), scale=(1e6, 1, 1)))


def test_a_door_stands_open_by_a_share() -> None:
    door = SceneObject("door_1", "door", "door", "d", (0.1, 0.9, 2.0), Pose.upright((0.0, 0.0, 1.0)))
    before = Scene(objects=(door,))
    scene = edits.set_open(before, "door_1", 0.4)
    assert scene.objects[0].open_share == 0.4
    for wrong in (-0.1, 1.5, float("nan")):
        with pytest.raises(EditRefused, match="100 %"):
            edits.set_open(before, "door_1", wrong)
