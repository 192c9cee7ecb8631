"""Scans written as RoomPlan writes them come back as they were made."""

from __future__ import annotations

import json
from pathlib import Path

import manifold3d
import numpy as np
import pytest
from shapely.geometry import Polygon

from diorama_app.cli import main
from diorama_core.errors import InputError
from diorama_core.geometry.planes import plane_axes
from diorama_core.importing.measured_room import open_room
from diorama_core.importing.opening import Opened
from diorama_core.importing.roomplan import read_room_plan
from diorama_core.importing.scene_import import import_scene
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import with_kin
from tests.importing.roomplan_files import (
    CORNERS,
    DOOR,
    FLOOR_M,
    FURNITURE,
    HEIGHT_M,
    WINDOW,
    furniture,
    turned,
    walls,
    write_json,
    write_usdz,
)

KINDS = {
    "television": {"television"},
    "toilet": {"toilet"},
    "washerDryer": with_kin("washing machine"),
    "refrigerator": {"refrigerator"},
    "sofa": with_kin("sofa"),
    "table": with_kin("table", "desk"),
    "bed": with_kin("bed"),
    "chair": with_kin("chair", "office chair", "armchair"),
}


def _written(folder: Path, kind: str) -> Path:
    if kind == "json":
        return write_json(folder / "room.json")
    pytest.importorskip("pxr", reason="needs usd-core (pip install 'diorama[usd]')")
    return write_usdz(folder / "room.usdz", baked=kind == "baked")


@pytest.fixture(scope="module", params=["json", "usdz", "baked"])
def scan(request, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Opened]:
    path = _written(tmp_path_factory.mktemp("scan"), request.param)
    return request.param, import_scene(path).opened


def test_walls_floor_and_ceiling_are_exact(scan: tuple[str, Opened]) -> None:
    _, opened = scan
    architecture = opened.scene.architecture
    found = architecture.by_role("wall")
    assert len(found) == len(CORNERS)
    for wall in walls():
        truth = np.array([[*p, z] for p in (wall.start, wall.end) for z in (FLOOR_M, FLOOR_M + HEIGHT_M)])
        off = [max(np.linalg.norm(p.polygon - c, axis=1).min() for c in truth) for p in found]
        best = found[int(np.argmin(off))]
        assert min(off) < 0.01
        inward = np.array([-wall.along[1], wall.along[0], 0.0])
        np.testing.assert_allclose(best.normal, inward, atol=1e-5)
    truth = Polygon(turned(CORNERS))
    for role, height in (("floor", FLOOR_M), ("ceiling", FLOOR_M + HEIGHT_M)):
        (plane,) = architecture.by_role(role)
        assert truth.symmetric_difference(Polygon(plane.polygon[:, :2])).area < 0.01
        np.testing.assert_allclose(plane.polygon[:, 2], height, atol=1e-6)
        assert plane.normal[2] == pytest.approx(1.0 if role == "floor" else -1.0)


def test_every_box_is_an_object_of_its_kind_in_its_place(scan: tuple[str, Opened]) -> None:
    kind_of_file, opened = scan
    hung = [o for o in opened.scene.objects if o.category in ("door", "window")]
    objects = [o for o in opened.scene.objects if o not in hung]
    assert len(objects) == len(FURNITURE)
    assert len(hung) == 2
    for item, row in zip(objects, FURNITURE, strict=True):
        kind, (width, height, depth), T, yaw = furniture(row)
        np.testing.assert_allclose(item.pose.position, T[:3, 3], atol=1e-5)
        assert item.category in KINDS.get(kind, {item.category}), kind
        assert len(item.candidates) > 1
        assert item.size_m[2] == pytest.approx(height, abs=1e-5)
        if kind_of_file == "baked":
            continue  # a box without its axes has no front
        np.testing.assert_allclose(item.size_m, [depth, width, height], atol=1e-5)
        assert np.cos(item.pose.yaw_rad - yaw) > 0.999, kind


def test_everything_stands_on_something(scan: tuple[str, Opened]) -> None:
    scene = scan[1].scene
    edges = {s.child: s for s in scene.supports}
    by_kind = {o.category: o for o in scene.objects}
    assert set(edges) == {o.id for o in scene.objects}
    assert scene.object(edges[by_kind["television"].id].parent).label == "storage"
    assert edges[by_kind["refrigerator"].id].parent == "floor"
    for kind, spec in (("door", DOOR), ("window", WINDOW)):
        edge = edges[by_kind[kind].id]
        wall, truth = scene.plane(edge.parent), walls()[spec[0]]
        middle = truth.placed(spec[1], FLOOR_M + spec[4] + spec[3] / 2)[:3, 3]
        assert edge.relation == "mounted on"
        assert abs(wall.normal @ middle - wall.offset) < 0.01
        assert np.linalg.norm((by_kind[kind].pose.position - middle)[[0, 1]]) < 0.05
        np.testing.assert_allclose(by_kind[kind].size_m[1:], spec[2:4], atol=1e-5)


