"""Poses and the optimiser on rendered rooms: true shapes given, with true and with estimated depth; the ablations."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from diorama_core.artefacts import Inputs
from diorama_core.errors import Cancelled
from diorama_core.evaluation import paper
from diorama_core.evaluation.cases import recipe, views_of
from diorama_core.evaluation.dataset.artefacts import LeaveAsIs, TrueShapes, true_supports
from diorama_core.evaluation.dataset.truth import TruthView
from diorama_core.evaluation.pose_metrics import Alignment, object_alignment, pair_checks, pooled
from diorama_core.evaluation.retrieval_bench import GROUPS, object_groups
from diorama_core.evaluation.scene_metrics import SceneScores, as_placed, in_true_world, matched, scene_scores
from diorama_core.evaluation.tables import Column, Row, Table, paper_rows
from diorama_core.layout.published import AllInOneRecipe, PaperRecipe
from diorama_core.layout.recipes import recipe as layout_recipe
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.build import Stages, build_scene, embedded_stages
from diorama_core.progress import Progress
from diorama_core.protocols import LayoutStage
from diorama_core.retrieval import EmbeddedRetrieval
from diorama_core.scene.types import Scene, Support

log = logging.getLogger(__name__)

RETRIEVALS = (1, 4, 8)
CATEGORY_NAMES = {"trash can": "bin", "television": "display", "monitor": "display", "desk": "table"}
"""Scan2CAD's names of categories, where they differ."""


@dataclass(frozen=True)
class GroupCounts:
    """Right answers of one group of objects: pairs with every other object, averaged, and the object itself."""

    instances: int
    r: float
    t: float
    s: float
    every: float
    own: float


@dataclass(frozen=True)
class PoseBench:
    """Named results; every list has one entry per room."""

    seed: int
    poses: tuple[tuple[str, tuple[SceneScores, ...]], ...]
    """"true depth" and "estimated depth", true shapes given."""
    retrievals: tuple[tuple[int, tuple[SceneScores, ...], tuple[SceneScores, ...]], ...]
    """(shapes kept, with true depth, with estimated depth)."""
    ablation: tuple[tuple[str, tuple[SceneScores, ...]], ...]
    groups: tuple[tuple[str, GroupCounts], ...]
    """With true depth and true shapes, by group and by "category: ..."."""

    def tables(self) -> tuple[Table, ...]:
        """The paper's pose, group, retrieval-count, ablation and category tables."""
        return (
            pose_table("Pose, true depth", dict(self.poses)["true depth"], paper.POSE_TRUE_DEPTH),
            pose_table("Pose, estimated depth", dict(self.poses)["estimated depth"], paper.POSE_ESTIMATED_DEPTH),
            groups_table(self.groups),
            retrievals_table(self.retrievals),
            ablation_table(self.ablation),
            all_in_one_table(self.ablation),
            category_table(self.groups),
        )

    def to_json(self) -> dict[str, object]:
        """Tables and every room."""
        return {
            "bench": "pose",
            "seed": self.seed,
            "tables": [t.to_json() for t in self.tables()],
            "rooms": {name: [asdict(s) for s in rows] for name, rows in (*self.poses, *self.ablation)},
        }


def run(library: ShapeLibrary, scenes: int = 6, seed: int = 0, progress: Progress | None = None) -> PoseBench:
    """Pose every room with true and estimated depth, with few and many retrieved shapes, and arrange it every way."""
    progress = progress or Progress()
    poses: dict[str, list[SceneScores]] = {"true depth": [], "estimated depth": []}
    kept: dict[int, tuple[list[SceneScores], list[SceneScores]]] = {k: ([], []) for k in RETRIEVALS}
    ablation: dict[str, list[SceneScores]] = {}
    groups: dict[str, list[tuple[float, ...]]] = {}
    cases = recipe(scenes, 1, seed)
    for number, (case, view) in enumerate(views_of(cases, library)):
        step = progress.part(number / len(cases), (number + 1) / len(cases))
        for turn, name in enumerate(poses):
            step.report(0.15 * turn, f"{case.name}: true shapes, {name}")
            inputs = view.inputs if name == "true depth" else replace(view.inputs, depth_m=None)
            observed = _observed(view, inputs, library, TrueShapes.of(view))
            poses[name].append(_scores(view, observed, library))
            if name == "true depth":
                _count_groups(view, observed, library, groups)
                _arrange(view, observed, library, ablation, step)
            for k in RETRIEVALS:
                step.report(0.4 + 0.1 * turn, f"{case.name}: {k} shapes kept, {name}")
                scene = _observed(view, inputs, library, EmbeddedRetrieval(library, keep=k))
                kept[k][turn].append(_scores(view, scene, library))
    progress.report(1.0, "done")
    return PoseBench(
        seed,
        tuple((name, tuple(rows)) for name, rows in poses.items()),
        tuple((k, tuple(a), tuple(b)) for k, (a, b) in kept.items()),
        tuple((name, tuple(rows)) for name, rows in ablation.items()),
        tuple((name, _counted(rows)) for name, rows in sorted(groups.items())),
    )


