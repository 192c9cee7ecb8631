"""A home in every format: storeys and rooms by name, what is in which, and what comes back of it."""

from __future__ import annotations

import csv
import json
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import pytest

from diorama_core.export import export_scene
from diorama_core.geometry.rooms import rooms_of_objects
from diorama_core.importing.scene_import import import_scene
from diorama_core.io.glb import read_glb
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Scene
from tests.importing.home_files import made_home, write_structure


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    """Six rooms on two storeys."""
    return import_scene(write_structure(tmp_path_factory.mktemp("home") / "home.json", made_home(3))).opened.scene


def written(scene: Scene, folder: Path, kind: str, suffix: str = "") -> Path:
    path = folder / f"home.{suffix or kind}"
    export_scene(scene, built_in_library(), path, kind)
    return path


def test_the_list_names_the_room_of_each_thing(home: Scene, tmp_path: Path) -> None:
    names = {r.id: r.name for r in home.rooms}
    with written(home, tmp_path, "csv").open(encoding="utf-8-sig", newline="") as file:
        rooms = {row["id"]: row["room"] for row in csv.DictReader(file)}
    assert rooms == {name: names[room] for name, room in rooms_of_objects(home).items()}


def test_a_plan_has_a_sheet_a_storey_and_names_its_rooms(home: Scene, tmp_path: Path) -> None:
    root = ET.parse(written(home, tmp_path, "svg")).getroot()
    pages = [e for e in root if e.tag.endswith("svg")]
    assert len(pages) == 2
    for number, page in enumerate(pages):
        texts = [t.text or "" for t in page.iter() if t.tag.endswith("text")]
        named = sorted(t.rsplit(" ", 2)[0] for t in texts if t.endswith("m²"))
        assert named == sorted(r.name for r in home.rooms if r.storey == number)
        assert any(t.endswith(f"storey {number}") for t in texts)


def test_the_pdf_has_a_page_a_storey_and_the_dxf_has_both(home: Scene, tmp_path: Path) -> None:
    pytest.importorskip("reportlab", reason="needs the extra [plan]")
    ezdxf = pytest.importorskip("ezdxf", reason="needs the extra [plan]")
    assert written(home, tmp_path, "pdf").read_bytes().count(b"/Type /Page\n") == 2
    space = ezdxf.readfile(written(home, tmp_path, "dxf")).modelspace()
    floors = [[p[:2] for p in e.get_points()] for e in space.query("LWPOLYLINE[layer=='FLOOR']")]
    assert len(floors) == len(home.rooms)
    lower = max(x for f in floors[:3] for x, _ in f)
    assert min(x for f in floors[3:] for x, _ in f) > lower, "storeys lie beside each other"


def test_ifc_has_storeys_with_a_space_for_each_room(home: Scene, tmp_path: Path) -> None:
    ifcopenshell = pytest.importorskip("ifcopenshell", reason="needs the extra [bim]")
    validate = pytest.importorskip("ifcopenshell.validate")

    model = ifcopenshell.open(str(written(home, tmp_path, "ifc")))
    logger = validate.json_logger()
    validate.validate(model, logger, express_rules=True)
    assert [json.dumps(s, default=str)[:300] for s in logger.statements] == []
    storeys = model.by_type("IfcBuildingStorey")
    heights = sorted({round(float(home.plane(r.floor).centre[2]), 3) for r in home.rooms})
    assert [round(s.Elevation, 3) for s in storeys] == heights
    names = {r.id: r.name for r in home.rooms}
    in_rooms = rooms_of_objects(home)
    for number, storey in enumerate(storeys):
        spaces = [e for rel in storey.IsDecomposedBy for e in rel.RelatedObjects]
        assert [s.Name for s in spaces] == [r.name for r in home.rooms if r.storey == number]
        for space in spaces:
            for item in (e for rel in space.ContainsElements for e in rel.RelatedElements):
                assert names[in_rooms[item.Tag]] == space.Name
        walls = [e for rel in storey.ContainsElements for e in rel.RelatedElements if e.is_a("IfcWall")]
        assert len(walls) == 4 * len(spaces)


def test_sweet_home_has_levels_and_comes_back(home: Scene, tmp_path: Path) -> None:
    path = written(home, tmp_path, "sh3d")
    with zipfile.ZipFile(path) as archive:
        root = ET.fromstring(archive.read("Home.xml"))
    assert [e.get("elevation") for e in root.iter("level")] == ["0.0000", "280.0000"]
    again = import_scene(path, tmp_path / "shapes").opened.scene
    assert [(r.name, r.storey) for r in again.rooms] == [(r.name, r.storey) for r in home.rooms]
    names = {r.id: r.name for r in home.rooms}
    tables = sorted(
        names[room] for name, room in rooms_of_objects(home).items() if home.object(name).category == "desk"
    )
    here = {r.id: r.name for r in again.rooms}
    back = [here[room] for name, room in rooms_of_objects(again).items() if again.object(name).category != "door"]
    assert sorted(back) == tables


def test_glb_groups_by_storey_and_room_and_comes_back_whole(home: Scene, tmp_path: Path) -> None:
    path = written(home, tmp_path, "glb")
    document, _ = read_glb(path.read_bytes())
    nodes = document["nodes"]
    objects = next(n for n in nodes if n["name"] == "objects")
    storeys = [nodes[k] for k in objects["children"]]
    assert len(storeys) == 2
    rooms = [nodes[k] for storey in storeys for k in storey["children"]]
    assert len(rooms) == len(home.rooms)
    assert sum(len(room["children"]) for room in rooms) == len(home.objects)
    assert import_scene(path).opened.scene == home


def test_usd_groups_by_storey_and_room_and_comes_back_whole(home: Scene, tmp_path: Path) -> None:
    pxr = pytest.importorskip("pxr", reason="OpenUSD is not installed (optional extra 'usd')")
    path = written(home, tmp_path, "usdc")
    stage = pxr.Usd.Stage.Open(str(path))
    storeys = stage.GetPrimAtPath("/Scene/Objects").GetChildren()
    assert [s.GetName() for s in storeys] == ["storey_0", "storey_1"]
    assert sum(len(s.GetChildren()) for s in storeys) == len(home.rooms)
    assert import_scene(path).opened.scene == home
