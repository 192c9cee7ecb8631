"""Make the pictures of the README, and those of the example rooms that the start page shows.

Writes `editor.jpg` (the editor with the example in it: a screenshot in Chromium, which the browser tests need, too) and
`photo-to-scene.jpg` (the example's picture, the scene through its camera, the scene from outside) into `--out`, and
`assets/start/*.jpg`: the example, and each room of `diorama_core.synthesis.example_rooms`. Run it after
`scripts/make_example.py`.

    python scripts/make_doc_pictures.py [--out docs/images] [--only editor,scene,start]
"""

from __future__ import annotations

import argparse
import io
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from PIL import Image

from diorama_app.projects.example import EXAMPLE
from diorama_app.serve import start
from diorama_core.appearance.surface_finish import with_finish_pictures
from diorama_core.library.catalogue import built_in_library
from diorama_core.project.storage import Project
from diorama_core.render.picture import picture
from diorama_core.synthesis.example_rooms import EXAMPLE_ROOMS, example_room
from tests.e2e.browser import FLAGS, EditorPage, chromium

PAGE = (1280, 720)
TILE = (640, 480)
GAP = 6
QUALITY = 88
SELECTED = "armchair"
START = Path("assets/start")
START_SIZE, START_SHOWN, START_QUALITY = (960, 672), (320, 224), 82
START_VIEWS = {
    "living": "look:1.06,-0.2,2.9:0.06,4.45,0.6",
    "bedroom": "orbit:30",
    "study": "orbit:30",
    "kitchen": "orbit:215",
}
"""From where each room is seen best; the example close to its furniture, which stands on half of its floor."""


def editor(out: Path) -> None:
    """A screenshot of the page with the example and an object selected."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        projects = Path(folder) / "projects"
        running = start(projects_dir=projects)
        browser = driver.chromium.launch(executable_path=chromium(), headless=True, args=list(FLAGS))
        try:
            context = browser.new_context(viewport={"width": PAGE[0], "height": PAGE[1]}, device_scale_factor=1)
            page = EditorPage.open(context, running, 120_000, query="?fixedDpr=1")
            page.page.wait_for_timeout(2000)
            page.row(SELECTED).click()
            page.until(lambda: len(page.selection) == 1, "selected")
            page.page.mouse.move(PAGE[0] / 2, PAGE[1] - 4)
            page.page.wait_for_timeout(8000)  # shadows, badges and thumbnails are there
            page.settle()
            shot = page.page.screenshot()
        finally:
            browser.close()
            running.stop()
    Image.open(io.BytesIO(shot)).convert("RGB").save(out / "editor.jpg", quality=QUALITY, optimize=True)


def scene(out: Path) -> None:
    """The example's picture, and its scene through the same camera and from outside."""
    library = built_in_library()
    project = Project.open(EXAMPLE / "project")
    made = project.load_scene()
    textures = project.textures(made)
    drawn = [picture(made, library, view=view, size=TILE, textures=textures) for view in ("photo", "orbit:30")]
    given = Image.open(EXAMPLE / "photo.jpg").convert("RGB").resize(TILE, Image.Resampling.LANCZOS)
    strip = np.full((TILE[1], 3 * TILE[0] + 2 * GAP, 3), 255, np.uint8)
    for number, tile in enumerate((np.asarray(given), *drawn)):
        left = number * (TILE[0] + GAP)
        strip[:, left : left + TILE[0]] = tile
    Image.fromarray(strip).save(out / "photo-to-scene.jpg", quality=QUALITY, optimize=True)


def start_page(_: Path) -> None:
    """The rooms that the start page shows."""
    START.mkdir(parents=True, exist_ok=True)
    library = built_in_library()
    example = Project.open(EXAMPLE / "project")
    made = example.load_scene()
    rooms = {"living": (made, example.textures(made))}
    rooms |= {room.kind: with_finish_pictures(example_room(room, library), {}) for room in EXAMPLE_ROOMS}
    for kind, (room, textures) in rooms.items():
        drawn = Image.fromarray(picture(room, library, view=START_VIEWS[kind], size=START_SIZE, textures=textures))
        small = drawn.resize(START_SHOWN, Image.Resampling.LANCZOS)
        small.save(START / f"{kind}.jpg", quality=START_QUALITY)


PICTURES = {"editor": editor, "scene": scene, "start": start_page}


def main() -> None:
    """Make all of them, or those that were named."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))
    parser.add_argument("--only", default=",".join(PICTURES))
    options = parser.parse_args()
    unknown = set(options.only.split(",")) - set(PICTURES)
    if unknown:
        parser.error(f"--only knows {', '.join(PICTURES)}, not {', '.join(sorted(unknown))}")
    options.out.mkdir(parents=True, exist_ok=True)
    for name in options.only.split(","):
        PICTURES[name](options.out)


if __name__ == "__main__":
    main()
