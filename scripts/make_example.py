"""Compose the bundled example: a furnished room of built-in shapes, photographed from eye height.

Writes `assets/example/photo.jpg`, `boxes.json` (what a person would draw, from what is truly visible) and
`intrinsics.json`. The same picture every time.

    python scripts/make_example.py [--out assets/example] [--draft]
"""

from __future__ import annotations

import argparse
import json
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.inputs import read_inputs
from diorama_core.project.build import build_project
from diorama_core.project.storage import Project
from diorama_core.render.lighting import Effort, Lighting
from diorama_core.render.picture import looking_along, picture
from diorama_core.render.raycast import MeshCaster, OrthographicView, render_buffers
from diorama_core.scene.types import Architecture, Camera, Intrinsics, Plane, Pose, Scene, SceneObject, yaw_rotation

SIZE = (1280, 960)
LEFT, RIGHT, NEAR, FAR, HEIGHT = -2.9, 2.9, -1.6, 5.55, 2.55
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
    Item("sofa", "sofa-blue-two", 1.3, 5.07),
    Item("pillow", "pillow-rust", 0.86, 5.1, -80.0, lean_deg=14.0),
    Item("pillow", "pillow-striped", 1.76, 5.1, -98.0, lean_deg=14.0),
    Item("coffee table", "coffee-table-walnut-oval", 0.98, 3.4),
    Item("plant", "plant-flowering", 1.26, 3.43),
    Item("books", "books-stack-large", 0.74, 3.38, -65.0),
    Item("mug", "cup-mug-white", 0.99, 3.24, 40.0),
    Item("armchair", "armchair-lounge-oak", 2.2, 4.0, 165.0),
    Item("side table", "side-table-tripod-oak", 2.52, 5.2),
    Item("lamp", "lamp-urn-blue", 2.52, 5.2),
    Item("floor lamp", "floor-lamp-tripod-oak", 0.25, 5.2),
    Item("picture", "picture-seascape-gilt", 1.3, FAR - 0.02, base_m=1.3),
    Item("picture", "picture-botanic", 2.3, FAR - 0.015, base_m=1.38),
    Item("clock", "clock-round-oak", -1.0, FAR - 0.025, base_m=1.7),
    Item("bookshelf", "bookshelf-oak-four", -0.45, 5.38),
    Item("books", "books-row", -0.62, 5.4, base_m=1.23, drawn=False),
    Item("vase", "vase-moon-stone", -0.18, 5.38, base_m=1.23, drawn=False),
    Item("books", "books-row-long", -0.45, 5.4, base_m=0.856, drawn=False),
    Item("books", "books-stack-small", -0.7, 5.38, -70.0, base_m=0.476, drawn=False),
    Item("books", "books-row", -0.32, 5.4, base_m=0.476, drawn=False),
    Item("basket", "basket-shelf", -0.63, 5.38, base_m=0.1, drawn=False),
    Item("basket", "basket-shelf", -0.24, 5.38, base_m=0.1, drawn=False),
    Item("plant", "plant-aloe", -0.45, 5.38),
    Item("mirror", "mirror-round-brass", -1.75, FAR - 0.02, base_m=0.85),
    Item("plant", "plant-fiddle", -2.42, 4.85),
    Item("dining table", "table-round-oak", -1.12, 3.5),
    Item("vase", "vase-moon-stone", -1.22, 3.58),
    Item("bowl", "bowl-wood", -0.88, 3.38),
    Item("chair", "chair-windsor-oak", -0.42, 3.6, 186.0),
    Item("chair", "chair-windsor-oak", -1.0, 4.22, -95.0),
    Item("chair", "chair-windsor-oak", -1.76, 3.74, -22.0),
    Item("ceiling lamp", "ceiling-lamp-wicker-bell", -1.12, 3.5, base_m=HANGING),
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


def room() -> Architecture:
    """Warm white walls, one of them sage, and an oak floor."""
    floor = np.array([[LEFT, NEAR, 0], [RIGHT, NEAR, 0], [RIGHT, FAR, 0], [LEFT, FAR, 0]])
    white, sage = (0.93, 0.915, 0.885), (0.70, 0.735, 0.68)

    def wall(name: str, a: tuple[float, float], b: tuple[float, float], colour: tuple[float, float, float]) -> Plane:
        polygon = np.array([[*a, 0], [*b, 0], [*b, HEIGHT], [*a, HEIGHT]])
        return Plane(name, "wall", polygon, colour=colour)

    return Architecture(
        (
            Plane("floor", "floor", floor, texture="planks"),
            Plane("ceiling", "ceiling", floor[::-1] + np.array([0, 0, HEIGHT]), colour=(0.96, 0.955, 0.945)),
            wall("back", (LEFT, FAR), (RIGHT, FAR), sage),
            wall("left", (LEFT, NEAR), (LEFT, FAR), white),
            wall("right", (RIGHT, FAR), (RIGHT, NEAR), white),
            wall("behind", (RIGHT, NEAR), (LEFT, NEAR), white),
        )
    )


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


