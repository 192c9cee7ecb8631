"""What rooms come from besides photos: cameras, scans, scenes of other programs, and edits in a model's words."""

from __future__ import annotations

import io
import json
import tempfile
import traceback
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, wraps
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from diorama_app.projects.folder_photos import read_camera
from diorama_core.editing.positioning import Positioner
from diorama_core.errors import DioramaError, InputError
from diorama_core.export.gathering import ExportOptions, gather
from diorama_core.export.gltf import glb_bytes
from diorama_core.export.usd import write_layer
from diorama_core.export.usd import write_usdz as write_usd_package
from diorama_core.importing.forms import read_mark
from diorama_core.importing.gltf import read_marked_gltf
from diorama_core.importing.measured_room import open_room
from diorama_core.importing.opening import open_marked
from diorama_core.importing.parts import parts_of_usd
from diorama_core.importing.room import room_of
from diorama_core.importing.roomplan import read_room_plan
from diorama_core.importing.sweethome import parts_of_sweet_home
from diorama_core.library.catalogue import built_in_library
from diorama_core.multiview.posed_photos import PosedPhoto, read_poses
from diorama_core.multiview.rooms import photo_world
from diorama_core.perception.language.replies import json_in
from diorama_core.scene.schema import scene_to_json
from diorama_core.text.edit_apply import EditApplier
from diorama_core.text.edit_plan import EditPlan
from tests.app.small_room import PlainLibrary, furnished_scene
from tests.fuzzing.mutate import Random, damaged
from tests.importing.roomplan_files import write_json, write_usdz
from tests.multiview.colmap_files import write_colmap
from tests.multiview.rooms import CAMERAS

JOINT = b"\n----\n"
"""Between the two files of a COLMAP model."""


def one_damaged(data: bytes, random: Random) -> bytes:
    """One of two files, damaged."""
    first, _, second = data.partition(JOINT)
    if random.integers(0, 2):
        return damaged(first, random) + JOINT + second
    return first + JOINT + damaged(second, random)


def _file(suffix: str, read: Callable[[Path], object]) -> Callable[[bytes], object]:
    def through(data: bytes) -> object:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"file{suffix}"
            path.write_bytes(data)
            return read(path)

    return through


def _placed(path: Path) -> object:
    """Whatever is read has a place in the room."""
    poses = read_poses(path)
    for photo in poses.photos:
        assert np.isfinite(photo_world(photo.camera)).all(), "a camera that is nowhere"
        photo.name.encode()
    return poses


def nerfstudio_samples() -> tuple[bytes, ...]:
    shared = {"w": 640, "h": 480, "fl_x": 500.0, "cx": 320.0, "cy": 240.0, "k1": 0.01, "metric": True}
    frames = [{"file_path": f"images/{n}.jpg", "transform_matrix": np.eye(4).tolist()} for n in range(2)]
    angle = {"camera_angle_x": 1.1, "w": 640, "h": 480, "frames": frames}
    return json.dumps({**shared, "frames": frames}).encode(), json.dumps(angle).encode()


read_nerfstudio = _file(".json", _placed)


@cache
def colmap_samples(kind: str) -> tuple[bytes, ...]:
    with tempfile.TemporaryDirectory() as folder:
        photos = tuple(PosedPhoto(f"view{n}.jpg", c) for n, c in enumerate(CAMERAS))
        write_colmap(Path(folder), photos, "binary" if kind == ".bin" else "text")
        return (JOINT.join((Path(folder) / f"{name}{kind}").read_bytes() for name in ("cameras", "images")),)


def colmap_reader(kind: str) -> Callable[[bytes], object]:
    def read(data: bytes) -> object:
        first, _, second = data.partition(JOINT)
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / f"cameras{kind}").write_bytes(first)
            (Path(folder) / f"images{kind}").write_bytes(second)
            return _placed(Path(folder))

    return read


def arkit_samples() -> tuple[bytes, ...]:
    pose = {f"t_{i}{j}": float(i == j) for i in range(3) for j in range(4)}
    inner = {"width": 1024, "height": 768, "fx": 800.0, "fy": 800.0, "cx": 512.0, "cy": 384.0}
    frame = {
        "cameraPoseARFrame": np.eye(4).ravel().tolist(),
        "intrinsics": [800.0, 0.0, 512.0, 0.0, 800.0, 384.0, 0.0, 0.0, 1.0],
    }
    return json.dumps({**pose, **inner}).encode(), json.dumps(frame).encode()


def read_arkit(data: bytes) -> object:
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "frame_00001.json").write_bytes(data)
        return _placed(Path(folder))


@cache
def roomplan_samples() -> tuple[bytes, ...]:
    with tempfile.TemporaryDirectory() as folder:
        return (write_json(Path(folder) / "room.json").read_bytes(),)


def _scanned(path: Path) -> object:
    room = read_room_plan(path)
    if room is None:
        raise InputError("no scan")  # as `diorama open` says it
    return scene_to_json(open_room(room, built_in_library()).scene).encode()


