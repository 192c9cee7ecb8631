"""Retrieval alone, given true masks and boxes: shapes that were offered, and shapes that never were.

Rooms are furnished from the library's test shapes. "Same source" retrieves from the whole library, so the true shape
can be found; "out of distribution" retrieves from the other shapes only.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial

from diorama_core.errors import DioramaError
from diorama_core.evaluation.benchmarks.cases import make_views, recipe
from diorama_core.evaluation.metrics.shape import is_household, shape_distance
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Column, Row, Table, mean, paper_rows
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.search import find
from diorama_core.library.taxonomy import broad
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import RetrievalStage
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.retrieval.joint import JointEmbedding
from diorama_core.retrieval.published import By, MatchedByLooks, TextThenPicture
from diorama_core.synthesis.artefacts import true_geometry, true_objects
from diorama_core.synthesis.splits import split_library
from diorama_core.synthesis.truth import TruthView

log = logging.getLogger(__name__)

CACHE_SIZE = 5
"""The paper takes the best of five."""
OCCLUDED = 0.95
"""An object with less of it visible is occluded (paper, supplement: an occlusion ratio above 5 %)."""
MISSED = 100.0
"""Distance of an object for which nothing was retrieved (that of a lamp from a bed is about 60)."""
ALONE = ("words alone", "looks alone")
"""Half of the query each, as the paper's DD-T and DD-V have them; hand-made stand-ins for the network's two towers."""
GROUPS = ("household", "furniture", "occluded", "complete", "supported", "supporting")


Ranked = Mapping[str, tuple[str, ...]]
"""Shapes for each object, the best first."""


@dataclass(frozen=True)
class RetrievalResult:
    """What was retrieved for one object."""

    case: str
    object_id: str
    category: str
    groups: tuple[str, ...]
    same_first: float
    """Chamfer of the first retrieved shape to the true one, times 1000; the whole library offered."""
    same_best: float
    """Chamfer distance of the best of five."""
    unseen_first: float
    unseen_best: float
    rank: int | None
    """Place of the true shape, 1 for the first; None when it is not among those kept."""
    same_kind: bool
    """Whether the first shape is of the true category, or of the same broad one; the whole library offered."""
    unseen_kind: bool
    alone: tuple[tuple[str, float, float], ...] = ()
    """(one of `ALONE` or `embedding_stages`, best of five of the whole library, and of the unseen shapes)."""


@dataclass(frozen=True)
class RetrievalBench:
    """All objects of all rooms."""

    seed: int
    objects: tuple[RetrievalResult, ...]

    def tables(self) -> tuple[Table, ...]:
        """The paper's retrieval table, and how often the very shape was found."""
        return retrieval_table(self.objects), recall_table(self.objects)

    def to_json(self) -> dict[str, object]:
        """Tables and every object."""
        return {
            "bench": "retrieval",
            "seed": self.seed,
            "tables": [t.to_json() for t in self.tables()],
            "objects": [asdict(o) for o in self.objects],
        }


def run(
    library: ShapeLibrary,
    scenes: int = 20,
    seed: int = 0,
    progress: Progress = SILENT,
    embeddings: Mapping[str, JointEmbedding] | None = None,
) -> RetrievalBench:
    """Retrieve for every object asked for, from the whole library and from its training and validation shapes.

    Args:
        library: Whose test shapes furnish the rooms.
        scenes: Number of rooms.
        seed: Of the rooms.
        progress: Where it is reported.
        embeddings: By their names in the publication's table, each gets its rows; see `embedding_stages`.
    """
    tested = split_library(library, "test")
    unoffered = split_library(library, "train", "validation")
    everything, others = HierarchicalRetrieval(library), HierarchicalRetrieval(unoffered)
    rows = {name: (partial(_alone, name, library), partial(_alone, name, unoffered)) for name in ALONE}
    for name, stage in embedding_stages(embeddings or {}).items():
        rows[name] = (partial(_ranks, stage(library)), partial(_ranks, stage(unoffered)))
    results: list[RetrievalResult] = []
    cases = recipe(scenes, 1, seed)
    for k, (case, view) in enumerate(make_views(cases, tested, [])):
        progress.report(k / len(cases), case.name)
        same, unseen = _ranks(everything, view), _ranks(others, view)
        alone = [(name, whole(view), others_only(view)) for name, (whole, others_only) in rows.items()]
        results += [_result(case.name, view, index, same, unseen, alone, library) for index in view.indices]
    return RetrievalBench(seed, tuple(results))


def embedding_stages(embeddings: Mapping[str, JointEmbedding]) -> dict[str, Callable[[ShapeLibrary], RetrievalStage]]:
    """The publication's way with each embedding, and DuoduoCLIP's by words and by picture alone, by row."""

    def stage(embedding: JointEmbedding, by: By) -> Callable[[ShapeLibrary], RetrievalStage]:
        return lambda library: TextThenPicture(library, embedding, by)

    ways: dict[str, By] = {"T": "words", "V": "picture", "H": "words and picture"}
    return {
        f"{name}-{letter}": stage(embedding, by)
        for name, embedding in embeddings.items()
        for letter, by in ways.items()
        if letter == "H" or name == "DD"
    }


