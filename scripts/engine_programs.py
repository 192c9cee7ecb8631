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
from dataclasses import dataclass
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
	if node is Spatial:
		found.places[node.name] = [node.translation.x, node.translation.y, node.translation.z]
	for child in node.get_children():
		walk(child, found)
func _init():
	var found = {"colliders": 0, "materials": {}, "places": {}}
	walk(load("res://room.glb").instance(), found)
	print("FOUND ", to_json(found))
	quit()
"""


def check_godot(path: Path, gathered: ExportScene) -> list[str]:
    """Imports the game pack into an empty project: colliders and materials are counted, doors are at their hinges."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "project.godot").write_text('config_version=4\n[application]\nconfig/name="room"\n')
        (folder / "count.gd").write_text(_GODOT)
        shutil.copyfile(path, folder / "room.glb")
        godot_import(folder)
        lines = said("godot3-server", "--path", name, "-s", "count.gd", cwd=folder).splitlines()
    found = next((json.loads(line[6:]) for line in lines if line.startswith("FOUND ")), None)
    if found is None:
        return [line for line in lines if "SCRIPT ERROR" in line] or ["not imported"]
    colliders, materials, hinges = game_pack(path)
    wrong = [] if found["colliders"] == colliders else [f"{found['colliders']} of {colliders} colliders"]
    wrong += [] if len(found["materials"]) == materials else [f"{len(found['materials'])} of {materials} materials"]
    places = {part: np.array(found["places"].get(part, [np.inf] * 3)) for part in hinges}
    return wrong + [f"{part} at {at}" for part, at in places.items() if not np.allclose(at, hinges[part], atol=1e-3)]


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


def game_pack(path: Path) -> tuple[int, int, dict[str, list[float]]]:
    """Number of colliders and of materials that are seen, and where parts that move are, by Godot's names for them."""
    content = path.read_bytes()
    document = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    nodes = document["nodes"]
    colliders = [node for node in nodes if node["name"].endswith("-convcolonly")]
    seen = [document["meshes"][node["mesh"]] for node in nodes if "mesh" in node and node not in colliders]
    materials = {primitive["material"] for mesh in seen for primitive in mesh["primitives"]}
    moving = [node for node in nodes if "joint" in node.get("extras", {})]
    hinges = {re.sub(r"[^\w -]+", "", node["name"]): node.get("translation", [0.0] * 3) for node in moving}
    return len(colliders), len(materials), hinges


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
