"""How sure a build is of a scene, from what its steps compared: probabilities and standard deviations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from diorama_core.arrangement.support_hypotheses import ObservationNoise
from diorama_core.arrangement.supports import DecidedSupports
from diorama_core.artefacts import Inputs, ObjectGeometry, PosedCandidates
from diorama_core.library.record import ShapeLibrary, record_of
from diorama_core.library.taxonomy import UNKNOWN, having
from diorama_core.perception.drawn_boxes import find_drawn_box
from diorama_core.pipeline.scene_steps import FinishedScene
from diorama_core.scene.belief import CERTAIN_FRONT, Belief, Shares
from diorama_core.scene.room_edits import KNOWN_LENGTH_SIGMA
from diorama_core.scene.types import Plane, Scene, SceneObject

QUARTER_RAD = np.pi / 2
_NO_FRONT = having("no_front")


@dataclass(frozen=True)
class BeliefSettings:
    """How what the steps compared becomes probabilities; scores of kinds and supporters are probabilities as they are.

    Fitted on 37 annotated photos for the highest likelihood; docs/benchmark.md shows how they hold on photos left out.
    """

    present: tuple[float, float] = (-1.51, 1.59)
    """Log odds that a box of the shipped detector is right: at even odds of its score, and how they rise with these."""
    kind: float = 1.2
    """Power of the probabilities of kinds of what nobody named."""
    front: float = 0.34
    """Power of the probabilities of headings: the terms they are made of are not as independent as they are taken."""
    front_compared: float = 0.69
    """Share of the probability that the decided front has for itself: poses were compared closely to find it."""
    rare: float = 1e-3
    """Least probability of what was decided."""
    told: int = 4
    """Alternatives that are told."""
    foot_hidden: float = 0.13
    """Spread of the distance where no foot is seen, as its share: measured on rendered rooms (docs/benchmark.md)."""
    hung: float = 0.08
    """Spread of the distance of things on walls and ceilings, as its share."""
    wall_m: tuple[float, float] = (0.2, 0.4)
    """Spread of the places of walls that are seen and of those that are assumed, in a room without measured depth: of
    45 and 9 walls of 24 rendered rooms."""
    ceiling_m: float = 0.12
    """Likewise of the height of the ceiling, of 8."""


SETTINGS = BeliefSettings()


def with_beliefs(
    finished: FinishedScene,
    inputs: Inputs,
    geometry: ObjectGeometry,
    posed: Sequence[PosedCandidates],
    supports: DecidedSupports,
    noise: ObservationNoise,
    library: ShapeLibrary,
    settings: BeliefSettings = SETTINGS,
) -> Scene:
    """The finished scene with how sure the build is of its scale, of its planes and of every object.

    Args:
        finished: the scene.
        inputs: boxes of a detector tell how likely each object is there; those that a person drew are certain.
        geometry: tells whose lower ends the photo shows.
        posed: candidates and headings of the objects, with their probabilities.
        supports: what may hold each object.
        noise: of observed positions.
        library: knows the kinds of shapes.
        settings: how probabilities are made.
    """
    scene, headings = finished.scene, {p.object_id: p.headings for p in posed}
    feet = {c.object_id for c in geometry.cuboids if c.foot_seen}

    def with_belief(item: SceneObject) -> SceneObject:
        choice, edge = supports.choices.get(item.id), scene.support_of(item.id)
        drawn = None if item.box_px is None else find_drawn_box(inputs.boxes, item.box_px)
        is_named = drawn is not None and drawn.category != UNKNOWN.name
        holders = {} if choice is None or edge is None else choice.probabilities
        sigma = _distance_sigma(scene, item, noise, settings, foot_seen=item.id in feet)
        belief = Belief(
            presence_of(drawn.score, settings) if drawn is not None and drawn.guessed and drawn.score < 1.0 else 1.0,
            _sort_alternatives(
                _kinds(item, library, 1.0 if is_named else settings.kind),
                record_of(library, item.shape_id).category,
                settings,
            ),
            _fronts(item, headings.get(item.id, ()), library, settings),
            () if edge is None or not holders else _sort_alternatives(holders, edge.parent, settings),
            round(float(np.hypot(sigma * _distance_m(scene, item), noise.across_m)), 3),
            round(sigma, 3),
        )
        return replace(item, belief=belief)

    planes = tuple(replace(p, sigma_m=_plane_sigma(scene, p, noise, settings)) for p in scene.architecture.planes)
    known = KNOWN_LENGTH_SIGMA if inputs.camera_height_m is not None else noise.along if noise.measured else None
    return replace(
        scene,
        architecture=replace(scene.architecture, planes=planes),
        objects=tuple(with_belief(item) for item in scene.objects),
        scale_sigma=geometry.scale_sigma if known is None else known,
    )


def _plane_sigma(scene: Scene, plane: Plane, noise: ObservationNoise, settings: BeliefSettings) -> float | None:
    """Standard deviation of a plane's place; the floor is where the scale has it, which has a deviation of its own."""
    if plane.role == "floor" or scene.camera is None:
        return 0.0 if plane.role == "floor" else None
    if noise.measured and plane.is_seen:
        away = abs(float(plane.normal @ scene.camera.position) - plane.offset)
        return round(float(np.hypot(noise.along * away, noise.across_m)), 3)
    return settings.ceiling_m if plane.role == "ceiling" and plane.is_seen else settings.wall_m[not plane.is_seen]


