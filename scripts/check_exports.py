"""Writes scenes of many sources in every format, opens each file with another program, and reports what is found.

    PYTHONPATH=. python scripts/check_exports.py PROJECT... [--made SEED...] [--text] [--scan] [--edited] [-o report.md]
    PYTHONPATH=. python scripts/check_exports.py PROJECT... --drift-only

Findings are: what validators say, objects that are missing or named otherwise, boxes that moved by more than a
millimetre. MuJoCo simulates two seconds; an object drifts when it moves by a centimetre or turns by two degrees.
"""

from __future__ import annotations

import argparse
import io
import json
import subprocess
import sys
import tempfile
import time
import traceback
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from export_scenes import Source, from_scan, from_text, made, projects
from PIL import Image

from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_core.export import export_scene
from diorama_core.export.blender import blender_python, missing_blender
from diorama_core.export.gathering import ExportOptions, ExportScene, gather
from diorama_core.export.stability import stability, urdf_model
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.importing.forms import read_mark
from diorama_core.importing.opening import open_marked
from diorama_core.importing.sweethome import parts_of_sweet_home
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.render.panorama import panorama
from diorama_core.scene.schema import scene_to_json
from diorama_core.scene.types import Scene
from tests.export.validators import gltf_findings, usd_findings

CLOSE_M = 1e-3
MAX_WHITE = 0.4
"""Share of a page; more means that it is lit too brightly."""
STEPS = (0.0, 0.1, 0.25, 0.5, 0.75, 1.0)
"""Of a joint's travel, at which it is tried."""
PATIENCE_MS = 240_000
"""A page drawn by the processor of a busy machine takes this long at most."""
MAX_DEPTH_M = 5e-3
"""So much deeper than when closed may a part be in its own object: colliders are as exact as this."""


def sources(a: argparse.Namespace, library: ShapeLibrary) -> Iterator[Source]:
    """The scenes that are asked for."""
    yield from projects(a.projects, library, edited=2 if a.edited else 0)
    yield from made(a.made, library)
    if a.text:
        yield from_text(library)
    if a.scan:
        yield from_scan()


def boxes(scene: Scene, gathered: ExportScene) -> dict[str, np.ndarray]:
    """World boxes of what was exported."""
    items = [scene.object(o.id) for o in gathered.objects if scene.has_object(o.id)]
    return {o.id: np.stack([o.corners_world.min(axis=0), o.corners_world.max(axis=0)]) for o in items}


def moved(gathered: ExportScene, back: Mapping[str, np.ndarray]) -> list[str]:
    """Objects that are missing, new, or whose boxes moved by more than a millimetre."""
    expected = boxes(gathered.scene, gathered)
    found = [f"{name} is missing" for name in expected.keys() - back.keys()]
    found += [f"{name} is new" for name in back.keys() - expected.keys()]
    for name in expected.keys() & back.keys():
        off = float(np.abs(expected[name] - back[name]).max())
        found += [f"{name} is off by {1000 * off:.1f} mm"] if off > CLOSE_M else []
    return found


def round_trip(path: Path, gathered: ExportScene) -> list[str]:
    marked = read_mark(path)
    if marked is None:
        return ["nothing of the scene is in the file"]
    opened = open_marked(marked)
    found = moved(gathered, boxes(opened.scene, gathered)) + list(opened.changes)
    before, after = scene_to_json(gathered.scene), scene_to_json(opened.scene)
    return found + ([] if before == after else ["the scene differs"])


def check_glb(path: Path, gathered: ExportScene) -> list[str]:
    return gltf_findings(path) + round_trip(path, gathered)


def check_usd(path: Path, gathered: ExportScene) -> list[str]:
    return usd_findings(path) + round_trip(path, gathered)


def check_mujoco(path: Path, gathered: ExportScene) -> list[str]:
    import mujoco

    model = urdf_model(path) if path.suffix == ".urdf" else mujoco.MjModel.from_xml_path(str(path))
    names = {model.body(k).name.rpartition("/")[2] for k in range(model.nbody)}
    return [f"{o.slug} is missing" for o in gathered.objects if o.slug not in names]


def check_mjcf(path: Path, gathered: ExportScene) -> list[str]:
    return check_mujoco(path, gathered) + stuck_joints(path)


