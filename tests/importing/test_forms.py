"""One front door for scenes, scans and homes: what a file is, is told by its content, and said where it is not read."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_core.errors import InputError
from diorama_core.export import export_scene
from diorama_core.importing.forms import SceneParts, open_form, scan_in
from diorama_core.importing.measured_cloud import measure_cloud
from diorama_core.importing.parts import Part, join_flat_parts
from diorama_core.importing.point_cloud import PointCloud, frame_of_scene, likely_up
from diorama_core.importing.point_files import is_text_cloud, read_points, read_splat_ply
from diorama_core.importing.room import room_of, shell_planes, slab_role
from diorama_core.library.ingest.models import read_model
from diorama_core.progress import Progress
from diorama_core.scene.types import Plane
from tests.importing.roomplan_files import write_json
from tests.importing.scans import DEPTH, WIDTH, room_meshes, room_points, write_app_scan
from tests.importing.stages import write_stage
from tests.primitives import PrimitiveLibrary, furnished_room


def part(name: str, mesh: trimesh.Trimesh) -> Part:
    return Part(name, trimesh.Scene({name: mesh}), np.eye(4))


def box(low: tuple[float, ...], high: tuple[float, ...]) -> trimesh.Trimesh:
    return trimesh.creation.box(bounds=[low, high])


def room_parts() -> dict[str, trimesh.Trimesh]:
    """A room of 5 x 4 x 2.5 m of slabs, a bookshelf at its wall and a chair."""
    return {
        "floor": box((-2.5, -2, -0.1), (2.5, 2, 0)),
        "n": box((-2.5, 2, 0), (2.5, 2.1, 2.5)),
        "s": box((-2.5, -2.1, 0), (2.5, -2, 2.5)),
        "e": box((2.5, -2, 0), (2.6, 2, 2.5)),
        "w": box((-2.6, -2, 0), (-2.5, 2, 2.5)),
        "shelf": trimesh.util.concatenate(
            [box((-2, 1.65 + 0.1 * k, 0.4 * k), (-1, 1.95, 0.4 * k + 0.03)) for k in range(2)]
            + [box((-2, 1.65, 0), (-1.95, 1.95, 2)), box((-1.05, 1.65, 0), (-1, 1.95, 2))]
        ),
        "chair": box((0, 0, 0), (0.45, 0.45, 0.9)),
    }


def sides(planes: tuple[Plane, ...]) -> dict[str, int]:
    return {role: sum(p.role == role for p in planes) for role in ("floor", "wall", "ceiling")}


@pytest.mark.parametrize("shell", [False, True])
def test_a_room_is_told_by_its_shape_whatever_it_is_called(shell: bool) -> None:
    meshes = room_parts()
    names = {"shelf", "chair"}
    walls = [mesh for name, mesh in meshes.items() if name not in names]
    parts = [part("Room", trimesh.util.concatenate(walls))] if shell else [part("Cube.001", m) for m in walls]
    room = room_of([*parts, *(part("Cube.002", meshes[name]) for name in sorted(names))])
    assert sides(room.planes) == {"floor": 1, "wall": 4, "ceiling": 0}
    assert len(room.objects) == 2
    floor = next(p for p in room.planes if p.role == "floor")
    assert np.ptp(floor.polygon, axis=0) == pytest.approx([5, 4, 0], abs=1e-4)
    walls_at = sorted(round(w.offset, 6) for w in room.planes if w.role == "wall")
    assert walls_at == [-2.5, -2.5, -2.0, -2.0]


def test_furniture_is_no_room() -> None:
    meshes = room_parts()
    everything = np.array([[-2.6, -2.1, -0.1], [2.6, 2.1, 2.5]])
    assert slab_role(part("a", meshes["shelf"]), everything) is None
    assert slab_role(part("a", meshes["n"]), everything) == "wall"
    assert shell_planes(part("a", meshes["chair"]), np.array([0.0, 0.0, 1.0])) is None


def test_a_flat_part_belongs_to_the_face_that_it_covers() -> None:
    screen = trimesh.Trimesh([[0.1, 0, 0.1], [1.1, 0, 0.1], [1.1, 0, 0.6], [0.1, 0, 0.6]], [[0, 1, 2], [0, 2, 3]])
    rug = trimesh.Trimesh([[3, 0, 0], [5, 0, 0], [5, 2, 0], [3, 2, 0]], [[0, 1, 2], [0, 2, 3]])
    joined = join_flat_parts([part("tv", box((0, 0.01, 0), (1.2, 0.06, 0.7))), part("s", screen), part("r", rug)])
    assert [p.name for p in joined] == ["tv", "r"]
    assert joined[0].whole.bounds[0, 1] == 0.0


def noisy_scan() -> trimesh.Trimesh:
    whole = trimesh.util.concatenate(room_meshes())
    fine = trimesh.Trimesh(*trimesh.remesh.subdivide_to_size(whole.vertices, whole.faces, 0.25))
    fine.vertices += np.random.default_rng(5).normal(0, 0.004, fine.vertices.shape)
    return fine


def test_a_scan_as_a_mesh_is_points_and_a_modelled_room_is_not() -> None:
    cloud = scan_in([part("mesh_0", noisy_scan())])
    outline = measure_cloud(cloud).floors[0].outline
    assert sorted(np.ptp(outline, axis=0)) == pytest.approx([DEPTH, WIDTH], abs=0.04)
    assert scan_in([part(name, mesh) for name, mesh in room_parts().items()]) is None
    assert scan_in([]) is None


@pytest.mark.parametrize("up", [(0, 0, 1), (0, 1, 0), (0, -1, 0)])
def test_up_is_found_on_either_side_of_an_axis(up: tuple[int, int, int]) -> None:
    z = np.array(up, float)
    x = np.array([1.0, 0, 0])
    R = np.stack([x, np.cross(z, x), z])
    assert likely_up(room_points() @ R) == pytest.approx(z)


def test_faint_and_huge_splats_are_left_out(tmp_path: Path) -> None:
    names = ("x", "y", "z", "opacity", "scale_0", "scale_1", "scale_2")
    rows = np.zeros((100, 7), "<f4")
    rows[:, 3], rows[:, 4:] = 4.0, -4.0
    rows[:10, 3], rows[10:20, 4:] = -6.0, 3.0
    heading = "".join(f"property float {name}\n" for name in names)
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex 100\n{heading}end_header\n"
    (tmp_path / "s.ply").write_bytes(head.encode() + rows.tobytes())
    assert len(read_splat_ply(tmp_path / "s.ply")) == 80


@pytest.mark.parametrize(
    ("suffix", "first", "delimiter"),
    [(".xyz", "", " "), (".pts", "120000\n", " "), (".csv", "X,Y,Z\n", ","), (".txt", "//X;Y;Z\n", ";")],
)
def test_points_in_plain_text_are_read(tmp_path: Path, suffix: str, first: str, delimiter: str) -> None:
    points = room_points()[::10] - room_points().mean(axis=0)
    lines = [delimiter.join(f"{v:.4f}" for v in (*p, 12, 200, 30)) for p in points]
    path = tmp_path / f"room{suffix}"
    path.write_text(first + "\n".join(lines) + "\n")
    assert read_points(path).points == pytest.approx(points, abs=1e-3)
    assert not is_text_cloud("some words\nand more\nand more\n")


def test_polycams_frames_are_read_from_their_zip_and_as_the_folder_keyframes(tmp_path: Path) -> None:
    folder = write_app_scan(tmp_path / "scan", "polycam")
    with zipfile.ZipFile(tmp_path / "scan.zip", "w") as archive:
        for path in folder.rglob("*"):
            archive.write(path, path.relative_to(folder).as_posix())
    whole = read_points(folder).points
    for place in (tmp_path / "scan.zip", folder / "keyframes"):
        with open_form(place) as (form, at):
            assert form.name == "Polycam raw data"
            np.testing.assert_allclose(read_points(at).points, whole)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.json", json.dumps({"annotations": [], "images": []}), "boxes"),
        ("a.json", json.dumps({"frames": [{"transform_matrix": []}]}), "nerfstudio"),
        ("a.blend", "BLENDER", "Blender"),
        ("a.xyz", "hello\nworld\n", "nothing that is read as a room"),
    ],
)
def test_what_is_no_scene_is_called_what_it_is(tmp_path: Path, name: str, content: str, said: str) -> None:
    (tmp_path / name).write_text(content)
    with pytest.raises(InputError, match=said), open_form(tmp_path / name):
        pass


def test_a_missing_file_does_not_exist(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"), open_form(tmp_path / "room.glb"):
        pass


def test_an_obj_of_a_room_is_put_upright_and_in_metres(tmp_path: Path) -> None:
    whole = trimesh.util.concatenate(list(room_parts().values()))
    whole.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, (1, 0, 0))).apply_scale(100.0)
    whole.export(tmp_path / "room.obj")
    T, notes = frame_of_scene(read_model(tmp_path / "room.obj", tmp_path))
    placed = trimesh.transform_points(whole.vertices, T)
    assert np.ptp(placed, axis=0)[2] == pytest.approx(2.6)
    assert any("centimetres" in note for note in notes)


UNIT_M = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}


@pytest.mark.parametrize("unit", UNIT_M)
@pytest.mark.parametrize("suffix", [".glb", ".obj", ".usda", ".usdc", ".ply", ".xyz"])
def test_a_given_unit_is_believed(suffix: str, unit: str, tmp_path: Path) -> None:
    """The room is twice as large as rooms usually are, so that nothing is guessed right by chance."""
    path, factor = tmp_path / f"room{suffix}", 2.0 / UNIT_M[unit]
    if suffix == ".xyz":
        np.savetxt(path, factor * room_points()[::20], fmt="%.6f")
        expected = 2.0 * np.ptp(room_points()[::20], axis=0)
    else:
        meshes = {name: mesh.copy().apply_scale(factor) for name, mesh in room_parts().items()}
        whole = trimesh.util.concatenate(list(room_parts().values()))
        expected = 2.0 * whole.extents
        if suffix in (".usda", ".usdc"):
            pytest.importorskip("pxr", reason="usd-core is not installed (optional extra 'usd')")
            write_stage(path, meshes)
        elif suffix == ".ply":
            whole.apply_scale(factor).export(path)
        else:
            scene = trimesh.Scene(meshes)
            if suffix == ".glb":
                scene.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, [1, 0, 0]))
            scene.export(path)
    with open_form(path) as (form, place):
        content = form.read(place, Progress(), UNIT_M[unit])
    if isinstance(content, PointCloud):
        found = np.ptp(content.points, axis=0)
        assert not any("taken for" in note for note in content.notes)
    else:
        assert isinstance(content, SceneParts)
        bounds = np.array([p.whole.bounds for p in content.parts])
        found = bounds[:, 1].max(axis=0) - bounds[:, 0].min(axis=0)
        assert not any("lengths" in note for note in content.notes)
    np.testing.assert_allclose(sorted(found), sorted(expected), rtol=0.02)


def test_files_that_say_their_unit_take_no_other(tmp_path: Path) -> None:
    room = write_json(tmp_path / "room.json")
    home = tmp_path / "home.sh3d"
    with zipfile.ZipFile(home, "w") as archive:
        archive.writestr("Home.xml", "<home/>")
    own = tmp_path / "own.glb"
    export_scene(furnished_room(PrimitiveLibrary()), PrimitiveLibrary(), own, "glb")
    for path in (room, home, own):
        with open_form(path) as (form, place), pytest.raises(InputError, match="leave out --unit"):
            form.read(place, Progress(), 0.01)


def test_pictures_of_a_scan_keep_their_place_in_another_unit(tmp_path: Path) -> None:
    cloud = read_points(write_app_scan(tmp_path / "scan", "polycam"))
    half = cloud.to_unit(0.5 * cloud.unit_m)
    np.testing.assert_allclose(half.points, 0.5 * cloud.points)
    for before, after in zip(cloud.photos, half.photos, strict=True):
        np.testing.assert_allclose(after.camera.position, 0.5 * before.camera.position)
        assert after.unit_m == 0.5 * before.unit_m
