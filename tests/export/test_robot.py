"""A room for robots: the same bodies in every file, places to put things, a map and where a disc can be."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from shapely.geometry import Point, Polygon, box

from diorama_core.export.colliders import physical_scene, world_parts
from diorama_core.export.navigation import standing_place, walkable, write_occupancy
from diorama_core.export.regions import MIN_SIDE_M
from diorama_core.export.robot import handle_of, write_robot
from tests.export.scenes import gathered

pytest.importorskip("pxr", reason="USD is not installed (optional extra 'usd')")


@pytest.fixture(scope="module")
def pack(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("robot")
    write_robot(gathered("fittings", joints=True), folder / "room.zip")
    with zipfile.ZipFile(folder / "room.zip") as archive:
        archive.extractall(folder)
    return folder


def read(pack: Path, name: str) -> list[dict]:
    return next(iter(json.loads((pack / f"{name}.json").read_text()).values()))


def test_every_file_names_the_same_bodies(pack: Path) -> None:
    from pxr import Usd

    names = {o["body"] for o in read(pack, "objects")}
    assert len(names) == 8
    for file, tag in (("room.xml", "body"), ("room.sdf", "link")):
        assert names <= {e.get("name") for e in ElementTree.parse(pack / file).iter(tag)}
    links = [e.get("name") for f in pack.rglob("*.urdf") for e in ElementTree.parse(f).iter("link")]
    assert names <= set(links)
    stage = Usd.Stage.Open(str(pack / "room.usdc"))
    labels = {n: stage.GetPrimAtPath(f"/Scene/Objects/{n}").GetAttribute("semantics:labels:category") for n in names}
    assert {n: a.Get()[0] for n, a in labels.items()} == {o["body"]: o["category"] for o in read(pack, "objects")}
    for name in [e.text for e in ElementTree.parse(pack / "room.sdf").iter("uri")]:
        assert (pack / name).exists()


def test_regions_are_sites_where_the_model_has_its_tops(pack: Path) -> None:
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed (optional extra 'sim')")
    model = mujoco.MjModel.from_xml_path(str(pack / "room.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    regions = read(pack, "regions")
    assert model.nsite == len(regions) > 2
    assert min(min(r["size_m"]) for r in regions) >= MIN_SIDE_M
    for region in regions:
        outline = np.array(region["outline_m"])
        middle = data.site(region["name"]).xpos
        assert middle[2] == pytest.approx(outline[:, 2].mean(), abs=1e-3)
        assert Polygon(outline[:, :2]).buffer(1e-3).contains(Point(middle[:2]))


def test_what_stands_on_a_region_covers_a_part_of_it(pack: Path) -> None:
    desk = next(r for r in read(pack, "regions") if "laptop_1" in r["holds"])
    assert desk["object"] == "desk_1"
    area = Polygon(np.array(desk["outline_m"])[:, :2]).area
    assert 0.3 * area < desk["free_m2"] < 0.95 * area
    scene = gathered("fittings", joints=True)
    laptop = next(b for b in physical_scene(scene).bodies if b.node.id == "laptop_1")
    spot = Point(desk["free_spot"]["position_m"][:2])
    for part in world_parts(laptop):
        assert Polygon(part[:, :2]).convex_hull.distance(spot) > desk["free_spot"]["radius_m"] - 0.01


def test_the_map_is_read_where_things_stand(pack: Path) -> None:
    head, size, depth, rest = (pack / "map.pgm").read_bytes().split(b"\n", 3)
    columns, rows = map(int, size.split())
    assert (head, depth, len(rest)) == (b"P5", b"255", columns * rows)
    grey = np.frombuffer(rest, np.uint8).reshape(rows, columns)
    about = dict(line.split(": ", 1) for line in (pack / "map.yaml").read_text().splitlines())
    assert (about["image"], float(about["resolution"]), about["negate"]) == ("map.pgm", 0.05, "0")
    left, bottom, _ = json.loads(about["origin"])

    def at(x: float, y: float) -> int:
        return int(grey[rows - 1 - int((y - bottom) / 0.05), int((x - left) / 0.05)])

    scene = gathered("fittings", joints=True)
    assert at(*scene.object("dresser_1").T_world[:2, 3]) == 0
    assert at(*scene.object("rug_1").T_world[:2, 3]) == 254  # driven over
    assert at(left + 0.01, bottom + 0.01) == 205


def test_the_map_alone_is_that_of_the_pack(pack: Path, tmp_path: Path) -> None:
    write_occupancy(gathered("fittings", joints=True), tmp_path / "flat.yaml")
    assert (tmp_path / "flat.pgm").read_bytes() == (pack / "map.pgm").read_bytes()
    assert (tmp_path / "flat.yaml").read_text() == (pack / "map.yaml").read_text().replace("map.pgm", "flat.pgm")


def test_a_disc_has_room_where_it_may_be_and_reaches_the_desk(pack: Path) -> None:
    document = json.loads((pack / "navigation.json").read_text())
    scene = gathered("fittings", joints=True)
    parts = [p for b in physical_scene(scene).bodies for p in world_parts(b) if p[:, 2].min() < 1.0]
    obstacles = [Polygon(p[:, :2]).convex_hull for p in parts if np.ptp(p[:, 2]) > 0.05]
    for polygon in document["free"]:
        free = Polygon(polygon["outline"], polygon["holes"])
        assert min(o.distance(free) for o in obstacles) > document["radius_m"] - 0.01
    for region in read(pack, "regions"):
        stand = region["stand"]
        assert stand is None or any(
            Polygon(p["outline"], p["holes"]).buffer(0.01).contains(Point(stand["x"], stand["y"]))
            for p in document["free"]
        )
    assert any(r["stand"] for r in read(pack, "regions") if r["object"] == "desk_1")


def test_a_place_that_is_out_of_reach_has_none_to_stand_at() -> None:
    walk = walkable(box(0, 0, 4, 4), box(1.9, 0, 2.1, 3), 0.25)
    assert [p.area for p in walk] == [pytest.approx(3.5 * 3.5 - 0.7 * 3.0, abs=0.1)]
    walk = walkable(box(0, 0, 4, 4), box(1.5, 0, 1.7, 4), 0.25)
    assert len(walk) == 2
    assert standing_place(walk, box(0.1, 1, 0.3, 2), 0.25, 0.8) is None  # behind the wall
    stand = standing_place(walk, box(3.9, 1, 4.0, 2), 0.25, 0.8)
    assert stand is not None
    assert stand[0] == pytest.approx(3.75)


def test_handles_are_on_the_front_and_are_pulled_outward() -> None:
    scene = gathered("fittings", joints=True)
    desk = next(b for b in physical_scene(scene).bodies if b.node.id == "desk_1")
    for moving in desk.moving:
        vertices = np.concatenate([s.vertices for s in scene.meshes[moving.limb.mesh].surfaces]) * desk.node.scale
        handle, pull = handle_of(moving, vertices)
        np.testing.assert_allclose(pull, [1.0, 0.0, 0.0], atol=1e-9)
        assert handle[0] > vertices[:, 0].max() - 0.02


def test_what_can_be_grasped_is_small_and_light_and_free(pack: Path) -> None:
    for thing in read(pack, "objects"):
        small = thing["grasp_width_m"] <= 0.08 and thing["mass_kg"] <= 3.0
        assert thing["graspable"] == (small and thing["free"])
