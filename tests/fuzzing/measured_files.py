"""What is measured or drawn elsewhere, as their programs write it: points, frames of a phone's depth, plans, tables."""

from __future__ import annotations

import io
import json
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image

from diorama_core.importing.measured_cloud import measure_cloud
from diorama_core.importing.measured_room import open_room
from diorama_core.importing.plan_pages import plan_page
from diorama_core.importing.point_files import read_points
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.ingest.finding import read_table
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.schema import scene_to_json
from diorama_core.scene.types import Camera, Intrinsics
from diorama_core.synthesis.cameras import level_pose
from tests.fuzzing.mutate import Random, damaged, strange_json
from tests.fuzzing.scene_files import JOINT, leaks
from tests.importing.scans import FROM_OPENCV, Y_UP, room_meshes, room_points
from tests.importing.test_plan_pages import write_pdf
from tests.importing.test_point_files import write_ply

PLY_ROW = np.dtype([("p", "<f4", 3), ("c", "u1", 3)])
STRANGE_NUMBERS = (np.nan, np.inf, -np.inf, 3e38, 1e30, 1e9, 0.0, -50.0, 1e-40)
POINTS = 4000
"""Twice as many as a room needs: half of a file is still one."""


@cache
def cloud_samples() -> tuple[bytes, ...]:
    """A room's points as PLY, LAS and E57. Damaged LAZ makes its reader abort, each time a process: see the corpus."""
    import laspy
    import pye57

    points = room_points(count=POINTS)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_ply(folder / "room.ply", points)
        header = laspy.LasHeader(point_format=3, version="1.2")
        header.offsets, header.scales = points.min(axis=0), np.full(3, 0.001)
        made = laspy.LasData(header)
        made.x, made.y, made.z = points.T
        made.write(str(folder / "room.las"))
        scan = pye57.E57(str(folder / "room.e57"), mode="w")
        scan.write_scan_raw({f"cartesian{a}": np.ascontiguousarray(points[:, n]) for n, a in enumerate("XYZ")})
        scan.close()
        return tuple((folder / f"room.{suffix}").read_bytes() for suffix in ("ply", "las", "e57"))


def strange_cloud(data: bytes, random: Random) -> bytes:
    """A file of points that is damaged, or whole with some points where none can be, or all of them elsewhere."""
    head, found, rows = data.partition(b"end_header\n")
    if not found or random.integers(0, 3) == 0:
        return damaged(data, random)
    values = np.frombuffer(rows, PLY_ROW).copy()
    kind = int(random.integers(0, 3))
    number = STRANGE_NUMBERS[int(random.integers(0, len(STRANGE_NUMBERS)))]
    axis = int(random.integers(0, 3))
    if kind == 0:
        values["p"][random.random(len(values)) < 0.3, axis] = number
    elif kind == 1:
        values["p"][:, axis] = number
    else:
        values["p"] *= np.float32(random.choice([0.0, 1e-6, 0.01, 3.0, 1e6, -1.0]))
    return head + found + values.tobytes()


def _room_in(path: Path) -> object:
    """The room with its things, whose kinds need not be told apart here."""
    return len(scene_to_json(open_room(measure_cloud(read_points(path)), built_in_library()).scene).encode())


@leaks
def read_cloud(data: bytes) -> object:
    compressed = data[:4] == b"LASF" and len(data) > 104 and data[104] & 0x80
    kinds = {b"ply": ".ply", b"LAS": ".laz" if compressed else ".las", b"AST": ".e57"}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"room{kinds.get(data[:3], '.ply')}"
        path.write_bytes(data)
        return _room_in(path)


@cache
def frame_samples() -> tuple[bytes, ...]:
    """One frame of a phone: its camera, its depth, and how sure that is."""
    camera = Camera(Intrinsics(96, 72, 30.0, 30.0, 48.0, 36.0), level_pose(np.array([1.6, -1.2, 1.5]), 2.4, 0.0))
    depth = MeshCaster([(m, np.eye(4)) for m in room_meshes()]).buffers(camera).depth_m
    T = Y_UP @ camera.T_world_camera @ FROM_OPENCV
    row = {"cameraPoseARFrame": T.ravel().tolist(), "intrinsics": [120.0, 0, 192.0, 0, 120.0, 144.0, 0, 0, 1]}
    pictures = (np.round(depth * 1000).astype(np.uint16), np.full(depth.shape, 2, np.uint8))
    buffers = [io.BytesIO() for _ in pictures]
    for picture, buffer in zip(pictures, buffers, strict=True):
        Image.fromarray(picture).save(buffer, "PNG")
    return (JOINT.join((json.dumps(row).encode(), *(b.getvalue() for b in buffers))),)


def strange_frame(data: bytes, random: Random) -> bytes:
    """One of a frame's three files, changed."""
    files = data.split(JOINT)
    which = int(random.integers(0, len(files)))
    files[which] = (damaged if which else strange_json)(files[which], random)
    return JOINT.join(files)


@leaks
def read_frame(data: bytes) -> object:
    with tempfile.TemporaryDirectory() as folder:
        names = ("frame_00001.json", "depth_00001.png", "conf_00001.png")
        for name, content in zip(names, data.split(JOINT), strict=False):
            (Path(folder) / name).write_bytes(content)
        return _room_in(Path(folder))


@cache
def plan_samples() -> tuple[bytes, ...]:
    """A page of lines, and two scans of paper."""
    buffers = [io.BytesIO() for _ in range(2)]
    for buffer, kind in zip(buffers, ("PNG", "JPEG"), strict=True):
        Image.new("RGB", (160, 120), (250, 250, 245)).save(buffer, kind)
    with tempfile.TemporaryDirectory() as folder:
        return write_pdf(Path(folder) / "plan.pdf").read_bytes(), *(b.getvalue() for b in buffers)


@leaks
def read_plan(data: bytes) -> object:
    return plan_page(data, "plan").shape


def table_samples() -> tuple[bytes, ...]:
    rows = b'chairs/a.glb,+y,-z,1,chair,a wooden chair,CC0\nb.obj,+z,,0.01,,"a lamp, red",\n'
    return (b"file,up,front,unit,category,caption,licence\n" + rows,)


def read_models_table(data: bytes) -> object:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "models.csv"
        path.write_bytes(data)
        return read_table(path)