def camera() -> Camera:
    """Eye height, a little to the left, looking slightly down."""
    yaw, tilt = np.radians(2.5), np.radians(7.5)
    z = np.array([np.sin(yaw) * np.cos(tilt), np.cos(yaw) * np.cos(tilt), -np.sin(tilt)])
    x = np.array([np.cos(yaw), -np.sin(yaw), 0.0])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.stack([x, np.cross(z, x), z], axis=1), [0.0, 0.0, 1.5]
    return Camera(Intrinsics.from_fov(*SIZE, np.radians(62.0)), T)


def daylight() -> Lighting:
    """Low sun through the windows of the left wall, and light from the room's own white walls."""
    return Lighting(
        window_centre=np.array([LEFT - 0.6, 2.05, 2.0]),
        window_edges=np.array([[0.0, 0.95, 0.0], [0.0, 0.0, 0.6]]),
        window_irradiance=np.array([1.5, 1.34, 1.08]) * 1.15,
        reference_m=3.6,
        sky=np.array([0.56, 0.57, 0.585]),
        ground=np.array([0.47, 0.435, 0.395]),
        reach_m=1.6,
    )


def compose(library: ShapeLibrary) -> Scene:
    """The furnished room."""
    placed: list[SceneObject] = []
    for number, item in enumerate(ITEMS):
        placed.append(standing(library, item, placed, number))
    return Scene(camera(), room(), tuple(placed))


def visible_boxes(scene: Scene, library: ShapeLibrary) -> list[dict]:
    """Boxes around what is seen of each thing; things mostly hidden or tiny are left out, as a person would."""
    assert scene.camera is not None
    posed = [(library.mesh(o.shape_id), o.pose.matrix) for o in scene.objects]
    together = render_buffers(posed, scene.camera).instance
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
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "assets" / "example")
    parser.add_argument("--draft", action="store_true", help="a quick look at half size")
    parser.add_argument("--project-only", action="store_true", help="keep the picture, build its project again")
    options = parser.parse_args()
    library = built_in_library()
    if not options.project_only:
        draw(library, options.out, options.draft)
    build(library, options.out)


def build(library: ShapeLibrary, out: Path) -> None:
    """The scene that the pipeline makes of the picture, as a project without what can be made again."""
    folder = out / "project"
    shutil.rmtree(folder, ignore_errors=True)
    k = json.loads((out / "intrinsics.json").read_text())
    read = read_inputs(
        out / "photo.jpg", boxes=out / "boxes.json", intrinsics=(k["fx"], k["fy"], k["cx"], k["cy"]), name="photo.jpg"
    )
    project = Project.create(folder, name="Example")
    build_project(project, read.inputs, library, warnings=read.warnings)
    project.update_info(stages=[])
    (folder / "photo.jpg").unlink()
    for made_again in ("stages", "backups"):
        shutil.rmtree(folder / made_again, ignore_errors=True)


def draw(library: ShapeLibrary, out: Path, draft: bool) -> None:
    """The picture, its boxes and its camera."""
    scene = compose(library)
    size, effort = ((640, 480), Effort(2, 4)) if draft else (SIZE, Effort(8, 20))
    look = {"textures": {"planks": planks()}, "photographed": False, "light": daylight()}
    image = picture(scene, library, size=size, effort=effort, **look)
    out.mkdir(parents=True, exist_ok=True)
    Image.fromarray(image).save(out / "photo.jpg", quality=90, optimize=True, subsampling=0)
    k = camera().intrinsics
    numbers = {"width": k.width, "height": k.height, "fx": k.fx, "fy": k.fy, "cx": k.cx, "cy": k.cy}
    (out / "intrinsics.json").write_text(json.dumps(numbers, indent=1) + "\n")
    rows = ",\n ".join(json.dumps(box) for box in visible_boxes(scene, library))
    (out / "boxes.json").write_text(f"[{rows}]\n")


if __name__ == "__main__":
    main()
