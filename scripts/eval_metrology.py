"""How well metric cuboids explain the boxes of the shared photos: IoU, implausible sizes, time, and overlays.

python scripts/eval_metrology.py [--overlays DIR] [PHOTO_ID ...]
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import cv2
import numpy as np

from diorama_core.artefacts import DetectedObject, Inputs, ObjectGeometry
from diorama_core.geometry.projection import box_iou, visible_bounds
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.perception.camera.estimate import EmbeddedCamera
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.masks import EmbeddedMasks
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.perception.metrology.priors import size_modes
from diorama_core.progress import Progress
from diorama_core.scene.types import Camera, box_corners

PHOTOS = Path(__file__).resolve().parents[2] / "shared" / "photos"
EDGES = [(i, i | (1 << axis)) for i in range(8) for axis in range(3) if not i & (1 << axis)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("photos", nargs="*", help="ids of photos; by default all with boxes or masks")
    parser.add_argument("--overlays", type=Path, help="folder for pictures with the cuboids drawn in")
    arguments = parser.parse_args()
    entries = json.loads((PHOTOS / "photos.json").read_text())
    pointed_at = [e for e in entries if e.get("detections_file") or e.get("instance_mask_file")]
    chosen = [e for e in pointed_at if not arguments.photos or e["id"] in arguments.photos]
    everything: list[tuple[float, str]] = []
    for entry in chosen:
        inputs = read_entry(entry)
        started = time.process_time()
        camera = EmbeddedCamera().estimate(inputs, Progress())
        objects = EmbeddedMasks().segment(inputs, Progress())
        middle = time.process_time()
        geometry = SingleViewMetrology().measure(inputs, camera, objects, Progress())
        finished = time.process_time()
        ious = overlaps(objects, geometry)
        print(
            f"{entry['id']}: h {geometry.camera.position[2]:.2f} m, confidence {geometry.confidence:.2f}, mean IoU "
            f"{np.mean(ious):.3f}, camera and masks {middle - started:.1f} s, metrology {finished - middle:.1f} s"
        )
        describe(objects, geometry, ious)
        everything += [(iou, f"{entry['id']} {o.id}") for iou, o in zip(ious, objects, strict=True)]
        if arguments.overlays:
            arguments.overlays.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(arguments.overlays / f"{entry['id']}.png"), overlay(inputs, objects, geometry))
    values = np.array([iou for iou, _ in everything])
    print(f"all: {len(values)} boxes, mean IoU {values.mean():.3f}, median {np.median(values):.3f}")
    print("worst:", ", ".join(f"{name} {iou:.2f}" for iou, name in sorted(everything)[:8]))


def read_entry(entry: dict) -> Inputs:
    def file(key: str) -> Path | None:
        return PHOTOS / entry[key] if entry.get(key) else None

    given = tuple(entry["K"]) if entry.get("K") else None
    return read_inputs(
        PHOTOS / entry["file"], intrinsics=given, boxes=file("detections_file"), masks=file("instance_mask_file")
    ).inputs


def overlaps(objects: tuple[DetectedObject, ...], geometry: ObjectGeometry) -> list[float]:
    camera = geometry.camera
    corners = np.array([camera.to_camera(c.corners_world) for c in geometry.cuboids])
    bounds, _ = visible_bounds(corners, camera.intrinsics)
    return [float(v) for v in box_iou(bounds, np.array([o.box for o in objects]))]


def describe(objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, ious: list[float]) -> None:
    for item, cuboid, support, iou in zip(objects, geometry.cuboids, geometry.supports, ious, strict=True):
        depth, width, height = cuboid.size_m
        yaw = np.degrees(np.arctan2(cuboid.R_world_object[1, 0], cuboid.R_world_object[0, 0]))
        place = " ".join(f"{v:6.2f}" for v in cuboid.centre)
        print(
            f"  {item.id:16s} {iou:.2f}  HWD {height:.2f} {width:.2f} {depth:.2f}  at {place}  yaw {yaw:4.0f}  "
            f"on {support.parent:16s} confidence {cuboid.confidence:.2f}{remark(item.category, cuboid.size_m)}"
        )


def remark(name: str, size_m: np.ndarray) -> str:
    """Says by how many sigmas a size is off, beyond two."""
    if name == UNKNOWN.name:
        return ""
    off = [np.abs((np.log(size_m) - m.log_size) / m.sigma).max() for m in size_modes(name)]
    return f"  size off by {min(off):.1f} sigma" if min(off) > 2 else ""


def overlay(inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry) -> np.ndarray:
    picture = np.ascontiguousarray(inputs.photo.rgb[..., ::-1]) // 2 + 40
    generator = np.random.default_rng(3)
    thick = max(1, round(inputs.photo.width / 500))
    for item, cuboid in zip(objects, geometry.cuboids, strict=True):
        colour = tuple(int(v) for v in generator.integers(90, 256, 3))
        corners = box_corners(cuboid.size_m) @ cuboid.R_world_object.T + cuboid.centre
        for a, b in EDGES:
            front = corners[a] + np.linspace(0, 1, 25)[:, None] * (corners[b] - corners[a])
            draw_line(picture, front, geometry.camera, colour, thick)
        x1, y1, x2, y2 = (round(v) for v in item.box)
        cv2.rectangle(picture, (x1, y1), (x2, y2), colour, 1)
        place = (x1 + 3, y1 + 12 * thick)
        cv2.putText(picture, item.id, place, cv2.FONT_HERSHEY_SIMPLEX, 0.4 * thick, colour, thick)
    return picture


def draw_line(picture: np.ndarray, points: np.ndarray, camera: Camera, colour: tuple, thick: int) -> None:
    seen = camera.to_camera(points)[:, 2] > 0.05
    pixels = camera.project(points)
    for n in range(len(points) - 1):
        if seen[n] and seen[n + 1] and np.abs(pixels[n : n + 2]).max() < 1e4:
            a, b = (tuple(round(v) for v in pixels[m]) for m in (n, n + 1))
            cv2.line(picture, a, b, colour, thick, cv2.LINE_AA)


if __name__ == "__main__":
    main()
