"""Homes of Sweet Home 3D: what is in them, and what a broken or hostile one says."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from shapely.geometry import Polygon

from diorama_core.errors import InputError
from diorama_core.geometry.rooms import rooms_of_objects
from diorama_core.importing import sweethome
from diorama_core.importing.scene_import import import_scene
from diorama_core.importing.sweethome import THIN_M, parts_of_sweet_home
from diorama_core.progress import Progress

WALL = '<wall xStart="0" yStart="0" xEnd="400" yEnd="0" thickness="10"/>'
ROOM = '<room><point x="0" y="0"/><point x="400" y="0"/><point x="400" y="300"/><point x="0" y="300"/></room>'
PIECE = '<pieceOfFurniture name="Chair" x="100" y="200" width="50" depth="60" height="90" {}/>'


def home(folder: Path, body: str, *files: tuple[str, bytes], head: str = '<home wallHeight="260">') -> Path:
    path = folder / "home.sh3d"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("Home.xml", f"{head}{body}</home>")
        for name, content in files:
            archive.writestr(name, content)
    return path


def parts(folder: Path, body: str, *files: tuple[str, bytes], **more):
    return parts_of_sweet_home(home(folder, body, *files, **more))[0]


def test_walls_and_floors_are_in_metres_with_y_turned(tmp_path: Path) -> None:
    wall, floor = parts(tmp_path, WALL + ROOM)
    np.testing.assert_allclose(wall.scene.bounds, [[0, -0.05, 0], [4, 0.05, 2.6]], atol=1e-9)
    np.testing.assert_allclose(floor.scene.bounds, [[0, -3, -THIN_M], [4, 0, 0]], atol=1e-6)
    assert floor.scene.to_geometry().volume == pytest.approx(12 * THIN_M, rel=1e-4)


def test_pieces_have_their_size_place_and_turn(tmp_path: Path) -> None:
    (piece,) = parts(tmp_path, PIECE.format(f'elevation="10" angle="{np.pi / 2}"'))
    low, high = piece.scene.bounds
    np.testing.assert_allclose((low + high) / 2, [1.0, -2.0, 0.1 + 0.45], atol=1e-6)
    np.testing.assert_allclose(high - low, [0.6, 0.5, 0.9], atol=1e-6)
    assert piece.yaw_rad == pytest.approx(-np.pi / 2)
    assert piece.name == "Chair"


def test_models_are_stood_upright_and_stretched(tmp_path: Path) -> None:
    cone = trimesh.creation.cone(0.5, 2.0)  # its tip along +Z of the file, which is the model's front
    buffer = cone.export(file_type="stl")
    (piece,) = parts(tmp_path, PIECE.format('model="0/cone.stl"'), ("0/cone.stl", buffer))
    np.testing.assert_allclose(np.ptp(piece.scene.bounds, axis=0), [0.5, 0.6, 0.9], atol=1e-6)
    points = piece.scene.to_geometry().vertices
    tip = points[np.argmin(points[:, 1])]
    assert tip[0] == pytest.approx(1.0, abs=1e-3), "the front looks to -Y"


def test_a_missing_or_broken_model_is_a_box_and_hidden_pieces_are_left_out(tmp_path: Path) -> None:
    body = PIECE.format('model="gone.obj"') + PIECE.format('model="bad.obj"') + PIECE.format('visible="false"')
    found = parts(tmp_path, body, ("bad.obj", b"\x00\x01"))
    assert len(found) == 2
    for piece in found:
        np.testing.assert_allclose(np.ptp(piece.scene.bounds, axis=0), [0.5, 0.6, 0.9], atol=1e-6)


@pytest.mark.parametrize(
    ("body", "head", "reason"),
    [
        ('<wall xStart="0"/>', "<home>", "without a usable"),
        (WALL, '<home wallHeight="high">', "usable wallHeight"),
        (WALL.replace('"400"', '"nan"'), "<home>", "usable xEnd"),
        (PIECE.format("").replace('width="50"', 'width="inf"'), "<home>", "usable width"),
        ("<wall", "<home>", "is damaged"),
        ("", '<!DOCTYPE home [<!ENTITY a "b">]><home>', "defines entities"),
    ],
)
def test_broken_homes_are_one_clear_line(tmp_path: Path, body: str, head: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        parts(tmp_path, body, head=head)


def test_what_is_no_home_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "home.sh3d"
    path.write_bytes(b"no archive")
    with pytest.raises(InputError, match="no Sweet Home 3D file"):
        parts_of_sweet_home(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("Home", b"")
    with pytest.raises(InputError, match=r"no Home\.xml"):
        parts_of_sweet_home(path)
    monkeypatch.setattr(sweethome, "XML_BYTES", 10)
    with pytest.raises(InputError, match="too large"):
        parts(tmp_path, WALL)


def test_damaged_and_encrypted_archives_are_refused(tmp_path: Path) -> None:
    path = home(tmp_path, WALL)
    data = bytearray(path.read_bytes())
    data[6] |= 1  # the flag of an encrypted entry, here and in the directory
    data[data.index(b"PK\x01\x02") + 8] |= 1
    path.write_bytes(bytes(data))
    with pytest.raises(InputError, match="no Sweet Home 3D file"):
        parts_of_sweet_home(path)
    piece = PIECE.format('model="a/b/c.stl"') + PIECE.format('model="a/b.stl"')
    clash = home(tmp_path, piece, ("a/b.stl", b"file"), ("a/b.stl/c.stl", b"in it"), ("a/b.stl/", b""))
    assert len(parts_of_sweet_home(clash)) == 2


def test_names_that_climb_stay_inside(tmp_path: Path) -> None:
    outside = tmp_path.parent / "escaped.txt"
    parts(tmp_path, WALL, ("../../../../../../../../" + str(outside)[1:], b"out"))
    assert not outside.exists()


def stl(side: float) -> bytes:
    return trimesh.creation.cone(side, 2.0 * side).export(file_type="stl")


@pytest.mark.parametrize(
    "name", ["{}", "../{}", "0/../../../../../../../../../../{}", "%2E%2E/{}", "file://{}", "\\{}"]
)
def test_models_are_read_out_of_the_home_only(tmp_path: Path, name: str) -> None:
    """A home named a model by its place on the disk, and got it."""
    secret = tmp_path / "secret.stl"
    secret.write_bytes(stl(0.5))
    piece = PIECE.format(f'model="{name.format(secret)}"')
    (read,) = parts(tmp_path, piece)
    assert len(read.scene.to_geometry().faces) == 12, "a box stands for what is not in the home"


def test_pieces_of_one_home_are_as_many_as_a_scene_holds(tmp_path: Path) -> None:
    """80,000 walls kept the reader busy for a minute without a word."""
    with pytest.raises(InputError, match=r"has 80,000 pieces, walls and rooms; up to 5,000 are read"):
        parts(tmp_path, WALL * 80_000)


def test_only_what_models_need_is_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """60,000 small entries took 20 seconds to unpack."""
    many = [(f"other/{i}.txt", b"") for i in range(500)]
    taken: list[str] = []
    monkeypatch.setattr(zipfile.ZipFile, "_extract_member", lambda self, e, *a: taken.append(e.filename))
    parts(tmp_path, PIECE.format('model="0/cone.stl"'), ("0/cone.stl", stl(0.5)), ("0/cone.mtl", b""), *many)
    assert sorted(taken) == ["0/cone.mtl", "0/cone.stl"]
    monkeypatch.setattr(sweethome, "MAX_FILES", 400)
    with pytest.raises(InputError, match="has 500 files beside its models"):
        parts(tmp_path, PIECE.format('model="other/cone.stl"'), *many)


def test_each_piece_is_progress(tmp_path: Path) -> None:
    told: list[str] = []
    parts_of_sweet_home(home(tmp_path, PIECE.format("") * 3), Progress(lambda event: told.append(event.message)))
    assert told == ["reading Chair"] * 3


def test_rooms_of_several_levels_are_a_home(tmp_path: Path) -> None:
    levels = '<level id="a" name="Ground" elevation="0"/><level id="b" name="Upper" elevation="260"/>'
    corner = "".join(
        f'<point x="{x}" y="{y}"/>' for x, y in ((0, 0), (400, 0), (400, 300), (200, 300), (200, 500), (0, 500))
    )
    rooms = f'<room level="a" name="Kitchen">{corner}</room>' + ROOM.replace("<room", '<room level="b"')
    path = home(tmp_path, levels + rooms + PIECE.format('level="b"'))
    scene = import_scene(path, tmp_path / "shapes").opened.scene
    assert [(r.name, r.storey) for r in scene.rooms] == [("Kitchen", 0), ("room 1", 1)]
    assert rooms_of_objects(scene) == {scene.objects[0].id: scene.rooms[1].id}
    floor = scene.plane(scene.rooms[0].floor)
    assert Polygon(floor.polygon[:, :2]).area == pytest.approx(16.0, rel=1e-3), "L-shaped, not the box around it"
