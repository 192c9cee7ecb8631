"""What would stand behind a wall is before it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.arrangement.noise import MEASURED, REASONED
from diorama_core.layout.support_check import checked_supports
from tests.layout.feasible.test_photo_observations import LIBRARY, looking_north, outline
from tests.layout.small_rooms import Room


def test_what_would_stand_behind_a_wall_rests_on_what_is_in_its_line_of_sight(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    top = room.objects[0].size_m[2]
    camera = looking_north()
    eye, on_top = camera.position, np.array([0.1, 1.0, top])
    sight = on_top - eye
    far = eye + sight * eye[2] / -sight[2]  # where the line of sight meets the floor
    assert far[1] > 2.5 / 0.9
    size = room.library.shape("cup_21").size_m
    grown = float(np.linalg.norm(far - eye) / np.linalg.norm(sight))
    plant = room.put("cup_21", (far[0], far[1], grown * size[2] / 2), scale=(grown,) * 3)
    scene = room.scene(camera=camera)
    potted = replace(scene, objects=tuple(replace(o, category="plant") if o.id == plant else o for o in scene.objects))
    checked, reasons = checked_supports(potted, LIBRARY, REASONED)
    assert checked.support_of(plant).parent == table
    assert np.allclose(outline(checked, plant), outline(potted, plant), atol=1e-6)
    assert np.allclose(checked.object(plant).size_m, size, rtol=0.01)
    assert "behind" in reasons[0]
    assert checked_supports(potted, LIBRARY, MEASURED)[0].object(plant).pose == potted.object(plant).pose


def test_beside_a_shape_the_box_in_the_photo_says_what_is_in_sight(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    half = room.objects[0].size_m[1] / 2
    camera = looking_north()
    sight = np.array([half + 0.3, 1.0, room.objects[0].size_m[2]]) - camera.position
    far = camera.position + sight * camera.position[2] / -sight[2]
    plant = room.put("cup_21", (far[0], far[1], 0.05))
    scene = room.scene(camera=camera)
    potted = replace(scene, objects=tuple(replace(o, category="plant") if o.id == plant else o for o in scene.objects))
    assert checked_supports(potted, LIBRARY, REASONED)[0].support_of(plant).parent != table
    whole = (0.0, 0.0, 640.0, 480.0)
    boxed = tuple(replace(o, box_px=whole) if o.id == table else o for o in potted.objects)
    checked, _ = checked_supports(replace(potted, objects=boxed), LIBRARY, REASONED)
    assert checked.support_of(plant).parent == table


def test_a_seat_carries_what_is_not_soft_only_where_nothing_else_is_in_sight(room: Room) -> None:
    seat, table = room.put("table_0", (0.0, 0.6, 0.37)), room.put("table_0", (0.0, 1.6, 0.37))
    camera = looking_north()
    sight = np.array([0.0, 0.6, room.objects[0].size_m[2]]) - camera.position
    far = camera.position + sight * camera.position[2] / -sight[2]
    plant = room.put("cup_21", (far[0], 9.0, 0.05))
    whole = (0.0, 0.0, 640.0, 480.0)
    kinds = {seat: "chair", table: "table", plant: "vase"}
    scene = room.scene(camera=camera)
    boxed = tuple(replace(o, category=kinds[o.id], box_px=whole) for o in scene.objects)
    assert checked_supports(replace(scene, objects=boxed), LIBRARY, REASONED)[0].support_of(plant).parent == table
    alone = tuple(o for o in boxed if o.id != table)
    edges = tuple(s for s in scene.supports if s.child != table)
    only = replace(scene, objects=alone, supports=edges)
    assert checked_supports(only, LIBRARY, REASONED)[0].support_of(plant).parent == seat
    rack = replace(only, objects=tuple(replace(o, category="coat rack") if o.id == plant else o for o in only.objects))
    assert checked_supports(rack, LIBRARY, REASONED)[0].support_of(plant).parent != seat


def test_what_people_put_on_furniture_is_at_the_wall_where_nothing_marked_carries_it(room: Room) -> None:
    camera = looking_north()
    far = np.array([0.4, 6.0, 0.3])
    lone = room.put("cup_21", tuple(far), scale=(4.0,) * 3)
    scene = room.scene(camera=camera)

    def named(kind: str):
        return replace(scene, objects=tuple(replace(o, category=kind) for o in scene.objects))

    checked, reasons = checked_supports(named("plant"), LIBRARY, REASONED)
    edge = checked.support_of(lone)
    wall = checked.plane(edge.parent)
    assert (wall.role, edge.relation) == ("wall", "mounted on")
    assert np.allclose(outline(checked, lone), outline(scene, lone), atol=1e-6)
    assert float((checked.object(lone).corners_world @ wall.normal).min()) - wall.offset >= -1e-9
    assert reasons == (f"please check: {checked.object(lone).label} would be behind the wall; what carries it is not "
                       "marked, so it is at the wall",)  # fmt: skip
    chair, silent = checked_supports(named("chair"), LIBRARY, REASONED)  # chairs stand on floors: the wall may be wrong
    assert chair.object(lone).pose == scene.object(lone).pose
    assert not silent
