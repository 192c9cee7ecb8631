"""Floor plans: what is drawn, and how the three formats say it."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from diorama_core.errors import ExportError
from diorama_core.export import export_scene
from diorama_core.export.gathering import gather
from diorama_core.export.plan import floor_plan
from diorama_core.export.plan_dxf import TEXT_MM
from diorama_core.export.plan_sheet import SheetLine, Text, plan_sheet
from diorama_core.geometry.planes import signed_area
from diorama_core.scene.types import Architecture, Plane, Pose, Scene, SceneObject, Support
from tests.export.scenes import scene_of
from tests.primitives import PrimitiveLibrary, box_room, furnished_room

LIBRARY = PrimitiveLibrary()


def room_with_door_and_window() -> Scene:
    scene = furnished_room(LIBRARY)
    size = LIBRARY.shape("print").size_m
    door = SceneObject("d", "door", "door", "print", size, Pose.upright((1.0, 4.99, 1.0), -np.pi / 2, (1, 1.1, 3.3)))
    window = SceneObject("w", "window", "window", "print", size, Pose.upright((-1.99, 2.0, 1.5), 0.0, (1, 1.5, 1.5)))
    edges = (Support("d", "back", "mounted on"), Support("w", "left", "mounted on"))
    return replace(scene, objects=(*scene.objects, door, window), supports=(*scene.supports, *edges))


@pytest.mark.parametrize(("shape", "lines"), [("door-sliding", 1), ("door-oak", 2)])
def test_only_a_door_with_hinges_swings(shape: str, lines: int) -> None:
    scene, library = scene_of("fittings")
    door = scene.object("door_1")
    other = replace(door, shape_id=shape, shape_size_m=library.shape(shape).size_m)
    objects = tuple(other if o.id == door.id else o for o in scene.objects)
    assert len(floor_plan(gather(replace(scene, objects=objects), library)).door_leaves) == lines


def test_walls_are_cut_and_closed_at_corners() -> None:
    plan = floor_plan(gather(room_with_door_and_window(), LIBRARY))
    area = sum(signed_area(w) for w in plan.walls)
    ring = 4.1 * 5.1 - 4 * 5
    assert area == pytest.approx(ring - 0.05 * (0.88 + 1.2), abs=1e-3)
    assert len(plan.window_panes) == 4
    leaf, swing = plan.door_leaves
    assert np.linalg.norm(leaf[1] - leaf[0]) == pytest.approx(0.88)
    assert (swing[:, 1] <= 5 + 1e-9).all(), "the door swings into the room"


def test_corners_that_point_into_the_room_stay_clear() -> None:
    outline = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]
    floor = Plane("floor", "floor", np.array([[x, y, 0] for x, y in outline], float))
    walls = []
    for number, (a, b) in enumerate(zip(outline, outline[1:] + outline[:1], strict=True)):
        corners = [[*b, 0], [*a, 0], [*a, 2.5], [*b, 2.5]]
        walls.append(Plane(f"w{number}", "wall", np.array(corners, float), thickness=0.1))
    plan = floor_plan(gather(Scene(architecture=Architecture((floor, *walls))), LIBRARY))
    assert sum(signed_area(w) for w in plan.walls) == pytest.approx(16 * 0.1 + 0.01 * 5 - 0.01, abs=2e-3)


def _rug_and_chair(rug_bottom: float) -> list[str]:
    scene = furnished_room(LIBRARY)
    chair = next(o for o in scene.objects if o.category == "chair")
    size = LIBRARY.shape("print").size_m
    rug_pose = Pose.upright(
        (*chair.pose.position[:2], rug_bottom + 0.007), 0.0, (1.5 / size[0], 1.5 / size[1], 0.014 / size[2])
    )
    rug = SceneObject("rug", "rug", "rug", "print", size, rug_pose)
    plan = floor_plan(gather(replace(scene, objects=(*scene.objects, rug)), LIBRARY))
    order = [p.id for p in plan.pieces]
    return order[order.index("rug") :]


@pytest.mark.parametrize("rug_bottom", [0.0, 0.001, -0.002])
def test_rugs_are_drawn_under_furniture(rug_bottom: float) -> None:
    chair = next(o.id for o in furnished_room(LIBRARY).objects if o.category == "chair")
    assert chair in _rug_and_chair(rug_bottom)


def test_floors_end_at_walls() -> None:
    """A floor that was seen through a gap reaches behind the wall as a wedge, which covers the wall."""
    planes = box_room().planes
    floor = next(p for p in planes if p.role == "floor")
    x0, y0, x1, y1 = *floor.polygon[:, :2].min(axis=0), *floor.polygon[:, :2].max(axis=0)
    wedge = np.array([[x0, y0], [x1, y0], [x1, y1], [x1 + 0.3, y1], [x1 + 0.3, y1 + 0.6], [x0, y1]])
    wider = replace(floor, polygon=np.column_stack([wedge, np.full(len(wedge), floor.polygon[0, 2])]))
    scene = Scene(architecture=Architecture(tuple(wider if p.role == "floor" else p for p in planes)))
    usual = Scene(architecture=Architecture(planes))
    plan, expected = (floor_plan(gather(s, LIBRARY)) for s in (scene, usual))
    for drawn, known in ((plan.floors, expected.floors), (plan.walls, expected.walls)):
        assert sum(map(signed_area, drawn)) == pytest.approx(sum(map(signed_area, known)), abs=0.01)


def test_lengths_are_those_of_the_walls() -> None:
    plan = floor_plan(gather(room_with_door_and_window(), LIBRARY))
    texts = sorted(d.text for d in plan.dimensions)
    assert texts.count("4.00") == 2
    assert texts.count("5.00") == 2
    assert {"0.88", "1.20"} <= set(texts)


def test_the_sheet_is_in_scale() -> None:
    plan = floor_plan(gather(furnished_room(LIBRARY), LIBRARY))
    sheet = plan_sheet(plan)
    walls = next(m for m in sheet.marks if isinstance(m, SheetLine) and m.group == "walls")
    extent = np.ptp(np.concatenate(walls.points), axis=0)
    np.testing.assert_allclose(extent, np.array([4.1, 5.1]) * 1000 / sheet.scale, atol=1e-6)
    every = np.concatenate([p for m in sheet.marks if isinstance(m, SheetLine) for p in m.points])
    assert (every >= 0).all()
    assert (every <= [sheet.width_mm, sheet.height_mm]).all()
    assert {"table", "chair"} <= {m.text for m in sheet.marks if isinstance(m, Text)}


def test_the_sheet_has_the_floor_s_area_and_a_schedule() -> None:
    scene = furnished_room(LIBRARY)
    sheet = plan_sheet(floor_plan(gather(scene, LIBRARY)))
    texts = [m for m in sheet.marks if isinstance(m, Text)]
    assert "20.0 m²" in {t.text for t in texts}
    rows: dict[float, dict[float, str]] = {}
    for text in (t for t in texts if t.group == "schedule"):
        rows.setdefault(text.at[1], {})[text.at[0]] = text.text
    _, *listed = [[row[x] for x in sorted(row)] for row in rows.values()]
    named = [o.label for o in scene.objects if o.category != "rug"]
    assert sum(int(number) for number, *_ in listed) == len(named)
    assert {label for _, label, _ in listed} == set(named)
    depth, width, height = scene.object("t").size_m
    assert f"{width:.2f} × {depth:.2f} × {height:.2f}" in {size for *_, size in listed}


def test_a_schedule_longer_than_the_page_counts_the_rest() -> None:
    scene = furnished_room(LIBRARY)
    many = [replace(scene.objects[0], id=f"o{k}", label=f"thing {k:03d}") for k in range(120)]
    crowded = replace(scene, objects=tuple(many), supports=())
    sheet = plan_sheet(floor_plan(gather(crowded, LIBRARY)))
    texts = [m for m in sheet.marks if isinstance(m, Text) and m.group == "schedule"]
    assert min(t.at[1] for t in texts) > 0
    assert "more" in {t.text for t in texts}
    assert sum(int(t.text) for t in texts if t.text.isdigit()) == len(many)


def test_a_plan_too_large_for_paper_says_so() -> None:
    floor = np.array([[0, 0, 0], [900, 0, 0], [900, 900, 0], [0, 900, 0]], float)
    scene = Scene(architecture=Architecture((Plane("floor", "floor", floor),)))
    with pytest.raises(ExportError, match="DXF"):
        plan_sheet(floor_plan(gather(scene, LIBRARY)))


def test_svg_is_in_millimetres_and_well_formed(tmp_path) -> None:
    scene = room_with_door_and_window()
    named = replace(scene.objects[0], label='<table> & "ü" 桌')
    export_scene(replace(scene, objects=(named, *scene.objects[1:])), LIBRARY, tmp_path / "p.svg", "svg")
    root = ET.parse(tmp_path / "p.svg").getroot()
    width, height = (float(root.get(k, "").removesuffix("mm")) for k in ("width", "height"))
    assert root.get("viewBox") == f"0 0 {width:g} {height:g}"
    svg = "{http://www.w3.org/2000/svg}"
    assert {g.get("class") for g in root.iter(f"{svg}g")} >= {"walls", "windows", "doors", "furniture", "dimensions"}
    texts = {t.text for t in root.iter(f"{svg}text")}
    assert '<table> & "ü" 桌' in texts
    wall = next(g for g in root.iter(f"{svg}g") if g.get("class") == "walls")[0]
    numbers = np.array(re.findall(r"-?\d+\.\d+", wall.get("d", "")), float).reshape(-1, 2)
    scale = int(re.search(r"1 : (\d+)", root.find(f"{svg}desc").text or "").group(1))
    np.testing.assert_allclose(np.ptp(numbers, axis=0), np.array([4.1, 5.1]) * 1000 / scale, atol=2e-3)


def test_pdf_has_the_page_and_the_texts(tmp_path) -> None:
    pytest.importorskip("reportlab", reason="needs the extra [plan]")
    export_scene(room_with_door_and_window(), LIBRARY, tmp_path / "p.pdf", "pdf")
    data = (tmp_path / "p.pdf").read_bytes()
    assert data.startswith(b"%PDF-")
    box = [float(v) for v in re.search(rb"/MediaBox \[ ([\d. ]+)\]", data).group(1).split()]
    assert sorted(round(v * 25.4 / 72) for v in box[2:]) in ([210, 297], [297, 420])
    export_scene(room_with_door_and_window(), LIBRARY, tmp_path / "q.pdf", "pdf", name="p")
    assert (tmp_path / "q.pdf").read_bytes() == data, "the same plan gives the same file"


def test_dxf_passes_the_audit_and_measures_right(tmp_path) -> None:
    ezdxf = pytest.importorskip("ezdxf", reason="needs the extra [plan]")
    export_scene(room_with_door_and_window(), LIBRARY, tmp_path / "p.dxf", "dxf")
    document = ezdxf.readfile(tmp_path / "p.dxf")
    audit = document.audit()
    assert audit.errors == []
    assert audit.fixes == []
    assert document.units == ezdxf.units.MM
    assert document.header["$DIMTXT"] == TEXT_MM, "LibreCAD sizes the text of dimensions by the header"
    space = document.modelspace()
    lengths = sorted(float(d.get_measurement()) for d in space.query("DIMENSION"))
    assert lengths.count(pytest.approx(4000)) == 2
    assert lengths.count(pytest.approx(5000)) == 2
    table = next(i for i in space.query("INSERT") if i.get_attrib_text("ID") == "t")
    assert table.get_attrib_text("SIZE") == "1.40 x 0.80 m"
    assert (table.dxf.insert.x, table.dxf.insert.y) == pytest.approx((200, 3000), abs=3)


def test_an_empty_scene_has_a_plan(tmp_path) -> None:
    for kind in ("svg", "dxf", "pdf"):
        export_scene(Scene(), LIBRARY, tmp_path / f"empty.{kind}", kind)
        assert (tmp_path / f"empty.{kind}").stat().st_size > 0
