"""Several photos that were dropped together: a project each, or one room of all; one photo of a whole room."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from diorama_app.projects.begin import begin_project, fresh_folder, keep_given
from diorama_app.projects.dropped import MAX_BYTES, DroppedPhoto, Reading, files_of, upload_of
from diorama_app.projects.folder_photos import FolderPhoto
from diorama_app.projects.uploads import Upload, decode
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.errors import DioramaError, InputError
from diorama_core.io.contained import unpack
from diorama_core.io.limited import LimitedProcess
from diorama_core.progress import Progress
from diorama_core.project.storage import Project

if TYPE_CHECKING:
    from diorama_app.projects.posed_build import PosedBuild


def begin_each(client: Client, name: str, content: bytes, reading: Reading) -> None:
    """Make a project of each photo and open the first.

    Args:
        client: who dropped them.
        name: of the archive.
        content: of the archive.
        reading: which photos, and what belongs to each.
    """
    session = client.session

    def work(progress: Progress) -> None:
        files, process = files_of(name, content), LimitedProcess()
        made: list[Project] = []
        failed: list[str] = []
        try:
            for number, photo in enumerate(reading.photos):
                progress.report(number / len(reading.photos), _("Reading {name}").format(name=Path(photo.file).name))
                try:
                    made.append(_begin(session.projects_dir, photo, files, process))
                except DioramaError as error:
                    failed.append(str(error))
        finally:
            process.close()
        if not made:
            raise InputError(failed[0])
        message = _("Each of the {count} photos has its own project; this is the first.").format(count=len(made))
        client.post(lambda: session.visit(client, made[0], " ".join((message, *failed[:3]))))

    session.jobs.start("import", _("Reading {count} photos").format(count=len(reading.photos)), work)
    client.close_dialog()


def _begin(projects_dir: Path, photo: DroppedPhoto, files: Mapping[str, bytes], process: LimitedProcess) -> Project:
    upload = upload_of(photo, files)
    project = begin_project(projects_dir, upload.name, decode(upload, process), upload.photo)
    keep_given(project, upload)
    return project


def build_one_room(client: Client, name: str, content: bytes, reading: Reading) -> None:
    """Build one project of all photos, and open it; arguments as for `begin_each`.

    Args:
        client: the browser that asked.
        name: of the file.
        content: of the file.
        reading: what it is.
    """
    session = client.session

    def work(progress: Progress) -> None:
        _check_photos(reading, files_of(name, content))
        output = fresh_folder(session.projects_dir, name)
        with tempfile.TemporaryDirectory(prefix="dropped-") as folder:
            (Path(folder) / "photos.zip").write_bytes(content)
            try:
                with unpack(Path(folder) / "photos.zip", MAX_BYTES) as inside:
                    built = _room(inside, reading, output, progress)
            except BaseException:
                shutil.rmtree(output, ignore_errors=True)
                raise
        message = _("One room from {photos} photos; objects: {objects}.").format(
            photos=len(built.photos), objects=len(built.room.scene.objects)
        )
        client.post(lambda: session.visit(client, built.project, message))

    session.jobs.start("build", _("Building a room from {count} photos").format(count=len(reading.photos)), work)
    client.close_dialog()


def check_all_round(upload: Upload) -> None:
    """Raise `InputError` where something came with a 360 degree photo that is not used with one."""
    for name, given in (("depth", upload.depth), ("masks", upload.masks)):
        if given is not None:
            raise InputError(f"{upload.name} is a 360 degree photo, with which {name} is not used; leave it out")


def _check_photos(reading: Reading, files: Mapping[str, bytes]) -> None:
    """Decode everything in a process of its own first, where a hostile file does no harm."""
    process = LimitedProcess()
    try:
        for photo in reading.photos:
            decode(upload_of(photo, files), process)
    finally:
        process.close()


def _room(inside: Path, reading: Reading, output: Path, progress: Progress) -> PosedBuild:
    from diorama_app.projects.options import BuildOptions  # the pipeline, without which the editor opens
    from diorama_app.projects.posed_build import build_posed_photos, poses_from_photos
    from diorama_core.multiview.posed_photos import read_poses

    photos = [
        FolderPhoto(inside / p.file, Path(p.file).stem, tuple((sort, inside / file) for sort, file in p.beside))
        for p in reading.photos
    ]
    if reading.poses:
        cameras = inside / reading.poses
        where = cameras if cameras.suffix == ".json" else cameras.parent
        poses = read_poses(where, [p.photo for p in photos])
    else:
        poses = poses_from_photos(photos, progress.part(0.0, 0.1))
    return build_posed_photos(photos, poses, BuildOptions(), output, progress.part(0.1, 1.0))
