"""Why each object is where and what it is, from what the steps of the plan found: terms, stages and late rules."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diorama_core.arrangement.explain import SCALE, reasons_of_change
from diorama_core.arrangement.noise import ObservationNoise
from diorama_core.artefacts import DetectedObject, Inputs, ObjectGeometry, PosedCandidates, Reason, SceneGraph
from diorama_core.library.labels import is_named, meanings, with_article
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.pipeline.findings import graph_sentence
from diorama_core.pipeline.steps import Corrected, LaidOut
from diorama_core.retrieval.seen_kinds import as_it_looks
from diorama_core.scene.types import Scene


def reasons_of_build(
    given: Inputs,
    inputs: Inputs,
    objects: tuple[DetectedObject, ...],
    geometry: ObjectGeometry,
    graph: SceneGraph | None,
    posed: Sequence[PosedCandidates],
    noise: ObservationNoise,
    corrected: Corrected,
    settled: LaidOut,
    refined: LaidOut,
) -> tuple[Reason, ...]:
    """The reasons for everything that was decided about the objects of the scene, by object.

    Args:
        given: what the user gave.
        inputs: the same, with what networks added.
        objects: what was outlined.
        geometry: cuboids, with the reasons of the stage that measured them.
        graph: what holds up what, where a stage decided that.
        posed: candidates, with the reasons of the stage that posed them.
        noise: of observed positions.
        corrected: the scene before its layout, with the reasons of the rules that changed it.
        settled: the scene after the layout.
        refined: the scene after the refinement.
    """
    named_by = "you" if given.boxes or given.instances is not None else "the detector"
    scene, kinds = refined.scene, {item.id: item.category for item in refined.scene.objects}
    reasons = [r for o in objects if o.id in kinds for r in _of_kind(o, kinds[o.id], named_by)]
    reasons += [r for p in posed for r in p.reasons or ()]
    reasons += geometry.reasons or ()
    reasons += _of_depth(inputs, geometry, noise) + _of_supports(graph, scene)
    reasons += corrected.reasons
    reasons += reasons_of_change(corrected.scene, settled.scene, "layout", "it rests on something, clear of the others")
    reasons += reasons_of_change(settled.scene, scene, "refinement", "its outline fits the photo better there")
    order = {item.id: k for k, item in enumerate(scene.objects)}
    return tuple(sorted((r for r in reasons if r.object_id in order), key=lambda r: order[r.object_id]))


def _of_kind(item: DetectedObject, kind: str, named_by: str) -> list[Reason]:
    """How much likelier its word, its picture and its place make a kind than kinds are on average."""
    named, reasons = is_named(item.label), []
    by_word: Mapping[str, float] = meanings(item.label, item.category)
    if named and kind in by_word:
        nats = float(np.log(by_word[kind] * len(CATEGORIES)))
        reasons.append(_kind_reason(item, "word", nats, f"named “{item.label}” by {named_by}"))
    seen = dict(item.looks_like)
    if seen:
        share = seen.get(kind, 0.0)
        nats = float(np.log(max(share, SCALE.rare) * len(seen)))
        looks = f"looks like {with_article(kind)}" if nats > 0 else f"hardly looks like {with_article(kind)}"
        reasons.append(_kind_reason(item, "picture", nats, f"it {looks} in the photo"))
    before, after = as_it_looks(by_word, item.looks_like, named), dict(item.meanings)
    if kind in after and before.get(kind, 0.0) > 0:
        nats = float(np.log(max(after[kind], SCALE.rare) / max(before[kind], SCALE.rare)))
        fits = "fit" if nats > 0 else "speak against"
        reasons.append(_kind_reason(item, "box", nats, f"its place and size in the photo {fits} {with_article(kind)}"))
    return reasons


def _kind_reason(item: DetectedObject, term: str, nats: float, sentence: str) -> Reason:
    return Reason(item.id, "kind", term, nats, "nats", sentence)


def _of_depth(inputs: Inputs, geometry: ObjectGeometry, noise: ObservationNoise) -> list[Reason]:
    """Where distances were measured, that places them."""
    if inputs.depth_m is None:
        return []
    nats = min(0.5 * (SCALE.change / noise.along) ** 2, SCALE.max_nats)
    word = "depth was measured there"
    return [Reason(c.object_id, "place", "depth", nats, "nats", word) for c in geometry.cuboids]


def _of_supports(graph: SceneGraph | None, scene: Scene) -> list[Reason]:
    """How sure the graph is of what holds an object, where it still is what the graph says."""
    if graph is None:
        return []
    parents = {edge.child: edge.parent for edge in scene.supports}
    roles = {p.id: p.role for p in scene.architecture.planes}
    reasons = []
    for edge, score in zip(graph.supports, graph.scores, strict=True):
        now = parents.get(edge.child)
        if now is not None and edge.parent in (now, roles.get(now)):
            share = float(np.clip(score, SCALE.rare, 1.0 - SCALE.rare))
            nats = float(np.log(share / (1.0 - share)))
            reasons.append(Reason(edge.child, "support", "graph", nats, "nats", graph_sentence(graph)))
    return reasons
