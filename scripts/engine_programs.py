"""Programs that open an exported file without simulating it: how each is asked, and what it finds wrong.

What is not installed is said in the table. Debian has assimp-utils, sweethome3d (with a Java compiler), godot3-server,
inkscape, librecad, libreoffice-calc, libsdformat-dev, poppler-utils and slic3r.
"""

from __future__ import annotations

import csv
import ctypes
import ctypes.util
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from check_exports import check_blend, check_dxf, check_ifc, check_pdf
from engine_environments import environment
from PIL import Image
from playwright.sync_api import Page, sync_playwright

from diorama_core.export.blender import blender_python, missing_blender
from diorama_core.export.gathering import ExportScene
from tests.export.validators import usd_findings

ENVIRONMENTS_VARIABLE = "DIORAMA_ENVIRONMENTS"
"""Names the folder of the engines that npm installs."""
SWEET_HOME = Path("/usr/share/sweethome3d/sweethome3d.jar")
PATIENCE_S = 600.0
INK, MIN_INK = 220, 0.001
NEAR_M = 0.03
"""Fewer triangles than a shape has move its corners by less."""
Check = Callable[[Path, ExportScene], list[str]]


@dataclass(frozen=True)
class Program:
    """One program that opens a format."""

    name: str
    kind: str
    """The format it is given."""
    release: Callable[[], str]
    """Its version; empty where it is not installed."""
    findings: Check


def said(*command: str, cwd: Path | None = None) -> str:
    """What a program prints, errors included."""
    env = {**os.environ, "LANG": "en_US.UTF-8", "QT_QPA_PLATFORM": "offscreen"}
    env |= {} if cwd is None else {"HOME": str(cwd)}
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False, cwd=cwd, env=env)
    return done.stdout + done.stderr


def debian(package: str) -> str:
    """Version of a Debian package without Debian's own marks."""
    found = said("dpkg-query", "-W", "-f", "${Version}", package) if shutil.which("dpkg-query") else ""
    return "" if "no packages" in found else re.sub(r"^\d+:|[-~+].*", "", found)


def check_assimp(path: Path, gathered: ExportScene) -> list[str]:
    lines = said("assimp", "info", str(path)).splitlines()
    meshes = next((int(line.split()[-1]) for line in lines if line.startswith("Meshes:")), 0)
    return [line for line in lines if line.startswith(("ERROR", "WARN"))] + ([] if meshes else ["no meshes"])


_GODOT = """extends SceneTree
func walk(node, found):
	if node is CollisionShape:
		found.colliders += 1
	if node is MeshInstance:
		for surface in node.mesh.get_surface_count():
			found.materials[node.mesh.surface_get_material(surface).get_instance_id()] = true
	for child in node.get_children():
		walk(child, found)
func bounds(node, box):
	if node is MeshInstance:
		for surface in node.mesh.get_surface_count():
			for vertex in node.mesh.surface_get_arrays(surface)[0]:
				var point = node.global_transform.xform(vertex)
				box = AABB(point, Vector3()) if box == null else box.expand(point)
	for child in node.get_children():
		box = bounds(child, box)
	return box
func open(node, travels, found):
	for child in node.get_children():
		open(child, travels, found)
	if travels.has(node.name):
		var travel = travels[node.name]
		var axis = Vector3(travel.axis[0], travel.axis[1], travel.axis[2])
		if travel.joint == "slide":
			node.translate_object_local(axis * travel.way)
		else:
			node.rotate_object_local(axis, travel.way)
		var box = bounds(node, null)
		var end = box.position + box.size
		found.opened[node.name] = [box.position.x, box.position.y, box.position.z, end.x, end.y, end.z]
func _init():
	var found = {"colliders": 0, "materials": {}, "opened": {}}
	var room = load("res://room.glb").instance()
	get_root().add_child(room)
	walk(room, found)
	var file = File.new()
	file.open("res://travels.json", File.READ)
	open(room, JSON.parse(file.get_as_text()).result, found)
	print("FOUND ", to_json(found))
	quit()
"""


