"""Draw the pictures of the example rooms that the start page shows.

Writes `assets/start/*.jpg`: the bundled example, and each room of `diorama_core.synthesis.example_rooms`.

    python scripts/make_start_pictures.py [--out assets/start]
"""

from __future__ import annotations

import argparse
from pathlib import Path

from PIL import Image

from diorama_core.appearance.surface_finish import with_finish_pictures
from diorama_core.library.catalogue import built_in_library
from diorama_core.project.storage import Project
from diorama_core.render.picture import picture
from diorama_core.synthesis.example_rooms import EXAMPLE_ROOMS, example_room

SIZE = (960, 672)
SHOWN = (320, 224)
VIEWS = {
    "living": "look:1.06,-0.2,2.9:0.06,4.45,0.6",
    "bedroom": "orbit:30",
    "study": "orbit:30",
    "kitchen": "orbit:215",
}
"""From where each room is seen best; the example close to its furniture, which stands on half of its floor."""


def main() -> None:
    """Draw all of them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("assets/start"))
    out: Path = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    library = built_in_library()
    example = Project.open(Path("assets/example/project"))
    scenes = {"living": example.load_scene()}
    textures = {"living": example.textures(scenes["living"])}
    for room in EXAMPLE_ROOMS:
        scenes[room.kind], textures[room.kind] = with_finish_pictures(example_room(room, library), {})
    for kind, scene in scenes.items():
        drawn = picture(scene, library, view=VIEWS[kind], size=SIZE, textures=textures[kind])
        Image.fromarray(drawn).resize(SHOWN, Image.Resampling.LANCZOS).save(out / f"{kind}.jpg", quality=82)


if __name__ == "__main__":
    main()
