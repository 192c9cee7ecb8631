"""Exports rooms, has engines simulate them and programs open them, and writes the table of the docs.

    PYTHONPATH=. python scripts/engines.py PROJECT... [--edited] [--text] [--scan] [--engines NAME...]
        [--environments FOLDER] [--docs docs/export.md] [--pictures FOLDER]

Engines of PyPI and npm are installed into `--environments` where they are missing (6 GB); `engine_programs.py` names
the programs of Debian. An object is stable when it moves by less than a centimetre
and two degrees; joints count that the engine has with the limits that were written, and colliders that it has. Pictures
are compared with ours of the same camera: mean difference of colour (CIE 1976), and how many are nearly all white or
black.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from engine_environments import make, python_of
from engine_programs import ENVIRONMENTS_VARIABLE, PROGRAMS, said, web_page
from export_scenes import Source, from_scan, from_text, projects
from PIL import Image

from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_core.export import export_scene
from diorama_core.export.blender import PYTHON_VARIABLE
from diorama_core.export.bodies import PhysicalScene
from diorama_core.export.colliders import physical_scene
from diorama_core.export.gathering import ExportScene
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.stability import MAX_DRIFT_M
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.picture import instances_seen, picture, scene_view
from diorama_core.render.raycast import PinholeView

FILES = {"MuJoCo": "mjcf", "PyBullet": "urdf", "SAPIEN": "urdf", "Drake": "sdf", "newton": "usdc"}
"""Which format each engine is given."""
DRAWN = ("MuJoCo", "PyBullet", "Blender", "three.js", "Babylon.js")
"""Rows with a picture."""
WIDTH_PX = 320
WHITE_L, BLACK_L, MAX_SHARE = 97.0, 3.0, 0.4
"""A picture is pale or black when more than this share of it is lighter or darker."""
MAX_TURN_DEG, PATIENCE_S = 2.0, 900.0
BEGIN, END = "<!-- engines -->", "<!-- /engines -->"
"""What surrounds the table in the docs."""


@dataclass
class Row:
    """One engine's or program's line of the table."""

    kind: str
    """The format that it is given."""
    version: str = "–"
    simulates: bool = True
    loads: int = 0
    stable: int = 0
    free: int = 0
    joints: int = 0
    all_joints: int = 0
    colliders: int = 0
    all_colliders: int = 0
    differences: list[float] = field(default_factory=list)
    """Of the pictures."""
    pale: int = 0

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
        left: list[Any] = [None if each is None else tuple(each) for each in found["limits"]]
        for expected in limits:
            match = next((each for each in left if same(each, expected)), "none")
            if match != "none":
                left.remove(match)
                self.joints += 1

    def compare(self, shown: np.ndarray, ours: np.ndarray, inside: np.ndarray) -> None:
        """Add a picture beside ours, where the room is seen: what is behind it, each program has its own."""
        shown, ours = shown[inside][None], ours[inside][None]
        theirs, here = (cv2.cvtColor(p.astype(np.float32) / 255, cv2.COLOR_RGB2LAB) for p in (shown, ours))
        self.differences.append(float(np.linalg.norm(theirs - here, axis=2).mean()))
        self.pale += bool(max((theirs[..., 0] > WHITE_L).mean(), (theirs[..., 0] < BLACK_L).mean()) > MAX_SHARE)

    def line(self, name: str, rooms: int) -> str:
        """The row in Markdown."""
        counts = "– | – | –"
        if self.simulates and self.loads:
            counts = (
                f"{self.stable} of {self.free} | {self.joints} of {self.all_joints} | "
                f"{self.colliders} of {self.all_colliders}"
            )
        shown = "–"
        if self.differences:
            shown = f"{np.mean(self.differences):.1f} ({len(self.differences)})"
            shown += f", {self.pale} pale or black" if self.pale else ""
        return f"| {name} | {self.version} | `{self.kind}` | {self.loads} of {rooms} | {counts} | {shown} |"


def same(a: tuple[float, float] | None, b: tuple[float, float] | None) -> bool:
    return a == b if a is None or b is None else max(abs(a[0] - b[0]), abs(a[1] - b[1])) < 1e-3


def limits_in(kind: str, limb: ExportLimb) -> tuple[float, float] | None:
    """Limits of a joint as a format has them: those without a position at the start count from where it stands."""
    if limb.kind == "swivel":
        return None
    shift = limb.opened if kind in ("urdf", "sdf") else 0.0
    return limb.lower - shift, limb.upper - shift


def checked(engine: str, python: Path, folder: Path) -> dict[str, Any] | None:
    """What an engine says of a room; None where it does not load it."""
    command = [str(python), str(Path(__file__).with_name("engine_checks.py")), engine, str(folder)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    except subprocess.TimeoutExpired:
        print(f"{engine}: not done after {PATIENCE_S:.0f} s", file=sys.stderr)
        return None
    if done.returncode:
        print(f"{engine}: {(done.stderr.strip().splitlines() or ['died'])[-1]}", file=sys.stderr)
        return None
    found: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1])
    return found


def file_of(kind: str) -> str:
    return f"{'game' if kind == 'game' else 'room'}{EXPORT_FORMATS[kind].suffixes[0]}"


def exported(source: Source, kinds: Iterable[str], library: ShapeLibrary, folder: Path) -> dict[str, ExportScene]:
    """The room in every format that is needed."""
    found = {}
    for kind in kinds:
        path = folder / file_of(kind)
        found[kind] = export_scene(source.scene, library, path, EXPORT_FORMATS[kind], textures=source.textures)
    return found


def simulate(rows: dict[str, Row], environments: Path, physical: PhysicalScene, folder: Path, name: str) -> None:
    """Count what each engine makes of a room."""
    bodies = sum(len(b.parts) + sum(len(m.parts) for m in b.moving) for b in physical.bodies)
    colliders = bodies + sum(len(slab.pieces) for slab in physical.slabs)
    free = [b.node.slug for b in physical.bodies if b.free]
    for title in [title for title in FILES if title in rows and rows[title].version]:
        engine, row = title.lower(), rows[title]
        limits = [limits_in(row.kind, m.limb) for b in physical.bodies for m in b.moving]
        row.free += len(free)
        row.all_joints += len(limits)
        row.all_colliders += colliders
        found = checked(engine, python_of(environments, engine), folder)
        if found is None:
            continue
        row.add(found, free, limits, colliders)
        moved = {
            n: f"{100 * m:.1f} cm {deg:.0f}°"
            for n, (m, deg) in found["moved"].items()
            if m >= MAX_DRIFT_M or deg >= MAX_TURN_DEG
        }
        joints = "" if len(found["limits"]) == len(limits) else f", {len(found['limits'])} joints"
        print(f"{name} {engine}: {moved or 'at rest'}{joints}", file=sys.stderr, flush=True)


def open_in_programs(rows: dict[str, Row], gathered: dict[str, ExportScene], folder: Path, name: str) -> None:
    """Count the programs that open a room without a finding."""
    for program in [p for p in PROGRAMS if p.name in rows and rows[p.name].version]:
        try:
            found = program.findings(folder / file_of(program.kind), gathered[program.kind])
        except Exception as error:  # every failure is a finding of its own
            found = [f"{type(error).__name__}: {error}"]
        rows[program.name].loads += not found
        if found:
            print(f"{name} {program.name}: {found[:3]}", file=sys.stderr, flush=True)


def draw(
    rows: dict[str, Row], environments: Path, source: Source, library: ShapeLibrary, folder: Path, album: Path | None
) -> None:
    """Compare the engines' pictures of a room with ours, where it has a camera."""
    camera = source.scene.camera
    if camera is None:
        return
    size = WIDTH_PX, round(WIDTH_PX * camera.intrinsics.height / camera.intrinsics.width)
    view = scene_view(source.scene, "photo", size)
    assert isinstance(view, PinholeView)
    lens = view.camera
    k = lens.intrinsics
    about = {"width": size[0], "height": size[1], "intrinsics": [k.fx, k.fy, k.cx, k.cy]}
    (folder / "camera.json").write_text(json.dumps({**about, "T_world_camera": lens.T_world_camera.tolist()}))
    ours = picture(source.scene, library, size=size, textures=source.textures)
    inside = instances_seen(source.scene, library, size=size) >= 0
    shown = {"diorama": ours}
    for name in DRAWN:
        if name in rows and rows[name].version not in ("", "–"):
            engine = name if name.endswith(".js") else name.lower()
            drawn = picture_by(engine, python_of(environments, engine), folder, size)
            if drawn is not None:
                rows[name].compare(drawn, ours, inside)
                shown[engine] = drawn
    if album is not None:
        album.mkdir(parents=True, exist_ok=True)
        Image.fromarray(np.hstack(list(shown.values()))).save(album / f"{source.name}.png")


