"""Measures a scene of 500 objects and two million triangles in every format.

    PYTHONPATH=. python scripts/bench_exports.py [--formats glb usdc ...] [-o table.md]

The objects are 292 different shapes of the built-in library at random sizes, on the floor of a large room. Every
format is written in a process of its own: the first time with nothing in memory, the second time as an editor does
that shows the scene already. Seconds are those of the processor and, in brackets, of the clock; the load is how many
processes wanted a core on average of the minute before.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_core.export import export_scene
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Architecture, Plane, Pose, Scene, SceneObject, Support

COUNT, ACROSS, CELL_M = 500, 23, 2.4
KINDS = (
    "chair", "armchair", "sofa", "plant", "lamp", "office chair", "books", "dresser", "bookshelf", "vase", "table",
    "bed", "floor lamp", "side table",
)  # fmt: skip


def large_room(library: ShapeLibrary) -> Scene:
    """The scene."""
    shapes = [s for s in library.shapes() if s.category in KINDS]
    rng = np.random.default_rng(0)
    rng.shuffle(shapes)
    objects = []
    for k in range(COUNT):
        shape = library.shape(shapes[k % len(shapes)].id)
        scale = rng.uniform(0.9, 1.1, 3)
        place = (CELL_M * (k % ACROSS), CELL_M * (k // ACROSS), float(shape.size_m[2] * scale[2]) / 2)
        pose = Pose.upright(place, float(rng.uniform(0, 2 * np.pi)), tuple(scale))
        objects.append(SceneObject(f"o{k}", shape.category, shape.category, shape.id, shape.size_m, pose))
    far = CELL_M * ACROSS
    floor = Plane("floor", "floor", np.array([[-3.0, -3, 0], [far, -3, 0], [far, far, 0], [-3, far, 0]]))
    return Scene(None, Architecture((floor,)), tuple(objects), tuple(Support(o.id, "floor") for o in objects))


def measured(name: str) -> dict[str, float]:
    """Costs of one format, in this process."""
    library = built_in_library()
    scene, chosen = large_room(library), EXPORT_FORMATS[name]
    found: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"large{chosen.suffixes[-1]}"
        for key in ("first", "again"):
            begun, wall = os.times(), time.monotonic()
            gathered = export_scene(scene, library, path, chosen)
            ended = os.times()
            found[key] = sum(ended[:4]) - sum(begun[:4])  # children count: Blender is one
            found[f"{key}_wall"] = time.monotonic() - wall
        found["size_mb"] = sum(f.stat().st_size for f in Path(folder).rglob("*") if f.is_file()) / 1e6
    own, children = (resource.getrusage(w).ru_maxrss for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    found["peak_gb"] = max(own, children) / 1e6
    pieces = ([o.mesh, *(limb.mesh for limb in o.limbs)] for o in gathered.objects)
    found["triangles"] = sum(gathered.meshes[key].triangles for keys in pieces for key in keys)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--formats", nargs="*", choices=list(EXPORT_FORMATS), default=list(EXPORT_FORMATS))
    parser.add_argument("--one", choices=list(EXPORT_FORMATS), help=argparse.SUPPRESS)
    parser.add_argument("-o", "--output", type=Path, help="write the table as Markdown")
    a = parser.parse_args()
    if a.one:
        print(json.dumps(measured(a.one)))
        return 0
    lines = ["| format | first, s | again, s | peak memory, GB | file, MB | load |", "|---|---|---|---|---|---|"]
    for name in a.formats:
        if EXPORT_FORMATS[name].missing:
            continue
        command = [sys.executable, __file__, "--one", name]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            lines.append(f"| `{name}` | {done.stderr.strip().splitlines()[-1]} |")
        else:
            r = json.loads(done.stdout)
            seconds = " | ".join(f"{r[key]:.1f} ({r[f'{key}_wall']:.1f})" for key in ("first", "again"))
            row = f"{seconds} | {r['peak_gb']:.2f} | {r['size_mb']:.1f} | {os.getloadavg()[0]:.0f}"
            lines.append(f"| `{name}` | {row} |")
            print(name, r, file=sys.stderr, flush=True)
        if a.output:
            a.output.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