def check_godot(path: Path, gathered: ExportScene) -> list[str]:
    """Imports the game pack into an empty project: colliders and materials are counted, and what moves is opened by the
    axis and the travel that its node says, about the node's own origin."""
    colliders, materials, travels = game_pack(path)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "project.godot").write_text('config_version=4\n[application]\nconfig/name="room"\n')
        (folder / "count.gd").write_text(_GODOT)
        (folder / "travels.json").write_text(json.dumps(travels))
        shutil.copyfile(path, folder / "room.glb")
        godot_import(folder)
        lines = said("godot3-server", "--path", name, "-s", "count.gd", cwd=folder).splitlines()
    found = next((json.loads(line[6:]) for line in lines if line.startswith("FOUND ")), None)
    if found is None:
        return [line for line in lines if "SCRIPT ERROR" in line] or ["not imported"]
    wrong = [] if found["colliders"] == colliders else [f"{found['colliders']} of {colliders} colliders"]
    wrong += [] if len(found["materials"]) == materials else [f"{len(found['materials'])} of {materials} materials"]
    for part, bounds in opened_bounds(gathered).items():
        box = np.array(found["opened"].get(part, [np.inf] * 6)).reshape(2, 3)
        wrong += [] if np.allclose(box, bounds, atol=NEAR_M) else [f"{part} opens to {box.round(2).tolist()}"]
    return wrong


def opened_bounds(gathered: ExportScene) -> dict[str, np.ndarray]:
    """Where each moving part is when it is open, +Y up, by Godot's name for it."""
    found = {}
    for node, limb in ((item, limb) for item in gathered.objects for limb in item.limbs):
        T = node.T_world @ replace(limb, opened=limb.upper).T_object_limb
        corners = np.concatenate([s.vertices for s in gathered.meshes[limb.mesh].surfaces]) * node.scale
        x, y, z = (corners @ T[:3, :3].T + T[:3, 3]).T
        world = np.column_stack([x, z, -y])
        found[godot_name(f"{node.name} {limb.name}")] = np.array([world.min(axis=0), world.max(axis=0)])
    return found


def godot_name(name: str) -> str:
    return re.sub(r"[^\w -]+", "", name)


def godot_import(folder: Path) -> None:
    """Has the editor import what is in a project. Godot 3.2's server does not quit then, whatever is asked of it."""
    command, environment = ["godot3-server", "--path", str(folder), "--editor"], {**os.environ, "HOME": str(folder)}
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    editor = subprocess.Popen(command, env=environment, **quiet)
    end = time.monotonic() + PATIENCE_S
    while editor.poll() is None and time.monotonic() < end and not [*folder.glob(".import/*.md5")]:
        time.sleep(0.5)
    editor.terminate()
    editor.wait()


def game_pack(path: Path) -> tuple[int, int, dict[str, dict[str, Any]]]:
    """Number of colliders and of materials that are seen, and how far each part moves that can, by Godot's names."""
    content = path.read_bytes()
    document = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    nodes = document["nodes"]
    colliders = [node for node in nodes if node["name"].endswith("-convcolonly")]
    seen = [document["meshes"][node["mesh"]] for node in nodes if "mesh" in node and node not in colliders]
    materials = {primitive["material"] for mesh in seen for primitive in mesh["primitives"]}
    moving = [(node["name"], node["extras"]) for node in nodes if "joint" in node.get("extras", {})]
    travels = {
        godot_name(name): {"joint": e["joint"], "axis": e["axis"], "way": e["upper"] - e["open"]} for name, e in moving
    }
    return len(colliders), len(materials), travels


_HOME = """import com.eteks.sweethome3d.io.HomeFileRecorder;
import com.eteks.sweethome3d.model.Home;
public class Opened {
  public static void main(String[] files) throws Exception {
    Home home = new HomeFileRecorder(0, true, null, false, true).readHome(files[0]);
    boolean newer = home.getVersion() > Home.CURRENT_VERSION;
    System.out.println("PIECES " + home.getFurniture().size() + (newer || home.isRepaired() ? " WARNED" : ""));
  }
}
"""


def check_sweet_home(path: Path, gathered: ExportScene) -> list[str]:
    """Read by the program's own classes."""
    with tempfile.TemporaryDirectory() as name:
        source = Path(name) / "Opened.java"
        source.write_text(_HOME)
        lines = said("java", "-cp", str(SWEET_HOME), str(source), str(path)).splitlines()
    return [] if lines[-1:] == [f"PIECES {len(gathered.objects)}"] else [" ".join(lines)[:200]]


def check_sdformat(path: Path, gathered: ExportScene) -> list[str]:
    """`gz sdf --check` calls the same function of libsdformat."""
    code = f"import ctypes; raise SystemExit(ctypes.CDLL({sdformat()!r}).cmdCheck({str(path).encode()!r}))"
    found = said("python3", "-c", code).strip().splitlines()
    return [] if found == ["Valid."] else found