def picture_by(engine: str, python: Path, folder: Path, size: tuple[int, int]) -> np.ndarray | None:
    """What an engine draws of a room; None where it draws nothing."""
    out = folder / f"{engine}.png"
    if engine.endswith(".js"):
        with web_page(engine, folder / "room.glb", *size) as (page, _, _):
            page.locator("canvas").screenshot(path=out)
    else:
        script = Path(__file__).with_name("engine_pictures.py")
        output = said(str(python), str(script), engine, str(folder), str(out))
        if not out.is_file():
            print(f"{engine}: {(output.strip().splitlines() or ['no picture'])[-1]}", file=sys.stderr)
            return None
    return np.asarray(Image.open(out).convert("RGB"))


def table(rows: dict[str, Row], rooms: list[str]) -> list[str]:
    lines = [
        "| engine | version | file | loads | stable | joints | colliders | picture |",
        "|---|---|---|---:|---:|---:|---:|---:|",
        *(row.line(name, len(rooms)) for name, row in rows.items() if row.version),
    ]
    missing = [name for name, row in rows.items() if not row.version]
    day = datetime.datetime.now(tz=datetime.UTC).strftime("%d %B %Y").lstrip("0")
    said_last = f"Checked by `scripts/engines.py` on {day}. Rooms: {'; '.join(rooms)}."
    return [*lines, "", said_last, *([f"Not installed there: {', '.join(missing)}."] if missing else [])]


