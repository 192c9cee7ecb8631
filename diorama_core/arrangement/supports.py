"""What holds each object of a room: the tree of supports that agrees best with everything that is known.

Every object has one supporter, a plane of the room or another object, and nothing holds itself up. So a support graph
is an arborescence from the room, and the likeliest one is that of least total cost (Edmonds 1967).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import networkx as nx
import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.support_hypotheses import (
    FARTHEST_WIDTHS,
    OBJECT,
    ObservationNoise,
    SupportEvidence,
    SupportHypothesis,
    support_hypotheses,
)
from diorama_core.arrangement.support_terms import SupportWeights, support_weights
from diorama_core.arrangement.surfaces import box_misfit, label_of, object_surfaces
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import AGAINST_WALLS
from diorama_core.scene import edits
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject, Support

NEAREST, FARTHEST = 0.4, 1.6
"""Shares of its distance between which an object is moved along its line of sight to a supporter."""
_SHARES = 49
"""Shares of its distance at which an object is tried on another one: 3 % apart."""
_ROOM = ""
"""Root of the graph."""
LEAST_ODDS = float(np.log(0.7 / 0.3))
"""An object is set against a wall where that is so likely: a wrong wall takes it away from where it was seen."""
ASLANT_COSINE = 0.95
"""A face that is turned farther from a wall does not stand against it: only an edge would touch."""
MAX_TOLERANCES = 6.0
"""What was seen farther from a wall than so many tolerances, on either side, does not stand against it."""


@dataclass(frozen=True)
class SupportChoice:
    """The supporter that was chosen for an object, and why."""

    hypothesis: SupportHypothesis
    shares: dict[str, float]
    """By term, how much more speaks against the next likeliest than against the choice, nats."""
    probabilities: Mapping[str, float]
    """By supporter how likely it is, all other objects staying."""

    @property
    def edge(self) -> Support:
        """The chosen edge."""
        return self.hypothesis.edge


@dataclass(frozen=True)
class DecidedSupports:
    """A scene with its supports decided."""

    scene: Scene
    choices: Mapping[str, SupportChoice]
    """By object."""
    notes: tuple[str, ...]
    """What changed, in plain words."""


def choose_supports(
    hypotheses: dict[str, tuple[SupportHypothesis, ...]], weights: SupportWeights
) -> dict[str, SupportChoice]:
    """The support of every object that has hypotheses, such that all together cost least and there is no cycle."""
    costs = {name: np.array([weights.cost(h) for h in of_one]) for name, of_one in hypotheses.items() if of_one}
    graph = nx.DiGraph()
    by_edge: dict[tuple[str, str], int] = {}
    for name, of_one in costs.items():
        for k in np.argsort(-of_one, kind="stable").tolist():  # of several planes the cheapest is left
            h = hypotheses[name][k]
            parent = h.edge.parent if h.role == OBJECT else _ROOM
            by_edge[parent, name] = k
            graph.add_edge(parent, name, weight=float(of_one[k]))
    if not graph:
        return {}
    graph.add_node(_ROOM)
    tree = nx.minimum_spanning_arborescence(graph)
    chosen = {child: by_edge[parent, child] for parent, child in tree.edges}
    return {name: _choice(hypotheses[name], costs[name], chosen[name], weights) for name in costs}


def _choice(
    of_one: tuple[SupportHypothesis, ...], costs: Float[np.ndarray, " k"], chosen: int, weights: SupportWeights
) -> SupportChoice:
    likely = np.exp(costs.min() - costs)
    others = [k for k in np.argsort(costs, kind="stable").tolist() if k != chosen]
    weights_of_terms = weights.shares(of_one[chosen])
    shares = {} if not others else {n: v - weights_of_terms[n] for n, v in weights.shares(of_one[others[0]]).items()}
    probabilities: dict[str, float] = {}
    for hypothesis, share in zip(of_one, (likely / likely.sum()).tolist(), strict=True):
        probabilities[hypothesis.edge.parent] = probabilities.get(hypothesis.edge.parent, 0.0) + share
    return SupportChoice(of_one[chosen], shares, probabilities)


def with_decided_supports(
    scene: Scene,
    library: ShapeLibrary,
    noise: ObservationNoise,
    evidence: SupportEvidence,
) -> DecidedSupports:
    """The scene in which every object rests on its likeliest supporter and stands against its walls, and why.

    Where distances were reasoned from a photo alone, an object whose supporter is another than the one that gave it its
    distance moves along its line of sight to the new one: it looks the same there.

    Args:
        scene: every object in its observed pose, with the photo's camera.
        library: where shapes come from.
        noise: of the observed poses.
        evidence: what else is known.
    """
    weights = support_weights()
    choices = choose_supports(support_hypotheses(scene, library, noise, evidence), weights)
    moved = scene
    for name in _carriers_first(choices):
        choice, item, before = choices[name], moved.object(name), scene.support_of(name)
        edge = choice.edge
        if before is not None and before.parent == edge.parent and before.relation == edge.relation:
            edge = replace(before, adheres_to=())
        elif not noise.measured and choice.hypothesis.role in ("wall", "ceiling"):
            moved = _move_along_sight(moved, item, _share_to_plane(moved, item, moved.plane(edge.parent)))
        if not noise.measured and choice.hypothesis.role == OBJECT and choice.hypothesis.outside >= FARTHEST_WIDTHS:
            moved = _move_along_sight(moved, item, _share_to_object(moved, item, moved.object(edge.parent), library))
        if choice.hypothesis.role == "floor":
            edge = replace(edge, adheres_to=standing_walls(moved, moved.object(name), noise, weights.walls))
        moved = edits.attach(moved, edge)
    return DecidedSupports(moved, choices, tuple(_changes(scene, moved)))


def _carriers_first(choices: Mapping[str, SupportChoice]) -> list[str]:
    """The objects, each after what holds it."""
    ordered: list[str] = []

    def add(name: str) -> None:
        if name in choices and name not in ordered:
            add(choices[name].edge.parent)
            ordered.append(name)

    for name in choices:
        add(name)
    return ordered


def _changes(before: Scene, after: Scene) -> Iterator[str]:
    """What is held otherwise than before, in plain words."""
    for edge in after.supports:
        old = before.support_of(edge.child)
        if old is not None and old.parent != edge.parent:
            name, new, former = before.object(edge.child).label, edge.parent, old.parent
            verb = "hangs on" if edge.relation == "mounted on" else "rests on"
            yield f"support changed: {name} {verb} {label_of(after, new)}, not {label_of(before, former)}"


def _share_to_plane(scene: Scene, item: SceneObject, plane: Plane) -> float:
    """The share of its distance at which an object touches a plane from the room; 1 where it is out of reach."""
    if scene.camera is None:
        return 1.0
    eye = scene.camera.position
    farthest = float(((item.corners_world - eye) @ plane.normal).min())
    share = (plane.offset - float(eye @ plane.normal)) / farthest if farthest < 0.0 else 1.0
    return share if NEAREST <= share <= FARTHEST else 1.0


def _share_to_object(scene: Scene, item: SceneObject, carrier: SceneObject, library: ShapeLibrary) -> float:
    """The share of its distance at which an object is on another one, as near as possible to where it was seen."""
    if scene.camera is None:
        return 1.0
    eye = scene.camera.position
    places = [place.to_world(carrier.pose) for place in object_surfaces(library.shape(carrier.shape_id), carrier)]
    shares = np.geomspace(NEAREST, FARTHEST, _SHARES)
    corners = eye + shares[:, None, None] * (item.corners_world - eye)
    costs = [
        min(box_misfit(c, share * item.size_m, place) for place in places)
        for share, c in zip(shares, corners, strict=True)
    ]
    return float(shares[np.argmin(costs)])


def _move_along_sight(scene: Scene, item: SceneObject, share: float) -> Scene:
    """The scene with an object at a share of its distance and as much smaller: it looks alike in the photo."""
    if scene.camera is None or share == 1.0:
        return scene
    eye = scene.camera.position

    def nearer(pose: Pose) -> Pose:
        return Pose(pose.R_world_object, eye + share * (pose.position - eye), share * pose.scale)

    candidates = tuple(replace(c, pose=nearer(c.pose)) for c in item.candidates)
    moved = replace(item, pose=nearer(item.pose), candidates=candidates)
    return replace(scene, objects=tuple(moved if o.id == item.id else o for o in scene.objects))


@dataclass(frozen=True)
class WallRelation:
    """How an object stands to a wall."""

    gap: float
    """From the wall, in tolerances of the observation; negative behind it."""
    parallel: float
    """Largest cosine between the wall's normal and an axis of the object."""
    fronted: float
    """Cosine between the object's front and the wall's normal."""
    backed_kind: bool
    """Whether things of its kind have their backs at walls."""


