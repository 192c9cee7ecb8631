from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_app.cli import main
from diorama_app.cli.many_photos import build_posed
from diorama_app.projects.folder_photos import photos_of
from diorama_app.projects.options import BuildOptions, PhotoFiles
from diorama_app.projects.posed_build import build_posed_photos, build_sphere_photo
from diorama_core.errors import InputError
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.layout.recipes import recipe
from diorama_core.library.catalogue import built_in_library
from diorama_core.multiview.posed_photos import PosedPhoto, read_poses
from diorama_core.multiview.rooms import build_room, photo_world
from diorama_core.pipeline.presets import stages_for
from diorama_core.progress import Progress
from diorama_core.project.further_photos import load_photos
from diorama_core.project.storage import Project
from tests.cli.room_photo import room_picture
from tests.cli.running import refused, told
from tests.few_shapes import stored_seats
from tests.multiview.colmap_files import write_colmap
from tests.multiview.rooms import CAMERAS, THINGS, photo
from tests.multiview.spheres import BOX, sphere_with_wardrobe

POSED = CAMERAS[:2]
SHOWN = THINGS[:1]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Photos of the made room with their boxes, a photo without a camera, and a COLMAP model."""
    place = tmp_path / "photos"
    place.mkdir()
    for number, camera in enumerate(POSED):
        seen, whose = photo(camera, SHOWN)
        boxes = [
            {"bbox": [float(v) for v in box], "class": SHOWN[k].kind}
            for box, k in zip(seen.boxes.observations.box_px, whose, strict=True)
        ]
        Image.fromarray(room_picture()).resize((640, 480)).save(place / f"view{number}.png")
        (place / f"view{number}.boxes.json").write_text(json.dumps(boxes))
    Image.fromarray(room_picture()).save(place / "other.png")
    write_colmap(tmp_path / "model", tuple(PosedPhoto(f"view{n}.jpg", c) for n, c in enumerate(POSED)))
    return place


@pytest.mark.slow
def test_photos_with_cameras_become_one_project(folder: Path, tmp_path: Path, capsys) -> None:
    command = ["build", str(folder), "--poses", str(tmp_path / "model"), "-o", str(tmp_path / "room")]
    said = json.loads(told(capsys, [*command, "--profile", "embedded", "--library", stored_seats(), "--json"]))
    assert len(said["objects"]) == len(SHOWN)
    assert said["in_several"] == len(SHOWN)
    assert any("other.png" in note for note in said["notes"])
    project = Project.open(tmp_path / "room")
    assert len(project.load_scene().objects) == len(SHOWN)
    assert {c["photo"] for c in project.info()["cameras"]} == {"view0.png", "view1.png"}
    assert {p.name for p in (tmp_path / "room" / "photos").glob("*.png")} == {"view0.png", "view1.png"}
    assert main(["picture", str(tmp_path / "room"), "-o", str(tmp_path / "top.png"), "--view", "top"]) == 0


def test_photos_of_other_names_or_sizes_are_refused(folder: Path, tmp_path: Path) -> None:
    poses = read_poses(tmp_path / "model")
    photos = [p for p in photos_of(folder)[0] if p.project == "other"]
    with pytest.raises(InputError, match="none of the photos has a camera"):
        build_posed_photos(photos, poses, BuildOptions(), tmp_path / "room", Progress())
    Image.new("RGB", (300, 900)).save(folder / "view0.png")
    (folder / "view0.boxes.json").unlink()
    with pytest.raises(InputError, match="another picture"):
        build_posed_photos(photos_of(folder)[0], poses, BuildOptions(), tmp_path / "room", Progress())


def test_photos_with_nothing_in_common_are_one_line(tmp_path: Path, capsys) -> None:
    pytest.importorskip("pycolmap", reason="needs pycolmap (pip install 'diorama[photos]')")
    for number in range(2):
        Image.new("RGB", (160, 120), (90 + number, 90, 90)).save(tmp_path / f"{number}.png")
    assert "too little in common" in refused(
        capsys, ["build", str(tmp_path), "--poses", "find", "-o", str(tmp_path / "room")]
    )
    assert not (tmp_path / "room").exists()


def test_poses_need_a_folder(tmp_path: Path, capsys) -> None:
    (tmp_path / "a.png").write_text("")
    assert build_posed.__doc__
    command = ["build", str(tmp_path / "a.png"), "--poses", str(tmp_path), "-o", str(tmp_path / "room")]
    assert "--poses is for a folder" in refused(capsys, command)


def test_no_photo_is_one_line() -> None:
    library = built_in_library()
    with pytest.raises(InputError, match="no photo"):
        build_room([], library, lambda inputs: stages_for("embedded", inputs, library), recipe("feasible", library))


@pytest.mark.parametrize("camera", CAMERAS)
def test_a_photo_s_own_world_has_the_camera_above_its_origin(camera) -> None:
    T = photo_world(camera)
    own = T[:3, :3].T @ (camera.position - T[:3, 3])
    assert abs(own[:2]).max() < 1e-9
    ahead = T[:3, :3].T @ camera.T_world_camera[:3, 2]
    assert ahead[1] > abs(ahead[0]) - 1e-9


@pytest.mark.slow
def test_a_360_degree_photo_becomes_one_closed_room(tmp_path: Path, capsys) -> None:
    """A wardrobe against a wall of a drawn room, the camera 1.4 m above its floor."""
    height_m = 1.4
    picture, boxes = sphere_with_wardrobe(height_m)
    (tmp_path / "sphere.png").write_bytes(picture)
    (tmp_path / "boxes.json").write_bytes(boxes)
    command = [
        "build",
        str(tmp_path / "sphere.png"),
        "--boxes",
        str(tmp_path / "boxes.json"),
        "-o",
        str(tmp_path / "room"),
    ]
    said = json.loads(told(capsys, [*command, "--profile", "embedded", "--json"]))
    assert any("360 degree photo" in note for note in said["notes"])
    assert len(said["photos"]) == 8
    scene = Project.open(tmp_path / "room").load_scene()
    assert [o.category for o in scene.objects] == ["wardrobe"]
    photos, damage = load_photos(Project.open(tmp_path / "room"))
    assert not damage
    assert [p.inputs.photo.equirectangular for p in photos] == [True, *[None] * 7]
    assert [b.label for b in photos[0].inputs.boxes] == ["wardrobe"]
    assert photos[0].T_world_sphere is not None
    assert photos[0].T_world_sphere[2, 3] == pytest.approx(height_m, rel=0.12)
    floor = scene.architecture.floor
    assert floor is not None
    assert len(scene.architecture.by_role("wall")) == 4
    assert is_in_polygon(scene.objects[0].pose.position[None, :2], floor.polygon[:, :2])[0]
    assert np.ptp(floor.polygon[:, :2], axis=0) == pytest.approx(height_m * np.ptp(BOX, axis=0), rel=0.12)


def test_what_a_360_degree_photo_does_not_take_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"--fov is not used"):
        build_sphere_photo(PhotoFiles(tmp_path / "a.jpg", fov_deg=60.0), BuildOptions(), tmp_path / "room", Progress())
    assert not (tmp_path / "room").exists()
