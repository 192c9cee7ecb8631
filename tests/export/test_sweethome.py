"""Sweet Home 3D files: a sound zip, the document type's elements, models that exist."""

from __future__ import annotations

import xml.etree.ElementTree as ET
import zipfile

import numpy as np
import pytest
import trimesh

from diorama_core.export import export_scene
from diorama_core.export.sweethome import write_sweet_home
from tests.export import scenes
from tests.export.test_plan import room_with_door_and_window
from tests.primitives import PrimitiveLibrary

LIBRARY = PrimitiveLibrary()
ORDER = ("observerCamera", "doorOrWindow", "pieceOfFurniture", "light", "wall", "room")
REQUIRED = {
    "pieceOfFurniture": ("name", "x", "y", "width", "depth", "height"),
    "doorOrWindow": ("name", "x", "y", "width", "depth", "height"),
    "wall": ("id", "xStart", "yStart", "xEnd", "yEnd", "thickness"),
    "observerCamera": ("attribute", "x", "y", "z", "yaw", "pitch", "fieldOfView"),
}


@pytest.fixture
def home(tmp_path):
    export_scene(room_with_door_and_window(), LIBRARY, tmp_path / "home.sh3d", "sh3d", name="Room & more")
    with zipfile.ZipFile(tmp_path / "home.sh3d") as archive:
        assert archive.testzip() is None
        archive.extractall(tmp_path / "out")
    return tmp_path / "out", ET.parse(tmp_path / "out" / "Home.xml").getroot()


def test_elements_and_their_required_attributes(home) -> None:
    folder, root = home
    assert root.tag == "home"
    assert root.get("version") == "5300", "programs warn of a home that is newer than they are"
    assert root.get("name") == "Room & more"
    for element in root:
        assert element.tag in ORDER
        for name in REQUIRED.get(element.tag, ()):
            assert element.get(name), f"{element.tag} without {name}"
    ids = [e.get("id") for e in root.iter() if e.get("id")]
    assert len(ids) == len(set(ids))
    for piece in (e for e in root if e.get("model")):
        assert (folder / piece.get("model")).is_file(), "a content that is missing keeps the home from opening"


def test_walls_have_their_inner_faces_where_the_scene_has_them(home) -> None:
    _, root = home
    lines = [[float(w.get(k)) for k in ("xStart", "yStart", "xEnd", "yEnd")] for w in root.iter("wall")]
    assert [200.0, -500.0] not in lines
    back = next(line for line in lines if line[1] == pytest.approx(-502.5) and line[3] == pytest.approx(-502.5))
    assert sorted((back[0], back[2])) == [pytest.approx(-200), pytest.approx(200)]


def test_models_are_upright_and_of_the_pieces_proportions(home) -> None:
    folder, root = home
    table = next(p for p in root.iter("pieceOfFurniture") if p.get("name") == "table")
    model = trimesh.load_scene(folder / table.get("model"))
    width, height, depth = model.extents
    sides = [float(table.get(k)) for k in ("width", "height", "depth")]
    np.testing.assert_allclose([width, height, depth], sides, atol=1e-2)
    assert float(table.get("elevation")) == pytest.approx(0.0, abs=1e-2)
    assert float(table.get("angle")) == pytest.approx(np.pi, abs=1e-6), "a front along world +y is up on the plan"


def test_walls_and_floors_have_their_pictures_and_lamps_shine(tmp_path) -> None:
    path = tmp_path / "home.sh3d"
    gathered = scenes.gathered("example")
    write_sweet_home(gathered, path)
    with zipfile.ZipFile(path) as archive:
        names, root = archive.namelist(), ET.fromstring(archive.read("Home.xml"))
    seen = [p.plane for p in gathered.planes if p.plane.role in ("wall", "floor") and p.plane.texture]
    textures = list(root.iter("texture"))
    assert {t.get("name") for t in textures} == {p.id for p in seen}
    assert all(t.get("image") in names and t.get("fittingArea") == "true" for t in textures)
    lamps = {light.owner: light for light in gathered.lights}
    lights = {p.get("id").removeprefix("piece-"): p for p in root.iter("light")}
    assert set(lights) == {gathered.object(owner).slug for owner in lamps}
    for owner, light in lamps.items():
        source = lights[gathered.object(owner).slug].find("lightSource")
        height = float(source.get("z")) * gathered.object(owner).item.size_m[2]
        low = gathered.object(owner).item.corners_world[:, 2].min()
        assert low + height == pytest.approx(light.T_world[2, 3], abs=1e-3)


def test_doors_reach_through_their_wall(home) -> None:
    _, root = home
    door, window = sorted(root.iter("doorOrWindow"), key=lambda d: d.get("name"))
    assert (door.get("name"), window.get("name")) == ("door", "window")
    assert all(float(d.get("depth")) > 5.0 for d in (door, window))
