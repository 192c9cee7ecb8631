"""The layout recipes by name, behind one protocol."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from diorama_core.artefacts import LayoutReport
from diorama_core.errors import InputError
from diorama_core.geometry.rooms import part_of_home, rooms_of_objects
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.settings import AS_IT_IS, Weights
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.protocols import LayoutStage, Preview
from diorama_core.scene.types import Scene


@dataclass(frozen=True)
class RoomByRoom:
    """A recipe that lays out each room of a home by itself; nothing moves from room to room."""

    stage: LayoutStage

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """Optimise the layout of every room; see `LayoutStage`."""
        if not scene.rooms:
            return self.stage.optimise(scene, progress, preview)
        whole, reports, in_rooms = scene, [], rooms_of_objects(scene)
        for number, room in enumerate(scene.rooms):
            if room.id not in in_rooms.values():
                continue

            def preview_part(part: Scene, costs: Sequence[tuple[str, float]], whole: Scene = whole) -> None:
                if preview is not None:
                    preview(_with_part(whole, part), costs)

            share = progress.part(number / len(scene.rooms), (number + 1) / len(scene.rooms))
            part, report = self.stage.optimise(part_of_home(whole, [room.id]), share, preview_part)
            whole = _with_part(whole, part)
            reports.append(report)
        if not reports:
            return self.stage.optimise(scene, progress, preview)
        return whole, LayoutReport(
            reports[0].recipe,
            _sum_costs([r.before for r in reports]),
            _sum_costs([r.after for r in reports]),
            sum(r.seconds for r in reports),
            tuple(reason for r in reports for reason in r.reasons),
            tuple(d for r in reports for d in r.disagreements),
        )


def _with_part(scene: Scene, part: Scene) -> Scene:
    """A home with objects and supports as one of its rooms has them."""
    changed = {o.id: o for o in part.objects}
    held = {s.child: s for s in part.supports}
    supports = tuple(s for s in scene.supports if s.child not in held)
    objects = tuple(changed.get(o.id, o) for o in scene.objects)
    return replace(scene, objects=objects, supports=(*supports, *held.values()))


def _sum_costs(costs: Sequence[Mapping[str, float]]) -> dict[str, float]:
    return {name: sum(c.get(name, 0.0) for c in costs) for c in costs for name in c}


NAMES = ("feasible", "paper", "all-in-one")
"""The default first."""


def recipe(
    name: str,
    library: ShapeLibrary,
    only: frozenset[str] | None = None,
    *,
    depth_measured: bool = False,
    sizes_reasoned: bool = False,
    weights: Weights = AS_IT_IS,
) -> LayoutStage:
    """The recipe of this name.

    Args:
        name: "feasible" (exact and fast, the default), "paper" (the published four stages) or "all-in-one" (every
            term at once, the paper's ablation).
        library: where shapes come from.
        only: ids free to move; everything else is constant.
        depth_measured: the observed distances were measured, not reasoned: the default recipe then keeps to them.
        sizes_reasoned: a photo alone gave distances and sizes: the default recipe then changes them together.
        weights: factors on what each cost counts; those a recipe does not know make no difference to it.

    Raises:
        InputError: when there is no such recipe.
    """
    if name == "feasible":
        depth_weight = 1.0 if depth_measured else FeasibleRecipe.depth_weight
        return FeasibleRecipe(
            library,
            only,
            depth_measured=depth_measured,
            depth_weight=depth_weight,
            sizes_reasoned=sizes_reasoned,
            weights=weights,
        )
    # torch takes two seconds to load, and the default recipe does without it.
    from diorama_core.layout.published.recipes import AllInOneRecipe, PaperRecipe

    if name == "paper":
        return PaperRecipe(library, only, weights=weights)
    if name == "all-in-one":
        return AllInOneRecipe(library, only, weights=weights)
    raise InputError(f"there is no layout recipe {name!r}; choose one of {', '.join(NAMES)}")