def stuck_joints(path: Path) -> list[str]:
    """Joints whose part runs into the rest of its own object on its way, by more than it does when closed."""
    import mujoco

    root = ET.parse(path)
    for contact in root.findall("contact"):  # a part and its case are told not to collide; here they are to
        contact.clear()
    option = root.find("option")
    assert option is not None
    ET.SubElement(option, "flag", filterparent="disable")
    loose = path.with_stem("every_contact")
    root.write(loose)
    model = mujoco.MjModel.from_xml_path(str(loose))
    data = mujoco.MjData(model)
    found = []
    for number in range(model.njnt):
        joint = model.joint(number)
        if joint.type[0] == mujoco.mjtJoint.mjJNT_FREE:
            continue
        depths = []
        for share in STEPS:
            mujoco.mj_resetData(model, data)
            lower, upper = joint.range if joint.limited[0] else (0.0, 2 * np.pi)
            data.qpos[joint.qposadr[0]] = lower + share * (upper - lower)
            mujoco.mj_forward(model, data)
            depths.append(_own_depth(model, data, int(joint.bodyid[0])))
        if max(depths) > depths[0] + MAX_DEPTH_M:
            found.append(f"{joint.name} runs {1000 * (max(depths) - depths[0]):.0f} mm into its own object")
    return found


def _own_depth(model: Any, data: Any, body: int) -> float:
    """How deep a moving part is in the rest of its object."""
    own = {int(model.body_parentid[body])}
    own |= {k for k in range(model.nbody) if k != body and int(model.body_parentid[k]) in own and model.body_jntnum[k]}
    depth = 0.0
    for contact in data.contact:
        pair = {int(model.geom_bodyid[g]) for g in contact.geom}
        if body in pair and pair - {body} and pair - {body} <= own:
            depth = max(depth, -float(contact.dist))
    return depth


def check_sdf(path: Path, gathered: ExportScene) -> list[str]:
    root = ET.parse(path).getroot()
    found = [f"{u.text} is missing" for u in root.iter("uri") if not (path.parent / str(u.text)).is_file()]
    links = {link.get("name") for link in root.iter("link")}
    return found + [f"{o.slug} is missing" for o in gathered.objects if o.slug not in links]


def check_obj(path: Path, gathered: ExportScene) -> list[str]:
    import trimesh

    with zipfile.ZipFile(path) as archive, tempfile.TemporaryDirectory() as folder:
        archive.extractall(folder)
        file = Path(folder) / f"{path.stem}.obj"
        names = [line[2:] for line in file.read_text().splitlines() if line.startswith("o ")]
        loaded = trimesh.load_scene(file)
        triangles = sum(len(g.faces) for g in loaded.geometry.values())
    expected = [" ".join(x.name.split()) for x in (*gathered.planes, *gathered.objects)]
    found = [] if names == expected else ["names differ"]
    return found + ([] if triangles == triangle_count(gathered) else [f"{triangles} triangles"])


def triangle_count(gathered: ExportScene) -> int:
    return sum(gathered.meshes[x.mesh].triangles for x in (*gathered.planes, *gathered.objects))


def check_hdr(path: Path, gathered: ExportScene) -> list[str]:
    read = cv2.imread(str(path), cv2.IMREAD_ANYDEPTH | cv2.IMREAD_COLOR)
    if read is None or read.shape[1] != 2 * read.shape[0]:
        return ["no latitude-longitude map"]
    off = float(np.abs(read[..., ::-1] - panorama(gathered.scene, gathered.library, textures=gathered.textures)).max())
    return [] if off <= 0.01 else [f"off by {off:.3f}"]


def check_ply(path: Path, gathered: ExportScene) -> list[str]:
    import open3d

    count = len(open3d.io.read_triangle_mesh(str(path)).triangles)
    return [] if count >= triangle_count(gathered) else [f"{count} triangles"]


def check_stl(path: Path, gathered: ExportScene) -> list[str]:
    import trimesh

    count = len(trimesh.load_mesh(path, process=False).faces)
    return [] if count == triangle_count(gathered) else [f"{count} triangles"]


def check_state(path: Path, gathered: ExportScene) -> list[str]:
    with zipfile.ZipFile(path) as archive:
        text = archive.read(next(n for n in archive.namelist() if n.endswith(".json") and "/" not in n))
        models = {Path(n).stem for n in archive.namelist() if n.endswith(".glb")}
    items = json.loads(text)["scene"]["object"]
    found = [] if len(items) == len(gathered.objects) else [f"{len(items)} objects"]
    return found + [f"{o['modelId']} has no model" for o in items if o["modelId"].split(".", 1)[1] not in models]


def check_svg(path: Path, gathered: ExportScene) -> list[str]:
    ET.parse(path)
    return []


