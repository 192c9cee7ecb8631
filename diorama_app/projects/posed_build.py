"""Several photos of one room, or one 360 degree photo, become one project."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import diorama_core as diorama
from diorama_app.projects.folder_photos import FolderPhoto
from diorama_app.projects.options import BuildOptions, PhotoFiles
from diorama_app.projects.pictures import encode_picture
from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import InputError, ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.layout.recipes import recipe
from diorama_core.multiview.camera_changes import quarters_of, upright_camera
from diorama_core.multiview.found_poses import UnposedPhoto, find_poses
from diorama_core.multiview.lens import undistort
from diorama_core.multiview.posed_photos import PosedPhoto, Poses
from diorama_core.multiview.rooms import JoinedRoom, PosedInputs, align_to_room, build_room
from diorama_core.multiview.sphere_scene import build_sphere
from diorama_core.perception.inputs import read_inputs
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import Progress
from diorama_core.project.further_photos import MAX_PHOTOS, note_placed, save_photos
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import Project
from diorama_core.scene.types import Camera

MAX_ASPECT_OFF = 0.02
"""Difference of a photo's aspect ratio from its camera's: more is another picture, or one that was cut or turned."""


_Row = tuple[str, Callable[[], bytes], PosedInputs]
"""A photo's name, what reads its file, and the photo with its camera."""


@dataclass(frozen=True, eq=False)
class PosedBuild:
    """What was built."""

    room: JoinedRoom
    project: Project
    photos: tuple[str, ...]
    """Names of the photos that were used, the main one first."""
    notes: tuple[str, ...]


def poses_from_photos(photos: Sequence[FolderPhoto], progress: Progress) -> Poses:
    """Cameras that the photos themselves tell, by what they have in common.

    Raises:
        UnavailableError: pycolmap is not installed.
        InputError: fewer than two photos join, or one cannot be used.
        Cancelled: on request.
    """
    unposed = []
    for number, photo in enumerate(photos):
        progress.report(0.1 * number / len(photos), f"Reading {photo.photo.name}")
        files = photo.files()
        given = read_inputs(files.photo, intrinsics=files.intrinsics, fov_deg=files.fov_deg).inputs
        focal_px = given.photo.exif_focal_px if given.intrinsics is None else given.intrinsics.fx
        unposed.append(UnposedPhoto(photo.photo.name, given.photo.rgb, focal_px))
    return find_poses(unposed, progress.part(0.1, 1.0))


def build_posed_photos(
    photos: Sequence[FolderPhoto], poses: Poses, options: BuildOptions, output: Path, progress: Progress
) -> PosedBuild:
    """One project of all photos whose cameras are known; the photo with most boxes is the one it opens with.

    Args:
        photos: with their files.
        poses: their cameras.
        options: of the build.
        output: folder that is written.
        progress: reports and cancellation.

    Raises:
        InputError: no photo has a camera, or a photo cannot be used.
        ProjectError: `output` cannot be written, or holds something else.
        LibraryError: there is no such library.
        Cancelled: on request.
    """
    library = diorama.open_library(options.library)
    pairs, notes = _pair(photos, poses)
    read: list[_Row] = []
    for photo, posed in pairs:
        inputs, warnings = _inputs(photo)
        notes += [f"{photo.photo.name}: {line}" for line in warnings]
        read.append((photo.photo.name, photo.photo.read_bytes, _pose(photo, inputs, posed, stored=poses.stored_pixels)))
    read.sort(key=lambda row: (-len(row[2].inputs.boxes), row[0]))

    def choose(inputs: Inputs) -> Stages:
        return stages_for(options.profile, inputs, library, recipe=options.recipe)

    project = Project.create(output)
    with ProjectLock(project.folder, "diorama build"):
        placed, _ = align_to_room(
            [row[2] for row in read], choose, metric=poses.metric, up=poses.up, progress=progress.part(0.0, 0.15)
        )
        layout = recipe(options.recipe, library, depth_measured=True)
        room = build_room(placed, library, choose, layout, progress.part(0.15, 1.0))
        scale = () if poses.metric else ("scale of the cameras: from the usual sizes of the named objects",)
        all_notes = (*poses.notes, *notes, *scale, *room.notes)
        further = [
            FurtherPhoto(Path(name).stem, posed.inputs, posed.camera, seen)
            for (name, _, _), posed, seen in zip(read[1:], placed[1:], room.seen[1:], strict=True)
        ]
        _save(project, room, read, placed, further, options.library, all_notes)
    return PosedBuild(room, project, tuple(row[0] for row in read), all_notes)


