"""Compose the bundled example: a furnished room of built-in shapes, path-traced by day from eye height.

Writes `assets/example/photo.jpg` (a rendering through the model of a camera: exposure, white balance, fall-off and
noise), `boxes.json` (what a person would draw, from what is truly visible), `intrinsics.json` and `project/`, the scene
that the pipeline makes of them. The picture needs Blender's Python module (`DIORAMA_BLENDER_PYTHON`, see
`docs/export.md`) and six minutes of a free core; with `--project-only` the picture stays and Blender is not needed.

    python scripts/make_example.py [--out assets/example] [--draft] [--project-only]
"""

from __future__ import annotations

import argparse
import json
import shutil
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter

from diorama_app.projects.example import PHOTO_NAME
from diorama_core.errors import UnavailableError
from diorama_core.export.blender import missing_blender
from diorama_core.export.cycles import CyclesLens, LightPortal, Outdoors, cycles_radiance
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.inputs import read_inputs
from diorama_core.project.build import build_project
from diorama_core.project.storage import Project
from diorama_core.render.picture import looking_along
from diorama_core.render.raycast import MeshCaster, OrthographicView
from diorama_core.scene.types import Architecture, Camera, Intrinsics, Plane, Pose, Scene, SceneObject, yaw_rotation
from diorama_core.synthesis.photograph import photograph

SIZE, DRAFT = (1280, 960), (640, 480)
LEFT, RIGHT, NEAR, FAR, HEIGHT = -2.9, 2.9, -1.6, 5.55, 2.55
SEED = 7
SKY = np.array([6.0, 6.9, 8.0])
"""Radiance of a bright, lightly clouded sky, W/(m2 sr)."""
SUN = np.array([16.0, 13.5, 10.0])
"""Irradiance of the low sun through net curtains, W/m2."""
SUN_FROM = np.array([-0.74, -0.30, 0.60])
SUN_ANGLE_RAD = 0.03
WHITE = np.array([1.0, 0.89, 0.80])
"""Colour of the daylight between the room's own walls and boards."""
LENS = CyclesLens(focus_m=4.2, aperture_m=0.004)
"""Of a compact camera at f/2.8: what is near is a little soft."""
FRAME_M = 0.05
"""Width of a window's frame and bars."""
HANGING = float("inf")
"""Height of what hangs from the ceiling."""
TO_VIEWER, TO_RIGHT, TO_LEFT = -90.0, 0.0, 180.0
"""Headings in degrees: where a shape's front points."""


@dataclass(frozen=True)
class Item:
    """One thing: what people call it, which shape, where its middle stands, where its front points."""

    label: str
    shape: str
    x: float
    y: float
    heading_deg: float = TO_VIEWER
    base_m: float | None = None
    """Height of its underside; None lets it stand on what is beneath it."""
    scale: float = 1.0
    lean_deg: float = 0.0
    """Leaning backwards."""
    drawn: bool = True
    """Whether a person would draw a box around it."""


