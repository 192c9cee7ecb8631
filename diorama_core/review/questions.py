"""Questions about a scene: the one whose answer brings the scene nearest to right, by what is expected of the answers,
and what a known length is worth.

An object is right when it is there, of its kind, turned the right way and on its supporter. An answer makes one of
these certain; it is worth the probability that this was wrong times that of everything else about it being right. A
length that is told brings objects to their places that are elsewhere only since everything is too large or too small.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from math import erf, sqrt
from typing import Any, Literal

import numpy as np

from diorama_core.artefacts import LabelledBox
from diorama_core.library.labels import with_article
from diorama_core.library.taxonomy import UNKNOWN, category
from diorama_core.scene.belief import Belief
from diorama_core.scene.room_edits import KNOWN_LENGTH_SIGMA
from diorama_core.scene.types import Scene, SceneObject

SHARP_SHARE = 0.36
"""Share of the picture's height from which a thing's own height is known to 2 % of all others' (`KNOWN_LENGTH_SIGMA`):
its ends are known to .7 % of the picture, by 111 things of 24 rendered rooms."""
IN_PLACE_M = 0.2
"""An object no farther off is in its place (`evaluation.metrics.pose`)."""


def ruler(scene: Scene) -> SceneObject | None:
    """The thing by whose height all lengths are told best: it stands on the floor and is seen whole.

    Of those that are large in the picture it is one of the kind whose heights differ least, as of doors; else it is the
    largest in the picture. None where none is whole.
    """
    if scene.camera is None:
        return None
    height_px = scene.camera.intrinsics.height

    def order(item: SceneObject) -> tuple[float, float, str]:
        share = 0.0 if item.box_px is None else (item.box_px[3] - item.box_px[1]) / height_px
        return (0.0, _height_spread(item), item.id) if share >= SHARP_SHARE else (1.0, -share, item.id)

    return min((o for o in scene.objects if _is_whole(scene, o) and not o.locked), key=order, default=None)


def count_misplaced(scene: Scene, scale_sigma: float) -> float:
    """How many objects, right otherwise, are expected elsewhere since all lengths are wrong by one factor.

    Args:
        scene: with its camera, about which everything grows.
        scale_sigma: standard deviation of the logarithm of the factor.
    """
    if scene.camera is None or scale_sigma <= 0.0:
        return 0.0
    away = [(float(np.linalg.norm(o.pose.position - scene.camera.position)), o.belief) for o in scene.objects]
    return sum(b.right * (1.0 - erf(IN_PLACE_M / max(far * scale_sigma * sqrt(2.0), 1e-9))) for far, b in away if b)


def _is_whole(scene: Scene, item: SceneObject) -> bool:
    edge = scene.support_of(item.id)
    if scene.camera is None or item.box_px is None or item.belief is None or edge is None:
        return False
    k, (x1, y1, x2, y2) = scene.camera.intrinsics, item.box_px
    on_floor = item.category == "door" or (scene.has_plane(edge.parent) and scene.plane(edge.parent).role == "floor")
    margin_x, margin_y = 0.01 * k.width, 0.01 * k.height
    inside = x1 > margin_x and y1 > margin_y and x2 < k.width - margin_x and y2 < k.height - margin_y
    return on_floor and inside and item.category != UNKNOWN.name


def _height_spread(item: SceneObject) -> float:
    """Deviation of the logarithm of a kind's heights, all its modes together."""
    modes = category(item.category).priors
    medians, sigmas = (np.array([getattr(m, name)[2] for m in modes]) for name in ("log_median_xyz", "log_sigma_xyz"))
    return float(np.hypot(np.std(medians), np.mean(sigmas)))


Subject = Literal["presence", "kind", "front", "supporter", "scale", "missing"]
SUBJECTS: tuple[Subject, ...] = ("presence", "kind", "front", "supporter", "scale")
"""Subjects of what a scene holds; what it may lack is asked of the photo (`missing`)."""
YES, NO = "yes", "no"
TURNS = ("as it is", "left", "backwards", "right")
"""Where an object faces, as seen from itself: quarter turns counter-clockwise."""
DIRECTIONS = ("away from the camera", "to the left", "toward the camera", "to the right")
"""Where things face in a photo, by quarter turns counter-clockwise."""
LEAST_GAIN = 0.05
"""Objects that an answer makes right, below which nobody is asked: one in twenty."""


@dataclass(frozen=True)
class Choice:
    """One answer that is offered."""

    value: str
    """What the answer says: yes or no, a category, one of `TURNS`, an id, a length in metres."""
    label: str
    """The answer in words for people."""
    probability: float


@dataclass(frozen=True)
class Question:
    """Something about one object that a person can tell."""

    object_id: str
    """Id of the object; for something that is missing, its box in the photo, x1,y1,x2,y2."""
    subject: Subject
    sentence: str
    choices: tuple[Choice, ...]
    """Likeliest first, what was decided among them; kinds and supporters that are not offered may be answered, too."""
    gain: float
    """How many more objects are right after the answer, as far as can be expected."""

    @property
    def id(self) -> str:
        """Names it within the scene: `kind:chair_1`."""
        return f"{self.subject}:{self.object_id}"

    def to_json(self) -> dict[str, Any]:
        """The question as JSON values."""
        return {"id": self.id, **asdict(self)}


