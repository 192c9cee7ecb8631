"""Point clouds and scanner apps' folders, written as their programs write them, become rooms."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from shapely.geometry import Polygon

from diorama_app.cli import main
from diorama_core.errors import InputError, UnavailableError
from diorama_core.importing.measured_cloud import measure_cloud
from diorama_core.importing.point_files import read_points
from diorama_core.project.storage import Project
from tests.importing.scans import DEPTH, FURNITURE, WIDTH, room_meshes, room_points, write_app_scan

AREA = WIDTH * DEPTH


def write_ply(path: Path, points: np.ndarray) -> Path:
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    head += "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
    head += "property uchar blue\nend_header\n"
    rows = np.zeros(len(points), dtype=[("p", "<f4", 3), ("c", "u1", 3)])
    rows["p"], rows["c"] = points, 128
    path.write_bytes(head.encode() + rows.tobytes())
    return path


def test_a_ply_is_imported_as_a_room(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_ply(tmp_path / "room.ply", room_points())
    assert main(["import", str(path), "-o", str(tmp_path / "room")]) == 0
    scene = Project.open(tmp_path / "room").load_scene()
    assert len(scene.architecture.by_role("wall")) == 4
    assert len(scene.objects) == len(FURNITURE)
    assert "kinds of objects are guessed" in capsys.readouterr().err


@pytest.mark.parametrize("mesh", [False, True])
def test_a_ply_in_centimetres_is_brought_to_metres_and_says_so(tmp_path: Path, mesh: bool) -> None:
    path = tmp_path / "room.ply"
    if mesh:
        whole = trimesh.util.concatenate(room_meshes())
        whole.apply_scale(100.0)
        whole.export(path)
    else:
        write_ply(path, 100.0 * (room_points() - room_points().mean(axis=0)))
    cloud = read_points(path)
    assert any("taken for centimetres" in note for note in cloud.notes)
    room = measure_cloud(cloud)
    assert Polygon(room.floors[0].outline).area == pytest.approx(AREA, rel=0.02)
    assert len(room.boxes) == len(FURNITURE)


@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_las_and_laz_are_read(tmp_path: Path, suffix: str) -> None:
    laspy = pytest.importorskip("laspy", reason="needs laspy (pip install 'diorama[scan]')")
    points = room_points() + np.array([512_000.0, 5_400_000.0, 0.0])  # a national grid, as surveyors write
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.offsets, header.scales = points.min(axis=0), np.full(3, 0.001)
    made = laspy.LasData(header)
    made.x, made.y, made.z = points.T
    made.write(str(tmp_path / f"room{suffix}"))
    cloud = read_points(tmp_path / f"room{suffix}")
    assert len(cloud.points) == len(points)
    assert np.abs(cloud.points[:, :2]).max() < 10.0
    assert Polygon(measure_cloud(cloud).floors[0].outline).area == pytest.approx(AREA, rel=0.02)


def test_e57_scans_are_joined_in_their_common_frame(tmp_path: Path) -> None:
    pye57 = pytest.importorskip("pye57", reason="needs pye57 (pip install 'diorama[scan]')")
    points = room_points()
    made = pye57.E57(str(tmp_path / "room.e57"), mode="w")
    for half, shift in ((points[::2], 0.0), (points[1::2], 2.0)):
        local = half - [shift, 0.0, 0.0]
        rows = {f"cartesian{a}": np.ascontiguousarray(local[:, n]) for n, a in enumerate("XYZ")}
        made.write_scan_raw(rows, rotation=np.array([1.0, 0, 0, 0]), translation=np.array([shift, 0.0, 0.0]))
    made.close()
    cloud = read_points(tmp_path / "room.e57")
    assert len(cloud.points) == len(points)
    assert Polygon(measure_cloud(cloud).floors[0].outline).area == pytest.approx(AREA, rel=0.02)


@pytest.mark.parametrize("app", ["polycam", "3d scanner app"])
def test_depth_of_scanner_apps_counts_where_it_is_sure(tmp_path: Path, app: str) -> None:
    folder = write_app_scan(tmp_path / "scan", app)
    room = measure_cloud(read_points(folder))
    assert Polygon(room.floors[0].outline).area == pytest.approx(AREA, rel=0.03)
    assert len(room.walls) == 4
    assert len(room.boxes) == len(FURNITURE)  # unsure depth would be dust in the air
    assert any("20 frames" in note for note in room.notes)


def test_without_depth_the_mesh_of_the_folder_is_taken(tmp_path: Path) -> None:
    whole = trimesh.util.concatenate(room_meshes())
    whole.apply_transform([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    (tmp_path / "scan").mkdir()
    whole.export(tmp_path / "scan" / "raw.glb")
    cloud = read_points(tmp_path / "scan")
    assert Polygon(measure_cloud(cloud).floors[0].outline).area == pytest.approx(AREA, rel=0.02)


def test_what_cannot_be_read_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "broken.ply").write_bytes(b"ply\nnothing")
    with pytest.raises(InputError, match="broken"):
        read_points(tmp_path / "broken.ply")
    with pytest.raises(InputError, match="has 10 points"):
        read_points(write_ply(tmp_path / "few.ply", np.zeros((10, 3))))
    with pytest.raises(InputError, match="has 0 points"):
        read_points(write_ply(tmp_path / "none.ply", np.zeros((0, 3))))
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="holds no points that are read"):
        read_points(tmp_path / "empty")
    folder = write_app_scan(tmp_path / "scan", "3d scanner app")
    for path in folder.glob("frame_*.json"):
        path.write_text(json.dumps({"cameraPoseARFrame": [1.0], "intrinsics": []}))
    with pytest.raises(InputError, match="cameras cannot be read"):
        read_points(folder)
    for name, suffix in (("laspy", ".las"), ("pye57", ".e57")):
        monkeypatch.setitem(sys.modules, name, None)
        (tmp_path / f"room{suffix}").write_bytes(b"0")
        with pytest.raises(UnavailableError, match=r"diorama\[scan\]"):
            read_points(tmp_path / f"room{suffix}")


def test_points_that_float_alone_are_left_out(tmp_path: Path) -> None:
    points = room_points(count=40_000)
    floating = points.mean(axis=0) + np.random.default_rng(0).uniform(-8.0, 8.0, (300, 3))
    np.savetxt(tmp_path / "room.xyz", np.vstack([points, floating]), "%.4f")
    cloud = read_points(tmp_path / "room.xyz")
    assert abs(len(cloud.points) - len(points)) < 40
    assert "float alone were left out" in cloud.notes[0]
    assert np.quantile(cloud.points, [0.001, 0.999], axis=0) == pytest.approx(
        np.quantile(points, [0.001, 0.999], axis=0), abs=0.02
    )


@pytest.mark.parametrize("heading", ["id,z,x,y", "//n,Z [m],X [m],Y [m]", "i,pos_z,pos_x,pos_y"])
def test_columns_are_told_by_their_heading(tmp_path: Path, heading: str) -> None:
    points = room_points(count=4000)
    rows = np.column_stack([np.arange(len(points)), points[:, [2, 0, 1]]])
    rows[::50, 1] = np.nan
    np.savetxt(tmp_path / "room.csv", rows, "%.4f", ",", header=heading, comments="")
    assert read_points(tmp_path / "room.csv").points == pytest.approx(np.delete(points, np.s_[::50], axis=0), abs=1e-4)
