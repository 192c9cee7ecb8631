"""Hierarchical retrieval: the category group first, then size, silhouette and looks."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import fsum

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Cuboid, DetectedObject, Inputs, LabelledBox, ObjectGeometry, RankedShapes
from diorama_core.geometry.observed import Observed, observe_among
from diorama_core.geometry.see_through import SeeThrough
from diorama_core.geometry.shape_appearance import SHARED_APPEARANCES, ShapeAppearance
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.io.large_libraries import load_open3d
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.labels import is_named
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import NEVER_OPEN, UNKNOWN, Mount, category, having
from diorama_core.progress import Progress
from diorama_core.retrieval.appearance_similarity import (
    EMBEDDED_FEATURES,
    AppearanceSimilarity,
    EmbeddedSimilarity,
    ObjectCrop,
)
from diorama_core.retrieval.neighbours import with_neighbours
from diorama_core.retrieval.outlines import outline_agreement, whole_outline
from diorama_core.retrieval.pools import Pool, RetrievalQuery, pool_for, size_cost
from diorama_core.retrieval.seen_forms import form_likelihood_factor, shape_form
from diorama_core.retrieval.seen_kinds import as_measured
from diorama_core.retrieval.settings import SETTINGS, RankingSettings, RetrievalSettings
from diorama_core.retrieval.usual_forms import usual_form_factor
from diorama_core.retrieval.word_senses import sense_probabilities
from diorama_core.retrieval.words import words_factor
from diorama_core.scene.types import Support, yaw_rotation

_SEATS = having("single_seat")
_MOUNTS: Mapping[str, tuple[Mount, ...]] = {"wall": ("wall",), "ceiling": ("ceiling",)}


@dataclass(frozen=True)
class HierarchicalRetrieval:
    """Ranks a category's shapes by what the photo shows of the object (paper, section 3.2).

    The paper's text query becomes the category's pool and what words say beyond it, its image query the agreement of
    size, silhouette and looks, which are compared with rendered views, or in a joint embedding of words, pictures and
    shapes where one is at hand.
    Objects of one category and size are ranked together, so that four dining chairs are four of a kind.
    """

    library: ShapeLibrary
    keep: int = 8
    """Number of candidates per object."""
    cells: int = 36
    """Resolution of the silhouettes, both ways."""
    size_weight: float = 0.3
    silhouette_weight: float = 0.4
    """Weight of a mask that can be trusted; less for doubtful ones."""
    similarity_weight: float = 1.3
    """Weight for an object that is seen whole; less, down to a quarter, for cut, hidden and badly outlined ones."""
    similarity: AppearanceSimilarity | None = None
    """Compares looks; by colours, outline and edges where None."""
    settings: RetrievalSettings = SETTINGS

    def __repr__(self) -> str:
        weights = (self.size_weight, self.silhouette_weight, self.similarity_weight)
        numbers = (self.keep, self.cells, *weights, self.settings)
        appearances = EMBEDDED_FEATURES if self.similarity is None else repr(self.similarity)
        return f"HierarchicalRetrieval({_fingerprint(self.library)}, {', '.join(map(str, numbers))}, {appearances})"

    def retrieve(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> tuple[RankedShapes, ...]:
        """Ranked shapes of every object that has a cuboid, in the order of `objects`.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.RetrievalStage`.
        """
        cuboids = {c.object_id: c for c in geometry.cuboids}
        measured = [o for o in objects if o.id in cuboids]
        sizes = [cuboids[o.id].size_m for o in measured]
        named = [is_named(o.label) for o in measured]
        ranking = self.settings.ranking
        kinds = [o.category if n else UNKNOWN.name for o, n in zip(measured, named, strict=True)]
        groups = _groups(kinds, sizes, ranking)
        senses = _senses(measured, [cuboids[o.id] for o in measured], geometry, self.settings)
        pools = self._pools(measured, sizes, groups, geometry.supports, senses)
        centres = np.array([cuboids[o.id].centre for o in measured]).reshape(-1, 3)
        parents = _parent_indices(measured, geometry.supports)
        similarity = self.similarity or EmbeddedSimilarity(self.library, settings=self.settings.similarity)
        scores: list[dict[str, float]] = []
        sight: list[float] = []
        for index, item in enumerate(measured):
            progress.report(index / len(measured), f"Looking for shapes: {item.label}")
            seen = observe_among(geometry.camera, measured, centres, parents, index, self.cells)
            members = pools[groups[index]].members
            visible = (1 - seen.border_share) * (1 - seen.hidden_share) * seen.mask_trust
            colours = None if item.category in NEVER_OPEN else SeeThrough.of(inputs.photo.rgb, seen)
            observed = _Observation(cuboids[item.id], seen, whole_outline(seen), visible, named[index], colours)
            object_crop = ObjectCrop(inputs.photo.rgb, item.mask, item.label, visible, seen.mask_trust)
            alike = similarity.similarities(object_crop, [m.shape for m in members])
            words, word_note = words_factor(
                self.library, item.label, item.category, [m.shape for m in members], ranking
            )
            described = (word_note == 1) & (word_note < 1).any()
            factors = [
                m.kind_factor * float(w) * self._form_factor(m.shape, item, described=d)
                for m, w, d in zip(members, words, described.tolist(), strict=True)
            ]
            sight.append(visible)
            scores.append(
                {
                    m.shape.id: factor * self._score(m.shape, observed, float(like))
                    for m, like, factor in zip(members, alike, factors, strict=True)
                }
            )
        means = _means(groups, scores, sight, ranking)
        kind_of = {m.shape.id: m.shape.category for pool in pools for m in pool.members}
        return tuple(
            RankedShapes(
                item.id, _best(scores_of_object, mean, self.keep, kind_of, ranking, named=n), pools[group].note
            )
            for item, scores_of_object, mean, group, n in zip(measured, scores, means, groups, named, strict=True)
        )

    def ahead(self, boxes: Sequence[LabelledBox]) -> Iterator[None]:
        """Load what is compared of the shapes of these kinds, step by step: all of those that are few enough."""
        load_open3d()
        repr(self)  # the libraries remember the names of all shapes' geometry, of which the stage's own name is made
        similarity = self.similarity or EmbeddedSimilarity(self.library, settings=self.settings.similarity)
        for kind in dict.fromkeys(box.category for box in boxes if is_named(box.label)):
            shapes = self.library.in_category(kind)
            for shape in shapes if len(shapes) <= self.settings.pools.named_pool else ():
                yield
                if isinstance(similarity, EmbeddedSimilarity):
                    similarity.prepare(shape)
                appearance = self._appearance(shape)
                shape_form(self.library, shape, appearance)
                usual_form_factor(self.library, shape, appearance, self.settings.forms)
                _ = appearance.caster

    def _pools(
        self,
        measured: Sequence[DetectedObject],
        sizes_m: Sequence[np.ndarray],
        groups: Sequence[int],
        supports: Sequence[Support],
        senses: Sequence[Mapping[str, float]],
    ) -> list[Pool]:
        """One pool per group of alike objects."""
        holders = {s.parent for s in supports}
        pools = []
        for group in range(max(groups, default=-1) + 1):
            members = [i for i, g in enumerate(groups) if g == group]
            first = measured[members[0]]
            query = RetrievalQuery(
                category=first.category,
                size_m=np.exp(np.median([np.log(np.maximum(sizes_m[i], 1e-3)) for i in members], axis=0)),
                supports_objects=any(measured[i].id in holders for i in members),
                senses=_mean_senses([senses[i] for i in members]),
                named=is_named(first.label),
            )
            pools.append(pool_for(self.library, query, self.settings.pools))
        return pools

    def _score(self, shape: Shape, item: _Observation, like: float) -> float:
        """0 to 1: the best of the shape's quarter turns in the cuboid, and its likeness."""
        appearance = self._appearance(shape)
        targets, poses = quarter_turns(shape, item.cuboid)
        cost = np.array([size_cost(shape.size_m, t) for t in targets])
        silhouettes = item.seen.silhouettes(appearance.caster, poses)
        outline = outline_agreement(item.seen, item.whole, silhouettes, self.settings.similarity)
        of_size, of_outline, of_appearances = self._weights(item)
        fit = of_size * np.exp(-cost / 2) + of_outline * outline
        score = float((fit.max() + of_appearances * like) / (of_size + of_outline + of_appearances))
        if item.see_through is None:
            return score
        open_alike = float(item.see_through.agreement(silhouettes).max())
        ranking = self.settings.ranking
        return score * (open_alike + ranking.roughly) ** (ranking.of_see_through * item.see_through.share)

    def _appearance(self, shape: Shape) -> ShapeAppearance:
        folder = default_cache_dir() / "appearances"
        return SHARED_APPEARANCES.get(shape.content_hash, folder, lambda: self.library.parts(shape.id))

    def _form_factor(self, shape: Shape, item: DetectedObject, *, described: bool) -> float:
        """Agreement of the shape's form with what was seen; how usual it is, where the mask can hardly tell.

        What the label describes is as usual as can be.
        """
        appearance = self._appearance(shape)
        seen, settings = 1.0, self.settings.forms
        if item.seen_form:
            seen = form_likelihood_factor(shape_form(self.library, shape, appearance), item.seen_form, settings)
        if described or item.mask_confidence >= 1.0:
            return seen
        return seen * usual_form_factor(self.library, shape, appearance, settings)

    def _weights(self, item: _Observation) -> tuple[float, float, float]:
        """Weights of size, outline and appearance for an object with this visibility."""
        by = self.settings.ranking
        sized = 1 - by.guessed_size * (1 - item.visible)
        outlined = 0.25 + 0.75 * item.seen.mask_trust
        return (
            self.size_weight * sized * (1.0 if item.named else by.unnamed_size),
            self.silhouette_weight * outlined * (1.0 if item.named else by.unnamed_outline),
            self.similarity_weight * (by.min_similarity + (1 - by.min_similarity) * item.visible),
        )


@dataclass(frozen=True, eq=False)
class _Observation:
    """What the picture says of one object."""

    cuboid: Cuboid
    seen: Observed
    whole: Float[np.ndarray, " n"]
    """`outlines.whole_outline`."""
    visible: float
    """0 to 1: how much of it is seen, and how well."""
    named: bool
    see_through: SeeThrough | None
    """Where one looks past it; None where its mask tells."""


def _senses(
    objects: Sequence[DetectedObject],
    cuboids: Sequence[Cuboid],
    geometry: ObjectGeometry,
    settings: RetrievalSettings = SETTINGS,
) -> list[Mapping[str, float]]:
    """For every object how likely its word means each kind, by its box, its height, its size and its neighbours.

    A thing without a name was measured as what it was taken for, so that its size says nothing more.
    """
    camera = geometry.camera
    by_box = sense_probabilities(objects, camera.intrinsics, camera.T_world_camera[:3, :3], float(camera.position[2]))
    parent_of = {s.child: s.parent for s in geometry.supports}
    weights: list[Mapping[str, float]] = []
    for item, cuboid, senses in zip(objects, cuboids, by_box, strict=True):
        named = is_named(item.label)
        mounts = _mounts_at(parent_of.get(item.id), named=named)
        other = settings.ranking.other_mount if named else settings.ranking.other_mount_of_unnamed
        sized = as_measured(senses, cuboid.size_m, settings.sizes) if named else senses
        weights.append({kind: p * (1.0 if category(kind).mount in mounts else other) for kind, p in sized.items()})
    return with_neighbours(weights, objects, cuboids, geometry.supports, settings.ranking)


def _mounts_at(parent: str | None, *, named: bool) -> tuple[Mount, ...]:
    """How kinds are held of which something is that the geometry found there.

    What a person calls a pillow may lie on the floor; what nobody named is likelier something that stands there.
    """
    if parent == "floor" and not named:
        return ("floor",)
    return _MOUNTS.get(parent or "", ("floor", "surface"))


def _mean_senses(senses: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Mean senses of things that are taken to be alike."""
    kinds = sorted({kind for of_one in senses for kind in of_one})
    wholes = [sum(of_one.values()) for of_one in senses]
    return {
        k: fsum(s.get(k, 0.0) / whole for s, whole in zip(senses, wholes, strict=True)) / len(senses) for k in kinds
    }


def _fingerprint(library: ShapeLibrary) -> str:
    """Changes with any shape of the library."""
    words = "\n".join(f"{s.id} {s.content_hash}" for s in library.shapes())
    return hashlib.sha256(words.encode()).hexdigest()[:12]


def quarter_turns(shape: Shape, cuboid: Cuboid) -> tuple[Float[np.ndarray, "p 3"], PoseBatch]:
    """Sizes and poses that fill the cuboid with the shape, turned by quarters (not at all where its front is known)."""
    turns = np.arange(1 if cuboid.front_known else 4)
    targets = np.array([cuboid.size_m if k % 2 == 0 else cuboid.size_m[[1, 0, 2]] for k in turns])
    R = np.array([cuboid.R_world_object @ yaw_rotation(k * np.pi / 2) for k in turns])
    scale = np.maximum(targets, 1e-3) / np.maximum(shape.size_m, 1e-3)
    return np.maximum(targets, 1e-3), PoseBatch(R, np.tile(cuboid.centre, (len(turns), 1)), scale)


def _parent_indices(objects: Sequence[DetectedObject], supports: Sequence[Support]) -> list[int | None]:
    """For each object, which of the others it lies on."""
    positions = {o.id: i for i, o in enumerate(objects)}
    parent_of = {s.child: positions.get(s.parent) for s in supports}
    return [parent_of.get(o.id) for o in objects]


def _groups(categories: Sequence[str], sizes_m: Sequence[np.ndarray], settings: RankingSettings) -> list[int]:
    """A group number for every object: those of one named category and similar size are of a kind."""
    leaders: list[int] = []
    groups = []
    for i, name in enumerate(categories):
        limit = settings.similar_log_size_of_seats if name in _SEATS else settings.similar_log_size
        same = [
            group
            for group, leader in enumerate(leaders)
            if name == categories[leader] and _log_difference(sizes_m[i], sizes_m[leader]) < limit
        ]
        alone = name == UNKNOWN.name or not same
        groups.append(len(leaders) if alone else same[0])
        if alone:
            leaders.append(i)
    return groups


def _means(
    groups: Sequence[int], scores: Sequence[dict[str, float]], visible: Sequence[float], settings: RankingSettings
) -> list[dict[str, float]]:
    """For each object the mean scores of its group, in which those that are seen best say most."""
    means = []
    for group, object_scores in zip(groups, scores, strict=True):
        alike = [(v + settings.min_voice, s) for g, s, v in zip(groups, scores, visible, strict=True) if g == group]
        voices = fsum(voice for voice, _ in alike)  # exact sums: the order of the objects must not show in a bit
        means.append({key: fsum(voice * s[key] for voice, s in alike) / voices for key in object_scores})
    return means


def _log_difference(a_m: np.ndarray, b_m: np.ndarray) -> float:
    """The largest difference of log extents of two cuboids, the better way round."""
    a, b = np.log(np.maximum(a_m, 1e-3)), np.log(np.maximum(b_m, 1e-3))
    return float(min(np.abs(a - b).max(), np.abs(a - b[[1, 0, 2]]).max()))


def _best(
    scores: dict[str, float],
    of_group: dict[str, float],
    keep: int,
    kind_of: Mapping[str, str],
    settings: RankingSettings,
    *,
    named: bool,
) -> tuple[tuple[str, float], ...]:
    """The best shapes by own and group's scores; most of them the group's, so that things of a kind can agree.

    Some are the best of other kinds that the word may mean, so that posing can tell and a person can choose.
    """
    share, kinds = settings.own_evidence, settings.kinds if named else settings.kinds_of_unnamed
    mixed = {key: share * scores[key] + (1 - share) * of_group[key] for key in scores}
    shared = _rank_keys(of_group)[: 3 * keep // 4]
    keys = [*shared, *(key for key in _rank_keys(mixed) if key not in shared)][:keep]
    of_kinds = {kind_of[key]: key for key in reversed(_rank_keys(mixed))}
    firsts = _rank_keys({key: mixed[key] for key in of_kinds.values()})[:kinds]
    keys = [*firsts, *(key for key in keys if key not in firsts)][:keep]
    return tuple((key, float(mixed[key])) for key in _rank_keys({key: mixed[key] for key in keys}))


def _rank_keys(scores: dict[str, float]) -> list[str]:
    return sorted(scores, key=lambda key: (-scores[key], key))