def build_sphere_photo(files: PhotoFiles, options: BuildOptions, output: Path, progress: Progress) -> PosedBuild:
    """One project of a 360 degree photo; its views are the project's photos.

    Args:
        files: the photo, with boxes in its pixels and the camera's height where they are given.
        options: of the build.
        output: folder that is written.
        progress: reports and cancellation.

    Raises:
        InputError: the photo cannot be used, or something is given that is not used with it.
        ProjectError: `output` cannot be written, or holds something else.
        LibraryError: there is no such library.
        Cancelled: on request.
    """
    unused = {
        "--depth": files.depth, "--masks": files.masks, "--intrinsics": files.intrinsics, "--fov": files.fov_deg,
        "--distortion": files.distortion or None, "--half-turn": files.half_turn or None, "--pose": options.pose,
        "--room": None if options.room == "closed" else options.room,
        "--system": None if options.system == "diorama" else options.system,
    }  # fmt: skip
    named = next((name for name, value in unused.items() if value is not None), None)
    if named is not None:
        raise InputError(f"{files.photo.name} is a 360 degree photo, with which {named} is not used; leave it out")
    given = read_inputs(files.photo, boxes=files.boxes, sphere=True)
    library, networks = diorama.open_library(options.library), options.networks(files)

    def choose(inputs: Inputs) -> Stages:
        return stages_for(options.profile, inputs, library, recipe=options.recipe, choice=networks)

    project = Project.create(output)
    with ProjectLock(project.folder, "diorama build"):
        layout = recipe(options.recipe, library, depth_measured=True)
        built = build_sphere(
            given.inputs.photo, given.inputs.boxes, library, choose, layout, progress,
            camera_height_m=files.camera_height_m,
        )  # fmt: skip
        notes = (*given.warnings, *built.room.notes)
        rows = [
            (n, partial(encode_picture, v.inputs.photo.rgb, "PNG", compress_level=2), v)
            for n, v in zip(built.names, built.views, strict=True)
        ]
        _save(project, built.room, rows, built.views, built.further_photos(given.inputs), options.library, notes)
    return PosedBuild(built.room, project, built.names, notes)


def _pair(photos: Sequence[FolderPhoto], poses: Poses) -> tuple[list[tuple[FolderPhoto, PosedPhoto]], list[str]]:
    """Photos with their cameras, by name, or by the name without its ending; and a line for those without."""
    by_name = {Path(p.name).name: p for p in poses.photos}
    by_stem = {Path(p.name).stem: p for p in poses.photos}
    pairs, without = [], []
    for photo in photos:
        posed = by_name.get(photo.photo.name) or by_stem.get(photo.photo.stem)
        if posed is None and photo.photo.name not in poses.left_out:
            without.append(photo.photo.name)
        elif posed is not None:
            pairs.append((photo, posed))
    if not pairs:
        raise InputError("none of the photos has a camera of its name in the poses")
    return pairs, [f"no camera is known of {', '.join(without)}: left out"] if without else []


def _inputs(photo: FolderPhoto) -> tuple[Inputs, tuple[str, ...]]:
    files = photo.files()
    read = read_inputs(files.photo, boxes=files.boxes, masks=files.masks)
    return read.inputs, read.warnings


def _pose(photo: FolderPhoto, inputs: Inputs, posed: PosedPhoto, *, stored: bool) -> PosedInputs:
    """A photo with its camera, which is turned with it where it is the camera of the picture as it is stored."""
    width, height = inputs.photo.width, inputs.photo.height
    quarters, k, lens = quarters_of(photo.photo), posed.camera.intrinsics, posed.lens
    lies = abs(k.height / k.width * height / width - 1.0) <= MAX_ASPECT_OFF and abs(k.width / k.height - 1.0) > 0.01
    if (quarters % 2 and lies) or (quarters == 2 and stored):
        posed = replace(posed, camera=upright_camera(posed.camera, quarters))
        lens = lens.rotate(quarters)
    k = posed.camera.intrinsics
    if abs(k.width / k.height * height / width - 1.0) > MAX_ASPECT_OFF:
        raise InputError(
            f"{photo.photo.name} has {width} x {height} pixels, its camera {k.width} x {k.height}: another picture?"
        )
    camera = Camera(k.resize(width, height), posed.camera.T_world_camera)
    straight = undistort(inputs, camera.intrinsics, lens)
    return PosedInputs(replace(straight, intrinsics=camera.intrinsics), camera)


def _save(
    project: Project,
    room: JoinedRoom,
    read: Sequence[_Row],
    placed: Sequence[PosedInputs],
    further: Sequence[FurtherPhoto],
    library: str,
    notes: tuple[str, ...],
) -> None:
    """The project with the main photo; the others lie in `photos`, their cameras in `project.json`."""
    folder = project.folder / "photos"
    folder.mkdir(exist_ok=True)
    for name, data, _ in read:
        write_atomically(folder / name, data(), error=ProjectError)  # a link there is replaced, not followed
    cameras = [
        {
            "photo": name,
            "T_world_camera": [[round(float(v), 6) for v in row] for row in posed.camera.T_world_camera],
            "intrinsics": [float(v) for v in (k.width, k.height, k.fx, k.fy, k.cx, k.cy)],
        }
        for (name, _, _), posed in zip(read, placed, strict=True)
        for k in (posed.camera.intrinsics,)
    ]
    project.save_inputs(replace(room.main.inputs, intrinsics=placed[0].camera.intrinsics))
    project.save_textures(room.textures)
    project.save_scene(room.scene)
    note_placed(project, room.scene)
    if len({p.name for p in further}) == len(further):  # photos of one stem and two endings have no names of their own
        save_photos(project, further[:MAX_PHOTOS])
    project.save_stage_runs(room.main.runs)
    project.update_info(library=library, notes=list(notes), cameras=cameras)
