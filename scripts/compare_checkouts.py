"""Builds every photo of a folder with two checkouts' commands and tells where their scenes differ.

    python scripts/compare_checkouts.py OLD NEW --photos ../shared/photos -o compared [--only im3d_1 nyu_00000]

OLD and NEW are checkouts (or folders of scenes that an earlier run made: `compared/old`). Scenes are compared as
bytes of `scene.json`; where they differ, the largest difference between numbers and the first entries are named.
Exits with 1 when any scene differs.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--photos", type=Path, required=True)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--only", nargs="*", help="ids of the photos to take")
    a = parser.parse_args()
    records = [r for r in json.loads((a.photos / "photos.json").read_text()) if not a.only or r["id"] in a.only]
    differing = 0
    for record in records:
        scenes = [scene(side, a.output / name, record, a.photos) for side, name in ((a.old, "old"), (a.new, "new"))]
        verdict = "equal" if scenes[0] == scenes[1] else difference(*(json.loads(s) for s in scenes))
        differing += verdict != "equal"
        print(f"{record['id']:<18} {verdict}", flush=True)
    print(f"{len(records) - differing} of {len(records)} scenes are equal")
    return int(differing > 0)


def scene(side: Path, output: Path, record: dict[str, Any], photos: Path) -> bytes:
    """The scene file of one photo, made by a checkout's own command unless it is there already."""
    finished = (side if not (side / "diorama_app").is_dir() else output) / record["id"] / "scene.json"
    if not finished.exists():
        output.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, "-m", "diorama_app.cli", "build", photos / record["file"], "-o", finished.parent]
        environment = {**os.environ, "PYTHONPATH": str(side.resolve())}
        subprocess.run([*map(str, command), *given(record, photos)], env=environment, check=True, capture_output=True)
    return finished.read_bytes()


def given(record: dict[str, Any], photos: Path) -> Iterator[str]:
    """The options that say what is known of the photo."""
    if record.get("K"):
        yield from ("--intrinsics", ",".join(map(str, record["K"])))
    if "<<13" in record.get("depth_to_metres", ""):
        yield from ("--depth-encoding", "sunrgbd")
    for option, key in (
        ("--depth", "depth_file"),
        ("--boxes", "detections_file"),
        ("--masks", "instance_mask_file"),
    ):
        if record.get(key):
            yield from (option, str(photos / record[key]))


def difference(old: Any, new: Any) -> str:
    """What differs between two documents, in one line."""
    entries = list(_differing(old, new, ""))
    numbers = [abs(a - b) for _, a, b in entries if isinstance(a, int | float) and isinstance(b, int | float)]
    largest = f"largest difference {max(numbers):.3g}; " if numbers else ""
    return f"{len(entries)} entries differ; {largest}" + "; ".join(f"{p}: {a!r} -> {b!r}" for p, a, b in entries[:3])


def _differing(old: Any, new: Any, path: str) -> Iterator[tuple[str, Any, Any]]:
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(old.keys() | new.keys()):
            yield from _differing(old.get(key), new.get(key), f"{path}/{key}")
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        for index, (a, b) in enumerate(zip(old, new)):
            yield from _differing(a, b, f"{path}/{index}")
    elif old != new:
        yield path, old, new


if __name__ == "__main__":
    sys.exit(main())
