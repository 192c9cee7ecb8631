"""Builds a scene from every photo of a folder with `photos.json` and reports how well each agrees with its picture.

    python scripts/eval_photos.py ../shared/photos -o built [--only im3d_1 nyu_00000] [--pictures]

Writes one project a photo, `report.json`, and with --pictures `ID.png`: photo, rendering before and after the layout,
and the scene seen from outside.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import time
import traceback
from pathlib import Path

import numpy as np
from PIL import Image

from diorama_core.evaluation.metrics.annotated import agreement
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.inputs import read_inputs
from diorama_core.pipeline.run import Built
from diorama_core.project.build import build_project
from diorama_core.project.storage import Project
from diorama_core.render.picture import picture


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--only", nargs="*", help="ids of the photos to take")
    parser.add_argument("--pictures", action="store_true")
    a = parser.parse_args()
    a.output.mkdir(parents=True, exist_ok=True)
    library = built_in_library()
    rows = []
    for record in json.loads((a.folder / "photos.json").read_text()):
        if a.only and record["id"] not in a.only:
            continue
        try:
            rows.append(evaluate(a.folder, record, a.output, library, a.pictures))
        except Exception:  # the other photos are worth measuring; the exit status says that one failed
            traceback.print_exc()
            rows.append({"id": record["id"], "failed": True})
        print(line(rows[-1]), flush=True)
    (a.output / "report.json").write_text(json.dumps(rows, indent=1))
    print(summary(rows))
    return int(any(r.get("failed") for r in rows))


def evaluate(folder: Path, record: dict, output: Path, library: ShapeLibrary, pictures: bool) -> dict:
    started = time.perf_counter()
    given = {
        "intrinsics": tuple(record["K"]) if record.get("K") else None,
        "depth": folder / record["depth_file"] if record.get("depth_file") else None,
        "depth_encoding": "sunrgbd" if "<<13" in record.get("depth_to_metres", "") else "linear",
        "boxes": folder / record["detections_file"] if record.get("detections_file") else None,
        "masks": folder / record["instance_mask_file"] if record.get("instance_mask_file") else None,
    }
    read = read_inputs(folder / record["file"], **given)
    place = output / record["id"]
    shutil.rmtree(place, ignore_errors=True)
    project = Project.create(place)
    built = build_project(project, read.inputs, library, warnings=read.warnings)
    seconds = time.perf_counter() - started
    rows = agreement(built.objects, built.geometry, built.observed, built.scene, library)
    if pictures:
        draw(built, read.inputs.photo.rgb, library, output / f"{record['id']}.png")
    return {
        "id": record["id"],
        "seconds": seconds,
        "given": len(built.objects),
        "built": len(built.scene.objects),
        "walls": len(built.scene.architecture.by_role("wall")),
        "floor": built.scene.architecture.floor is not None,
        "stages": {r.stage: round(r.seconds, 2) for r in built.runs},
        "notes": built.notes,
        "objects": [r.__dict__ for r in rows],
    }


def draw(built: Built, photo: np.ndarray, library: ShapeLibrary, path: Path) -> None:
    height = 480
    width = round(photo.shape[1] * height / photo.shape[0])
    views = [np.asarray(Image.fromarray(photo).resize((width, height)))]
    seen = ((built.observed, "photo", width), (built.scene, "photo", width), (built.scene, "orbit:25", height))
    for scene, view, across in seen:
        views.append(picture(scene, library, view=view, size=(across, height), textures=built.textures))
    Image.fromarray(np.hstack(views)).save(path)


def mean(row: dict, key: str) -> float:
    values = [o[key] for o in row.get("objects", [])]
    return float(np.mean(values)) if values else float("nan")


def line(row: dict) -> str:
    if row.get("failed"):
        return f"{row['id']:<18} FAILED"
    ious = " ".join(f"{k.split('_')[0]} {mean(row, k):.3f}" for k in ("cuboid_iou", "shape_iou", "final_iou"))
    stages = " ".join(f"{k} {v:.1f}" for k, v in row["stages"].items())
    counts = f"{row['id']:<18} {row['built']:>2}/{row['given']:<2} walls {row['walls']}"
    return f"{counts} {ious}  {row['seconds']:.1f} s ({stages})"


def summary(rows: list[dict]) -> str:
    objects = [(r["id"], o) for r in rows for o in r.get("objects", [])]
    if not objects:
        return "no objects"
    text = []
    for key in ("cuboid_iou", "shape_iou", "final_iou"):
        values = np.array([o[key] for _, o in objects])
        worst = [objects[i] for i in np.argsort(values)[:3]]
        named = ", ".join(f"{photo}/{o['object_id']} {o[key]:.2f}" for photo, o in worst)
        per_photo = np.nanmean([mean(r, key) for r in rows if r.get("objects")])
        text.append(
            f"{key}: mean {values.mean():.3f} over {len(values)} objects, {per_photo:.3f} over photos, "
            f"median {np.median(values):.3f}; worst {named}"
        )
    odd = [
        f"{photo}/{o['object_id']} {np.round(o['size_m'], 2).tolist()}" for photo, o in objects if not o["plausible"]
    ]
    text.append(f"implausible sizes: {len(odd)} {odd}")
    return "\n".join(text)


if __name__ == "__main__":
    sys.exit(main())
