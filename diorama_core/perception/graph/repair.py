"""Repairs a proposed graph: one supporter for each object, no cycles."""

from __future__ import annotations

from collections.abc import Sequence

from diorama_core.artefacts import SceneGraph
from diorama_core.scene.types import Support


def repaired(
    proposed: Sequence[tuple[Support, float]], fallback: SceneGraph
) -> tuple[tuple[Support, ...], tuple[float, ...], int]:
    """The proposed edges where they can be, the fallback's elsewhere.

    Args:
        proposed: edges with how sure each is, 0 to 1; unknown or repeated children and unknown parents are dropped.
        fallback: one acyclic edge for every object: what the graph shall be about.

    Returns:
        Edges in the fallback's order, their scores, and how many are the fallback's.
    """
    known = {s.child for s in fallback.supports}
    chosen: dict[str, Support] = {}
    score: dict[str, float] = {}
    # The surest first: an edge that would close a cycle with surer ones is the one to go.
    for edge, sure in sorted(proposed, key=lambda pair: (-pair[1], pair[0].child)):
        room = edge.parent in ("floor", "wall", "ceiling")
        if edge.child in known and edge.child not in chosen and (room or edge.parent in known):
            chosen[edge.child], score[edge.child] = edge, sure
            if _cyclic(edge.child, chosen):
                del chosen[edge.child], score[edge.child]
    mended = 0
    for edge, sure in sorted(zip(fallback.supports, fallback.scores, strict=True), key=lambda pair: -pair[1]):
        if edge.child in chosen:
            continue
        mended += 1
        chosen[edge.child], score[edge.child] = edge, sure
        if _cyclic(edge.child, chosen):
            chosen[edge.child], score[edge.child] = Support(edge.child, "floor"), 0.1
    supports = tuple(chosen[s.child] for s in fallback.supports)
    return supports, tuple(score[s.child] for s in supports), mended


def _cyclic(start: str, edges: dict[str, Support]) -> bool:
    """Whether following supporters from an object leads back to it."""
    at, steps = start, 0
    while at in edges and steps <= len(edges):
        at, steps = edges[at].parent, steps + 1
        if at == start:
            return True
    return False
