"""Writes the tables of docs/what-goes-in.md that are made from the readers' own tables.

python scripts/what_goes_in.py [--check]
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from diorama_core.perception.inputs.source import Form

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

PAGE = ROOT / "docs" / "what-goes-in.md"
EXTRA = "needs `diorama[{}]`"


def tables() -> dict[str, str]:
    """The generated parts of the page, by name."""
    from diorama_core.importing.forms import SCENE_FORMS
    from diorama_core.io.file_heads import OTHER_FILES
    from diorama_core.library.ingest.models import MODEL_FORMS
    from diorama_core.perception.inputs.boxes.reading import BOX_FORMS
    from diorama_core.perception.inputs.depth.containers import DEPTH_FORMS
    from diorama_core.perception.inputs.depth.scale import USUAL_UNITS
    from diorama_core.perception.inputs.masks.reading import MASK_FORMS
    from diorama_core.perception.inputs.photos.reading import PHOTO_FORMS

    models = [f"| {f.name} | {', '.join(f.suffixes)} | {f.note} |" for f in MODEL_FORMS]
    scenes = [
        f"| {f.name} | {f.files} | {f.becomes}{'; ' + EXTRA.format(f.extra) if f.extra else ''} |" for f in SCENE_FORMS
    ]
    others = [f"| {f.name} | {f.advice} |" for f in OTHER_FILES]
    given: dict[str, Sequence[Form[Any, Any]]] = {
        "photos": PHOTO_FORMS, "boxes": BOX_FORMS, "masks": MASK_FORMS, "depth": DEPTH_FORMS
    }  # fmt: skip
    rows = {name: [f"| {f.name} | {f.written_by} | {f.understood} |" for f in forms] for name, forms in given.items()}
    return {
        **{k: "\n".join(["| form | written by | what is read |", "|---|---|---|", *v]) for k, v in rows.items()},
        "units": ", ".join(f"{scale:g} ({words})" for scale, words in USUAL_UNITS.items()) + ".",
        "models": "\n".join(["| format | endings | |", "|---|---|---|", *models]),
        "scenes": "\n".join(["| what | comes as | becomes |", "|---|---|---|", *scenes]),
        "others": "\n".join(["| what | what to do |", "|---|---|", *others]),
    }


def filled(page: str) -> str:
    """The page with its generated parts made anew; everything else stays."""
    for name, table in tables().items():
        marks = re.compile(rf"(<!-- made: {name} -->\n).*?(<!-- end: {name} -->)", re.DOTALL)
        page = marks.sub(partial(_between, table), page)
    return page


def _between(table: str, found: re.Match[str]) -> str:
    """A table between its marks."""
    return f"{found[1]}{table}\n{found[2]}"


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--check", action="store_true", help="only say whether the page is up to date")
    options = parser.parse_args()
    page = PAGE.read_text()
    made = filled(page)
    if options.check:
        return int(made != page)
    PAGE.write_text(made)
    return 0


if __name__ == "__main__":
    sys.exit(main())