ITEMS = (
    Item("rug", "rug-persian-red", 1.05, 3.6, TO_RIGHT),
    Item("sofa", "sofa-blue-two", 1.5, 5.07),
    Item("pillow", "pillow-rust", 1.06, 5.1, -80.0, lean_deg=14.0),
    Item("pillow", "pillow-striped", 1.96, 5.1, -98.0, lean_deg=14.0),
    Item("coffee table", "coffee-table-waterfall-walnut", 0.98, 3.4),
    Item("plant", "plant-flowering", 1.26, 3.43),
    Item("bowl", "bowl-stoneware", 0.7, 3.36),
    Item("mug", "cup-mug-white", 1.0, 3.24, 40.0),
    Item("armchair", "armchair-lounge-oak", 2.08, 3.95, 165.0),
    Item("side table", "side-table-tripod-oak", 2.6, 5.2),
    Item("lamp", "lamp-urn-blue", 2.6, 5.2),
    Item("floor lamp", "floor-lamp-tripod-oak", -0.74, 5.22),
    Item("picture", "picture-seascape-gilt", 1.48, FAR - 0.02, base_m=1.3),
    Item("picture", "picture-botanic", 2.4, FAR - 0.015, base_m=1.38),
    Item("clock", "clock-round-oak", -1.1, FAR - 0.025, base_m=1.75),
    Item("bookshelf", "bookshelf-oak-four", 0.2, 5.38),
    Item("books", "books-row", 0.03, 5.4, base_m=1.23),
    Item("vase", "vase-moon-stone", 0.47, 5.38, base_m=1.23),
    Item("vase", "vase-bottle-white", -0.05, 5.38, base_m=0.856),
    Item("books", "books-row", 0.34, 5.4, base_m=0.856),
    Item("books", "books-stack-small", -0.05, 5.38, -70.0, base_m=0.476),
    Item("books", "books-row", 0.3, 5.4, base_m=0.476, drawn=False),
    Item("basket", "basket-shelf", 0.02, 5.38, base_m=0.1),
    Item("basket", "basket-shelf", 0.41, 5.38, base_m=0.1),
    Item("plant", "plant-aloe", 0.2, 5.38),
    Item("mirror", "mirror-round-brass", -1.8, FAR - 0.02, base_m=0.85),
    Item("plant", "plant-fiddle", -2.42, 4.85),
    Item("dining table", "table-oak-classic", -1.1, 3.6, TO_RIGHT),
    Item("vase", "vase-moon-stone", -1.18, 3.9),
    Item("bowl", "bowl-wood", -1.02, 3.3),
    Item("chair", "chair-slat-oak", -0.44, 3.5, 184.0),
    Item("chair", "chair-slat-oak", -1.74, 3.95, 2.0),
    Item("chair", "chair-slat-oak", -1.12, 4.66, -91.0),
    Item("ceiling lamp", "ceiling-lamp-wicker-bell", -1.1, 3.6, base_m=HANGING),
)


def standing(library: ShapeLibrary, item: Item, placed: list[SceneObject], number: int) -> SceneObject:
    """The item as an object, resting on whatever lies beneath its middle."""
    shape = library.shape(item.shape)
    lean = np.radians(item.lean_deg)
    tilt = np.array([[np.cos(lean), 0, -np.sin(lean)], [0, 1, 0], [np.sin(lean), 0, np.cos(lean)]])
    R = yaw_rotation(np.radians(item.heading_deg)) @ tilt
    corners = np.asarray(library.mesh(item.shape).vertices) * item.scale @ R.T
    base = ground_below(library, placed, item.x, item.y) if item.base_m is None else item.base_m
    z = HEIGHT - corners[:, 2].max() if base == HANGING else base - corners[:, 2].min()
    pose = Pose(R, np.array([item.x, item.y, z]), np.full(3, item.scale))
    name = f"{item.label.replace(' ', '-')}-{number}"
    return SceneObject(name, item.label, shape.category, item.shape, shape.size_m, pose)


def ground_below(library: ShapeLibrary, placed: list[SceneObject], x: float, y: float) -> float:
    """Height of the first surface beneath a spot: the floor, a table's top, a seat."""
    meshes = [(library.mesh(o.shape_id), o.pose.matrix) for o in placed]
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = looking_along(np.array([0.0, 0.0, -1.0]), up=np.array([0.0, 1.0, 0.0])), [x, y, 4.0]
    depth = MeshCaster(meshes).buffers(OrthographicView(T, 1, 1, 0.001)).depth_m[0, 0]
    return 4.0 - float(depth) if depth > 0 else 0.0


@dataclass(frozen=True)
class Window:
    """A hole in a wall, from left to right as seen from inside (metres along the wall) and from bottom to top."""

    start: float
    stop: float
    sill: float
    head: float


WINDOWS = {
    "left": (Window(1.5, 2.9, 0.8, 2.25), Window(3.9, 5.3, 0.8, 2.25)),
    "behind": (Window(0.9, 2.7, 0.5, 2.25),),
}


def room() -> Architecture:
    """Warm white walls, one of them sage, and an oak floor; windows to the left and behind the camera, out of sight."""
    floor = np.array([[LEFT, NEAR, 0], [RIGHT, NEAR, 0], [RIGHT, FAR, 0], [LEFT, FAR, 0]])
    white, sage = (0.93, 0.915, 0.885), (0.70, 0.735, 0.68)
    return Architecture(
        (
            Plane("floor", "floor", floor, texture="planks"),
            Plane("ceiling", "ceiling", floor[::-1] + np.array([0, 0, HEIGHT]), colour=(0.96, 0.955, 0.945)),
            *wall("back", sage),
            *wall("left", white),
            *wall("right", white),
            *wall("behind", white),
        )
    )


