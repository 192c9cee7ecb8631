"""Contact sheets of the built-in shapes, one PNG per category, to look at.

python scripts/library_sheet.py OUT_FOLDER [category ...]
"""

from __future__ import annotations

import argparse
import io
import sys
from pathlib import Path

from PIL import Image

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.render.thumbnails import thumbnail
from diorama_core.render.views import contact_sheet


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("categories", nargs="*", default=[c.name for c in CATEGORIES])
    parser.add_argument("--size", type=int, default=240, help="pixels of one shape's picture")
    arguments = parser.parse_args()
    library = built_in_library()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for category in arguments.categories:
        shapes = library.in_category(category)
        sheet = contact_sheet(
            shapes, lambda s: Image.open(io.BytesIO(thumbnail(library, s.id, arguments.size))), arguments.size
        )
        path = arguments.out / f"{category.replace(' ', '-')}.png"
        sheet.save(path)
        sys.stdout.write(f"{path}: {len(shapes)} shapes\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
