from __future__ import annotations

import importlib
import sys
from dataclasses import replace

import numpy as np
import pytest

from diorama_core.errors import UnavailableError
from diorama_core.layout.exact import drift, mesh_overlap_m3, stable_share
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.progress import Progress
from diorama_core.synthesis.layout_rooms import box_library, generate_room
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def has_mujoco() -> bool:
    try:
        importlib.import_module("mujoco")
    except ImportError:
        return False
    return True


needs_mujoco = pytest.mark.skipif(not has_mujoco(), reason="MuJoCo is not installed (optional extra 'sim')")


def test_shared_volume_of_two_boxes(room: Room) -> None:
    room.put("box_24", (0, 0, 0.15))
    room.put("box_24", (0.25, 0.0, 0.15))
    assert mesh_overlap_m3(room.scene(), LIBRARY) == pytest.approx(0.1 * 0.45 * 0.3, rel=1e-4)


def test_supporters_are_left_out_unless_asked(room: Room) -> None:
    box = room.put("box_24", (0, 0, 0.15))
    room.put("cup_21", (0, 0, 0.3), on=box)
    assert mesh_overlap_m3(room.scene(), LIBRARY) == 0.0
    assert mesh_overlap_m3(room.scene(), LIBRARY, skip_supporters=False) == pytest.approx(0.09**2 * 0.05, rel=1e-4)


def test_feasible_leaves_no_shared_volume() -> None:
    room = generate_room(0, 20)
    after, _ = FeasibleRecipe(LIBRARY).optimise(room.observed, Progress())
    assert mesh_overlap_m3(after, LIBRARY) <= 0.01 * mesh_overlap_m3(room.observed, LIBRARY) + 1e-9


@needs_mujoco
def test_a_feasible_room_stands_still_and_a_floating_box_falls(room: Room) -> None:
    after, _ = FeasibleRecipe(LIBRARY).optimise(generate_room(1, 12).observed, Progress())
    assert stable_share(drift(after, LIBRARY)) >= 0.98
    floating = room.put("box_24", (0, 0, 0.6))
    moved, _ = drift(room.scene(), LIBRARY)[floating]
    assert moved == pytest.approx(0.45, abs=0.03)


def test_without_mujoco_the_reason_is_said(room: Room, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    room.put("box_24", (0, 0, 0.15))
    with pytest.raises(UnavailableError, match="MuJoCo"):
        drift(room.scene(), LIBRARY)


def test_shares() -> None:
    assert stable_share({}) == 1.0
    assert stable_share({"a": (0.0, 0.0), "b": (0.5, 0.0), "c": (0.0, 1.0), "d": (0.009, np.deg2rad(1.9))}) == 0.5


def test_a_rug_does_not_lift_what_stands_over_its_edge(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.0, 0.37))
    room.put("box_24", (0.0, 0.0, 0.025), scale=(8.0, 8.0, 0.05 / 0.3), id="rug")
    scene = room.scene()
    objects = tuple(replace(o, category="rug") if o.id == "rug" else o for o in scene.objects)
    assert drift(scene, room.library, seconds=1.0)[table][0] > 0.002
    assert drift(replace(scene, objects=objects), room.library, seconds=1.0)[table][0] < 0.002