CORNERS = {
    "back": ((LEFT, FAR), (RIGHT, FAR)),
    "left": ((LEFT, NEAR), (LEFT, FAR)),
    "right": ((RIGHT, FAR), (RIGHT, NEAR)),
    "behind": ((RIGHT, NEAR), (LEFT, NEAR)),
}
"""Where each wall starts and stops, from left to right as seen from inside."""


def wall(name: str, colour: tuple[float, float, float]) -> list[Plane]:
    """A wall as rectangles around its windows, and the bars of these."""
    start, stop = (np.array([*corner, 0.0]) for corner in CORNERS[name])
    length = float(np.linalg.norm(stop - start))
    along, up = (stop - start) / length, np.array([0.0, 0.0, 1.0])
    pieces, at = [], 0.0
    for window in WINDOWS.get(name, ()):
        pieces += [(at, window.start, 0.0, HEIGHT), (window.start, window.stop, 0.0, window.sill)]
        pieces += [(window.start, window.stop, window.head, HEIGHT), *bars(window)]
        at = window.stop
    pieces.append((at, length, 0.0, HEIGHT))
    return [
        Plane(
            f"{name}-{number}",
            "wall",
            np.array([start + along * x + up * z for x, z in ((a, low), (b, low), (b, high), (a, high))]),
            colour=colour,
        )
        for number, (a, b, low, high) in enumerate(pieces)
    ]


def bars(window: Window) -> list[tuple[float, float, float, float]]:
    """The frame of a window and a cross in it, as start, stop, bottom and top."""
    x = (window.start, (window.start + window.stop - FRAME_M) / 2, window.stop - FRAME_M)
    z = (window.sill, 0.35 * window.sill + 0.65 * window.head, window.head - FRAME_M)
    upright = [(a, a + FRAME_M, window.sill, window.head) for a in x]
    level = [(a + FRAME_M, b, low, low + FRAME_M) for a, b in pairwise(x) for low in z]
    return upright + level


def openings() -> tuple[LightPortal, ...]:
    """The windows as holes through which daylight comes, just outside the walls."""
    found = []
    for name, windows in WINDOWS.items():
        start, stop = (np.array([*corner, 0.0]) for corner in CORNERS[name])
        along = (stop - start) / np.linalg.norm(stop - start)
        inward = np.array([along[1], -along[0], 0.0])
        for window in windows:
            middle = start + along * (window.start + window.stop) / 2 - inward * 0.08
            middle = middle + np.array([0.0, 0.0, (window.sill + window.head) / 2])
            found.append(LightPortal(middle, inward, window.stop - window.start, window.head - window.sill))
    return tuple(found)


def planks(pixels_per_metre: int = 260, seed: int = 7) -> np.ndarray:
    """A floor of oak boards laid away from the viewer, 14 cm wide, each with its own tone and grain."""
    rng = np.random.default_rng(seed)
    height, width = round((FAR - NEAR) * pixels_per_metre), round((RIGHT - LEFT) * pixels_per_metre)
    board, length = round(0.14 * pixels_per_metre), round(1.5 * pixels_per_metre)
    tone, seam = np.zeros((height, width)), np.zeros((height, width))
    for left in range(0, width, board):
        at = -int(rng.integers(length))
        while at < height:
            rows = slice(max(at, 0), min(at + length, height))
            tone[rows, left : left + board] = rng.normal(0, 1)
            seam[max(rows.stop - 2, 0) : rows.stop, left : left + board] = 1
            at += length
        seam[:, left : left + 2] = 1
    grain = gaussian_filter(rng.normal(size=(height, width)), (40, 1.2))
    fine = gaussian_filter(rng.normal(size=(height, width)), (8, 0.6))
    value = 1 + 0.045 * tone + 0.03 * grain / grain.std() + 0.02 * fine / fine.std()
    value = gaussian_filter(value, 0.6) * (1 - 0.3 * gaussian_filter(seam, 0.7))
    return np.clip(np.array([190, 155, 120]) * value[..., None], 0, 255).astype(np.uint8)


