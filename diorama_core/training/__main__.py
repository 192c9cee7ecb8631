"""`python -m diorama_core.training STEP`; `--help` lists them: rendering, training, exporting, scoring."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import torch

from diorama_core.arrangement.facing.terms import PATH as WEIGHTS
from diorama_core.errors import DioramaError, InputError, UnavailableError
from diorama_core.evaluation.benchmarks.photos import PhotoSource, plan
from diorama_core.io.assets import CARD, DETECTOR, FOLDER, NAMER, OUTLINER, SURFACES
from diorama_core.io.atomic import write_atomically
from diorama_core.library.catalogue import built_in_library
from diorama_core.models.recogniser import Recogniser
from diorama_core.progress import Progress
from diorama_core.training.adapting import adapt_detector, read_photos
from diorama_core.training.export import (
    export_detector,
    export_namer,
    export_outliner,
    export_surfaces,
    join_namers,
    score,
    write_card,
)
from diorama_core.training.facings import FacingModel, as_settings, beginning, certificate, gather
from diorama_core.training.kind_evidence import train as train_evidence
from diorama_core.training.pictures import PictureFiles, category_names, make_pictures
from diorama_core.training.shape_views import ShapeViewFiles, make_shape_views
from diorama_core.training.surfaces import SurfaceFiles, make_surfaces
from diorama_core.training.train import (
    Schedule,
    Trainer,
    TrainingRun,
    detector_trainer,
    namer_trainer,
    outliner_trainer,
    surface_trainer,
)
from diorama_core.training.windows import WindowFiles, make_windows

SCHEDULES = {
    "detector": Schedule(steps=12000, batch=24),
    "namer": Schedule(steps=8000, batch=128),
    "outliner": Schedule(steps=20000, batch=64),
    "surfaces": Schedule(steps=1000, batch=8),
}
"""How long each network learns."""


def main() -> int:
    """Parse and run; one line on failure."""
    arguments = _parser().parse_args()
    try:
        arguments.run(arguments)
    except DioramaError as error:
        print(f"training: {error}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    p = argparse.ArgumentParser(prog="python -m diorama_core.training", description=__doc__)
    steps = p.add_subparsers(required=True)
    _add_rendering(steps)
    _add_training(steps)
    _add_photos(steps)
    return p


def _add_rendering(steps: Any) -> None:
    for name, make, rooms, first, words in (
        ("pictures", make_pictures, 1000, 0, "render rooms"),
        ("windows", make_windows, 400, 500_000, "render rooms for the outliner"),
        ("surfaces", make_surfaces, 500, 830_000, "render rooms for the head that tells a room's surfaces"),
    ):
        step = steps.add_parser(name, help=f"{words}; goes on where it stopped")
        step.set_defaults(run=_render, make=make)
        step.add_argument("folder", type=Path)
        step.add_argument("--rooms", type=int, default=rooms)
        step.add_argument("--first", type=int, default=first, help="seed of the first room")
    shapes = steps.add_parser("shapes", help="render single shapes for the namer; goes on where it stopped")
    shapes.set_defaults(run=_shapes)
    shapes.add_argument("folder", type=Path)


def _add_training(steps: Any) -> None:
    train = steps.add_parser("train", help="train one network; goes on from its checkpoint")
    train.set_defaults(run=_train)
    train.add_argument("network", choices=tuple(SCHEDULES))
    train.add_argument("--pictures", type=Path, required=True, help="folder of what is rendered for it")
    train.add_argument("--checkpoints", type=Path, required=True)
    train.add_argument("--steps", type=int)
    train.add_argument("--threads", type=int, default=2)
    train.add_argument("--device", choices=("cpu", "cuda"), default="cpu")
    train.add_argument("--workers", type=int, default=1, help="processes that prepare batches (default: %(default)s)")
    export = steps.add_parser("export", help="write the trained networks as ONNX graphs")
    export.set_defaults(run=_export)
    export.add_argument("networks", choices=("recogniser", "outliner", "surfaces"))
    export.add_argument("--pictures", type=Path, required=True, help="folder of what is rendered for it")
    export.add_argument("--checkpoints", type=Path, required=True)
    export.add_argument("-o", "--output", type=Path, required=True)
    adapt = steps.add_parser("adapt", help="adapt the shipped detector to annotated photos")
    adapt.set_defaults(run=_adapt)
    adapt.add_argument(
        "--photos", type=Path, nargs=2, action="append", required=True, metavar=("ANNOTATIONS", "FOLDER")
    )
    adapt.add_argument("--pictures", type=Path, required=True, help="folder of rendered rooms")
    adapt.add_argument("--detector", type=Path, default=FOLDER / DETECTOR, help="adapted (default: the shipped one)")
    adapt.add_argument("--fold", type=int, nargs=2, metavar=("K", "OF"), help="hold back this fold of the photos")
    adapt.add_argument("-o", "--output", type=Path, required=True)
    join = steps.add_parser("join", help="make one namer of several, which says the mean of what they say")
    join.set_defaults(run=_join)
    join.add_argument("namers", type=Path, nargs="+")
    join.add_argument("-o", "--output", type=Path, required=True)


def _add_photos(steps: Any) -> None:
    """Declare what is measured or fitted on annotated photos."""
    scores = steps.add_parser("score", help="measure exported networks on annotated photos")
    scores.set_defaults(run=_score)
    scores.add_argument("annotations", type=Path)
    scores.add_argument("--photos", type=Path, required=True)
    scores.add_argument("--networks", type=Path, required=True, help="folder written by export")
    facings = steps.add_parser("facings", help="fit the weights that decide which way objects face")
    facings.set_defaults(run=_facings)
    facings.add_argument("annotations", type=Path, nargs="+")
    facings.add_argument("--photos", type=Path, nargs="+", required=True, help="one folder for each file")
    facings.add_argument("--stages", type=Path, help="keep stage results, as `diorama bench photos` does")
    facings.add_argument("--folds", type=int, default=5, help="of the photos (default: %(default)s)")
    facings.add_argument("--settings", type=Path, help="folder for each fold's weights, for bench photos --settings")
    facings.add_argument("-o", "--output", type=Path, default=WEIGHTS, help="weights with what they are worth")
    evidence = steps.add_parser("evidence", help="fit the layer from features of photos to kinds")
    evidence.set_defaults(run=_evidence)
    evidence.add_argument(
        "--photos", type=Path, nargs=2, action="append", required=True, metavar=("ANNOTATIONS", "FOLDER")
    )
    evidence.add_argument("-o", "--output", type=Path, required=True)


def _evidence(a: argparse.Namespace) -> None:
    for way in train_evidence([(marked, folder) for marked, folder in a.photos], a.output, _progress()):
        print(f"{way.way:20} first {way.first:.3f}, among five {way.among_five:.3f}, log loss {way.log_loss:.3f}")


def _render(a: argparse.Namespace) -> None:
    made = a.make(a.folder, built_in_library(), range(a.first, a.first + a.rooms), _progress())
    print(f"{made} rooms rendered, {a.rooms - made} were there: {a.folder}")


def _shapes(a: argparse.Namespace) -> None:
    made = make_shape_views(a.folder, built_in_library(), _progress())
    print(f"{made} shapes rendered: {a.folder}")


def _train(a: argparse.Namespace) -> None:
    if a.workers < 1:
        raise InputError(f"--workers {a.workers}: at least one process prepares batches; give 1 or more")
    if a.device == "cuda" and not torch.cuda.is_available():
        raise UnavailableError("--device cuda: PyTorch sees no card here; train with --device cpu")
    torch.set_num_threads(a.threads)
    trainer = _trainer(a.network, a.pictures, a.checkpoints, a.steps, a.device, a.workers)
    trainer.run(_progress())
    print(f"{a.network}: {trainer.step} steps: {trainer.how.checkpoint}")


def _trainer(
    network: str, pictures: Path, checkpoints: Path, steps: int | None = None, device: str = "cpu", workers: int = 1
) -> Trainer:
    checkpoints.mkdir(parents=True, exist_ok=True)
    how = TrainingRun(SCHEDULES[network].lasting(steps), checkpoints / f"{network}.pt", device, workers)
    if network == "outliner":
        return outliner_trainer(WindowFiles.of(pictures), how)
    if network == "surfaces":
        return surface_trainer(SurfaceFiles.read(pictures), how)
    files, kinds = PictureFiles.of(pictures), len(category_names(built_in_library()))
    if network == "detector":
        return detector_trainer(files, kinds, how)
    return namer_trainer(files, ShapeViewFiles.of(pictures), kinds, how)


def _export(a: argparse.Namespace) -> None:
    a.output.mkdir(parents=True, exist_ok=True)
    if a.networks == "outliner":
        export_outliner(_trainer("outliner", a.pictures, a.checkpoints).averaged, a.output / OUTLINER)
    elif a.networks == "surfaces":
        export_surfaces(_trainer("surfaces", a.pictures, a.checkpoints).averaged, a.output / SURFACES)
    else:
        _export_recogniser(a)
    print(f"networks written: {a.output}")


def _export_recogniser(a: argparse.Namespace) -> None:
    detector, namer = (_trainer(n, a.pictures, a.checkpoints) for n in ("detector", "namer"))
    export_detector(detector.averaged, a.output / DETECTOR)
    export_namer(namer.averaged, a.output / NAMER)
    files = PictureFiles.of(a.pictures)
    write_card(
        a.output / CARD,
        category_names(built_in_library()),
        rooms=len(files.rooms),
        detector={"steps": detector.step, "batch": detector.how.schedule.batch, "seed": detector.how.schedule.seed},
        namer={"steps": namer.step, "batch": namer.how.schedule.batch, "seed": namer.how.schedule.seed},
    )


def _adapt(a: argparse.Namespace) -> None:
    kinds = category_names(built_in_library())
    photos = {k: v for marked, folder in a.photos for k, v in read_photos(marked, folder, kinds).items()}
    if a.fold:
        order = np.random.default_rng(0).permutation(len(photos))
        held_out = {list(photos)[k] for k in order[a.fold[0] :: a.fold[1]]}
        print("held back: " + " ".join(sorted(held_out)))
        photos = {name: photo for name, photo in photos.items() if name not in held_out}
    torch.set_num_threads(1)
    rendered = PictureFiles.of(a.pictures)
    adapt_detector(a.detector, tuple(photos.values()), rendered, len(kinds), a.output, progress=_progress())
    print(f"detector written: {a.output}")


def _join(a: argparse.Namespace) -> None:
    join_namers(a.namers, a.output)
    print(f"namer written: {a.output}")


def _score(a: argparse.Namespace) -> None:
    for table in score(a.annotations, a.photos, Recogniser.of(a.networks)).tables():
        print(table.to_markdown())


def _facings(a: argparse.Namespace) -> None:
    torch.set_num_threads(1)
    sources = [PhotoSource(*source) for source in zip(a.annotations, a.photos, strict=True)]
    model = FacingModel(gather(plan(sources, cache=a.stages), built_in_library(), _progress()))
    given = " ".join(path.name for path in a.annotations)
    certified = certificate(model, f"python -m diorama_core.training facings {given}", a.folds)
    write_atomically(a.output, json.dumps(certified, indent=1).encode())
    for k in range(a.folds if a.settings else 0):
        weights = as_settings(model.fit(beginning(), ~model.fold(k, a.folds)))
        settings = {f"pose.stage.facing.{name}": weight for name, weight in weights.items()}
        write_atomically(a.settings / f"fold{k}.json", json.dumps(settings, indent=1).encode())
    print(f"weights written: {a.output}")


def _progress() -> Progress:
    return Progress(lambda event: print(f"{event.fraction:6.1%} {event.message}", file=sys.stderr, flush=True))


if __name__ == "__main__":
    sys.exit(main())