def test_a_front_that_looks_into_its_wall_is_turned_round(tmp_path: Path) -> None:
    backward = tuple((*row[:7], row[7] + 180) if row[0] == "refrigerator" else row for row in FURNITURE)
    scene = import_scene(write_json(tmp_path / "room.json", backward)).opened.scene
    item = next(o for o in scene.objects if o.category == "refrigerator")
    yaw = furniture(next(row for row in FURNITURE if row[0] == "refrigerator"))[3]
    assert np.cos(item.pose.yaw_rad - yaw) > 0.999


def test_walls_enclose_the_floor_where_the_file_has_none(tmp_path: Path) -> None:
    scene = import_scene(write_json(tmp_path / "room.json", floors=False)).opened.scene
    floor = scene.architecture.floor
    assert Polygon(turned(CORNERS)).symmetric_difference(Polygon(floor.polygon[:, :2])).area < 0.01
    assert floor.polygon[0, 2] == pytest.approx(FLOOR_M)


def test_the_command_makes_a_project(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_json(tmp_path / "room.json")
    assert main(["import", str(path), "-o", str(tmp_path / "room")]) == 0
    said = capsys.readouterr()
    assert f"{len(FURNITURE) + 2} objects, 8 planes" in said.out
    assert "opening" not in said.err
    assert main(["export", str(tmp_path / "room"), "--format", "glb", "-o", str(tmp_path / "room.glb")]) == 0


def test_a_wall_cabinet_hangs_and_attributes_name_kinds(tmp_path: Path) -> None:
    rows = (("storage", 0.8, 0.7, 0.34, 3.2, 0.17, 1.4, 90), ("table", 1.0, 0.5, 0.6, 1.0, 1.0, 0.0, 0))
    path = write_json(tmp_path / "room.json", rows)
    document = json.loads(path.read_text())
    document["objects"][1]["attributes"] = {"TableType": "coffee"}
    document["objects"][1]["confidence"] = {"low": {}}
    path.write_text(json.dumps(document))
    opened = import_scene(path).opened
    cabinet, table = opened.scene.objects[:2]
    assert cabinet.category in with_kin("wall cabinet", "shelves")
    edge = opened.scene.support_of(cabinet.id)
    assert edge.relation == "mounted on"
    assert table.category == "coffee table"
    assert any("unsure of 1 of 2" in line for line in opened.changes)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d["walls"][0].update(transform=[1.0] * 15), "makes no sense"),
        (lambda d: d["walls"][0].update(transform=[0.0] * 16), "no rotation"),
        (lambda d: d["walls"][0].update(transform=[float("1e999")] * 16), "room.json"),
        (lambda d: d["objects"][0].update(dimensions=[1, -1, 1]), "no lengths"),
        (lambda d: d["objects"].append(3), "makes no sense"),
        (lambda d: d.update(doors={"a": 1}), "lists"),
        (lambda d: d.pop("walls"), "no scan of RoomPlan"),
    ],
)
def test_what_makes_no_sense_is_one_line(tmp_path: Path, change, words: str) -> None:
    path = write_json(tmp_path / "room.json")
    document = json.loads(path.read_text())
    change(document)
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match=words):
        import_scene(path)


def test_an_empty_scan_is_an_empty_room(tmp_path: Path) -> None:
    (tmp_path / "room.json").write_text('{"walls": []}')
    room = read_room_plan(tmp_path / "room.json")
    scene = open_room(room, built_in_library()).scene
    assert (scene.objects, scene.architecture.planes) == ((), ())


def test_an_opening_without_a_door_cuts_its_wall(tmp_path: Path) -> None:
    wall = import_scene(write_json(tmp_path / "room.json", ())).opened.scene.plane("wall-3")
    truth = walls()[2]
    whole = truth.length * HEIGHT_M
    triangles = manifold3d.triangulate([wall.polygon @ np.stack(plane_axes(wall.normal), axis=1)])
    a, b, c = (wall.polygon[triangles[:, k]] for k in range(3))
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2
    assert area == pytest.approx(whole - 0.8 * 2.0, abs=1e-4)


@pytest.mark.parametrize(
    ("change", "kinds", "words"),
    [
        ({"category": {"lamp": {}}}, {"floor lamp", "lamp"}, ""),
        ({"category": {"hammock": {}}}, {"object"}, ""),
        ({"category": None}, {"object"}, ""),
        ({"transform": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1]}, set(), "a chair lies on its side"),
        ({"dimensions": [0.0, 0.0, 0.0]}, set(), "a chair lies on its side or has no size"),
    ],
)
def test_odd_things_cost_themselves_at_most(tmp_path: Path, change: dict, kinds: set, words: str) -> None:
    rows = (FURNITURE[0], ("chair", 0.4, 1.6, 0.4, 2.0, 1.1, 0.0, 215))
    path = write_json(tmp_path / "room.json", rows)
    document = json.loads(path.read_text())
    document["objects"][1].update(change)
    path.write_text(json.dumps(document))
    opened = import_scene(path).opened
    things = [o for o in opened.scene.objects if o.category not in ("door", "window")]
    assert things[0].category in KINDS["bed"]
    assert {o.category for o in things[1:]} <= kinds
    assert len(things) == 1 + bool(kinds)
    assert words in " ".join(opened.changes)
