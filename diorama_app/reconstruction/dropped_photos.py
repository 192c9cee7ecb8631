"""Several photos that were dropped together: a project each, or one room of all; one photo of a whole room."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from diorama_app.projects.begin import begin_project, fresh_folder, keep_given
from diorama_app.projects.dropped import MAX_BYTES, DroppedPhoto, Reading
from diorama_app.projects.dropped_files import files_of, upload_of
from diorama_app.projects.folder_photos import FolderPhoto
from diorama_app.projects.uploads import Upload, decoded
from diorama_app.reconstruction.build_job import counted
from diorama_app.session.client import Client
from diorama_app.session.project_contents import shown_notes
from diorama_app.strings import _
from diorama_core.artefacts import FurtherPhoto
from diorama_core.errors import DioramaError, EditRefused, InputError
from diorama_core.io.contained import unpacked
from diorama_core.io.limited import LimitedProcess
from diorama_core.progress import Progress
from diorama_core.project.further_photos import note_placed
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene

if TYPE_CHECKING:
    from diorama_app.projects.posed_build import PosedBuild
    from diorama_core.multiview.sphere_scene import SphereScene  # the pipeline, without which the editor opens


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
                    made.append(_begun(session.projects_dir, photo, files, process))
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


def _begun(projects_dir: Path, photo: DroppedPhoto, files: Mapping[str, bytes], process: LimitedProcess) -> Project:
    upload = upload_of(photo, files)
    project = begin_project(projects_dir, upload.name, decoded(upload, process), upload.photo)
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
                with unpacked(Path(folder) / "photos.zip", MAX_BYTES) as inside:
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


def build_all_round(client: Client, upload: Upload) -> None:
    """Build one project of a 360 degree photo, and open it.

    Args:
        client: the browser that asked.
        upload: the photo, with boxes where they came with it.

    Raises:
        InputError: something came with it that is not used.
    """
    for name, given in (("depth", upload.depth), ("masks", upload.masks)):
        if given is not None:
            raise InputError(f"{upload.name} is a 360 degree photo, with which {name} is not used; leave it out")
    session = client.session

    def work(progress: Progress) -> None:
        from diorama_app.projects.options import BuildOptions  # the pipeline, without which the editor opens
        from diorama_app.projects.posed_build import build_read_sphere
        from diorama_core.pipeline.choices import NetworkChoice

        process = LimitedProcess()
        try:
            given = decoded(replace(upload, sphere=True), process)
        finally:
            process.close()
        output = fresh_folder(session.projects_dir, upload.name)
        try:
            built = build_read_sphere(given, BuildOptions(), NetworkChoice(), output, progress)
        except BaseException:
            shutil.rmtree(output, ignore_errors=True)
            raise
        message = _("The whole room from a 360 degree photo; objects: {objects}.").format(
            objects=len(built.room.scene.objects)
        )
        client.post(lambda: session.visit(client, built.project, message))

    session.jobs.start("build", _("Building the whole room of a 360 degree photo"), work)
    client.close_dialog()


def build_all_round_again(client: Client) -> None:
    """Build the room of the chosen 360 degree photo from the boxes in it, as one undo step.

    Args:
        client: the browser that asked.

    Raises:
        EditRefused: the project is read-only, or the scene was changed while it was built.
        InputError: no 360 degree photo with boxes is chosen.
    """
    session, sphere = client.session, client.further_photo
    if sphere is None or not sphere.inputs.boxes:
        raise InputError("mark the furniture in the 360 degree photo first")
    session.need_writable()
    project, before, library = session.project, session.scene, session.offered
    if project is None:
        raise EditRefused("no project is open")
    client.view.canvas.close()

    def work(progress: Progress) -> None:
        from diorama_core.layout.recipes import recipe  # the pipeline, without which the editor opens
        from diorama_core.multiview.sphere_scene import build_sphere
        from diorama_core.pipeline.presets import stages_for

        session.autosave.flush()
        built = build_sphere(
            sphere.inputs.photo,
            sphere.inputs.boxes,
            library,
            lambda given: stages_for("auto", given, library),
            recipe("feasible", library, depth_measured=True),
            progress,
        )
        note_placed(project, built.room.scene)
        client.post(lambda: _show_all_round(client, project, before, sphere, built))

    session.jobs.start("build", _("Building the whole room of a 360 degree photo"), work)


def _show_all_round(client: Client, project: Project, before: Scene, sphere: FurtherPhoto, built: SphereScene) -> None:
    session = client.session
    if session.project != project:
        return  # another project was opened here meanwhile
    if session.scene is not before or not any(p is sphere for p in session.further_photos):
        raise EditRefused("the scene was changed while the room was built, so it stays as it is; build it again")
    session.add_textures(dict(built.room.textures))
    session.notes = shown_notes(built.room.notes)
    main = built.views[0]
    session.commit(
        _("build the whole room"),
        built.room.scene,
        by=client,
        selection=(),
        inputs=replace(main.inputs, intrinsics=main.camera.intrinsics),
        further=built.further_photos(sphere.inputs),
    )
    session.view.show_whole_room()
    session.notice_all(counted(built.room.scene), "good")


def _check_photos(reading: Reading, files: Mapping[str, bytes]) -> None:
    """Decode everything in a process of its own first, where a hostile file does no harm."""
    process = LimitedProcess()
    try:
        for photo in reading.photos:
            decoded(upload_of(photo, files), process)
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