def questions(scene: Scene) -> tuple[Question, ...]:
    """All that is worth asking about a scene, the most helpful question first.

    What a person has decided since the build, by an answer or by an edit, is not asked.
    """
    candidates = [
        q for item in scene.objects if item.belief is not None for q in _object_questions(scene, item, item.belief)
    ]
    length = _length_question(scene)
    candidates += [] if length is None else [length]
    return tuple(sorted((q for q in candidates if q.gain >= LEAST_GAIN), key=lambda q: (-q.gain, q.id)))


def _object_questions(scene: Scene, item: SceneObject, belief: Belief) -> Iterator[Question]:
    edge = scene.support_of(item.id)
    if belief.present < 1.0:
        # Where it is no object, what is right afterwards is that nothing is there.
        gain = (1.0 - belief.present) * (1.0 + belief.right)
        choices = (Choice(YES, "Yes", belief.present), Choice(NO, "Not an object", 1.0 - belief.present))
        yield Question(item.id, "presence", _is_this(item.label), choices, gain)
    if belief.kinds and belief.kinds[0][0] == item.category and belief.kinds[0][1] < 1.0:
        yield _question(item, "kind", _is_this(item.category), belief.kinds, belief, str)
    if belief.fronts and belief.fronts[0] < 1.0 and not item.by_hand:
        turns = tuple(zip(TURNS, belief.fronts, strict=True))
        turns = tuple(turn for turn in turns if turn[1] > 0.0)
        sentence = f"Which way does the {item.label} face?"
        yield _question(item, "front", sentence, turns, belief, lambda turn: _direction(scene, item, turn))
    if (
        belief.supporters
        and edge is not None
        and belief.supporters[0][0] == edge.parent
        and belief.supporters[0][1] < 1.0
    ):
        verb = "hang on" if edge.relation == "mounted on" else "stand on"
        sentence = f"What does the {item.label} {verb}?"
        yield _question(item, "supporter", sentence, belief.supporters, belief, lambda i: name_of(scene, i))


def missing(scene: Scene, box: LabelledBox, present: float) -> Question:
    """Whether something is in a box of the photo that was not built; worth what is right of an object on average.

    Args:
        scene: without the object.
        box: with its likeliest name.
        present: probability that there is an object.
    """
    known = [o.belief.right for o in scene.objects if o.belief is not None]
    gain = present * (sum(known) / len(known) if known else 1.0)
    name = f"Yes, {with_article(box.label)}" if box.category != UNKNOWN.name else "Yes"
    choices = (Choice(YES, name, present), Choice(NO, "Nothing", 1.0 - present))
    ordered = tuple(sorted(choices, key=lambda choice: -choice.probability))
    return Question(",".join(f"{v:.0f}" for v in box.box), "missing", "Is something here?", ordered, gain)


def _length_question(scene: Scene) -> Question | None:
    """How high one thing is, by which all lengths are known; the thing is one that many know or can measure."""
    item = ruler(scene)
    if item is None or scene.scale_sigma is None or scene.scale_sigma <= KNOWN_LENGTH_SIGMA:
        return None
    now = float(item.size_m[2])
    heights = (now, *(float(np.exp(mode.log_median_xyz[2])) for mode in category(item.category).priors))
    lengths = tuple(dict.fromkeys(f"{height:.2f}" for height in heights))[: len(TURNS)]
    off = np.log([float(length) / now for length in lengths]) / scene.scale_sigma
    weights = np.exp(-0.5 * np.minimum(off**2, 50.0))
    choices = sorted(zip(lengths, weights / weights.sum(), strict=True), key=lambda choice: -choice[1])
    gain = count_misplaced(scene, scene.scale_sigma) - count_misplaced(scene, KNOWN_LENGTH_SIGMA)
    labels = tuple(Choice(v, f"{v} m" + (", as it is" if v == lengths[0] else ""), float(p)) for v, p in choices)
    return Question(item.id, "scale", f"How high is the {item.label}?", labels, gain)


def _question(
    item: SceneObject,
    subject: Subject,
    sentence: str,
    shares: tuple[tuple[str, float], ...],
    belief: Belief,
    label: Callable[[str], str],
) -> Question:
    """A question whose first alternative is what was decided.

    Args:
        item: what is asked about.
        subject: of the question.
        sentence: that people read.
        shares: alternatives with their probabilities.
        belief: of the object.
        label: of an alternative's value.
    """
    decided = max(shares[0][1], 1e-6)
    gain = (1.0 - decided) * belief.right / decided
    ordered = sorted(shares, key=lambda share: -share[1])
    return Question(item.id, subject, sentence, tuple(Choice(v, label(v), p) for v, p in ordered), gain)


def _is_this(words: str) -> str:
    named = with_article(words)
    return f"Is this {named}?" if named != words else f"Are these {words}?"


def _direction(scene: Scene, item: SceneObject, turn: str) -> str:
    """Where an object would face after a turn, as one sees it in the photo; the turn itself without a photo."""
    if scene.camera is None:
        return turn
    view = scene.camera.T_world_camera[:2, 2]
    yaw = item.pose.yaw_rad + TURNS.index(turn) * np.pi / 2 - np.arctan2(view[1], view[0])
    return DIRECTIONS[round(yaw / (np.pi / 2)) % len(DIRECTIONS)]


def name_of(scene: Scene, any_id: str) -> str:
    """An object's label or a plane's role, as people read it."""
    if scene.has_object(any_id):
        return f"the {scene.object(any_id).label}"
    plane = scene.plane(any_id)
    same = scene.architecture.by_role(plane.role)
    return f"the {plane.role}" if len(same) == 1 else f"{plane.role} {same.index(plane) + 1}"
