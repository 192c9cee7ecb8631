"""The whole system on other people's pictures, from a local copy of their dataset.

What can be measured is what a dataset's annotation tells: masks always, who stands on what in SSDB, where furniture
stands in Scan2CAD. Support, overlap and bounds need no annotation.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path
from typing import Literal

import numpy as np

from diorama_core.artefacts import Inputs
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.files import read_json
from diorama_core.evaluation.adapters.scan2cad import AlignedModel, ScanFrame, read_scan2cad
from diorama_core.evaluation.adapters.ssdb import SsdbScene, read_ssdb
from diorama_core.evaluation.adapters.sunrgbd import read_sunrgbd
from diorama_core.evaluation.benchmarks.cases import attempt_one
from diorama_core.evaluation.metrics.pose import Placed, object_alignment
from diorama_core.evaluation.metrics.scene import (
    as_placed,
    mean_mask_iou,
    out_of_bounds_share,
    structure_of,
    support_share,
)
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Column, Row, Table, mean, paper_rows
from diorama_core.layout.exact import mesh_overlap_m3
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import with_kin
from diorama_core.pipeline.run import build_scene
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Scene, SceneObject
from diorama_core.synthesis.truth import transform

Dataset = Literal["ssdb", "scan2cad", "sunrgbd"]
_SCAN2CAD_CLASSES: dict[str, frozenset[str]] = {
    "bed": with_kin("bed"),
    "bookshelf": with_kin("bookshelf", "shelves") - {"wine rack"},
    "cabinet": with_kin("cabinet", "sideboard", "dresser", "wardrobe", "tv stand"),
    "chair": with_kin("chair", "armchair", "office chair", "stool"),
    "sofa": with_kin("sofa"),
    "table": with_kin("table", "desk", "coffee table", "side table", "console table", "night stand") - {"bar cart"},
    "bin": frozenset({"trash can"}),
    "display": frozenset({"television", "monitor"}),
}
"""Our kinds of things by Scan2CAD's class: those of ShapeNet, whose chairs are armchairs and stools, too."""


@dataclass(frozen=True, eq=False)
class LocalCase:
    """One picture with what its dataset tells."""

    name: str
    inputs: Inputs
    parents: tuple[tuple[int, int | None], ...] | None = None
    """(mask id, mask id of what carries it or None for the room); None where not annotated."""
    frame: ScanFrame | None = None
    """Where furniture stands, and the camera; None where not annotated."""


@dataclass(frozen=True)
class LocalResult:
    """One build."""

    case: str
    asked: int
    """Annotated objects."""
    found: int
    image_iou: float
    relation: float | None
    """Share of annotated supporters that were found; None where not annotated."""
    aligned: tuple[tuple[str, bool], ...]
    """For every aligned model its category and whether an object of it stands there (20 cm, 20 degrees, 20 %)."""
    structure: float
    supported: float
    out_of_bounds: float
    mesh_overlap_l: float | None
    seconds: float
    failure: str = ""


@dataclass(frozen=True)
class LocalBench:
    """Results of one dataset."""

    dataset: Dataset
    results: tuple[LocalResult, ...]

    def tables(self) -> tuple[Table, ...]:
        """What was measured; for Scan2CAD the paper's table by category too."""
        scenes = local_table(self.dataset, self.results)
        return (scenes, alignment_table(self.results)) if self.dataset == "scan2cad" else (scenes,)

    def to_json(self) -> dict[str, object]:
        """Tables and every picture."""
        return {
            "bench": "system",
            "dataset": self.dataset,
            "tables": [t.to_json() for t in self.tables()],
            "cases": [asdict(r) for r in self.results],
        }


def run(
    dataset: Dataset, path: Path, library: ShapeLibrary, scenes: int = 20, progress: Progress = SILENT
) -> LocalBench:
    """Build the first pictures of a dataset, in the order of their names; failures count as wrong.

    Args:
        dataset: how its folder is laid out.
        path: of the folder.
        library: where shapes come from.
        scenes: pictures at most.
        progress: reports and cancellation.

    Raises:
        InputError: when the folder holds no picture laid out as the dataset publishes it.
    """
    results = []
    for k, case in enumerate(islice(local_cases(dataset, path), scenes)):
        progress.report(min(k / scenes, 1.0), case.name)
        results.append(_measure(case, library, progress))
    if not results:
        raise InputError(f"{path}: no picture of {dataset} is there; give a folder laid out as it is published")
    progress.report(1.0, "done")
    return LocalBench(dataset, tuple(results))


def local_cases(dataset: Dataset, path: Path) -> Iterator[LocalCase]:
    """The pictures of a local copy, in the order of their names."""
    if dataset == "ssdb":
        for marker in sorted(path.rglob("gt.json")):
            yield _ssdb_case(read_ssdb(marker.parent))
    elif dataset == "sunrgbd":
        for marker in sorted(path.rglob("intrinsics.txt")):
            yield LocalCase(marker.parent.name, read_sunrgbd(marker.parent))
    else:
        annotations = path / "full_annotations.json"
        for scan in sorted(str(r["id_scan"]) for r in read_json(annotations)):
            for picture in sorted((path / "scans" / scan / "color").glob("*.*")):
                frame = read_scan2cad(path / "scans", annotations, scan, picture.stem)
                yield LocalCase(frame.name, frame.inputs, frame=frame)


def _ssdb_case(scene: SsdbScene) -> LocalCase:
    rank = {o.id: k for k, o in enumerate(scene.objects, start=1)}
    seen = {number for number, _ in scene.inputs.instance_boxes}
    parents = tuple(
        (rank[o.id], None if o.parent is None else rank.get(o.parent)) for o in scene.objects if rank[o.id] in seen
    )
    return LocalCase(scene.name, scene.inputs, parents)


