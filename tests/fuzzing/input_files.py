"""Samples of the forms that tools write for photos, boxes, masks and depth, and their readers."""

from __future__ import annotations

import base64
import io
import json
import zipfile
import zlib

import numpy as np
from PIL import Image

from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.sorting import recognise
from tests.fuzzing.mutate import Random, damaged, strange_json, strange_zip
from tests.fuzzing.photo_readers import with_depth, with_masks
from tests.perception.inputs.boxes.test_forms import FORMS, SIZE, content
from tests.perception.inputs.depth.test_channels import in_bytes
from tests.perception.inputs.files import encoded, npy
from tests.perception.inputs.photos.test_kinds_of_photos import raw_file


def _archive(**arrays: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def _metres() -> np.ndarray:
    down = np.maximum(np.arange(64) - 24, 1)[:, None] / (0.8 * 96) * np.ones((1, 96))
    return np.minimum(1.4 / down, 4.0).astype(np.float32)


def _ids() -> np.ndarray:
    ids = np.zeros((64, 96), np.uint8)
    ids[10:30, 10:40], ids[35:60, 50:90] = 1, 2
    return ids


def box_samples() -> tuple[bytes, ...]:
    """A file of every form of boxes, and YOLO's."""
    return (*(content(document) for _, document in FORMS), b"0 0.5 0.5 0.2 0.3\n1 0.2 0.2 0.1 0.1 0.9\n")


def read_boxes(data: bytes) -> object:
    """Boxes of a photo of 400 x 300 pixels."""
    return read_inputs(encoded(Image.new("RGB", SIZE, (90, 120, 200))), name="photo.png", boxes=data)


def strange_text(data: bytes, random: Random) -> bytes:
    """Values of JSON, and bytes of anything."""
    json_like = data[:1] in b"[{" and bool(random.random() < 0.7)
    return strange_json(data, random) if json_like else damaged(data, random)


def depth_samples() -> tuple[bytes, ...]:
    """Every container of depth but PNG, .npy of floats and EXR, which have parsers of their own."""
    metres = _metres()
    millimetres = (metres * 1000).astype(np.uint16)
    x, y = np.meshgrid(np.arange(96) / 80 - 0.6, np.arange(64) / 80 - 0.4)
    points = np.stack([metres * x, metres * y, metres], axis=-1).astype(np.float32)
    pictures = [encoded(Image.fromarray(metres), "TIFF"), encoded(Image.fromarray(millimetres), "TIFF")]
    pictures.append(encoded(Image.fromarray(in_bytes(millimetres, 0, 1))))
    text = "\n".join(" ".join(f"{v:.3f}" for v in row) for row in metres).encode()
    return _archive(depth=metres), npy(millimetres), npy(points), millimetres.tobytes(), text, *pictures


def read_depth(data: bytes) -> object:
    """Depth of a photo of 96 x 64 pixels."""
    return with_depth(data)


def mask_samples() -> tuple[bytes, ...]:
    """Arrays, an archive of pictures, run lengths and polygons."""
    ids, stream = _ids(), io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for number in (1, 2):
            archive.writestr(f"{number}.png", encoded(Image.fromarray((ids == number).astype(np.uint8) * 255)))
    runs = {"size": [64, 96], "counts": [100, 200, 5844]}
    shape = {"label": "x", "shape_type": "polygon", "points": [[5, 5], [60, 5], [60, 50]]}
    polygons = {"shapes": [shape], "imageWidth": 96, "imageHeight": 64}
    region = {"shape_attributes": {"name": "polygon", "all_points_x": [5, 60, 60], "all_points_y": [5, 5, 50]}}
    via = {"photo.png123": {"filename": "photo.png", "size": 123, "regions": [{**region, "region_attributes": {}}]}}
    part = base64.b64encode(zlib.compress(encoded(Image.fromarray(np.full((9, 9), 255, np.uint8))))).decode()
    bitmap = {"classTitle": "chair", "bitmap": {"data": part, "origin": [5, 5]}}
    bitmaps = {"size": {"height": 64, "width": 96}, "objects": [bitmap]}
    segments = (json.dumps(d).encode() for d in ([{"segmentation": runs}], polygons, via, bitmaps))
    polygon_rows = b"0 0.1 0.1 0.6 0.1 0.6 0.8\n1 0.2 0.3 0.5 0.3 0.5 0.9\n"
    first, second = ids == 1, ids == 2
    stacks = npy(np.stack([first, second])), npy(np.stack([first, second]).astype(np.float32) * 0.9)
    archives = _archive(masks=ids), _archive(chair=first, table=second), stream.getvalue()
    figures = '<polygon points="5,5;60,5;60,50"/><mask left="5" top="5" width="9" height="2" rle="3, 15"/>'
    cvat = f'<annotations><image name="photo.png" width="96" height="64">{figures}</image></annotations>'.encode()
    return npy(ids), *stacks, *archives, *segments, polygon_rows, cvat, json.dumps(_brush()).encode()


def _brush() -> list[object]:
    """Label Studio's region of a brush: 24,576 bytes in one run."""
    bits = f"{4 * 64 * 96:032b}{7:05b}{2:04b}{3:04b}{7:04b}{15:04b}1{3:02b}{4 * 64 * 96 - 1:016b}{255:08b}"
    packed = [int(bits[k : k + 8].ljust(8, "0"), 2) for k in range(0, len(bits), 8)]
    return [{"original_width": 96, "original_height": 64, "value": {"format": "rle", "rle": packed}}]


def read_masks(data: bytes) -> object:
    """Masks of a photo of 96 x 64 pixels."""
    return with_masks(data)


def strange_masks(data: bytes, random: Random) -> bytes:
    """Damage to the container that it is."""
    if data.startswith(b"PK"):
        return strange_zip(data, random)
    return strange_text(data, random)


def photo_samples() -> tuple[bytes, ...]:
    """Camera raw, HEIC, sixteen bits, a frame."""
    from pillow_heif import register_heif_opener

    register_heif_opener()
    noise = np.random.default_rng(0).integers(60, 200, (64, 96, 3)).astype(np.uint8)
    framed = np.full((100, 130, 3), 255, np.uint8)
    framed[18:82, 17:113] = noise
    photo = Image.fromarray(noise)
    twelve = Image.fromarray((noise[..., 0].astype(np.uint16)) * 16)
    return (
        raw_file(photo.resize((32, 24)), photo),
        encoded(photo, "HEIF"),
        encoded(twelve),
        encoded(Image.fromarray(framed)),
    )


def sorting_samples() -> tuple[bytes, ...]:
    """Some of all."""
    return (*box_samples()[:4], *depth_samples(), *mask_samples(), *photo_samples())


def read_sort(data: bytes) -> object:
    """What a dropped file is."""
    return recognise(data, "file", (96, 64))