STANDING_TERMS: Mapping[str, Callable[[WallRelation], float]] = {
    "always": lambda r: 1.0,
    "within tolerance": lambda r: min(abs(r.gap), 1.0),
    "beyond tolerance": lambda r: max(abs(r.gap) - 1.0, 0.0),
    "behind": lambda r: float(r.gap < -1.0),
    "aslant": lambda r: min((1.0 - r.parallel) / (1.0 - ASLANT_COSINE), 1.0),
    "fronted": lambda r: r.fronted,
    "backed kind": lambda r: float(r.backed_kind),
    "backed kind fronted": lambda r: float(r.backed_kind) * r.fronted,
}
"""By name a term of the log odds of standing against a wall."""


def wall_relation(scene: Scene, item: SceneObject, wall: Plane, noise: ObservationNoise) -> WallRelation | None:
    """How an object stands to a wall; None where it is beside it, far away or aslant.

    Args:
        scene: whose camera tells how sure positions are.
        item: the object, posed in the world.
        wall: a vertical plane of the room.
        noise: of positions along and across the line of sight.
    """
    along = np.cross([0.0, 0.0, 1.0], wall.normal)
    ends, place = wall.polygon @ along, float(item.pose.position @ along)
    if not ends.min() <= place <= ends.max():
        return None
    gap_m = float((item.corners_world @ wall.normal).min()) - wall.offset
    gap = gap_m / noise.tolerance_m(scene.camera, item.pose.position, wall.normal)
    parallel = float(np.abs(wall.normal @ item.pose.R_world_object).max())
    if abs(gap) > MAX_TOLERANCES or parallel < ASLANT_COSINE:
        return None
    return WallRelation(
        gap,
        parallel,
        float(wall.normal @ item.pose.R_world_object[:, 0]),
        item.category in AGAINST_WALLS,
    )


def standing_walls(
    scene: Scene, item: SceneObject, noise: ObservationNoise, weights: Mapping[str, Mapping[str, float]]
) -> tuple[str, ...]:
    """Walls that an object surely enough stands against, the likeliest first, at most one in each direction.

    Args:
        scene: with the walls.
        item: what stands on its floor.
        noise: of its observed pose.
        weights: by "measured" and "reasoned" those of `STANDING_TERMS`.
    """
    fitted = weights["measured" if noise.measured else "reasoned"]
    odds: list[tuple[float, str]] = []
    for wall in scene.architecture.by_role("wall"):
        relation = wall_relation(scene, item, wall, noise)
        if relation is not None:
            odds.append((sum(fitted[name] * term(relation) for name, term in STANDING_TERMS.items()), wall.id))
    walls: list[str] = []
    for value, name in sorted(odds, key=lambda pair: (-pair[0], pair[1])):
        normal = scene.plane(name).normal
        if value > LEAST_ODDS and all(
            abs(float(normal @ scene.plane(other).normal)) < ASLANT_COSINE for other in walls
        ):
            walls.append(name)
    return tuple(walls)
