"""Models, scans and archives in the forms that programs write, and the front doors that read them."""

from __future__ import annotations

import io
import struct
import tempfile
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import trimesh

from diorama_core.importing.forms import open_form
from diorama_core.importing.measured_cloud import measure_cloud
from diorama_core.importing.point_files import read_points
from diorama_core.library.ingest.finding import members_of
from diorama_core.library.ingest.limits import Limits
from diorama_core.library.ingest.models import read_model
from diorama_core.library.ingest.repair import repair
from diorama_core.progress import Progress
from tests.importing.scans import room_points

OBJ_BACKWARDS = b"o seat\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2\nf -4 -2 -1\n"


@cache
def compressed_samples() -> tuple[bytes, ...]:
    """One object of Diorama's own, compressed in both ways."""
    from diorama_core.export import export_scene
    from diorama_core.export.gathering import ExportOptions
    from tests.primitives import PrimitiveLibrary, furnished_room

    library = PrimitiveLibrary()
    scene = furnished_room(library)
    made = []
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("draco", "meshopt"):
            path = Path(folder) / f"{kind}.glb"
            options = ExportOptions(only=frozenset({scene.objects[0].id}), compression=kind)
            export_scene(scene, library, path, "glb", options=options)
            made.append(path.read_bytes())
    return tuple(made)


def box(kind: str) -> bytes:
    """A box in a format that trimesh writes."""
    made = trimesh.creation.box((0.5, 0.4, 0.9)).export(file_type=kind)
    return made.encode() if isinstance(made, str) else bytes(made)


def three_mf() -> bytes:
    """A package with one triangle."""
    corners = "".join(f'<vertex x="{x}" y="{y}" z="0"/>' for x, y in ((0, 0), (9, 0), (0, 9)))
    mesh = f'<mesh><vertices>{corners}</vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh>'
    model = (
        '<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
        f'<object id="1">{mesh}</object></resources><build><item objectid="1"/></build></model>'
    )
    return zipped({"3D/3dmodel.model": model.encode(), "[Content_Types].xml": b"<Types/>"})


def three_ds() -> bytes:
    """One mesh of one triangle."""

    def chunk(kind: int, body: bytes) -> bytes:
        return struct.pack("<HI", kind, 6 + len(body)) + body

    vertices = struct.pack("<H9f", 3, 0, 0, 0, 1, 0, 0, 0, 1, 0)
    faces = struct.pack("<H4H", 1, 0, 1, 2, 0)
    mesh = chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces))
    return chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, b"a\0" + mesh)))


def zipped(files: dict[str, bytes]) -> bytes:
    """An archive of these files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def archives() -> tuple[bytes, ...]:
    """A model, a scan and a home in archives."""
    points = "\n".join(f"{x:.3f} {y:.3f} {z:.3f}" for x, y, z in room_points(count=3000)).encode()
    return (
        zipped({"pack/chair.obj": OBJ_BACKWARDS, "pack/chair.mtl": b"newmtl a\nmap_Kd -s 2 2 a.png\n"}),
        zipped({"room.xyz": points}),
        zipped({"Home.xml": b"<home><level id='a' elevation='0'/><wall level='a' xStart='0'/></home>"}),
    )


@cache
def text_clouds() -> tuple[bytes, ...]:
    """Points as XYZ and as PCD."""
    points = room_points(count=3000)
    rows = "\n".join(f"{x:.3f} {y:.3f} {z:.3f}" for x, y, z in points)
    head = f"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\n"
    pcd = (head + f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\nDATA binary\n").encode()
    return rows.encode(), pcd + points.astype("<f4").tobytes()


@cache
def array_clouds() -> tuple[bytes, ...]:
    """Points as an array, an archive of arrays, and bare floats."""
    points = room_points(count=3000).astype(np.float32)
    array, archive = io.BytesIO(), io.BytesIO()
    np.save(array, points)
    np.savez(archive, points=points, colours=np.zeros((9, 3), np.uint8))
    return array.getvalue(), archive.getvalue(), np.column_stack([points, points[:, 0] / 9]).tobytes()


@cache
def splat_samples() -> tuple[bytes, ...]:
    """Splats as PLY."""
    points = room_points(count=3000)
    names = ("x", "y", "z", "opacity", "scale_0", "scale_1", "scale_2")
    rows = np.column_stack([points, np.full(len(points), 3.0), np.full((len(points), 3), -4.0)]).astype("<f4")
    heading = "".join(f"property float {name}\n" for name in names)
    return (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{heading}end_header\n".encode()
        + rows.tobytes(),
    )


def read_as_model(suffix: str) -> Callable[[bytes], object]:
    """The reader of models for bytes of a file that ends so."""
    return {".glb": _glb, ".dae": _dae, ".3mf": _3mf, ".3ds": _3ds, ".off": _off, ".obj": _obj}[suffix]


def _model(data: bytes, suffix: str) -> object:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"model{suffix}"
        path.write_bytes(data)
        return len(repair(read_model(path, Path(folder), Limits()).scene, Limits()).meshes)


def _glb(data: bytes) -> object:
    return _model(data, ".glb")


def _dae(data: bytes) -> object:
    return _model(data, ".dae")


def _3mf(data: bytes) -> object:
    return _model(data, ".3mf")


def _3ds(data: bytes) -> object:
    return _model(data, ".3ds")


def _off(data: bytes) -> object:
    return _model(data, ".off")


def _obj(data: bytes) -> object:
    return _model(data, ".obj")


def read_archive(data: bytes) -> object:
    """Both doors for an archive: its models, and the scene in it."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "a.zip"
        path.write_bytes(data)
        members = members_of(path)
        for member in members:
            repair(read_model(path, Path(name), Limits(), member).scene, Limits())
        if not members:
            with open_form(path) as (form, place):
                form.read(place, Progress())
        return len(members)


def read_text_points(data: bytes) -> object:
    """A cloud in plain text or PCD, to the room in it."""
    return _points(data, ".pcd" if b"VERSION" in data[:300] else ".xyz")


def read_array_points(data: bytes) -> object:
    """A cloud of bare numbers, to the room in it."""
    starts = {b"\x93NUM": ".npy", b"PK\x03\x04": ".npz"}
    return _points(data, starts.get(data[:4], ".bin"))


def read_splats(data: bytes) -> object:
    """Splats, to the room in them."""
    return _points(data, ".ply")


def _points(data: bytes, suffix: str) -> object:
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / f"room{suffix}"
        path.write_bytes(data)
        return len(measure_cloud(read_points(path)).walls)
