"""What was dropped together, by the content of the files."""

from __future__ import annotations

import io
import json
import zipfile

import numpy as np
import pytest
import trimesh
from PIL import Image

from diorama_app.projects.dropped import Dropped, files_of, interpret, upload_of
from diorama_core.errors import InputError
from diorama_core.importing.point_cloud import MIN_POINTS
from diorama_core.perception.inputs.boxes.reading import read_boxes
from diorama_core.perception.inputs.depth.reading import DepthOptions, read_depth
from diorama_core.perception.inputs.photos.reading import read_photo
from diorama_core.perception.inputs.source import read_source
from tests.perception.inputs.depth.rooms import HEIGHT, WIDTH, room
from tests.perception.inputs.files import box, boxes_json, depth_png, encoded, npy, picture

PHOTO = encoded(picture(WIDTH, HEIGHT), "JPEG")
BOXES = boxes_json(box(10, 20, 60, 90))
DEPTH = depth_png(room()[0] * 1000)
OBJECT = encoded(Image.fromarray(np.pad(np.full((60, 60), 255, np.uint8), ((30, HEIGHT - 90), (30, WIDTH - 90)))))
FRAME = {"color.png": PHOTO, "depth.png": DEPTH, "pose.txt": b"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"}
YOLO = b"0 0.5 0.5 0.2 0.2\n1 0.3 0.3 0.2 0.2\n0 0.7 0.6 0.2 0.2\n"