def sources(a: argparse.Namespace, library: ShapeLibrary) -> Iterator[Source]:
    """The rooms that are asked for."""
    if a.scan:
        yield from_scan()
    if a.text:
        yield from_text(library)
    yield from projects(a.projects, library, edited=1 if a.edited else 0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("projects", nargs="*", type=Path, metavar="PROJECT")
    parser.add_argument("--edited", action="store_true", help="the first project after edits, too")
    parser.add_argument("--text", action="store_true", help="a room from words")
    parser.add_argument("--scan", action="store_true", help="a room as RoomPlan measures it")
    every = [*map(str.lower, FILES), *(p.name for p in PROGRAMS)]
    parser.add_argument("--engines", nargs="*", default=every, choices=every, metavar="NAME", help=", ".join(every))
    parser.add_argument(
        "--environments", type=Path, default=Path(".venv/engines"), metavar="FOLDER", help="where engines are installed"
    )
    parser.add_argument("--docs", type=Path, metavar="FILE.md", help="write the table there, between its marks")
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="keep the engines' pictures beside ours there")
    a = parser.parse_args()
    make(a.environments, a.engines)
    os.environ.setdefault("MUJOCO_GL", "osmesa")
    os.environ[ENVIRONMENTS_VARIABLE] = str(a.environments)
    os.environ.setdefault(PYTHON_VARIABLE, str(python_of(a.environments, "Blender")))
    library, done = built_in_library(), list[str]()
    rows = {
        name: Row(kind, "–" if python_of(a.environments, name).is_file() else "")
        for name, kind in FILES.items()
        if name.lower() in a.engines
    }
    rows |= {p.name: Row(p.kind, p.release(), simulates=False) for p in PROGRAMS if p.name in a.engines}
    for source in sources(a, library):
        with tempfile.TemporaryDirectory() as name:
            kinds = dict.fromkeys(["glb", *(row.kind for row in rows.values() if row.version)])
            gathered = exported(source, kinds, library, Path(name))
            open_in_programs(rows, gathered, Path(name), source.name)
            bodies = next((gathered[row.kind] for row in rows.values() if row.simulates and row.version), None)
            if bodies is not None:
                simulate(rows, a.environments, physical_scene(bodies), Path(name), source.name)
            draw(rows, a.environments, source, library, Path(name), a.pictures)
        done.append(source.name)
        lines = table(rows, done)
        if a.docs is not None:
            before, _, rest = a.docs.read_text("utf-8").partition(BEGIN)
            after = rest.partition(END)[2]
            a.docs.write_text("\n".join([before + BEGIN, *lines, END + after]), "utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
