"""`diorama build`: a scene from a photo, or many from a folder of photos."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from diorama_app.cli.arguments import (
    PROFILES,
    RECIPES,
    coefficients,
    command,
    field_of_view,
    intrinsics,
    positive,
    print_note,
    progress_bar,
)
from diorama_app.projects.options import POSES, ROOMS, SYSTEMS, BuildOptions, PhotoFiles, build_files
from diorama_core.errors import InputError, SphericalPhotoError


def add_build(commands: Any) -> None:
    """Declare `diorama build`."""
    p = command(commands, "build", _build, "diorama build room.jpg --boxes boxes.json -o my-room")
    p.add_argument("image", type=Path, metavar="IMAGE|DIR", help="the photo, or a folder of photos with their files")
    p.add_argument(
        "-o",
        "--output",
        "--out",
        type=Path,
        required=True,
        metavar="PROJECT|DIR",
        help="project folder to write; of a folder of photos, the folder of their projects and of report.html",
    )
    p.add_argument("--workers", type=int, metavar="N", help="photos built at once (default: half the cores)")
    p.add_argument("--ray", metavar="ADDRESS", help="build a folder on a Ray cluster: auto, HOST:PORT, or local")
    p.add_argument(
        "--poses",
        type=Path,
        metavar="PATH|find",
        help="cameras of a folder's photos, which then become one room: COLMAP model, transforms.json, ARKit frames; "
        "'find' finds them by what the photos have in common",
    )
    _add_inputs(p)
    _add_networks(p)
    _add_methods(p)
    p.add_argument("--seed", type=int, default=0, help="seed of random stages (the built-in ones use none)")
    p.add_argument(
        "--explain", type=Path, metavar="FILE", help="file for the reasons of each place, kind and size, as JSON"
    )
    p.add_argument("--json", action="store_true", help="print the result as JSON")


def _add_inputs(p: argparse.ArgumentParser) -> None:
    """Declare what may be given with the photo."""
    p.add_argument("--depth", type=Path, metavar="FILE", help="measured depth: 16-bit PNG, .npy, .npz, EXR or a dump")
    p.add_argument(
        "--depth-scale",
        type=positive,
        metavar="N",
        help="depth units a metre (default: 1000 of whole numbers and 1 of others, unless the picture contradicts it)",
    )
    p.add_argument(
        "--depth-kind",
        choices=("auto", "depth", "distance", "inverse", "root", "logarithm", "shifted"),
        default="auto",
        help="along the optical axis or the rays, inverse, root, logarithm, less a constant (default: by its looks)",
    )
    p.add_argument("--depth-encoding", choices=("linear", "sunrgbd"), default="linear", help="how a PNG stores depth")
    inner = p.add_mutually_exclusive_group()
    inner.add_argument("--intrinsics", type=intrinsics, metavar="fx,fy,cx,cy", help="camera intrinsics in pixels")
    inner.add_argument("--fov", type=field_of_view, metavar="DEG", help="horizontal field of view in degrees")
    p.add_argument(
        "--camera-height",
        type=positive,
        metavar="M",
        help="height of the camera above the floor in metres: tells the scale",
    )
    p.add_argument(
        "--distortion",
        type=coefficients,
        default=(),
        metavar="k1,k2,p1,p2,k3",
        help="of the lens, as OpenCV has it, k1 alone at least: the photo is straightened before it is used; "
        "0 leaves it as it is (default: what its lines say)",
    )
    p.add_argument(
        "--half-turn", action="store_true", help="the photo and its files are upside down: turn them by 180 degrees"
    )
    p.add_argument(
        "--flat", action="store_true", help="the photo shows one direction, although it looks like a panorama"
    )
    p.add_argument(
        "--boxes",
        type=Path,
        metavar="FILE",
        help='JSON list of {"bbox": [x1, y1, x2, y2], "class": "chair"}, or COCO, VOC, YOLO, LabelMe, CVAT...',
    )
    p.add_argument(
        "--masks", type=Path, metavar="PATH", help="PNG with one colour or id per object, or a folder of masks"
    )


def _add_networks(p: argparse.ArgumentParser) -> None:
    p.add_argument("--profile", choices=PROFILES, default="auto", help="which networks to use (default: %(default)s)")
    p.add_argument(
        "--detector",
        metavar="ID|FILE",
        help="network that finds objects, or your own: an ONNX file of YOLO or DETR, its labels in a .txt beside it "
        "(default: the best on this machine)",
    )
    p.add_argument(
        "--depth-network",
        metavar="ID|FILE",
        help="network that reads depth, or your own: an ONNX file from RGB between 0 and 1 to metres "
        "(default: the best on this machine)",
    )


def _add_methods(p: argparse.ArgumentParser) -> None:
    """Declare shapes and layout, and the methods of the paper and of others to compare with."""
    p.add_argument(
        "--arrangements",
        type=int,
        default=1,
        metavar="N",
        help="number of scenes to write, each with other candidate shapes",
    )
    p.add_argument(
        "--library",
        default="built-in",
        metavar="NAME",
        help="shape library, or several joined by + (default: %(default)s)",
    )
    p.add_argument("--recipe", choices=RECIPES, default=RECIPES[0], help="layout optimiser (default: %(default)s)")
    p.add_argument(
        "--room",
        choices=ROOMS,
        default=ROOMS[0],
        help="how planes are found in depth, to compare with: the paper's PlainRecon or the baselines RaC and ACDC "
        "(default: %(default)s)",
    )
    p.add_argument(
        "--pose",
        choices=POSES,
        help="how shapes are posed, to compare with: the paper's correspondences or a baseline, with the embedded "
        "features (default: the profile's)",
    )
    p.add_argument(
        "--system",
        choices=SYSTEMS,
        default=SYSTEMS[0],
        help="acdc: room, retrieval, poses and layout as ACDC has them, to compare with (default: %(default)s)",
    )


def _build(a: argparse.Namespace) -> None:
    """Build a scene from a photo."""

    from diorama_app.cli.many_photos import build_folder

    options = BuildOptions(
        depth_scale=a.depth_scale,
        depth_encoding=a.depth_encoding,
        depth_kind=a.depth_kind,
        profile=a.profile,
        detector=a.detector,
        depth_network=a.depth_network,
        recipe=a.recipe,
        library=a.library,
        room=a.room,
        pose=a.pose,
        system=a.system,
    )
    if a.explain is not None and (a.poses is not None or a.image.is_dir()):
        raise InputError("--explain is for one photo; each project of a folder of photos has its reasons.json")
    if a.poses is not None:
        from diorama_app.cli.many_photos import build_posed

        build_posed(a, options)
    elif a.image.is_dir():
        build_folder(a, options)
    elif a.workers is not None or a.ray is not None:
        raise InputError("--workers and --ray are for a folder of photos; leave them out for one photo")
    else:
        _build_photo(a, options)


def _build_photo(a: argparse.Namespace, options: BuildOptions) -> None:
    from diorama_app.projects.report import build_report, write_arrangements
    from diorama_core.project.reasons import write_reasons

    if a.arrangements < 1:
        raise InputError(f"--arrangements {a.arrangements}: ask for at least one")
    files = PhotoFiles(
        a.image, a.boxes, a.masks, a.depth, a.intrinsics, a.fov, a.distortion, a.half_turn, a.camera_height, a.flat
    )
    try:
        with progress_bar() as progress:
            room = build_files(files, options, a.output, progress, print_note)
            scenes = write_arrangements(room, a.arrangements, progress)
    except SphericalPhotoError:
        from diorama_app.cli.many_photos import build_sphere

        build_sphere(a, files, options)
        return
    if a.explain is not None and room.built is not None:
        write_reasons(a.explain, room.built.reasons, InputError)
    report = build_report(room, scenes)
    if a.json:
        print(json.dumps(report))
    else:
        print(f"{a.output}: {report['summary']}")
        if "left_out" in report:
            print(_proposals_note(a.output, len(room.scene.objects), report["left_out"], _has_detector()))
        if not room.scene.objects:
            print(_invitation(a.output, detected=room.stages is not None and room.stages.detection is not None))


def _proposals_note(project: Path, used: int, left_out: int, detector: bool) -> str:
    """Note on a scene whose boxes nobody drew or checked.

    Args:
        project: its folder.
        used: objects in the scene.
        left_out: likely objects that were not used.
        detector: whether a network that finds any furniture is here already.
    """
    more = "" if detector else ", or find more with 'diorama models pull tiny'"
    return (
        f"No boxes were given: {used} of {used + left_out} likely objects were used. "
        f"Open it with 'diorama serve {project}' and correct the boxes{more}."
    )


def _has_detector() -> bool:
    from diorama_core.models.manifest import NETWORKS
    from diorama_core.models.store import ModelStore

    store = ModelStore.default()
    return any(store.has(n) for n in NETWORKS if n.role == "detection")


def _invitation(project: Path, *, detected: bool) -> str:
    """What to do where a scene is empty."""
    drawing = f"open it with 'diorama serve {project}' and draw boxes around the furniture"
    if detected:
        return f"No furniture was found: {drawing}."
    return f"No boxes were given: get the small detector with 'diorama models pull yolox-nano', or {drawing}."