def packed(files: dict[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return content.getvalue()


def dropped(files: dict[str, bytes], photo_size: tuple[int, int] | None = None) -> Dropped:
    return interpret(packed(files), "drop.zip", photo_size)


def glb(*boxes: tuple[tuple[float, float, float], tuple[float, float, float]]) -> bytes:
    scene = trimesh.Scene()
    for extents, middle in boxes:
        mesh = trimesh.creation.box(extents)
        mesh.apply_translation(middle)
        scene.add_geometry(mesh)
    return bytes(scene.export(file_type="glb"))


def test_confidence_comes_with_its_depth() -> None:
    levels = encoded(Image.fromarray(np.repeat(np.uint8(2 * (np.arange(HEIGHT) >= 40))[:, None], WIDTH, axis=1)))
    files = {"room.jpg": PHOTO, "depth.png": DEPTH, "confidence.png": levels}
    found = dropped(files)
    (reading,) = found.readings
    assert (reading.action, found.left_out) == ("photo", ())
    assert "confidence of depth" in reading.words
    upload = upload_of(reading.photos[0], files_of("drop.zip", packed(files)))
    depth, notes = read_depth(upload.depth, DepthOptions(1000.0), read_photo(read_source(PHOTO, "photo"), 1600))
    assert (depth[:40] == 0).all()
    assert "unsure by confidence.png" in " ".join(notes)
    (alone,) = interpret(levels, "room_confidence.png", (WIDTH, HEIGHT)).readings
    assert (alone.action, alone.inputs[0][0]) == ("inputs", "confidence")


def test_a_photo_comes_with_what_belongs_to_it() -> None:
    files = {"a/room.jpg": PHOTO, "a/labels.json": BOXES, "a/d.png": DEPTH, "a/0.png": OBJECT, "a/1.png": OBJECT,
             "a/notes.md": b"x"}  # fmt: skip
    found = dropped(files)
    (reading,) = found.readings
    assert (reading.action, found.left_out) == ("photo", ("notes.md",))
    assert {sort for sort, _ in reading.photos[0].beside} == {"boxes", "depth", "masks"}
    assert "list of boxes" in reading.words
    upload = upload_of(reading.photos[0], files_of("drop.zip", packed(files)))
    assert (upload.name, upload.photo, upload.depth.data) == ("room.jpg", PHOTO, DEPTH)
    assert zipfile.ZipFile(io.BytesIO(upload.masks.data)).namelist() == ["0.png", "1.png"]


def test_classes_come_with_their_boxes() -> None:
    files = {"room.jpg": PHOTO, "room.txt": YOLO, "classes.txt": b"chair\nsofa\n"}
    (reading,) = dropped(files).readings
    upload = upload_of(reading.photos[0], files_of("drop.zip", packed(files)))
    boxes, _ = read_boxes(read_source(upload.boxes, "boxes"), read_photo(read_source(PHOTO, "photo"), 1600))
    assert [b.label for b in boxes] == ["chair", "sofa", "chair"]


def test_several_photos_may_be_one_room_or_several() -> None:
    found = dropped({"v/a.jpg": PHOTO, "v/b.jpg": PHOTO, "v/b.json": BOXES, "v/c.heif.txt": b"hello"})
    assert [r.action for r in found.readings] == ["room", "photos"]
    assert [dict(p.beside) for p in found.readings[1].photos] == [{}, {"boxes": "v/b.json"}]
    assert found.left_out == ("c.heif.txt",)
    posed = dropped({"a.jpg": PHOTO, "b.jpg": PHOTO, "transforms.json": b'{"frames": [{"transform_matrix": []}]}'})
    assert posed.readings[0].poses == "transforms.json"
    assert posed.left_out == ()


def test_a_grey_picture_beside_a_photo_is_asked_about() -> None:
    found = dropped({"a.jpg": PHOTO, "b.png": encoded(picture(WIDTH, HEIGHT, "L"))})
    assert [r.action for r in found.readings] == ["photo", "room", "photos"]
    assert dict(found.readings[0].photos[0].beside) == {"depth": "b.png"}
    named = dropped({"a.jpg": PHOTO, "a_depth.png": encoded(picture(WIDTH, HEIGHT, "L"))})
    assert [r.action for r in named.readings] == ["photo"]


def test_files_of_the_open_photo() -> None:
    found = dropped({"boxes.json": BOXES, "depth.png": DEPTH}, (WIDTH, HEIGHT))
    assert [(r.action, dict(r.inputs)) for r in found.readings] == [
        ("inputs", {"boxes": "boxes.json", "depth": "depth.png"})
    ]
    with pytest.raises(InputError, match="no photo"):
        dropped({"boxes.json": BOXES, "depth.png": DEPTH})
    (alone,) = interpret(BOXES, "boxes.json", (WIDTH, HEIGHT)).readings
    assert alone.inputs == (("boxes", "boxes.json"),)
    assert [r.action for r in interpret(YOLO, "a.txt", (WIDTH, HEIGHT)).readings] == ["inputs"]


def test_a_model_a_room_and_a_scan() -> None:
    chair = glb(((0.5, 0.9, 0.5), (0, 0.45, 0)))
    assert [r.action for r in interpret(chair, "chair.glb", None).readings] == ["models"]
    furnished = glb(((4, 0.1, 3), (0, 0, 0)), ((4, 2.5, 0.1), (0, 1.25, 1.5)), ((0.5, 0.9, 0.5), (0, 0.5, 0)))
    assert [r.action for r in interpret(furnished, "room.glb", None).readings] == ["scene", "models"]
    found = dropped({"m/a.glb": chair, "m/b.glb": chair, "m/wood.png": PHOTO, "m/readme.txt": b"x"})
    assert [(r.action, r.words) for r in found.readings] == [("models", "2 models (glTF) for the library")]
    assert found.left_out == ("readme.txt",)
    points = trimesh.PointCloud(np.random.default_rng(0).uniform(0, 3, (MIN_POINTS, 3))).export(file_type="ply")
    assert [r.action for r in interpret(points, "scan.ply", None).readings] == ["scene"]


def test_arrays_of_points_are_scans_and_lossy_masks_are_masks() -> None:
    points = np.random.default_rng(0).uniform(0, 3, (MIN_POINTS, 3)).astype(np.float32)
    assert [r.action for r in interpret(npy(points), "scan.npy", (WIDTH, HEIGHT)).readings] == ["scene"]
    bright = np.column_stack([points, np.zeros(len(points), np.float32)])
    assert [r.action for r in interpret(bright.tobytes(), "scan.bin", None).readings] == ["scene"]
    assert [r.action for r in interpret(npy(room()[0]), "depth.npy", (WIDTH, HEIGHT)).readings] == ["inputs"]
    lossy = encoded(Image.open(io.BytesIO(OBJECT)), "JPEG")
    found = dropped({"a.jpg": PHOTO, "masks/0.jpg": lossy, "masks/1.jpg": lossy})
    assert [(r.action, r.photos[0].beside) for r in found.readings] == [
        ("photo", (("masks", "masks/0.jpg"), ("masks", "masks/1.jpg")))
    ]


def test_frames_of_a_data_set_are_no_photos() -> None:
    frames = {f"frame-{n:06d}.{what}": data for n in range(3) for what, data in FRAME.items()}
    assert [r.words for r in dropped(frames).readings] == ["a scan (7-Scenes, ScanNet frames), as a new project"]


def test_what_is_not_read_is_said() -> None:
    with pytest.raises(InputError, match="SketchUp model: export it"):
        interpret(b"\xff\xfe\xff\x0eS", "a.skp", None)
    with pytest.raises(InputError, match=r"drop.zip holds no photo.*b.md"):
        dropped({"notes.md": b"hello", "b.md": b"hello"})
    assert json.dumps(Dropped((), tuple("abcdefgh")).unread()) == '"Left out: a, b, c, d, e, f and 2 more"'
