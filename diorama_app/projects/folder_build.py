"""Many photos, unattended: a project for each. What is finished is kept, what fails is listed."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from diorama_app.projects.folder_photos import FolderPhoto
from diorama_app.projects.options import BuildOptions, build_files
from diorama_app.projects.pictures import encode_picture
from diorama_core.errors import DioramaError, ProjectError, SphericalPhotoError
from diorama_core.io.atomic import write_atomically, write_json
from diorama_core.io.bounded import read_json
from diorama_core.progress import Progress
from diorama_core.workers import FinishedItem, WorkerDied, Workers

RECORD = "build.json"
"""In a project: what it was built from and what came of it. Its presence means that the build was finished."""
PICTURE = "exports/scene.jpg"
PICTURE_WIDTH_PX = 640
MAX_RECORD_BYTES = 8_000_000


@dataclass(frozen=True)
class PhotoResult:
    """What became of one photo."""

    photo: Path
    project: Path
    report: dict[str, Any] | None = None
    """As `diorama build --json` prints it; None where it failed."""
    error: str = ""
    """Why it failed, in one line; empty where it did not."""
    kept: bool = False
    """Whether it was finished by an earlier run."""
    seconds: float = 0.0
    tries: int = 1

    @property
    def picture(self) -> Path:
        """The picture of its scene."""
        return self.project / PICTURE


def build_photos(
    photos: Sequence[FolderPhoto], options: BuildOptions, output: Path, workers: Workers, progress: Progress
) -> tuple[PhotoResult, ...]:
    """A project for each photo in the folder `output`, in the order of the photos.

    What an earlier run finished with the same files and options is kept as it is, edits included. A photo whose process
    died (memory, a crash in native code) is tried once more when the others are done; stage results that it had are
    read from its project. On cancellation the photos that are done are kept.

    Args:
        photos: with their files.
        options: of the build.
        output: folder that is written.
        workers: processes that read pictures.
        progress: reports and cancellation.

    Raises:
        ProjectError: `output` cannot be written.
        Cancelled: on request.
    """
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ProjectError(f"{output}: the folder cannot be made ({error.strerror}); choose another place") from error
    results: dict[FolderPhoto, PhotoResult] = {}
    died: list[FolderPhoto] = []

    def take(done: Iterable[FinishedItem[FolderPhoto, PhotoResult]], *, again: bool) -> None:
        for piece in done:
            if isinstance(piece.error, WorkerDied) and not again:
                died.append(piece.item)
                progress.check()
                continue
            result = piece.value or PhotoResult(piece.item.photo, output / piece.item.project, error=_reason(piece))
            results[piece.item] = replace(result, tries=2 if again else 1)
            progress.report(len(results) / len(photos), f"{len(results)} of {len(photos)}: {piece.item.photo.name}")

    build = partial(build_photo, options=options, output=output)
    take(workers.map(build, photos), again=False)
    take(workers.map(build, died), again=True)
    return tuple(results[photo] for photo in photos)


def build_photo(photo: FolderPhoto, options: BuildOptions, output: Path) -> PhotoResult:
    """One photo's project, kept where it is finished."""
    began, project = time.perf_counter(), output / photo.project
    key = photo.key(options)
    finished = report_of(project, key)
    if finished is not None:
        return PhotoResult(photo.photo, project, finished, kept=True)
    (project / RECORD).unlink(missing_ok=True)
    warnings: list[str] = []
    try:
        room = build_files(photo.files(), options, project, Progress(), warnings.append)
    except SphericalPhotoError:
        import diorama_core as diorama
        from diorama_app.projects.posed_build import build_sphere_photo

        warnings += build_sphere_photo(photo.files(), options, project, Progress()).notes
        room = diorama.load(project)
    from diorama_app.projects.report import build_report  # the recogniser, which the editor starts without

    report = build_report(room, ("scene.json",))
    report["notes"] = [*warnings, *report["notes"]]
    _draw(room, project / PICTURE)
    seconds = time.perf_counter() - began
    report["seconds"] = round(seconds, 2)
    write_json(project / RECORD, {"key": key, "report": report}, ProjectError, most=MAX_RECORD_BYTES)
    return PhotoResult(photo.photo, project, report, seconds=seconds)


def report_of(project: Path, key: str) -> dict[str, Any] | None:
    """What a finished build with this key reported; None where there is none."""
    if not ((project / RECORD).exists() and (project / "scene.json").exists()):
        return None
    try:
        record = read_json(project / RECORD, ProjectError, most=MAX_RECORD_BYTES)
    except ProjectError:
        return None  # a damaged record is no record: the photo is built again
    same = isinstance(record, dict) and record.get("key") == key and isinstance(record.get("report"), dict)
    return record["report"] if same else None


def _draw(room: Any, path: Path) -> None:
    import diorama_core as diorama

    width, height = room.inputs.photo.width, room.inputs.photo.height
    scale = min(1.0, PICTURE_WIDTH_PX / width)
    rgb = diorama.render(room, view="photo", size=(max(round(width * scale), 16), max(round(height * scale), 16)))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, encode_picture(rgb, "JPEG", quality=88), error=ProjectError)


def _reason(piece: FinishedItem[FolderPhoto, PhotoResult]) -> str:
    error = piece.error
    if isinstance(error, DioramaError):
        return " ".join(str(error).split())
    return f"internal error ({type(error).__name__}: {' '.join(str(error).split())[:200]})"