def check_pdf(path: Path, gathered: ExportScene) -> list[str]:
    done = subprocess.run(["pdftotext", str(path), "-"], capture_output=True, text=True, check=False)
    return [] if done.returncode == 0 and done.stdout.strip() else [done.stderr.strip() or "no text in it"]


def check_dxf(path: Path, gathered: ExportScene) -> list[str]:
    import ezdxf

    audit = ezdxf.readfile(path).audit()
    return [str(e.message) for e in (*audit.errors, *audit.fixes)]


def check_sh3d(path: Path, gathered: ExportScene) -> list[str]:
    with zipfile.ZipFile(path) as archive:
        names, root = set(archive.namelist()), ET.fromstring(archive.read("Home.xml"))
    found = [f"{p.get('model')} is missing" for p in root.iter() if p.get("model") and p.get("model") not in names]
    parts = [p for p in parts_of_sweet_home(path)[0] if p.name not in ("wall", "floor")]
    if len(parts) != len(gathered.objects):
        return [*found, f"{len(parts)} pieces"]
    floor = gathered.scene.architecture.floor
    level = np.array([0.0, 0.0, 0.0 if floor is None else float(floor.centre[2])])
    for part, item in zip(parts, gathered.objects, strict=True):
        points = np.concatenate([s.vertices for s in gathered.meshes[item.mesh].surfaces]) * item.scale
        world = points @ item.T_world[:3, :3].T + item.T_world[:3, 3] - level
        far = part.scene.bounds - [world.min(axis=0), world.max(axis=0)]
        if item.item.category in OPENING_CATEGORIES:  # they reach through their wall, so that it is cut
            far = far.mean(axis=0)
        off = float(np.abs(far).max())
        found += [f"{item.id} is off by {1000 * off:.1f} mm"] if off > CLOSE_M else []
    return found


def check_ifc(path: Path, gathered: ExportScene) -> list[str]:
    import ifcopenshell
    import ifcopenshell.validate

    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(ifcopenshell.open(str(path)), logger, express_rules=False)
    return [str(s.get("message", s))[:120] for s in logger.statements]


def check_html(path: Path, gathered: ExportScene) -> list[str]:
    from playwright.sync_api import sync_playwright

    errors: list[str] = []
    with sync_playwright() as p:
        browser = p.chromium.launch(executable_path="/usr/bin/chromium", args=["--no-sandbox", "--use-gl=swiftshader"])
        page = browser.new_page(viewport={"width": 960, "height": 720})
        page.set_default_timeout(PATIENCE_MS)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(path.as_uri())
        page.locator("canvas").first.wait_for()
        page.wait_for_timeout(12_000)
        shown = np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
        browser.close()
    white = float((shown.min(axis=2) > 250).mean())
    errors += ["nothing is seen"] if shown.reshape(-1, 3).std(axis=0).max() < 10 else []
    return errors + ([f"{white:.0%} of it are white"] if white > MAX_WHITE else [])


def check_blend(path: Path, gathered: ExportScene) -> list[str]:
    reader = Path(__file__).resolve().parents[1] / "tests" / "export" / "blend_reader.py"
    command = [blender_python(), str(reader), str(path)]
    output = subprocess.run(command, capture_output=True, text=True, check=True, timeout=900).stdout
    read = json.loads(next(line for line in output.splitlines() if line.startswith("FOUND "))[6:])
    corners = {v["id"]: np.array(v["corners"]) for v in read["objects"].values()}
    found = moved(gathered, {k: np.stack([c.min(axis=0), c.max(axis=0)]) for k, c in corners.items()})
    found += [] if set(read["objects"]) == {o.name for o in gathered.objects} else ["names differ"]
    return found + ([] if read["materials"] == sorted(m.name for m in gathered.materials) else ["materials differ"])