def _ranks(stage: RetrievalStage, view: TruthView) -> Ranked:
    try:
        ranked = stage.retrieve(view.inputs, true_objects(view), true_geometry(view), Progress())
    except DioramaError as error:
        log.warning("retrieval failed: %s", error)
        return {}
    return {r.object_id: tuple(shape for shape, _ in r.ranked) for r in ranked}


def _alone(name: str, library: ShapeLibrary, view: TruthView) -> Ranked:
    """Ranked shapes of every object by its label's words, or by what its kind's shapes look like."""
    if name == "words alone":
        return {o.id: tuple(s.id for s in find(library, o.label, k=CACHE_SIZE).shapes) for o in true_objects(view)}
    return _ranks(MatchedByLooks(library), view)


def _distances(true: str, ranked: Sequence[str], library: ShapeLibrary) -> tuple[float, float]:
    """Chamfer distance of the first and of the best of five to the true shape."""
    near = [shape_distance(library, true, s) for s in ranked[:CACHE_SIZE]]
    return (near[0], min(near)) if near else (MISSED, MISSED)


def _result(
    case: str,
    view: TruthView,
    index: int,
    same: Ranked,
    unseen: Ranked,
    alone: Sequence[tuple[str, Ranked, Ranked]],
    library: ShapeLibrary,
) -> RetrievalResult:
    item = view.scene.objects[index]

    def distances(found: Ranked) -> tuple[float, float]:
        return _distances(item.shape_id, found.get(item.id, ()), library)

    def right_kind(found: Ranked) -> bool:
        first = found.get(item.id, ())[:1]
        return any(broad(library.shape(s).category) == broad(item.category) for s in first)

    ranked = same.get(item.id, ())
    return RetrievalResult(
        case,
        item.id,
        item.category,
        object_groups(view, index),
        *distances(same),
        *distances(unseen),
        ranked.index(item.shape_id) + 1 if item.shape_id in ranked else None,
        right_kind(same),
        right_kind(unseen),
        tuple((name, distances(whole)[1], distances(others)[1]) for name, whole, others in alone),
    )


def object_groups(view: TruthView, index: int) -> tuple[str, ...]:
    """The paper's groups that an object belongs to."""
    item = view.scene.objects[index]
    edge = view.scene.support_of(item.id)
    groups = ["household" if is_household(item.category) else "furniture"]
    groups.append("occluded" if view.visible_fraction[index] < OCCLUDED else "complete")
    if edge is not None and view.scene.has_object(edge.parent):
        groups.append("supported")
    if view.scene.children_of(item.id):
        groups.append("supporting")
    return tuple(groups)


def retrieval_table(objects: Sequence[RetrievalResult]) -> Table:
    """Chamfer distance by group, same source and out of distribution (paper, table 4)."""
    columns = tuple(Column(f"{g} {s}", ".1f", "↓") for g in GROUPS for s in ("SS", "OOD"))

    by_row: dict[str, list[tuple[RetrievalResult, tuple[float, float]]]] = {
        "embedded, first": [(o, (o.same_first, o.unseen_first)) for o in objects],
        "embedded, best of 5": [(o, (o.same_best, o.unseen_best)) for o in objects],
    }
    for o in objects:
        for name, same, unseen in o.alone:
            by_row.setdefault(f"{name}, best of 5", []).append((o, (same, unseen)))
    rows = [
        Row(name, tuple(mean(x[k] for o, x in found if group in o.groups) for group in GROUPS for k in (0, 1)))
        for name, found in by_row.items()
    ]
    note = (
        f"{len(objects)} objects. Two-way mean squared chamfer of normalised shapes x 1000. SS: the true shape "
        "is in the library; OOD: it is not. Words alone: a text search for the label; looks alone: rendered views of "
        "the shapes of its kind. They stand in for the halves of the paper's networks. CLIP-H, OS-H, DD-T, DD-V, DD-H: "
        "the paper's way with its networks, where they are on the machine."
    )
    return Table("Retrieval", columns, (*rows, *paper_rows(paper.RETRIEVAL)), note)


def recall_table(objects: Sequence[RetrievalResult]) -> Table:
    """How often the very shape is first, or among the first five or eight, and the first is of the right kind."""
    columns = (
        Column("objects", "d"),
        *(Column(n, better="↑") for n in ("first", "first five", "first eight", "right kind", "right kind OOD")),
    )
    rows = []
    for group in ("all", *GROUPS):
        inside = [o for o in objects if group == "all" or group in o.groups]
        ranks = [o.rank for o in inside]
        shares = [mean(r is not None and r <= most for r in ranks) for most in (1, CACHE_SIZE, 8)]
        kinds = [mean(o.same_kind for o in inside), mean(o.unseen_kind for o in inside)]
        rows.append(Row(group, (len(inside), *shares, *kinds)))
    return Table("The very shape found", columns, tuple(rows))
