"""Programs that open an exported file without simulating it: how each is asked, and what it finds wrong.

What is not installed is said in the table. Debian has assimp-utils, sweethome3d (with a Java compiler), godot3-server,
libsdformat-dev and poppler-utils; npm has three (`npm install --prefix .venv/node three`).
"""

from __future__ import annotations

import ctypes
import ctypes.util
import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from check_exports import check_blend, check_dxf, check_ifc, check_pdf
from playwright.sync_api import Page, sync_playwright

from diorama_core.export.blender import blender_python, missing_blender
from diorama_core.export.gathering import ExportScene
from tests.export.validators import usd_findings

ROOT = Path(__file__).resolve().parents[1]
THREE = Path(os.environ.get("DIORAMA_THREE", ROOT / ".venv" / "node" / "node_modules" / "three"))
SWEET_HOME = Path("/usr/share/sweethome3d/sweethome3d.jar")
PATIENCE_S = 600.0
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
    env = {**os.environ, "LANG": "en_US.UTF-8", **({} if cwd is None else {"HOME": str(cwd)})}
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False, cwd=cwd, env=env)
    return done.stdout + done.stderr


def debian(package: str) -> str:
    """Version of a Debian package without Debian's own marks."""
    found = said("dpkg-query", "-W", "-f", "${Version}", package) if shutil.which("dpkg-query") else ""
    return "" if "no packages" in found else found.partition("-")[0].partition("~")[0].partition("+")[0]


def check_assimp(path: Path, gathered: ExportScene) -> list[str]:
    lines = said("assimp", "info", str(path)).splitlines()
    meshes = next((int(line.split()[-1]) for line in lines if line.startswith("Meshes:")), 0)
    return [line for line in lines if line.startswith(("ERROR", "WARN"))] + ([] if meshes else ["no meshes"])


_GODOT = """extends SceneTree
func count(node, found):
	found[node.get_class()] = found.get(node.get_class(), 0) + 1
	for child in node.get_children():
		count(child, found)
	return found
func _init():
	print("FOUND ", to_json(count(load("res://room.glb").instance(), {})))
	quit()
"""


def check_godot(path: Path, gathered: ExportScene) -> list[str]:
    """Imports the game pack into an empty project and counts its bodies."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "project.godot").write_text('config_version=4\n[application]\nconfig/name="room"\n')
        (folder / "count.gd").write_text(_GODOT)
        shutil.copyfile(path, folder / "room.glb")
        said("godot3-server", "--path", name, "--editor", "--quit", cwd=folder)
        lines = said("godot3-server", "--path", name, "-s", "count.gd", cwd=folder).splitlines()
    counted: dict[str, int] = next((json.loads(line[6:]) for line in lines if line.startswith("FOUND ")), {})
    wrong = [line for line in lines if "SCRIPT ERROR" in line]
    return wrong + ([] if counted.get("StaticBody") and counted.get("MeshInstance") else [f"only {counted}"])


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


_PAGE = """<body style="margin:0"><script type="importmap">{"imports":{"three":"/three/build/three.module.js",
"three/addons/":"/three/examples/jsm/"}}</script><script type="module">
import * as THREE from 'three'; import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true, antialias: true});
renderer.setSize(innerWidth, innerHeight); document.body.append(renderer.domElement);
new GLTFLoader().load('/room.glb', file => {
  const scene = new THREE.Scene(); scene.add(file.scene); scene.updateMatrixWorld(true);
  const camera = file.cameras[0] ?? new THREE.PerspectiveCamera();
  camera.aspect = innerWidth / innerHeight; camera.updateProjectionMatrix(); renderer.render(scene, camera);
  let meshes = 0; file.scene.traverse(node => { meshes += node.isMesh ? 1 : 0; }); window.shown = meshes;
}, undefined, error => { window.shown = String(error); });
</script>"""


@contextmanager
def three_page(path: Path, width: int, height: int) -> Iterator[tuple[Page, list[str], Any]]:
    """A page of Chromium in which three.js has loaded a file; what it complained about; how many meshes it has."""
    complaints: list[str] = []

    def serve(route: Any) -> None:
        name = route.request.url.split("//", 1)[1].partition("/")[2].partition("?")[0]
        if name == "room.glb":
            route.fulfill(body=path.read_bytes(), content_type="model/gltf-binary")
        elif name.startswith("three/"):
            route.fulfill(body=(THREE / name[6:]).read_bytes(), content_type="text/javascript")
        else:
            route.fulfill(body="" if name else _PAGE, content_type="text/html")

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


def check_three(path: Path, gathered: ExportScene) -> list[str]:
    with three_page(path, 64, 48) as (_, complaints, meshes):
        return complaints + ([] if isinstance(meshes, int) and meshes else [str(meshes)])


def three_release() -> str:
    return str(json.loads((THREE / "package.json").read_text())["version"]) if THREE.is_dir() else ""


def blender_release() -> str:
    if missing_blender():
        return ""
    return said(blender_python(), "-c", "import bpy; print(bpy.app.version_string)").strip().splitlines()[-1]


PROGRAMS = (
    Program("three.js", "glb", three_release, check_three),
    Program("assimp", "glb", lambda: debian("assimp-utils"), check_assimp),
    Program("Blender", "blend", blender_release, check_blend),
    Program("Godot", "game", lambda: debian("godot3-server"), check_godot),
    Program("libsdformat (`gz sdf --check`)", "sdf", lambda: debian("libsdformat-dev"), check_sdformat),
    Program("UsdValidation", "usdc", lambda: version("usd-core"), lambda path, _: usd_findings(path)),
    Program("UsdValidation, USDZ", "usdz", lambda: version("usd-core"), lambda path, _: usd_findings(path)),
    Program("IfcOpenShell's validator", "ifc", lambda: version("ifcopenshell"), check_ifc),
    Program("Sweet Home 3D's classes", "sh3d", lambda: debian("sweethome3d"), check_sweet_home),
    Program("poppler", "pdf", lambda: debian("poppler-utils"), check_pdf),
    Program("ezdxf's audit", "dxf", lambda: version("ezdxf"), check_dxf),
)