def sdformat() -> str:
    """Name of the library; empty without."""
    return next((n for k in range(16, 9, -1) if (n := ctypes.util.find_library(f"sdformat{k}"))), "")


_THREE = """<body style="margin:0"><script type="importmap">{"imports":{"three":"/three/build/three.module.js",
"three/addons/":"/three/examples/jsm/"}}</script><script type="module">
import * as THREE from 'three'; import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true, antialias: true});
renderer.setSize(innerWidth, innerHeight); document.body.append(renderer.domElement);
new GLTFLoader().load('/room.glb', file => {
  const scene = new THREE.Scene(); scene.add(file.scene); scene.updateMatrixWorld(true);
  const camera = file.cameras[0] ?? new THREE.PerspectiveCamera();
  camera.aspect = innerWidth / innerHeight; camera.updateProjectionMatrix();
  const {width, height, cx, cy} = camera.userData; // glTF's cameras look through the middle of the picture
  if (width) camera.setViewOffset(width, height, width / 2 - cx, height / 2 - cy, width, height);
  renderer.render(scene, camera);
  let meshes = 0; file.scene.traverse(node => { meshes += node.isMesh ? 1 : 0; }); window.shown = meshes;
}, undefined, error => { window.shown = String(error); });
</script>"""
_BABYLON = """<body style="margin:0"><canvas id="canvas" style="display:block; width:100vw; height:100vh"></canvas>
<script src="/babylonjs/babylon.js"></script><script src="/babylonjs-loaders/babylonjs.loaders.min.js"></script><script>
BABYLON.SceneLoaderFlags.ShowLoadingScreen = false;
const engine = new BABYLON.Engine(canvas, true, {preserveDrawingBuffer: true});
BABYLON.LoadSceneAsync('/room.glb', engine).then(scene => scene.executeWhenReady(() => {
  const camera = scene.cameras[0] ?? new BABYLON.UniversalCamera('', BABYLON.Vector3.Zero(), scene);
  scene.activeCamera = camera;
  const extras = scene.getNodes().map(node => node.metadata?.gltf?.extras).find(found => found?.cx);
  if (extras) { // glTF's cameras look through the middle of the picture
    const lens = camera.getProjectionMatrix().toArray().slice(), forward = scene.useRightHandedSystem ? -1 : 1;
    lens[8] = forward * (2 * extras.cx / extras.width - 1); lens[9] = forward * (1 - 2 * extras.cy / extras.height);
    camera.freezeProjectionMatrix(BABYLON.Matrix.FromArray(lens));
  }
  scene.render(); window.shown = scene.meshes.filter(mesh => mesh.getTotalVertices()).length;
})).catch(error => { window.shown = String(error); });
</script>"""
PAGES = {"three.js": ("three", _THREE), "Babylon.js": ("babylonjs", _BABYLON)}
"""What npm calls an engine, and a page that shows a file with it."""


def node_modules(engine: str) -> Path:
    return environment(Path(os.environ[ENVIRONMENTS_VARIABLE]), engine) / "node_modules"


