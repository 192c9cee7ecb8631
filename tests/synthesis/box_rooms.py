"""Furnishing with boxes: fast, and every size is known."""

from __future__ import annotations

import numpy as np

from diorama_core.synthesis.furnisher import Furnisher, Spread
from diorama_core.synthesis.layout_rooms import COMPOUNDS, BoxLibrary, block
from diorama_core.synthesis.plan import RoomPlan

MORE = (
    block("door", 0.1, 0.9, 2.0), block("window", 0.1, 1.2, 1.2), block("curtain", 0.12, 0.9, 2.2),
    block("radiator", 0.1, 0.9, 0.6), block("bed", 2.05, 1.6, 0.5, top=True), block("desk", 0.7, 1.4, 0.74, top=True),
    block("office chair", 0.5, 0.5, 0.9), block("coffee table", 0.6, 1.0, 0.42, top=True),
    block("tv stand", 0.4, 1.4, 0.5, top=True), block("pillow", 0.12, 0.45, 0.45),
    block("rug", 1.6, 2.2, 0.01, top=True),
    block("armchair", 0.8, 0.8, 0.8), block("ceiling lamp", 0.4, 0.4, 0.4), block("monitor", 0.06, 0.55, 0.4),
    block("keyboard", 0.14, 0.44, 0.02), block("mouse", 0.1, 0.06, 0.03), block("floor lamp", 0.35, 0.35, 1.6),
)  # fmt: skip
LIBRARY = BoxLibrary((*COMPOUNDS, *MORE))
PLAN = RoomPlan(np.array([[-2.5, -2.0], [2.5, -2.0], [2.5, 2.0], [-2.5, 2.0]]), 2.6)


def furnisher(seed: int = 0, plan: RoomPlan = PLAN) -> Furnisher:
    """An empty room; shapes keep their sizes."""
    return Furnisher(plan, LIBRARY, np.random.default_rng(seed), Spread(0.0, 0.0))


def sound(f: Furnisher) -> None:
    """Everything is inside, held up by something that is there, and cuts nothing else."""
    low, high = np.append(f.plan.outline.min(axis=0), 0.0), np.append(f.plan.outline.max(axis=0), f.plan.height_m)
    ids = {o.id for o in f.objects} | {w.id for w in f.plan.walls} | {"floor", "ceiling"}
    edges = {s.child: s for s in f.supports}
    for item in f.objects:
        assert edges[item.id].parent in ids
        corners = item.corners_world
        assert (corners > low - 0.011).all(), item.id
        assert (corners < high + 0.011).all(), item.id
        f.bodies.remove(item.id)
        carried = {s.child for s in f.supports if s.parent == item.id}
        assert f.bodies.hit_by(f.items[item.id], item.pose, ignore=carried) is None, item.id
        f.bodies.add(item.id, f.items[item.id], item.pose)