CHECKS: dict[str, tuple[str, str, str, Callable[[Path, ExportScene], list[str]]]] = {
    "glb": (".glb", "Blender, Unity, Unreal, Godot", "Khronos validator; opened again", check_glb),
    "usda": (".usda", "Isaac Sim, Blender, Unreal", "UsdValidation; opened again", check_usd),
    "usdc": (".usdc", "Isaac Sim, Blender, Unreal", "UsdValidation; opened again", check_usd),
    "usdz": (".usdz", "iPhone, iPad", "UsdValidation; opened again", check_usd),
    "blend": (".blend", "Blender", "opened in Blender 5.0: count, names, materials, boxes", check_blend),
    "mjcf": (".xml", "MuJoCo", "loaded in MuJoCo; every joint opened", check_mjcf),
    "urdf": (".urdf", "ROS, PyBullet", "loaded in MuJoCo", check_mujoco),
    "sdf": (".sdf", "Gazebo", "every file and link is there", check_sdf),
    "obj": (".zip", "any 3D program", "read by trimesh: names, triangles", check_obj),
    "hdr": (".hdr", "Unity, Blender, three.js", "read by OpenCV: the radiance that was written", check_hdr),
    "ply": (".ply", "MeshLab", "read by Open3D: triangles", check_ply),
    "stl": (".stl", "slicers", "read by trimesh: triangles", check_stl),
    "scene-state": (".zip", "SceneEval", "objects and models", check_state),
    "svg": (".svg", "browsers", "parsed", check_svg),
    "pdf": (".pdf", "anything", "text read by poppler", check_pdf),
    "dxf": (".dxf", "AutoCAD, QCAD", "ezdxf's audit", check_dxf),
    "sh3d": (".sh3d", "Sweet Home 3D", "models there; opened again: boxes", check_sh3d),
    "ifc": (".ifc", "Revit, viewers", "ifcopenshell.validate", check_ifc),
    "html": (".html", "any browser", "opened in Chromium: no error, something is seen", check_html),
}


def checked(source: Source, name: str, library: ShapeLibrary, folder: Path) -> list[str]:
    """Findings of one scene in one format."""
    suffix, _, _, check = CHECKS[name]
    path = folder / f"{name}{suffix}"
    try:
        gathered = export_scene(
            source.scene, library, path, EXPORT_FORMATS[name], textures=source.textures, photo=source.photo
        )
        return check(path, gathered)
    except Exception as error:  # every failure is a finding of its own
        traceback.print_exc()
        return [f"{type(error).__name__}: {error}"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("projects", nargs="*", type=Path, metavar="PROJECT")
    parser.add_argument(
        "--made", type=int, nargs="*", default=[], metavar="SEED", help="furnished rooms of these seeds"
    )
    parser.add_argument("--text", action="store_true", help="a room from words")
    parser.add_argument("--scan", action="store_true", help="a room as RoomPlan measures it")
    parser.add_argument("--edited", action="store_true", help="the first two projects after edits, too")
    parser.add_argument("--formats", nargs="*", default=list(CHECKS), choices=list(CHECKS))
    parser.add_argument("--drift-only", action="store_true")
    parser.add_argument("-o", "--output", type=Path, help="write the table as Markdown")
    a = parser.parse_args()
    library = built_in_library()
    findings: dict[str, list[str]] = {name: [] for name in (() if a.drift_only else a.formats)}
    drifts: list[tuple[str, int, int, list[str]]] = []
    text = ""
    for source in sources(a, library):
        begun = time.monotonic()
        if not a.drift_only:
            with tempfile.TemporaryDirectory() as folder:
                for name in findings:
                    findings[name] += [f"{source.name}: {f}" for f in checked(source, name, library, Path(folder))]
        report = stability(gather(source.scene, library, options=ExportOptions(joints=True)))
        worst = [f"{d.object_id} {100 * d.moved_m:.1f} cm {np.degrees(d.turned_rad):.1f}°" for d in report.unstable]
        drifts.append((source.name, len(report.drifts) - len(worst), len(report.drifts), worst))
        print(f"{source.name}: {time.monotonic() - begun:.0f} s, drift {worst}", file=sys.stderr, flush=True)
        for name in findings:
            mine = [f for f in findings[name] if f.startswith(f"{source.name}: ")]
            if mine:
                print(f"  {name}: {mine[:5]}", file=sys.stderr, flush=True)
        text = table(findings, drifts, skipped=missing_blender() if "blend" in a.formats else "")
        if a.output:
            a.output.write_text(text)
    print(text)
    return 0 if not any(findings.values()) else 1


def table(findings: Mapping[str, list[str]], drifts: list[tuple[str, int, int, list[str]]], skipped: str) -> str:
    """The report as Markdown."""
    lines = ["| format | opens in | checked how | findings |", "|---|---|---|---|"] if findings else []
    for name, found in findings.items():
        _, opens, how, _ = CHECKS[name]
        lines.append(f"| `{name}` | {opens} | {skipped if name == 'blend' and skipped else how} | {len(found)} |")
    lines += ["", "| scene | objects | stay | drift |", "|---|---|---|---|"]
    lines += [f"| {name} | {count} | {stay} | {'; '.join(worst)} |" for name, stay, count, worst in drifts]
    stay, count = (sum(d[k] for d in drifts) for k in (1, 2))
    return "\n".join([*lines, "", f"{stay} of {count} objects stay: {stay / max(count, 1):.1%}.", ""])


if __name__ == "__main__":
    sys.exit(main())