def presence_of(score: float, settings: BeliefSettings = SETTINGS) -> float:
    """Probability that there is an object in a box of the shipped detector with this score."""
    start, slope = settings.present
    odds = start + slope * float(np.log(max(score, settings.rare) / max(1.0 - score, settings.rare)))
    return round(float(1.0 / (1.0 + np.exp(-odds))), 3)


def _kinds(item: SceneObject, library: ShapeLibrary, power: float) -> dict[str, float]:
    """By category the power of the score of its best candidate, as a probability."""
    best: dict[str, float] = {}
    for candidate in item.candidates:
        kind = record_of(library, candidate.shape_id).category
        best[kind] = max(best.get(kind, 0.0), candidate.score)
    powers = {kind: max(score, 0.0) ** power for kind, score in best.items()}
    whole = sum(powers.values())
    return {kind: score / whole for kind, score in powers.items()} if whole > 0.0 else {}


def _fronts(
    item: SceneObject, headings: tuple[float, ...], library: ShapeLibrary, settings: BeliefSettings
) -> tuple[float, ...]:
    """Probabilities of the four quarter turns from where it faces on; what looks the same is added to the first."""
    if item.category in _NO_FRONT:
        return CERTAIN_FRONT
    if not headings:
        return ()
    steps = np.arange(len(headings)) * 2 * np.pi / len(headings)
    quarters = np.rint((steps - item.pose.yaw_rad) / QUARTER_RAD).astype(int) % 4
    shares = np.bincount(quarters, np.array(headings) ** settings.front, 4)
    fold = record_of(library, item.shape_id).symmetry
    if fold > 2:
        shares = np.array([shares.sum(), 0.0, 0.0, 0.0])
    elif fold == 2:
        shares = np.array([shares[0] + shares[2], shares[1] + shares[3], 0.0, 0.0])
    compared = settings.front_compared * np.array([1.0, 0.0, 0.0, 0.0])
    return tuple(np.round(compared + (1.0 - settings.front_compared) * shares / shares.sum(), 4).tolist())


def _distance_sigma(
    scene: Scene, item: SceneObject, noise: ObservationNoise, settings: BeliefSettings, *, foot_seen: bool
) -> float:
    """Standard deviation of an object's distance, as its share; its size is as far wrong."""
    edge = scene.support_of(item.id)
    if noise.measured:
        return noise.along
    if edge is not None and edge.relation == "mounted on":
        return settings.hung
    return noise.along if foot_seen else settings.foot_hidden


def _distance_m(scene: Scene, item: SceneObject) -> float:
    return 0.0 if scene.camera is None else float(np.linalg.norm(item.pose.position - scene.camera.position))


def _sort_alternatives(shares: Mapping[str, float], decided: str, settings: BeliefSettings) -> Shares:
    """The likeliest alternatives, what was decided before all others."""
    others = sorted(((n, p) for n, p in shares.items() if n != decided), key=lambda pair: (-pair[1], pair[0]))
    chosen = ((decided, max(shares.get(decided, 0.0), settings.rare)), *others)[: settings.told]
    return tuple((name, round(share, 4)) for name, share in chosen if share >= settings.rare)