def _observed(
    view: TruthView, inputs: Inputs, library: ShapeLibrary, retrieval: TrueShapes | EmbeddedRetrieval
) -> Scene | None:
    """The scene before any layout, or None when a stage failed."""
    stages: Stages = replace(embedded_stages(inputs, library), retrieval=retrieval, layout=LeaveAsIs())
    try:
        return build_scene(inputs, library, stages=stages).observed
    except Cancelled:
        raise
    except Exception as error:  # whatever goes wrong, the room counts as failed
        log.warning("a room failed: %s", error)
        return None


def _scores(view: TruthView, scene: Scene | None, library: ShapeLibrary) -> SceneScores:
    return SceneScores.failed(len(view.asked)) if scene is None else scene_scores(view, scene, library)


def _arrange(
    view: TruthView,
    observed: Scene | None,
    library: ShapeLibrary,
    ablation: dict[str, list[SceneScores]],
    progress: Progress,
) -> None:
    """Every row of the optimiser's ablation for one room."""
    rows: list[tuple[str, LayoutStage, Scene | None]] = [("none", LeaveAsIs(), observed)]
    rows += [
        (name, PaperRecipe(library, stages=k), observed)
        for k, name in enumerate(("O", "O, P", "O, P, S", "O, P, S, R"), start=1)
    ]
    feasible = layout_recipe("feasible", library)
    rows += [
        ("all-in-one", AllInOneRecipe(library), observed),
        ("feasible", feasible, observed),
        ("true graph", feasible, None if observed is None else with_true_graph(view, observed)),
        ("true architecture", feasible, None if observed is None else with_true_architecture(view, observed)),
    ]
    for name, stage, scene in rows:
        progress.report(0.3, f"layout: {name}")
        arranged = None if scene is None else stage.optimise(scene, Progress())[0]
        ablation.setdefault(name, []).append(_scores(view, arranged, library))


def with_true_graph(view: TruthView, scene: Scene) -> Scene:
    """The prediction with the true support edges among the objects that were found; planes by role and nearness."""
    scene = in_true_world(scene, view)
    truth = [view.scene.objects[k] for k in view.asked]
    names = {t.id: m.id for t, m in zip(truth, matched(truth, scene)) if m is not None}
    edges = []
    for edge in true_supports(view):
        if edge.child in names:
            parent = names.get(edge.parent) or _same_plane(view, scene, edge.parent)
            if parent:
                edges.append(Support(names[edge.child], parent, edge.relation, None, edge.child_face))
    given = {e.child for e in edges}
    rest = tuple(s for s in scene.supports if s.child not in given and s.child not in names.values())
    return replace(scene, supports=(*edges, *rest))


def _same_plane(view: TruthView, scene: Scene, plane_id: str) -> str | None:
    if not view.scene.has_plane(plane_id):
        return None
    true = view.scene.plane(plane_id)
    options = [p for p in scene.architecture.by_role(true.role) if p.normal @ true.normal > 0.8]
    return min(options, key=lambda p: abs(p.offset - true.offset)).id if options else None


def with_true_architecture(view: TruthView, scene: Scene) -> Scene:
    """The prediction in the true room; edges to planes go to the true plane that faces most alike and is nearest."""
    scene = in_true_world(scene, view)
    true = view.scene.architecture
    renamed = {}
    for plane in scene.architecture.planes:
        options = true.by_role(plane.role)
        if options:
            near = min(
                options, key=lambda p: (round(1 - float(p.normal @ plane.normal), 1), abs(p.offset - plane.offset))
            )
            renamed[plane.id] = near.id
    edges = [
        replace(
            s,
            parent=renamed.get(s.parent, s.parent),
            adheres_to=tuple(renamed[w] for w in s.adheres_to if w in renamed),
        )
        for s in scene.supports
        if not scene.has_plane(s.parent) or s.parent in renamed
    ]
    return replace(scene, architecture=true, supports=tuple(edges))


def _count_groups(
    view: TruthView, scene: Scene | None, library: ShapeLibrary, groups: dict[str, list[tuple[float, ...]]]
) -> None:
    truth = [view.scene.objects[k] for k in view.asked]
    match = [None] * len(truth) if scene is None else matched(truth, in_true_world(scene, view))
    true = [as_placed(t, library.shape(t.shape_id).symmetry) for t in truth]
    placed = [None if m is None else as_placed(m) for m in match]
    checks = pair_checks(true, placed)
    others = max(len(truth) - 1, 1)
    for row, index in enumerate(view.asked):
        grids = (checks.rotation[row], checks.translation[row], checks.scale[row])
        every = grids[0] & grids[1] & grids[2]
        shares = [(float(g.sum()) - 1) / others for g in (*grids, every)]
        own = object_alignment([true[row]], [placed[row]]).acc
        item = view.scene.objects[index]
        name = CATEGORY_NAMES.get(item.category, item.category)
        name = name if name in paper.CATEGORIES else "others"
        for group in (*object_groups(view, index), f"category: {name}"):
            groups.setdefault(group, []).append((*shares, own))


