"""Photos against what a person annotated in them: kinds, form, colours, fronts, what carries what, outlines, ghosts.

Every photo is built from the annotated boxes with their plain words, or without words; as it is, and under
perturbations that should not change much (`photo_perturbations`). Settings may be other than the usual ones, for each
fold of photos by itself, so that what was fitted on the others is judged on photos that it has not seen.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8
from pydantic import TypeAdapter, ValidationError

from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.photo_annotations import picture_of, read_annotations, read_intrinsics
from diorama_core.evaluation.benchmarks.photo_build import PhotoScores, PhotoTask, build_photo, grid
from diorama_core.evaluation.benchmarks.photo_tables import (
    folds_table,
    form_table,
    fronts_table,
    overall_table,
    perturbation_tables,
)
from diorama_core.evaluation.reports.tables import Table
from diorama_core.io.bounded import read_json
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.workers import workers

SHEET_COLUMNS = 2
_CAPTION_PX = 18
_MAX_BYTES = 100_000_000
"""Results of some ten thousand photos."""
_RESULTS = TypeAdapter(list[PhotoScores])
_SETTINGS = TypeAdapter(dict[str, float])


@dataclass(frozen=True)
class PhotoSource:
    """A file of annotations and the folder of its photos."""

    annotations: Path
    """As `adapters.photo_annotations` describes it."""
    photos: Path
    """Pictures named by id, with `photos.json` for known intrinsics where there is one."""


@dataclass(frozen=True)
class PhotoPlan:
    """Which builds a run makes."""

    tasks: tuple[PhotoTask, ...]
    """The photos as they are, then perturbed ones."""
    missing: tuple[str, ...] = ()
    """Annotated photos that the folders do not have."""
    named: bool = True
    folds: Mapping[str, int] = field(default_factory=dict)
    """Fold of each photo; empty without folds."""
    fitted: bool = False
    """Whether each fold has settings of its own."""


@dataclass(frozen=True)
class PhotosBench:
    """Results of all photos."""

    plan: PhotoPlan
    results: tuple[PhotoScores, ...]
    """Results of the tasks that are done, in their order."""

    @property
    def plain(self) -> tuple[PhotoScores, ...]:
        """Photos as they are."""
        return tuple(r for r in self.results if not r.perturbation)

    def tables(self) -> tuple[Table, ...]:
        """All photos, fronts by kind, attributes of form; folds and perturbations where they were asked for."""
        tables = [overall_table(self.plain, named=self.plan.named, missing=self.plan.missing)]
        tables += [fronts_table(self.plain), form_table(self.plain)]
        if self.plan.folds:
            count = max(self.plan.folds.values()) + 1
            folds = [[r for r in self.plain if self.plan.folds[r.photo] == k] for k in range(count)]
            tables.append(folds_table([fold for fold in folds if fold], fitted=self.plan.fitted))
        names = dict.fromkeys(r.perturbation for r in self.results if r.perturbation)
        if names:
            of = {name: [r for r in self.results if r.perturbation == name] for name in names}
            tables += perturbation_tables(self.plain, of)
        return tuple(tables)

    def to_json(self) -> dict[str, object]:
        """Tables, every photo and every object."""
        return {
            "bench": "photos",
            "named": self.plan.named,
            "missing": list(self.plan.missing),
            "tables": [t.to_json() for t in self.tables()],
            "photos": [asdict(r) for r in self.results],
        }


def plan(
    sources: Sequence[PhotoSource],
    *,
    named: bool = True,
    only: Sequence[str] = (),
    perturbations: Sequence[str] = (),
    folds: int = 0,
    settings: Sequence[Mapping[str, float]] = (),
    cache: Path | None = None,
    tiles: Path | None = None,
) -> PhotoPlan:
    """Every annotated photo that a folder has, as it is and under each perturbation.

    Args:
        sources: annotations with their photos; ids must differ.
        named: whether boxes come with their plain words.
        only: ids of photos to take; all where empty.
        perturbations: names of `photo_perturbations.PERTURBATIONS`.
        folds: into how many folds the photos are dealt, in the order of their ids; none where 0.
        settings: values of the stages' settings, as `pipeline.settings` names them: none, one for all photos, or one
            for each fold.
        cache: folder for stage results, one folder a photo; a later run resumes from them.
        tiles: folder for a picture of every build; none where None.

    Raises:
        InputError: annotations that cannot be read, the same id twice, no photo at all, or settings that are not as
            many as the folds.
    """
    if len(settings) > 1 and len(settings) != folds:
        raise InputError(f"{len(settings)} files of settings for {folds} folds: give one for all, or one for each fold")
    tasks_by_id: dict[str, PhotoTask] = {}
    missing: list[str] = []
    for source in sources:
        intrinsics = read_intrinsics(source.photos)
        for name, photo in read_annotations(source.annotations).items():
            path = picture_of(source.photos, name)
            if only and name not in only:
                continue
            if name in tasks_by_id:
                raise InputError(f"{source.annotations}: {name} is in an earlier file too; give ids that differ")
            if path is None:
                missing.append(name)
            else:
                tasks_by_id[name] = PhotoTask(name, path, photo, intrinsics.get(name), named)
    if not tasks_by_id:
        folders = ", ".join(str(source.photos) for source in sources)
        raise InputError(f"{folders}: none of the {len(missing)} annotated photos is there; name pictures by their ids")
    fold_of = {name: k % folds for k, name in enumerate(sorted(tasks_by_id))} if folds else {}
    settings_of_photo = (
        {name: settings[fold_of[name] if len(settings) > 1 else 0] for name in tasks_by_id} if settings else {}
    )
    tasks = [
        _change(replace(task, settings=settings_of_photo.get(name, {})), change, cache, tiles)
        for change in ("", *perturbations)
        for name, task in tasks_by_id.items()
    ]
    return PhotoPlan(tuple(tasks), tuple(missing), named, fold_of, len(settings) > 1)


def _change(task: PhotoTask, change: str, cache: Path | None, tiles: Path | None) -> PhotoTask:
    """The task under a perturbation, with places of its own for what it writes."""
    title = "-".join(part for part in (task.name, "" if task.named else "unnamed", change) if part)
    return replace(
        task,
        perturbation=change,
        cache=None if cache is None else cache / title,
        tile=None if tiles is None else tiles / f"{title}.jpg",
    )


def run(
    asked: PhotoPlan,
    library: ShapeLibrary,
    *,
    known: Sequence[PhotoScores] = (),
    processes: int = 1,
    after_photo: Callable[[PhotosBench], None] | None = None,
    progress: Progress = SILENT,
) -> PhotosBench:
    """Build every photo of a plan; failures count as wrong.

    Args:
        asked: as `plan` makes it.
        library: where shapes come from.
        known: results of an earlier run; those of the same code, photos and settings are taken over.
        processes: photos built at once.
        after_photo: called with the results so far after every photo, so that an interrupted run has some.
        progress: reports and cancellation.
    """
    of_key = {r.key: r for r in known if not r.failure}
    drawn = (task for task in asked.tasks if task.tile is None or task.tile.is_file())
    done = {task.title: of_key[key] for task in drawn if (key := task.key()) in of_key}
    waiting = [task for task in asked.tasks if task.title not in done]

    def take(task: PhotoTask, result: PhotoScores) -> None:
        done[task.title] = result
        progress.report(len(done) / len(asked.tasks), f"{len(done)} of {len(asked.tasks)}: {task.title}")
        if after_photo is not None:
            after_photo(so_far())

    def so_far() -> PhotosBench:
        return PhotosBench(asked, tuple(done[task.title] for task in asked.tasks if task.title in done))

    if processes > 1:
        for piece in workers(None, processes).map(partial(build_photo, library=library), waiting):
            take(piece.item, piece.unwrap())
            progress.check()
    else:
        for k, task in enumerate(waiting):
            part = progress.part(len(done) / len(asked.tasks), (len(done) + 1) / len(asked.tasks))
            part.report(0.0, f"{task.title} ({k + 1} of {len(waiting)})")
            take(task, build_photo(task, library, part))
    progress.report(1.0, "done")
    return so_far()


def read_results(path: Path) -> list[PhotoScores]:
    """The photos of an earlier run's JSON; none where there is no such file.

    Raises:
        InputError: the file is something else.
    """
    if not path.exists():
        return []
    document = read_json(path, InputError, most=_MAX_BYTES)
    try:
        return _RESULTS.validate_python(document["photos"] if isinstance(document, dict) else document)
    except (KeyError, ValidationError) as error:
        raise InputError(f"{path}: it holds no results of annotated photos; give another name") from error


def read_settings(path: Path) -> dict[str, float]:
    """A JSON object of settings' names and values.

    Raises:
        InputError: the file is something else.
    """
    try:
        return _SETTINGS.validate_python(read_json(path, InputError, most=_MAX_BYTES))
    except ValidationError as error:
        raise InputError(f'{path}: settings are an object such as {{"layout.weights.outline": 2.0}}') from error


def sheet(bench: PhotosBench) -> UInt8[np.ndarray, "_ _ 3"]:
    """All pictures of the builds in a grid, each under its name; builds that failed have none.

    Raises:
        InputError: no build has a picture.
    """
    pictures = ((task.title, cv2.imread(str(task.tile))) for task in bench.plan.tasks if task.tile is not None)
    tiles = [_caption(picture[..., ::-1], title) for title, picture in pictures if picture is not None]
    if not tiles:
        raise InputError("no photo was built, so there is nothing to show in a sheet")
    return grid(tiles, SHEET_COLUMNS)


def _caption(tile: UInt8[np.ndarray, "h w 3"], words: str) -> UInt8[np.ndarray, "_ w 3"]:
    bar = np.full((_CAPTION_PX, tile.shape[1], 3), 255, np.uint8)
    cv2.putText(bar, words, (6, 13), cv2.FONT_HERSHEY_SIMPLEX, 0.42, (20, 20, 20), 1, cv2.LINE_AA)
    return np.concatenate([bar, tile])
