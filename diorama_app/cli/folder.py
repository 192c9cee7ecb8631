"""`diorama build DIR --out DIR`: many photos, unattended."""

from __future__ import annotations

import argparse
import json
import os
import sys
from typing import TYPE_CHECKING

from diorama_app.cli.arguments import print_note, progress_bar
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_app.projects.folder_build import PhotoResult
    from diorama_app.projects.options import BuildOptions

REPORT = "report.html"


def build_folder(a: argparse.Namespace, options: BuildOptions) -> None:
    """Build every photo of the folder `a.image`, and write the report.

    Raises:
        InputError: an option is for one photo, or photos failed; the reasons are on stderr and in the report.
    """
    from diorama_app.projects.folder_build import build_photos
    from diorama_app.projects.folder_report import write_report
    from diorama_app.projects.photo_folder import photos_of
    from diorama_core.workers import workers

    check_options_of_one_photo(a)
    photos, remarks = photos_of(a.image)
    for remark in remarks:
        print_note(remark)
    pool = workers(a.ray, a.workers if a.workers is not None or a.ray else max((os.cpu_count() or 1) // 2, 1))
    with progress_bar() as progress:
        results = build_photos(photos, options, a.output.absolute(), pool, progress)
    write_report(a.output.absolute() / REPORT, results, remarks)
    failed = [r for r in results if r.error]
    for result in failed:
        print(f"failed: {result.photo.name}: {result.error}", file=sys.stderr)
    if a.json:
        print(json.dumps({"report": str(a.output / REPORT), "photos": [_as_json(r) for r in results]}))
    else:
        kept = sum(r.kept for r in results)
        before = f" ({kept} were finished before)" if kept else ""
        print(f"{a.output / REPORT}: {len(results) - len(failed)} of {len(results)} photos became scenes{before}")
    if failed:
        raise InputError(f"{len(failed)} of {len(results)} photos failed; the reasons are above and in the report")


def check_options_of_one_photo(a: argparse.Namespace) -> None:
    """Raise `InputError` where an option is given that says something of one photo."""
    single = {"--depth": a.depth, "--intrinsics": a.intrinsics, "--boxes": a.boxes, "--masks": a.masks}
    if a.half_turn:
        raise InputError("--half-turn is for one photo; build upside-down photos of a folder one by one")
    if a.distortion:
        raise InputError("--distortion is for one photo; straighten the photos of a folder before")
    named = next((name for name, value in single.items() if value is not None), None)
    if named is not None:
        kind = named.removeprefix("--").replace("intrinsics", "camera")
        raise InputError(f"{named} is for one photo; of a folder, put a file NAME.{kind}... beside each photo NAME")
    if a.fov is not None:
        raise InputError("--fov is for one photo; of a folder, put a file NAME.camera.json beside each photo NAME")
    if a.camera_height is not None:
        raise InputError("--camera-height is for one photo; set the scale of others in the editor")
    if a.arrangements != 1:
        raise InputError("--arrangements is for one photo; leave it out for a folder")


def _as_json(result: PhotoResult) -> dict[str, object]:
    return {
        "photo": str(result.photo),
        "project": str(result.project),
        "state": "failed" if result.error else "kept" if result.kept else "built",
        "error": result.error or None,
        "seconds": round(result.seconds, 2),
        "tries": result.tries,
        "result": result.report,
    }
