"""`diorama build` of many photos: of a folder, unattended, each a room of its own (`--out DIR`), or of one room, with
known cameras or without (`--poses`), and of one 360 degree photo.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from typing import TYPE_CHECKING

from diorama_app.cli.arguments import print_note, progress_bar
from diorama_core.errors import Cancelled, DioramaError, InputError
from diorama_core.io.text import number_of

if TYPE_CHECKING:
    from pathlib import Path

    from diorama_app.projects.folder_build import PhotoResult
    from diorama_app.projects.options import BuildOptions, PhotoFiles
    from diorama_app.projects.posed_build import PosedBuild

REPORT = "report.html"


def build_folder(a: argparse.Namespace, options: BuildOptions) -> None:
    """Build every photo of the folder `a.image`, and write the report; of a folder of homes, home by home.

    Raises:
        InputError: an option is for one photo, or photos or homes failed; the reasons are on stderr and in the report.
    """
    from diorama_app.projects.folder_home import homes_of

    check_options_of_one_photo(a)
    homes, failed = homes_of(a.image), []
    for home in homes:
        try:
            _build_photos_of(home, a.output if home == a.image else a.output / home.name, a, options)
        except DioramaError as error:
            if home == a.image or isinstance(error, Cancelled):
                raise
            print(f"failed: {home.name}: {error}", file=sys.stderr)
            failed.append(home.name)
    if failed:
        raise InputError(f"{len(failed)} of {len(homes)} homes failed: {', '.join(failed)}")


def _build_photos_of(folder: Path, output: Path, a: argparse.Namespace, options: BuildOptions) -> None:
    from diorama_app.projects.folder_build import build_photos
    from diorama_app.projects.folder_home import FOLDER, join_rooms, read_doors
    from diorama_app.projects.folder_photos import photos_of
    from diorama_app.projects.folder_report import write_report
    from diorama_core.workers import workers

    doors = read_doors(folder)
    photos, remarks = photos_of(folder)
    for remark in remarks:
        print_note(remark)
    pool = workers(a.ray, a.workers if a.workers is not None or a.ray else max((os.cpu_count() or 1) // 2, 1))
    with progress_bar() as progress:
        results = build_photos(photos, options, output.absolute(), pool, progress)
    write_report(output.absolute() / REPORT, results, remarks)
    failed = [r for r in results if r.error]
    for result in failed:
        print(f"failed: {result.photo.name}: {result.error}", file=sys.stderr)
    if a.json:
        print(json.dumps({"report": str(output / REPORT), "photos": [_as_json(r) for r in results]}))
    else:
        kept = sum(r.kept for r in results)
        before = f" ({kept} were finished before)" if kept else ""
        print(f"{output / REPORT}: {len(results) - len(failed)} of {len(results)} photos became scenes{before}")
    if failed:
        raise InputError(f"{len(failed)} of {len(results)} photos failed; the reasons are above and in the report")
    if doors:
        home = join_rooms({r.project.name: r.project for r in results}, doors, output.absolute() / FOLDER)
        if not a.json:
            print(f"{output / FOLDER}: a home of {number_of(len(home.load_scene().rooms), 'room')}")


def check_options_of_one_photo(a: argparse.Namespace) -> None:
    """Raise `InputError` where an option is given that says something of one photo."""
    beside = "of a folder, put a file NAME.{}... beside each photo NAME"
    options = {
        "--half-turn": (a.half_turn, "build upside-down photos of a folder one by one"),
        "--flat": (a.flat, "build photos of a folder that look like panoramas one by one"),
        "--distortion": (a.distortion, "straighten the photos of a folder before"),
        "--depth": (a.depth, beside.format("depth")),
        "--intrinsics": (a.intrinsics, beside.format("camera")),
        "--boxes": (a.boxes, beside.format("boxes")),
        "--masks": (a.masks, beside.format("masks")),
        "--fov": (a.fov, "of a folder, put a file NAME.camera.json beside each photo NAME"),
        "--camera-height": (a.camera_height, "set the scale of others in the editor"),
        "--arrangements": (a.arrangements != 1, "leave it out for a folder"),
    }
    for option, (given, advice) in options.items():
        if given:
            raise InputError(f"{option} is for one photo; {advice}")


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


FIND = "find"
"""Instead of a path: the photos themselves tell where they were taken."""


def build_posed(a: argparse.Namespace, options: BuildOptions) -> None:
    """Build one project of the photos in the folder `a.image`.

    Raises:
        InputError: no folder is named, or a photo or the poses cannot be used.
        UnavailableError: cameras are to be found and pycolmap is not installed.
    """
    from diorama_app.projects.folder_photos import photos_of
    from diorama_app.projects.posed_build import build_posed_photos, poses_from_photos
    from diorama_core.multiview.posed_photos import read_poses

    if not a.image.is_dir():
        raise InputError(f"--poses is for a folder of photos of one room; {a.image} is none")
    if a.workers is not None or a.ray is not None:
        raise InputError("--workers and --ray build photos one by one; leave them out with --poses")
    check_options_of_one_photo(a)
    photos, remarks = photos_of(a.image)
    for remark in remarks:
        print_note(remark)
    with progress_bar() as progress:
        find = str(a.poses) == FIND
        poses = (
            poses_from_photos(photos, progress.part(0.0, 0.1))
            if find
            else read_poses(a.poses, [p.photo for p in photos])
        )
        built = build_posed_photos(photos, poses, options, a.output, progress.part(0.1 if find else 0.0, 1.0))
    _print(a, built)


def build_sphere(a: argparse.Namespace, files: PhotoFiles, options: BuildOptions) -> None:
    """Build one project of the 360 degree photo `a.image`.

    Raises:
        InputError: the photo or something given with it cannot be used.
    """
    from diorama_app.projects.posed_build import build_sphere_photo

    if a.arrangements != 1 or a.explain is not None:
        raise InputError(f"{a.image.name} is a 360 degree photo; --arrangements and --explain are for other photos")
    with progress_bar() as progress:
        built = build_sphere_photo(files, options, a.output, progress)
    _print(a, built)


def _print(a: argparse.Namespace, built: PosedBuild) -> None:
    """Print what was built."""
    scene = built.room.scene
    several = sum(len(track.boxes) > 1 for track in built.room.tracks)
    if a.json:
        objects = [
            {"id": o.id, "category": o.category, "shape": o.shape_id, "size_m": [round(float(v), 4) for v in o.size_m]}
            for o in scene.objects
        ]
        summary = {"project": str(a.output), "photos": list(built.photos), "objects": objects, "in_several": several}
        print(json.dumps({**summary, "notes": list(built.notes)}))
        return
    for note in built.notes:
        print_note(note)
    print(
        f"{a.output}: {number_of(len(scene.objects))} of {number_of(len(built.photos), 'photo')}, "
        f"{several} in more than one"
    )
