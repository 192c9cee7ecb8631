"""Many variants of one room in a folder: each in a format, a manifest of what varies, and a contact sheet."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from PIL import Image

import diorama_core as diorama
from diorama_app.projects.pictures import encode_picture
from diorama_core.appearance.surface_finish import with_finish_pictures
from diorama_core.errors import InputError
from diorama_core.export import Format
from diorama_core.io.atomic import write_atomically
from diorama_core.progress import Progress
from diorama_core.synthesis.variants import ASPECTS, Aspect, Variant, VariantMaker, lock_restless

if TYPE_CHECKING:
    from diorama_core.export.gathering import ExportOptions

PICTURE_PX = (320, 240)
COLUMNS = 10
MAX_DRAWN = 3
"""Seeds that are tried for each variant that is asked for, at most."""


def write_variants(
    room: diorama.Reconstruction,
    folder: Path,
    chosen: Format,
    *,
    count: int,
    seed: int,
    aspects: Sequence[str],
    options: ExportOptions,
    view: str,
    progress: Progress,
) -> dict[str, Any]:
    """Write so many variants, every one of which is at rest, and return the manifest, which is written last.

    Args:
        room: what varies.
        folder: for the files; it is made where it is missing.
        chosen: the format of the variants.
        count: how many.
        seed: of the first; those whose rooms do not come to rest are passed over.
        aspects: of `ASPECTS`.
        options: of the export.
        view: of the pictures, as `diorama picture` names them.
        progress: reports and cancellation.

    Raises:
        InputError: there is no such aspect, or too few seeds lead to a room at rest.
        ExportError: a file cannot be written.
    """
    if unknown := sorted(set(aspects) - set(ASPECTS)):
        raise InputError(f"--vary {unknown[0]}: choose of {', '.join(ASPECTS)}")
    scene, locked = lock_restless(room.scene, room.library)
    maker = VariantMaker(scene, room.library, cast("Sequence[Aspect]", aspects))
    folder.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    pictures = []
    for drawn in range(count * MAX_DRAWN):
        progress.report(len(rows) / count, f"variant {len(rows) + 1} of {count}")
        variant = maker.draw(seed + drawn)
        if variant is None:
            continue
        finished, finishes = with_finish_pictures(variant.scene, room.textures)
        shown = replace(room, scene=finished, textures={**room.textures, **finishes})
        path = folder / f"variant_{len(rows):03d}{chosen.suffixes[0]}"
        diorama.export(shown, path, format=chosen, options=options, progress=Progress(token=progress.token))
        pictures.append(diorama.render(shown, view=view, size=PICTURE_PX))
        rows.append(_row(path, variant))
        if len(rows) == count:
            break
    else:
        raise InputError(f"{folder}: {len(rows)} of {count} variants come to rest; vary less, such as --vary textures")
    manifest = {"seed": seed, "vary": list(aspects), "drawn": drawn + 1, "locked": list(locked), "variants": rows}
    _write_sheet(folder / "variants.jpg", pictures)
    text = json.dumps(manifest, indent=1) + "\n"
    write_atomically(folder / "variants.json", text.encode(), error=InputError)
    return manifest


def _row(path: Path, variant: Variant) -> dict[str, Any]:
    moved = round(variant.max_moved_m, 5)
    return {"file": path.name, "seed": variant.seed, "max_moved_m": moved, "changes": dict(variant.changes)}


def _write_sheet(path: Path, pictures: Sequence[np.ndarray]) -> None:
    """All pictures side by side, row by row."""
    width, height = PICTURE_PX
    columns = min(COLUMNS, len(pictures))
    sheet = Image.new("RGB", (columns * width, -(-len(pictures) // columns) * height), "white")
    for number, picture in enumerate(pictures):
        sheet.paste(Image.fromarray(picture), (number % columns * width, number // columns * height))
    write_atomically(path, encode_picture(sheet, "JPEG", quality=85), error=InputError)
