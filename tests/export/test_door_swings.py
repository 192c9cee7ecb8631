"""Doors open into the room where they can, else out of it, else not at all; engines find the same."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.export.door_swings import MIN_OPEN_RAD, DoorSwing, door_swings
from diorama_core.export.gathering import ExportOptions, gather
from diorama_core.export.mjcf import write_mjcf
from diorama_core.export.plan import floor_plan
from diorama_core.library.furniture.articulation import articulation
from diorama_core.scene.types import Pose, Scene, SceneObject
from tests.export.scenes import scene_of


def room_with(*chests: tuple[float, float]) -> Scene:
    """The room with fittings, whose door is in the far wall (y = 3.4) at x = 1.2, and chests of half a metre."""
    scene, library = scene_of("fittings")
    shape = library.in_category("chest")[0]
    scale = tuple(0.5 / np.asarray(shape.size_m))
    boxes = [
        SceneObject(f"chest_{k}", "chest", "chest", shape.id, shape.size_m, Pose.upright((*at, 0.25), 0.0, scale))
        for k, at in enumerate(chests)
    ]
    return replace(scene, objects=(*scene.objects, *boxes))


def swing_in(scene: Scene) -> DoorSwing:
    return door_swings(scene.objects, articulation)["door_1"]


def test_a_free_door_opens_into_the_room() -> None:
    swing = swing_in(room_with())
    assert not swing.outward
    assert swing.free_rad == pytest.approx(np.pi / 2)
    (leaf,) = swing.leaves
    opened = leaf.turn(leaf.outline, swing.free_rad)
    assert opened[:, 1].min() < 3.4 - 0.6, "into the room"
    assert opened[:, 1].max() < 3.4 + 1e-6


def test_what_stands_at_the_end_of_the_way_shortens_it() -> None:
    hinge = swing_in(room_with()).leaves[0].hinge
    swing = swing_in(room_with((float(hinge[0]) + 0.15, 2.6)))
    assert MIN_OPEN_RAD <= swing.free_rad < np.pi / 2


def test_a_door_behind_furniture_opens_out() -> None:
    swing = swing_in(room_with((1.2, 3.0)))
    assert swing.outward
    assert swing.can_open
    (leaf,) = swing.leaves
    assert leaf.turn(leaf.outline, swing.free_rad)[:, 1].max() > 3.4 + 0.6


def test_a_door_between_furniture_does_not_open_and_its_plan_has_no_swing() -> None:
    scene, library = room_with((1.2, 3.0), (1.2, 3.8)), scene_of("fittings")[1]
    assert not swing_in(scene).can_open
    assert [len(line) for line in floor_plan(gather(scene, library)).door_leaves] == [2]
    out = floor_plan(gather(room_with((1.2, 3.0)), library)).door_leaves
    assert len(out) == 2
    assert out[1][:, 1].max() > 3.4 + 0.6, "the arc is drawn where the door opens"


def test_a_person_s_open_door_stays_as_it_stands() -> None:
    scene = room_with((1.2, 3.0))
    ajar = tuple(replace(o, open_share=0.2) if o.id == "door_1" else o for o in scene.objects)
    assert not swing_in(replace(scene, objects=ajar)).outward


@pytest.mark.parametrize("name", [s.id for s in scene_of("fittings")[1].in_category("door")])
def test_leaves_stay_within_their_frame_s_width_when_they_open_out(name: str) -> None:
    library = scene_of("fittings")[1]
    shape = library.shape(name)
    door = SceneObject("d", "door", "door", shape.id, shape.size_m, Pose.upright((0.0, 0.0, 1.0)))
    block = replace(door, id="b", category="chest", pose=Pose.upright((0.3, 0.0, 1.0)))
    swings = door_swings((door, block), articulation)
    assert ("d" in swings) == any(j.kind == "hinge" for j in getattr(articulation(name), "joints", ()))
    for swing in swings.values():
        assert swing.outward
        for leaf in swing.leaves:
            opened = leaf.turn(leaf.outline, swing.free_rad)
            assert np.abs(opened[:, 1]).max() <= shape.size_m[1] / 2 + 1e-3
            assert opened[:, 0].min() < -0.3


def test_mujoco_opens_the_door_that_furniture_stands_before(tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco", reason="needs the extra [sim]")
    for chests in ((), ((1.2, 3.0),)):
        scene = gather(room_with(*chests), scene_of("fittings")[1], options=ExportOptions(joints=True))
        write_mjcf(scene, tmp_path / "room.xml")
        spec = mujoco.MjSpec.from_file(str(tmp_path / "room.xml"))
        motor = spec.add_actuator(name="door", target="door_1__door", trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_position(kp=30, dampratio=1)
        model = spec.compile()
        data = mujoco.MjData(model)
        data.actuator("door").ctrl = np.pi / 2
        for _ in range(round(2.0 / model.opt.timestep)):
            mujoco.mj_step(model, data)
        assert data.joint("door_1__door").qpos[0] == pytest.approx(np.pi / 2, abs=0.2)
