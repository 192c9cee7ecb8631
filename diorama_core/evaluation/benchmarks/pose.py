"""Poses and the optimiser on rendered rooms: our solver beside the published ones, groups, shape counts, ablations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import TypeVar

from diorama_core.artefacts import RankedShapes
from diorama_core.evaluation.benchmarks.cases import attempt_one, make_views, recipe
from diorama_core.evaluation.benchmarks.pose_comparison import (
    BASELINES,
    COMPARED_SHAPES,
    CONDITIONS,
    ESTIMATED_DEPTH,
    GIVEN,
    OURS,
    TRUE_DEPTH,
    PoseScores,
    SeenInput,
    SideBySide,
    inputs_with,
    pose_scores,
    predict,
    shapes_of,
)
from diorama_core.evaluation.benchmarks.pose_tables import (
    ObjectShares,
    ablation_table,
    all_in_one_table,
    category_table,
    comparison_table,
    groups_table,
    retrievals_table,
)
from diorama_core.evaluation.benchmarks.retrieval import object_groups
from diorama_core.evaluation.metrics.pose import object_alignment, pair_checks
from diorama_core.evaluation.metrics.scene import Matched, align_to_truth
from diorama_core.evaluation.reports import paper
from diorama_core.evaluation.reports.tables import Table
from diorama_core.layout.published.recipes import AllInOneRecipe, PaperRecipe
from diorama_core.layout.recipes import recipe as layout_recipe
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.given_stages import AsObserved
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import LayoutStage
from diorama_core.scene.types import Scene, Support
from diorama_core.synthesis.artefacts import true_supports
from diorama_core.synthesis.truth import TruthView

RETRIEVALS = (1, 4, 8)
PAPER_LAYOUT = "O, P, S, R"
"""The row of the optimiser's ablation in which all four stages run."""
CATEGORY_NAMES = {"trash can": "bin", "television": "display", "monitor": "display", "desk": "table"}
"""Scan2CAD's names of categories, where they differ."""
_PUBLISHED = {(TRUE_DEPTH, GIVEN): paper.POSE_TRUE_DEPTH, (ESTIMATED_DEPTH, GIVEN): paper.POSE_ESTIMATED_DEPTH}

Name = TypeVar("Name")
Result = TypeVar("Result")


def _rows_of(*names: Name) -> dict[Name, list[PoseScores]]:
    return {name: [] for name in names}


@dataclass(frozen=True)
class PoseBench:
    """Results by name; every list has one entry per room, those of groups one per object."""

    seed: int
    compared: Mapping[tuple[str, str], Mapping[str, list[PoseScores]]] = field(
        default_factory=lambda: {condition: _rows_of(OURS, *BASELINES) for condition in CONDITIONS}
    )
    """By depth and shapes, and by solver."""
    retained: Mapping[str, Mapping[int, list[PoseScores]]] = field(
        default_factory=lambda: {depth: _rows_of(*RETRIEVALS) for depth in (TRUE_DEPTH, ESTIMATED_DEPTH)}
    )
    """By depth and shapes kept."""
    ablation: dict[str, list[PoseScores]] = field(default_factory=dict)
    groups: dict[str, list[ObjectShares]] = field(default_factory=dict)
    """With true depth and true shapes, by group and by "category: ..."."""
    groups_after: dict[str, list[ObjectShares]] = field(default_factory=dict)
    """After the paper's four stages of layout."""

    def tables(self) -> tuple[Table, ...]:
        """The solvers under every condition, then the paper's group, retrieval-count, ablation and category tables."""
        return (
            *(
                comparison_table(f"Pose, {depth}, {shapes}", solvers, _PUBLISHED.get((depth, shapes)))
                for (depth, shapes), solvers in self.compared.items()
            ),
            groups_table(self.groups),
            groups_table(self.groups_after, "after the paper's layout"),
            retrievals_table(*self.retained.values()),
            ablation_table(self.ablation),
            all_in_one_table(self.ablation),
            category_table(self.groups),
        )

    def to_json(self) -> dict[str, object]:
        """Tables and every room."""
        compared = {
            f"{depth}, {shapes}: {name}": rows
            for (depth, shapes), solvers in self.compared.items()
            for name, rows in solvers.items()
        }
        return {
            "bench": "pose",
            "seed": self.seed,
            "tables": [t.to_json() for t in self.tables()],
            "rooms": {name: [asdict(s) for s in rows] for name, rows in (compared | self.ablation).items()},
        }


def run(library: ShapeLibrary, scenes: int = 6, seed: int = 0, progress: Progress = SILENT) -> PoseBench:
    """Pose every room by every solver, with few and many retrieved shapes, and arrange it every way.

    What cannot be done counts as a room in which everything is wrong.

    Args:
        library: where shapes come from.
        scenes: how many rooms.
        seed: of the series of rooms.
        progress: reports and cancellation.
    """
    bench = PoseBench(seed)
    solvers = SideBySide.create_embedded(library)
    cases = recipe(scenes, 1, seed)
    for number, (case, view) in enumerate(make_views(cases, library, [])):
        step = progress.part(number / len(cases), (number + 1) / len(cases))
        _one_room(view, solvers, bench, step, case.name)
    progress.report(1.0, "done")
    return bench


