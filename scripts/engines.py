"""Exports rooms for simulators, lets each engine load them and two seconds of gravity run, and prints a table.

    DIORAMA_ENGINES_PYTHON=engines/bin/python PYTHONPATH=. python scripts/engines.py PROJECT... [--engines NAME...]

The engines live in an environment of their own (`pip install mujoco pybullet drake sapien 'newton[sim,importers]'`).
An object is stable when it moves by less than a centimetre and two degrees.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from diorama_core.export import FORMATS, export_scene
from diorama_core.export.stability import MAX_DRIFT_M
from diorama_core.library.catalogue import built_in_library
from diorama_core.project.storage import Project

FILES = {"mujoco": "mjcf", "pybullet": "urdf", "sapien": "urdf", "drake": "sdf", "newton": "usdc"}
"""Which format each engine is given."""
MAX_TURN_DEG, PATIENCE_S = 2.0, 900.0


def checked(engine: str, folder: Path) -> dict[str, Any] | None:
    """What an engine says of a room; None where it does not load it."""
    command = [
        os.environ.get("DIORAMA_ENGINES_PYTHON", sys.executable),
        str(Path(__file__).with_name("engine_checks.py")),
    ]
    done = subprocess.run(
        [*command, engine, str(folder)], capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )
    if done.returncode:
        print(f"{engine}: {done.stderr.strip().splitlines()[-1]}", file=sys.stderr)
        return None
    found: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1])
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("projects", nargs="+", type=Path, metavar="PROJECT")
    parser.add_argument("--engines", nargs="*", default=list(FILES), choices=list(FILES))
    a = parser.parse_args()
    library, rows = built_in_library(), {engine: [0, 0, 0, 0, 0] for engine in a.engines}
    versions = dict.fromkeys(a.engines, "–")
    for project in map(Project.open, a.projects):
        scene = project.load_scene()
        with tempfile.TemporaryDirectory() as name:
            for kind in {FILES[engine] for engine in a.engines}:
                suffix, textures = FORMATS[kind].suffixes[0], project.textures(scene)
                gathered = export_scene(scene, library, Path(name) / f"room{suffix}", kind, textures=textures)
            joints = sum(len(o.limbs) for o in gathered.objects)
            for engine in a.engines:
                found = checked(engine, Path(name))
                row = rows[engine]
                row[4] += joints
                if found is None:
                    continue
                still = {n for n, (m, deg) in found["moved"].items() if m < MAX_DRIFT_M and deg < MAX_TURN_DEG}
                print(f"{project.name} {engine}: {set(found['moved']) - still} moved", file=sys.stderr)
                versions[engine] = found["version"]
                for column, value in enumerate((1, len(still), len(found["moved"]), found["joints"])):
                    row[column] += value
    print("| engine | version | file | loads | stable | joints |\n|---|---|---|---:|---:|---:|")
    for engine, (loads, stable, count, joints, expected) in rows.items():
        print(
            f"| {engine} | {versions[engine]} | `{FILES[engine]}` | {loads} of {len(a.projects)} "
            f"| {stable} of {count} | {joints} of {expected} |"
        )


if __name__ == "__main__":
    main()