def _measure(case: LocalCase, library: ShapeLibrary, progress: Progress) -> LocalResult:
    asked = [number for number, _ in case.inputs.instance_boxes]
    models = () if case.frame is None else tuple(m for m in case.frame.models if _is_in_picture(m, case.frame))
    begun = time.process_time()

    def measure() -> LocalResult:
        scene = build_scene(case.inputs, library, progress=Progress(token=progress.token)).scene
        spent = time.process_time() - begun
        by_mask = {o.mask_id: o for o in scene.objects if o.mask_id is not None}
        instances = case.inputs.instances
        assert instances is not None
        pairs = [(instances == n, by_mask[n].id if n in by_mask else None) for n in asked]
        return LocalResult(
            case.name,
            len(asked),
            sum(n in by_mask for n in asked),
            mean_mask_iou(pairs, scene, library, None),
            _relation(case, scene, by_mask),
            () if case.frame is None else alignments(models, scene, case.frame),
            structure_of(scene, library)["structure"],
            support_share(scene, library),
            out_of_bounds_share(scene),
            1000 * mesh_overlap_m3(scene, library) if scene.objects else None,
            spent,
            "" if scene.objects else "no object came out",
        )

    result, failure = attempt_one(case.name, measure)
    if result is not None:
        return result
    missed, relation = tuple((m.category, False) for m in models), None if case.parents is None else 0.0
    spent = time.process_time() - begun
    return LocalResult(case.name, len(asked), 0, 0.0, relation, missed, 0.0, 0.0, 1.0, None, spent, failure)


def _relation(case: LocalCase, scene: Scene, by_mask: dict[int, SceneObject]) -> float | None:
    if case.parents is None:
        return None
    right = 0
    for child, parent in case.parents:
        edge = scene.support_of(by_mask[child].id) if child in by_mask else None
        if edge is not None and parent is None:
            right += scene.has_plane(edge.parent)
        elif edge is not None and parent is not None and parent in by_mask:
            right += edge.parent == by_mask[parent].id
    return right / len(case.parents) if case.parents else 1.0


def alignments(models: Sequence[AlignedModel], scene: Scene, frame: ScanFrame) -> tuple[tuple[str, bool], ...]:
    """For every model whether some object of its category is within 20 cm, 20 degrees and 20 %; each is used once."""
    if scene.camera is not None:
        scene = transform(scene, frame.camera.T_world_camera @ scene.camera.T_camera_world)
    left = list(scene.objects)
    rows = []
    for model in models:
        true = Placed(model.R_world_object, model.centre, model.size_m, model.symmetry)
        near = sorted(left, key=lambda o: float(np.linalg.norm(o.pose.position - model.centre)))
        alike = (o for o in near if scan2cad_class(o.category) == scan2cad_class(model.category))
        hit = next((o for o in alike if object_alignment([true], [as_placed(o)]).acc == 1.0), None)
        if hit is not None:
            left.remove(hit)
        rows.append((model.category, hit is not None))
    return tuple(rows)


def _is_in_picture(model: AlignedModel, frame: ScanFrame) -> bool:
    x, y, z = frame.camera.to_camera(model.centre[None])[0]
    k = frame.camera.intrinsics
    return bool(z > 0 and 0 <= k.fx * x / z + k.cx < k.width and 0 <= k.fy * y / z + k.cy < k.height)


def scan2cad_class(category: str) -> str:
    """The name of a category in the table by category; of others their own."""
    return next((name for name, kinds in _SCAN2CAD_CLASSES.items() if category in kinds), category)


def local_table(dataset: Dataset, results: Sequence[LocalResult]) -> Table:
    """What the annotation, and the scene itself, can tell."""
    keys = {
        "image_iou": Column("image IoU", better="↑"), "relation": Column("relation", better="↑"),
        "structure": Column("structure", better="↑"), "supported": Column("supported", better="↑"),
        "out_of_bounds": Column("out of bounds", better="↓"), "mesh_overlap_l": Column("meshes l", ".2f", "↓"),
        "seconds": Column("time s", ".1f", "↓"),
    }  # fmt: skip
    counted = (Column("pictures", "d"), Column("failed", "d", "↓"), Column("found", better="↑"))
    found = sum(r.found for r in results) / max(sum(r.asked for r in results), 1)
    means = (mean(getattr(r, key) for r in results) for key in keys)
    row = Row("embedded", (len(results), sum(bool(r.failure) for r in results), found, *means))
    columns = (*counted, *keys.values())
    return Table(f"Scenes of {dataset}", columns, (row,), "Pictures that fail count as wrong in every share.")


def alignment_table(results: Sequence[LocalResult]) -> Table:
    """Percent of Scan2CAD's models aligned, by category (paper, supplement)."""
    rows = [(scan2cad_class(name), hit) for r in results for name, hit in r.aligned]
    known = paper.CATEGORIES
    each = [_percent([hit for name, hit in rows if (name if name in known else "others") == c]) for c in known]
    columns = tuple(Column(c, ".1f", "↑") for c in (*known, "class mean", "instance mean"))
    ours = Row("embedded", (*each, mean(each), _percent([hit for _, hit in rows])))
    note = f"{len(rows)} models whose middle is in the picture."
    return Table("Alignment by category", columns, (ours, *paper_rows(paper.BY_CATEGORY)), note)


def _percent(hits: Sequence[bool]) -> float | None:
    return 100 * float(np.mean(hits)) if hits else None
