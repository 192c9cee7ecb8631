"""Exports rooms, has engines load them and two seconds of gravity run there, and writes the table of the docs.

    DIORAMA_ENGINES_PYTHON=engines/bin/python PYTHONPATH=. python scripts/engines.py PROJECT... [--engines NAME...]
        [--docs docs/export.md]

The engines live in an environment of their own (`pip install mujoco pybullet drake sapien 'newton[sim,importers]'`).
An object is stable when it moves by less than a centimetre and two degrees; joints count that the engine has with the
limits that were written, and colliders that it has.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from diorama_core.export import FORMATS, export_scene
from diorama_core.export.bodies import PhysicalScene
from diorama_core.export.colliders import physical_scene
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.stability import MAX_DRIFT_M
from diorama_core.library.catalogue import built_in_library
from diorama_core.project.storage import Project

FILES = {"mujoco": "mjcf", "pybullet": "urdf", "sapien": "urdf", "drake": "sdf", "newton": "usdc"}
"""Which format each engine is given."""
NAMES = {"mujoco": "MuJoCo", "pybullet": "PyBullet", "sapien": "SAPIEN", "drake": "Drake", "newton": "newton"}
MAX_TURN_DEG, PATIENCE_S = 2.0, 900.0
BEGIN, END = "<!-- engines -->", "<!-- /engines -->"
"""What surrounds the table in the docs."""


@dataclass
class Row:
    """One engine's line of the table."""

    version: str = "–"
    loads: int = 0
    stable: int = 0
    free: int = 0
    joints: int = 0
    all_joints: int = 0
    colliders: int = 0
    all_colliders: int = 0

    def add(
        self, found: dict[str, Any], free: list[str], limits: list[tuple[float, float] | None], colliders: int
    ) -> None:
        """Count one room as the engine found it.

        Args:
            found: What the engine said.
            free: Names of the objects that may move.
            limits: Of the joints, as they were written.
            colliders: How many were written.
        """
        self.version, self.loads = found["version"], self.loads + 1
        moved = [found["moved"][name] for name in free if name in found["moved"]]
        self.stable += sum(m < MAX_DRIFT_M and deg < MAX_TURN_DEG for m, deg in moved)
        self.colliders += min(found["colliders"], colliders)
        left = [None if each is None else tuple(each) for each in found["limits"]]
        for expected in limits:
            match = next((each for each in left if same(each, expected)), "none")
            if match != "none":
                left.remove(match)
                self.joints += 1


def same(a: tuple[float, float] | None, b: tuple[float, float] | None) -> bool:
    return a == b if a is None or b is None else max(abs(a[0] - b[0]), abs(a[1] - b[1])) < 1e-3


def limits_in(kind: str, limb: ExportLimb) -> tuple[float, float] | None:
    """Limits of a joint as a format has them: those without a position at the start count from where it stands."""
    if limb.kind == "swivel":
        return None
    shift = limb.opened if kind in ("urdf", "sdf") else 0.0
    return limb.lower - shift, limb.upper - shift


def colliders_in(physical: PhysicalScene) -> int:
    bodies = sum(len(b.parts) + sum(len(m.parts) for m in b.moving) for b in physical.bodies)
    return bodies + sum(len(slab.pieces) for slab in physical.slabs)


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
        print(f"{engine}: {(done.stderr.strip().splitlines() or ['died'])[-1]}", file=sys.stderr)
        return None
    found: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1])
    return found


def check_room(project: Project, rows: dict[str, Row]) -> None:
    """Export one room in every format that is needed, and count what each engine makes of it."""
    library, scene = built_in_library(), project.load_scene()
    with tempfile.TemporaryDirectory() as name:
        for kind in {FILES[engine] for engine in rows}:
            suffix, textures = FORMATS[kind].suffixes[0], project.textures(scene)
            gathered = export_scene(scene, library, Path(name) / f"room{suffix}", kind, textures=textures)
        physical = physical_scene(gathered)
        colliders, free = colliders_in(physical), [b.node.slug for b in physical.bodies if b.free]
        for engine, row in rows.items():
            limits = [limits_in(FILES[engine], m.limb) for b in physical.bodies for m in b.moving]
            row.free += len(free)
            row.all_joints += len(limits)
            row.all_colliders += colliders
            found = checked(engine, Path(name))
            if found is not None:
                row.add(found, free, limits, colliders)
                moved = {
                    n: f"{100 * m:.1f} cm {deg:.0f}°"
                    for n, (m, deg) in found["moved"].items()
                    if m >= MAX_DRIFT_M or deg >= MAX_TURN_DEG
                }
                joints = "" if len(found["limits"]) == len(limits) else f", {len(found['limits'])} joints"
                print(f"{project.name} {engine}: {moved or 'at rest'}{joints}", file=sys.stderr, flush=True)


def table(rows: dict[str, Row], rooms: int) -> list[str]:
    lines = ["| engine | version | file | loads | stable | joints | colliders |", "|---|---|---|---:|---:|---:|---:|"]
    for engine, row in rows.items():
        counts = (
            f"{row.stable} of {row.free} | {row.joints} of {row.all_joints} | {row.colliders} of {row.all_colliders}"
        )
        lines.append(f"| {NAMES[engine]} | {row.version} | `{FILES[engine]}` | {row.loads} of {rooms} | {counts} |")
    day = datetime.datetime.now(tz=datetime.UTC).strftime("%d %B %Y").lstrip("0")
    return [*lines, "", f"Checked by `scripts/engines.py` on {day}; number of rooms: {rooms}."]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("projects", nargs="+", type=Path, metavar="PROJECT")
    parser.add_argument("--engines", nargs="*", default=list(FILES), choices=list(FILES))
    parser.add_argument("--docs", type=Path, metavar="FILE.md", help="write the table there, between its marks")
    a = parser.parse_args()
    rows = {engine: Row() for engine in a.engines}
    for done, project in enumerate(map(Project.open, a.projects), 1):
        check_room(project, rows)
        lines = table(rows, done)
        if a.docs is not None:
            before, _, rest = a.docs.read_text("utf-8").partition(BEGIN)
            after = rest.partition(END)[2]
            a.docs.write_text("\n".join([before + BEGIN, *lines, END + after]), "utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
