"""The furniture schedule: a row an object, sizes along the front, nothing that a spreadsheet would calculate."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import pytest

from diorama_core.export import FORMATS, export_scene
from diorama_core.export.schedule import COLUMNS, write_schedule
from tests.export.scenes import gathered, scene_of


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def test_every_object_has_its_row(tmp_path: Path) -> None:
    scene, library = scene_of("example")
    export_scene(scene, library, tmp_path / "room.csv", FORMATS["schedule"])
    rows = {row["id"]: row for row in rows_of(tmp_path / "room.csv")}
    assert rows.keys() == {o.id for o in scene.objects}
    sofa, table = rows["sofa_1"], rows["bowl_1"]
    assert tuple(sofa) == COLUMNS
    assert float(sofa["width_m"]) == pytest.approx(scene.object("sofa_1").size_m[1], abs=1e-3)
    assert float(sofa["width_m"]) > float(sofa["depth_m"])
    assert float(sofa["bottom_m"]) == pytest.approx(scene.object("sofa_1").corners_world[:, 2].min(), abs=1e-3)
    assert table["on"] == "coffee_table_1"
    assert all(row["materials"] and row["kind"] and row["room"] for row in rows.values())


def test_names_are_no_formulas(tmp_path: Path) -> None:
    room = gathered("primitives")
    named = [replace(o, name="=1+1") for o in room.objects[:1]]
    write_schedule(replace(room, objects=(*named, *room.objects[1:])), tmp_path / "room.csv")
    assert "'=1+1" in {row["name"] for row in rows_of(tmp_path / "room.csv")}