@contextmanager
def web_page(engine: str, path: Path, width: int, height: int) -> Iterator[tuple[Page, list[str], Any]]:
    """A page of Chromium in which an engine has loaded a file; what it complained about; how many meshes it has."""
    complaints: list[str] = []

    def serve(route: Any) -> None:
        name = route.request.url.split("//", 1)[1].partition("/")[2].partition("?")[0]
        module = node_modules(engine) / name
        if name == "room.glb":
            route.fulfill(body=path.read_bytes(), content_type="model/gltf-binary")
        elif module.is_file():
            route.fulfill(body=module.read_bytes(), content_type="text/javascript")
        else:
            route.fulfill(body="" if name else PAGES[engine][1], content_type="text/html")

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path="/usr/bin/chromium",
            args=["--no-sandbox", "--use-gl=swiftshader", "--enable-unsafe-swiftshader"],
        )
        page = browser.new_page(viewport={"width": width, "height": height})
        page.set_default_timeout(1000 * PATIENCE_S)
        page.route("**/*", serve)
        page.on("console", lambda m: complaints.append(m.text) if m.type in ("warning", "error") else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto("http://room.test/")
        page.wait_for_function("window.shown !== undefined")
        yield page, [c for c in complaints if "GPU stall" not in c and "GL Driver" not in c], page.evaluate("shown")
        browser.close()


def check_in_page(engine: str, path: Path) -> list[str]:
    with web_page(engine, path, 64, 48) as (_, complaints, meshes):
        return complaints + ([] if isinstance(meshes, int) and meshes else [str(meshes)])


def npm_release(engine: str) -> str:
    package = node_modules(engine) / PAGES[engine][0] / "package.json"
    return str(json.loads(package.read_text())["version"]) if package.is_file() else ""


def blender_release() -> str:
    if missing_blender():
        return ""
    return said(blender_python(), "-c", "import bpy; print(bpy.app.version_string)").strip().splitlines()[-1]


def check_libreoffice(path: Path, gathered: ExportScene) -> list[str]:
    """LibreOffice Calc writes what it has read of a workbook as CSV."""
    with tempfile.TemporaryDirectory() as name:
        said("soffice", "--headless", "--convert-to", "csv", "--outdir", name, str(path), cwd=Path(name))
        read = Path(name) / f"{path.stem}.csv"
        rows = list(csv.reader(read.open(encoding="utf-8"))) if read.is_file() else []
    return [] if {row[0] for row in rows[1:]} == {o.id for o in gathered.objects} else [f"{len(rows)} rows"]


def check_librecad(path: Path, gathered: ExportScene) -> list[str]:
    """LibreCAD prints a drawing, which is not empty then."""
    with tempfile.TemporaryDirectory() as name:
        shutil.copyfile(path, f"{name}/plan.dxf")
        said("librecad", "dxf2pdf", "-a", "-c", f"{name}/plan.dxf", cwd=Path(name))
        said("pdftoppm", "-singlefile", "-r", "40", "-png", f"{name}/plan.pdf", f"{name}/plan")
        return drawn(Path(name) / "plan.png")


def check_inkscape(path: Path, gathered: ExportScene) -> list[str]:
    """Inkscape draws a plan with its labels."""
    with tempfile.TemporaryDirectory() as name:
        said("inkscape", str(path), "--export-background=white", f"--export-filename={name}/plan.png", cwd=Path(name))
        return drawn(Path(name) / "plan.png")


def drawn(picture: Path) -> list[str]:
    """Finds a picture missing or empty: of less than a thousandth of ink."""
    if not picture.is_file():
        return ["no picture"]
    ink = float((np.asarray(Image.open(picture).convert("L")) < INK).mean())
    return [] if ink > MIN_INK else [f"{ink:.4f} of ink"]


def check_slic3r(path: Path, gathered: ExportScene) -> list[str]:
    """Slic3r finds a closed body of all triangles, in millimetres."""
    found = dict(line.partition(" = ")[::2] for line in said("slic3r", "--info", str(path)).splitlines())
    triangles = int.from_bytes(path.read_bytes()[80:84], "little")
    return [] if found.get("number_of_facets", "").strip() == str(triangles) else [str(found)[:200]]


PROGRAMS = (
    *(
        Program(engine, "glb", partial(npm_release, engine), lambda path, _, engine=engine: check_in_page(engine, path))
        for engine in PAGES
    ),
    Program("assimp", "glb", lambda: debian("assimp-utils"), check_assimp),
    Program("Blender", "blend", blender_release, check_blend),
    Program("Godot", "game", lambda: debian("godot3-server"), check_godot),
    Program("libsdformat (`gz sdf --check`)", "sdf", lambda: debian("libsdformat-dev"), check_sdformat),
    Program("UsdValidation", "usdc", lambda: version("usd-core"), lambda path, _: usd_findings(path)),
    Program("UsdValidation, USDZ", "usdz", lambda: version("usd-core"), lambda path, _: usd_findings(path)),
    Program("IfcOpenShell's validator", "ifc", lambda: version("ifcopenshell"), check_ifc),
    Program("Sweet Home 3D's classes", "sh3d", lambda: debian("sweethome3d"), check_sweet_home),
    Program("poppler", "pdf", lambda: debian("poppler-utils"), check_pdf),
    Program("Inkscape", "svg", lambda: debian("inkscape"), check_inkscape),
    Program("LibreCAD", "dxf", lambda: debian("librecad"), check_librecad),
    Program("LibreOffice Calc", "xlsx", lambda: debian("libreoffice-calc"), check_libreoffice),
    Program("Slic3r", "stl", lambda: debian("slic3r"), check_slic3r),
    Program("ezdxf's audit", "dxf", lambda: version("ezdxf"), check_dxf),
)