def _one_room(view: TruthView, solvers: SideBySide, bench: PoseBench, progress: Progress, name: str) -> None:
    library = solvers.library
    depths = tuple(dict.fromkeys(depth for depth, _ in CONDITIONS))
    progress.report(0.0, f"{name}: perception")
    seen = {d: _try(predict, inputs_with(view, d), library) for d in depths}
    asked_for = {*bench.retained, *(depth for depth, shapes in CONDITIONS if shapes != GIVEN)}
    retrieved = {d: _retrieve(solvers, seen[d]) for d in depths if d in asked_for}
    for turn, (depth, shapes) in enumerate(CONDITIONS):
        progress.report(0.1 + 0.1 * turn, f"{name}: {depth}, {shapes}")
        scenes = _scenes(view, solvers, seen[depth], retrieved.get(depth), shapes)
        for solver, rows in bench.compared[depth, shapes].items():
            rows.append(pose_scores(view, scenes.get(solver), library))
        if (depth, shapes) == (TRUE_DEPTH, GIVEN):
            _count_groups(view, scenes.get(OURS), library, bench.groups)
            arranged = _arrange(view, scenes.get(OURS), library, bench.ablation, progress)
            _count_groups(view, arranged.get(PAPER_LAYOUT), library, bench.groups_after)
    for depth, by_count in bench.retained.items():
        for k, rows in by_count.items():
            progress.report(0.8, f"{name}: {k} shapes kept, {depth}")
            first = _firsts(retrieved[depth], k)
            at_hand = seen[depth]
            scene = None if at_hand is None or first is None else _try(solvers.our_scene, at_hand, first)
            rows.append(pose_scores(view, scene, library))


def _retrieve(solvers: SideBySide, seen: SeenInput | None) -> tuple[RankedShapes, ...] | None:
    """One more shape of every object than any table keeps."""
    return None if seen is None else _try(solvers.retrieve, seen, max(RETRIEVALS) + 1)


def _firsts(retrieved: tuple[RankedShapes, ...] | None, count: int) -> tuple[RankedShapes, ...] | None:
    return None if retrieved is None else tuple(replace(r, ranked=r.ranked[:count]) for r in retrieved)


def _scenes(
    view: TruthView,
    solvers: SideBySide,
    seen: SeenInput | None,
    retrieved: tuple[RankedShapes, ...] | None,
    shapes: str,
) -> Mapping[str, Scene]:
    if seen is None or (retrieved is None and shapes != GIVEN):
        return {}
    chosen = shapes_of(solvers.true_shapes(view, seen), retrieved or (), shapes, COMPARED_SHAPES)
    return _try(solvers.scenes, seen, chosen) or {}


def _try(work: Callable[..., Result], *given: object) -> Result | None:
    """The result, or None when a stage failed."""
    return attempt_one("a room", work, *given)[0]


def _arrange(
    view: TruthView,
    observed: Scene | None,
    library: ShapeLibrary,
    ablation: dict[str, list[PoseScores]],
    progress: Progress,
) -> Mapping[str, Scene]:
    """Every row of the optimiser's ablation for one room; the arranged scenes by row."""
    feasible = layout_recipe("feasible", library)
    graph = None if observed is None else with_true_graph(view, observed)
    room = None if observed is None else with_true_architecture(view, observed)
    stages = (PaperRecipe(library, stages=k) for k in range(1, 5))
    rows: list[tuple[str, LayoutStage, Scene | None]] = [
        ("none", AsObserved(), observed),
        *((name, stage, observed) for name, stage in zip(("O", "O, P", "O, P, S", PAPER_LAYOUT), stages, strict=True)),
        ("all-in-one", AllInOneRecipe(library), observed),
        ("feasible", feasible, observed),
        ("true graph", PaperRecipe(library), graph),
        ("true architecture", PaperRecipe(library), room),
        ("feasible, true graph", feasible, graph),
        ("feasible, true architecture", feasible, room),
    ]
    scenes: dict[str, Scene] = {}
    for name, stage, scene in rows:
        progress.report(0.3, f"layout: {name}")
        arranged = None if scene is None else _try(stage.optimise, scene, Progress())
        ablation.setdefault(name, []).append(pose_scores(view, None if arranged is None else arranged[0], library))
        if arranged is not None:
            scenes[name] = arranged[0]
    return scenes


def with_true_graph(view: TruthView, scene: Scene) -> Scene:
    """The prediction with the true support edges among the objects that were found; planes by role and nearness."""
    matched = Matched.of(view, scene)
    scene, names = matched.scene, {true: item.id for true, item in matched.counterparts.items()}
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
    scene = align_to_truth(scene, view)
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
    view: TruthView, scene: Scene | None, library: ShapeLibrary, groups: dict[str, list[ObjectShares]]
) -> None:
    true, placed = Matched.of(view, Scene() if scene is None else scene).poses(library)
    checks = pair_checks(true, placed)
    grids, others = (checks.rotation, checks.translation, checks.scale, checks.all_three), max(len(true) - 1, 1)
    for row, index in enumerate(view.indices):
        shares = [(float(g[row].sum()) - 1) / others for g in grids]
        accuracy = object_alignment([true[row]], [placed[row]]).acc
        item = view.scene.objects[index]
        name = CATEGORY_NAMES.get(item.category, item.category)
        name = name if name in paper.CATEGORIES else "others"
        for group in (*object_groups(view, index), f"category: {name}"):
            groups.setdefault(group, []).append((*shares, accuracy))