read_roomplan = _file(".json", _scanned)


def side_camera_samples() -> tuple[bytes, ...]:
    return b'{"intrinsics": [500, 500, 320, 240]}', b'{"fov_deg": 60}'


read_side_camera = _file(".camera.json", read_camera)


@cache
def marked_samples() -> tuple[bytes, ...]:
    return (glb_bytes(furnished_scene(), PlainLibrary()),)


def _marked(path: Path) -> object:
    marked = read_marked_gltf(path)
    if marked is None:
        return None
    return scene_to_json(open_marked(marked).scene).encode()


read_marked = _file(".glb", _marked)


@cache
def usd_samples() -> tuple[bytes, ...]:
    """A scene of ours as text, binary and package, one of another program, and a scan."""
    from pxr import Usd, UsdGeom

    gathered = gather(furnished_scene(), PlainLibrary(), options=ExportOptions(joints=True))
    with tempfile.TemporaryDirectory() as folder:
        stage = Usd.Stage.CreateNew(str(Path(folder) / "other.usda"))
        for name in ("floor", "chair"):
            mesh = UsdGeom.Mesh.Define(stage, f"/World/{name}")
            mesh.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1)])
            mesh.CreateFaceVertexCountsAttr([4, 3, 3])
            mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 3, 0, 1, 4, 1, 2, 4])
            UsdGeom.Xformable(mesh).AddTranslateOp().Set((2.0, 0.0, 0.0))
        stage.Save()
        for suffix, write in (("usda", write_layer), ("usdc", write_layer), ("usdz", write_usd_package)):
            write(gathered, Path(folder) / f"room.{suffix}")
        write_usdz(Path(folder) / "scan.usdz")
        names = ("room.usda", "room.usdc", "room.usdz", "other.usda", "scan.usdz")
        return tuple((Path(folder) / name).read_bytes() for name in names)


@dataclass(frozen=True)
class Leaked:
    """Something else than a `DioramaError` that a reader in another process raised."""

    what: str
    where: str


def leaks(read: Callable[[bytes], object]) -> Callable[[bytes], object]:
    """A reader for another process: whatever Python raises in it comes back as the finding it is."""

    @wraps(read)
    def through(data: bytes) -> object:
        try:
            return read(data)
        except DioramaError:
            raise
        except Exception as error:
            return Leaked(f"{type(error).__name__}: {error}", traceback.format_exc(limit=-3))

    return through


@leaks
def read_usd(data: bytes) -> object:
    """As `diorama import` reads it, but for the shapes."""
    return _opened_usd(data)


def _opened_usd(data: bytes) -> object:
    suffix = {b"PK": ".usdz", b"PX": ".usdc"}.get(data[:2], ".usda")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"file{suffix}"
        path.write_bytes(data)
        marked = read_mark(path)
        if marked is not None:
            return len(scene_to_json(open_marked(marked).scene).encode())
        scan = read_room_plan(path)
        if scan is not None:
            return len(scene_to_json(open_room(scan, built_in_library()).scene).encode())
        parts, _ = parts_of_usd(path)
        return len(room_of(parts).objects) if parts else 0


def home_samples() -> tuple[bytes, ...]:
    piece = '<pieceOfFurniture name="Chair" x="100" y="200" width="50" depth="60" height="90" angle="0.5"/>'
    wall = '<wall xStart="0" yStart="0" xEnd="400" yEnd="0" thickness="10"/>'
    room = '<room><point x="0" y="0"/><point x="400" y="0"/><point x="400" y="300"/></room>'
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("Home.xml", f'<home wallHeight="260">{piece}{wall}{room}</home>')
    return (buffer.getvalue(),)


read_home = _file(".sh3d", parts_of_sweet_home)


def edit_samples() -> tuple[bytes, ...]:
    edits = [
        {"do": "turn", "objects": ["chair_1"], "degrees": 45.0},
        {"do": "resize", "objects": ["lamp_1"], "factor": 1.1},
        {"do": "restyle", "objects": ["chair_1", "chair_2"], "look": "red"},
        {"do": "paint", "part": "walls", "colour": "light blue"},
        {"do": "move", "objects": ["chair_2"], "places": [{"relation": "beside", "targets": ["table_1"]}]},
        {"do": "remove", "objects": ["chair_1"]},
    ]
    return tuple(json.dumps({"edits": some}).encode() for some in (edits[:2], edits[2:5], edits[5:]))


@cache
def _positioner() -> Positioner:
    return Positioner(PlainLibrary())


def read_edits(data: bytes) -> object:
    """As a language model's reply goes: what is no plan is refused, and a plan is done on a scene."""
    try:
        plan = EditPlan.model_validate(json_in(data.decode("utf-8", "replace")))
    except ValidationError as error:
        raise InputError("no plan") from error  # the model is asked again
    scene, applier = furnished_scene(), EditApplier(_positioner())
    for edit in plan.edits:
        scene = applier.apply(scene, edit).scene
    return scene_to_json(scene).encode()
