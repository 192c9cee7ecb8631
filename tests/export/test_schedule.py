"""The furniture list: a row an object, sizes along the front, nothing that a spreadsheet would calculate."""

from __future__ import annotations

import csv
import io
import re
import xml.etree.ElementTree as ET
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image

from diorama_core.export import FORMATS, export_scene
from diorama_core.export.schedule import COLUMNS, NUMBERED, write_csv, write_xlsx
from tests.export.scenes import gathered, scene_of


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def test_every_object_has_its_row(tmp_path: Path) -> None:
    scene, library = scene_of("example")
    export_scene(scene, library, tmp_path / "room.csv", FORMATS["csv"])
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
    write_csv(replace(room, objects=(*named, *room.objects[1:])), tmp_path / "room.csv")
    assert "'=1+1" in {row["name"] for row in rows_of(tmp_path / "room.csv")}


def test_materials_are_named_without_what_tells_them_apart() -> None:
    names = ("leather 02 from the photo 65cf15a3", "leather 3 from the photo 0f1", "light oak", "brass 2")
    assert [NUMBERED.sub("", name) for name in names] == ["leather", "leather", "light oak", "brass"]


def workbook(path: Path) -> tuple[list[list[str | float]], list[Image.Image]]:
    """Cells row by row and pictures, read from the parts of the package."""
    pytest.importorskip("xlsxwriter", reason="pip install 'diorama[plan]'")
    write_xlsx(gathered("example"), path)
    with zipfile.ZipFile(path) as package:
        shared = ["".join(t.text or "" for t in item.iter(f"{MAIN}t")) for item in part(package, "sharedStrings")]
        rows = [
            [shared[int(c.find(f"{MAIN}v").text)] if c.get("t") == "s" else float(c.find(f"{MAIN}v").text) for c in row]
            for row in part(package, "worksheets/sheet1").iter(f"{MAIN}row")
        ]
        media = sorted((n for n in package.namelist() if "/media/" in n), key=lambda n: int(re.sub(r"\D", "", n)))
        return rows, [Image.open(io.BytesIO(package.read(name))) for name in media]


MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"


def part(package: zipfile.ZipFile, name: str) -> ET.Element:
    return ET.fromstring(package.read(f"xl/{name}.xml"))


def test_the_workbook_has_the_rows_of_the_csv_and_pictures(tmp_path: Path) -> None:
    rows, pictures = workbook(tmp_path / "room.xlsx")
    write_csv(gathered("example"), tmp_path / "room.csv")
    expected = rows_of(tmp_path / "room.csv")
    assert rows[0] == [*COLUMNS, "appearance"]
    assert len(rows) - 1 == len(expected)
    for row, texts in zip(rows[1:], expected, strict=True):
        cells = dict(zip(COLUMNS, row, strict=True))
        assert cells["name"] == texts["name"]
        assert cells["materials"] == texts["materials"]
        for column in ("width_m", "height_m", "x_m", "turned_deg"):
            assert cells[column] == pytest.approx(float(texts[column]), abs=5e-4)
    shapes = {o.item.shape_id for o in gathered("example").objects}
    assert len(shapes) <= len(pictures) <= len(expected)  # equal pictures are one file
    assert all(p.size == (96, 96) and p.convert("RGBA").getchannel("A").getbbox() for p in pictures)


def test_the_same_room_gives_the_same_workbook(tmp_path: Path) -> None:
    workbook(tmp_path / "a.xlsx")
    workbook(tmp_path / "b.xlsx")
    assert (tmp_path / "a.xlsx").read_bytes() == (tmp_path / "b.xlsx").read_bytes()


def test_openpyxl_reads_the_workbook(tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    rows, _ = workbook(tmp_path / "room.xlsx")
    sheet = openpyxl.load_workbook(tmp_path / "room.xlsx").active
    assert [cell.value for cell in sheet[2]][:6] == rows[1][:6]
    assert sheet.freeze_panes == "C2"