def camera(size: tuple[int, int]) -> Camera:
    """Eye height, a little to the left, looking slightly down."""
    yaw, tilt = np.radians(2.5), np.radians(7.5)
    z = np.array([np.sin(yaw) * np.cos(tilt), np.cos(yaw) * np.cos(tilt), -np.sin(tilt)])
    x = np.array([np.cos(yaw), -np.sin(yaw), 0.0])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.stack([x, np.cross(z, x), z], axis=1), [0.0, 0.0, 1.5]
    return Camera(Intrinsics.from_fov(*size, np.radians(62.0)), T)


def outdoors() -> Outdoors:
    """A bright sky and a low sun to the left of the camera."""
    return Outdoors(SKY, SUN, SUN_FROM / np.linalg.norm(SUN_FROM), SUN_ANGLE_RAD, openings())


def compose(library: ShapeLibrary, size: tuple[int, int] = SIZE) -> Scene:
    """The furnished room."""
    placed: list[SceneObject] = []
    for number, item in enumerate(ITEMS):
        placed.append(standing(library, item, placed, number))
    return Scene(camera(size), room(), tuple(placed))


def visible_boxes(scene: Scene, library: ShapeLibrary) -> list[dict]:
    """Boxes around what is seen of each thing; things mostly hidden or tiny are left out, as a person would."""
    assert scene.camera is not None
    posed = [(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]
    together = MeshCaster(posed).buffers(scene.camera).instance
    boxes = []
    for index, (item, obj) in enumerate(zip(ITEMS, scene.objects, strict=True)):
        seen = together == index
        alone = MeshCaster([posed[index]]).buffers(scene.camera).silhouette
        if not item.drawn or seen.sum() < 350 or seen.sum() < 0.2 * alone.sum():
            continue
        rows, columns = np.nonzero(seen)
        box = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
        boxes.append({"bbox": [float(v) for v in box], "class": obj.label})
    return boxes


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "assets" / "example")
    parser.add_argument("--draft", action="store_true", help="a quick look at half size, without the project")
    parser.add_argument("--project-only", action="store_true", help="keep the picture, build its project again")
    options = parser.parse_args()
    if not options.project_only and missing_blender():
        parser.error(f"{missing_blender()}; or keep the picture with --project-only")
    library = built_in_library()
    try:
        if not options.project_only:
            draw(library, options.out, options.draft)
    except UnavailableError as error:
        parser.error(str(error))
    if not options.draft:
        build(library, options.out)


def build(library: ShapeLibrary, out: Path) -> None:
    """The scene that the pipeline makes of the picture, as a project without what can be made again."""
    folder = out / "project"
    shutil.rmtree(folder, ignore_errors=True)
    k = json.loads((out / "intrinsics.json").read_text())
    read = read_inputs(
        out / "photo.jpg", boxes=out / "boxes.json", intrinsics=(k["fx"], k["fy"], k["cx"], k["cy"]), name=PHOTO_NAME
    )
    project = Project.create(folder, name="Example")
    build_project(project, read.inputs, library, warnings=read.warnings)
    project.update_info(stages=[])
    (folder / "photo.jpg").unlink()
    for made_again in ("stages", "backups"):
        shutil.rmtree(folder / made_again, ignore_errors=True)


def draw(library: ShapeLibrary, out: Path, draft: bool) -> None:
    """The picture, its boxes and its camera."""
    size, samples = (DRAFT, 12) if draft else (SIZE, 24)
    scene = compose(library, size)
    assert scene.camera is not None
    k = scene.camera.intrinsics
    light = cycles_radiance(
        scene, library, outdoors(), lens=LENS, textures={"planks": planks()}, samples=samples, seed=SEED
    )
    image = photograph(light, k, WHITE, seed=SEED)
    out.mkdir(parents=True, exist_ok=True)
    Image.fromarray(image).save(out / "photo.jpg", quality=88, optimize=True)
    numbers = {"width": k.width, "height": k.height, "fx": k.fx, "fy": k.fy, "cx": k.cx, "cy": k.cy}
    (out / "intrinsics.json").write_text(json.dumps(numbers, indent=1) + "\n")
    rows = ",\n ".join(json.dumps(box) for box in visible_boxes(scene, library))
    size = json.dumps({"width": k.width, "height": k.height})
    (out / "boxes.json").write_text(f'{{"image": {size}, "boxes": [\n {rows}\n]}}\n')


if __name__ == "__main__":
    main()