def _counted(rows: Sequence[tuple[float, ...]]) -> GroupCounts:
    r, t, s, every, own = (float(x) for x in np.mean(rows, axis=0))
    return GroupCounts(len(rows), r, t, s, every, own)


def pose_table(title: str, rooms: Sequence[SceneScores], published: paper.Rows) -> Table:
    """Alignment, collision and relations before any layout (paper, table 5 and supplement)."""
    columns = (
        Column("rAcc", better="↑"), Column("tAcc", better="↑"), Column("sAcc", better="↑"), Column("Acc", better="↑"),
        Column("collision cm", ".2f", "↓"), Column("relation", better="↑"),
    )  # fmt: skip
    collision, relation = _mean([s.box_overlap_cm for s in rooms]), _mean([s.relation for s in rooms])
    rows = [
        Row(f"embedded, {a.reading}", (*_shares(a), collision, relation))
        for a in (pooled([s.pairs for s in rooms]), pooled([s.every for s in rooms]))
    ]
    note = f"{len(rooms)} rooms, true shapes, classes and masks; collision as overlap of bounding boxes per object."
    return Table(title, columns, (*rows, *paper_rows(published)), note)


def groups_table(groups: Sequence[tuple[str, GroupCounts]]) -> Table:
    """Alignment by group of objects (paper, supplement)."""
    columns = (Column("instances", "d"), *(Column(n, better="↑") for n in ("rAcc", "tAcc", "sAcc", "Acc")))
    known = dict(groups)
    rows = [Row(g, (c.instances, c.r, c.t, c.s, c.every)) for g in GROUPS if (c := known.get(g))]
    return Table("Groups, true depth, mean over pairs", columns, (*rows, *paper_rows(paper.GROUPS)))


def retrievals_table(
    retrievals: Sequence[tuple[int, Sequence[SceneScores], Sequence[SceneScores]]],
) -> Table:
    """Alignment against the number of retrieved shapes (paper, supplement)."""
    names = [f"{n} {d}" for d in ("true depth", "estimated") for n in ("rAcc", "tAcc", "sAcc", "Acc")]
    rows = [
        Row(str(k), (*_shares(pooled([s.pairs for s in a])), *_shares(pooled([s.pairs for s in b]))))
        for k, a, b in retrievals
    ]
    columns = tuple(Column(n, better="↑") for n in names)
    return Table("Shapes retrieved, mean over pairs", columns, (*rows, *paper_rows(paper.RETRIEVALS)))


def ablation_table(ablation: Sequence[tuple[str, Sequence[SceneScores]]]) -> Table:
    """Collision and structure by what of the optimiser runs (paper, table 6)."""
    return _layout_table("Optimiser ablation", [(n, r) for n, r in ablation if n != "all-in-one"], paper.ABLATION)


def all_in_one_table(ablation: Sequence[tuple[str, Sequence[SceneScores]]]) -> Table:
    """All costs at once against stage by stage (paper, supplement)."""
    names = {"all-in-one": "all-in-one", "O, P, S, R": "stage-wise", "feasible": "feasible"}
    rows = [(names[n], r) for n, r in ablation if n in names]
    return _layout_table("All-in-one against stage-wise", rows, paper.ALL_IN_ONE)


def _layout_table(title: str, rows: Sequence[tuple[str, Sequence[SceneScores]]], published: paper.Rows) -> Table:
    columns = (
        Column("collision cm", ".2f", "↓"), Column("orientation", better="↑"), Column("placement", better="↑"),
        Column("overall", better="↑"),
    )  # fmt: skip
    keys = ("box_overlap_cm", "orientation", "placement", "structure")
    ours = [Row(name, tuple(_mean([getattr(s, k) for s in rooms]) for k in keys)) for name, rooms in rows]
    return Table(title, columns, (*ours, *paper_rows(published)))


def category_table(groups: Sequence[tuple[str, GroupCounts]]) -> Table:
    """Percent of objects aligned with their own truth, by Scan2CAD's categories (paper, supplement)."""
    known = dict(groups)
    counts = [known.get(f"category: {c}") for c in paper.CATEGORIES]
    present = [c for c in counts if c is not None]
    total = sum(c.instances for c in present)
    each = [None if c is None else 100 * c.own for c in counts]
    mean = _mean([v for v in each if v is not None])
    instances = 100 * sum(c.own * c.instances for c in present) / total if total else None
    columns = tuple(Column(c, ".1f", "↑") for c in (*paper.CATEGORIES, "class mean", "instance mean"))
    rows = (Row("embedded, true depth and shapes", (*each, mean, instances)), *paper_rows(paper.BY_CATEGORY))
    return Table("Alignment by category (20 cm, 20 degrees, 20 %)", columns, rows)


def _shares(a: Alignment) -> tuple[float, float, float, float]:
    return a.r_acc, a.t_acc, a.s_acc, a.acc


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None
