"""Writes COLMAP models, which the program only reads."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Literal

import numpy as np
from scipy.spatial.transform import Rotation

from diorama_core.multiview.posed_photos import PosedPhoto

Kind = Literal["text", "binary"]


def write_colmap(folder: Path, photos: tuple[PosedPhoto, ...], kind: Kind = "text") -> None:
    """Write cameras as a COLMAP model without points.

    Args:
        folder: made if it is missing.
        photos: each gets a camera of its own.
        kind: text or binary files.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for photo in photos:
        T = np.linalg.inv(photo.camera.T_world_camera)
        x, y, z, w = Rotation.from_matrix(T[:3, :3]).as_quat()
        rows.append((photo, [float(v) for v in (w, x, y, z, *T[:3, 3])]))
    ks = [p.camera.intrinsics for p in photos]
    if kind == "text":
        cameras = [f"{n} PINHOLE {k.width} {k.height} {k.fx!r} {k.fy!r} {k.cx!r} {k.cy!r}" for n, k in enumerate(ks, 1)]
        (folder / "cameras.txt").write_text("\n".join(["# cameras", *cameras]) + "\n", encoding="utf-8")
        images = [f"{n} {' '.join(map(repr, v))} {n} {p.name}\n" for n, (p, v) in enumerate(rows, 1)]
        (folder / "images.txt").write_text("# images\n" + "\n".join(images) + "\n", encoding="utf-8")
        return
    packed = [struct.pack("<iiQQ4d", n, 1, k.width, k.height, k.fx, k.fy, k.cx, k.cy) for n, k in enumerate(ks, 1)]
    (folder / "cameras.bin").write_bytes(struct.pack("<Q", len(ks)) + b"".join(packed))
    images_b = [
        struct.pack("<i7di", n, *v, n) + p.name.encode() + b"\0" + struct.pack("<Q", 0)
        for n, (p, v) in enumerate(rows, 1)
    ]
    (folder / "images.bin").write_bytes(struct.pack("<Q", len(rows)) + b"".join(images_b))
