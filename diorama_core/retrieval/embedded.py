"""Retrieval without learned embeddings: category first, then size, silhouette and colour."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Cuboid, DetectedObject, Inputs, ObjectGeometry, RankedShapes
from diorama_core.geometry.observed import Observed, observe_among
from diorama_core.geometry.silhouette import SHARED_CASTERS, KeyedCache, PoseBatch, ShapeCaster
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.progress import Progress
from diorama_core.retrieval.colours import Palette, palette_agreement, palette_of_crop, palette_of_parts
from diorama_core.retrieval.pools import pool_for, size_cost
from diorama_core.scene.types import Support, yaw_rotation

_PALETTES: KeyedCache[Palette] = KeyedCache(4096)
_SIMILAR_LOG_SIZE = 0.35
_OWN_EVIDENCE = 0.4


@dataclass(frozen=True)
class EmbeddedRetrieval:
    """Ranks a category's shapes by what the photo shows of the object; needs no weights (paper, section 3.2).

    The paper's text query becomes the category's pool, its image query the agreement of size, silhouette and main
    colours. Objects of one category and size are ranked together, so that four dining chairs are four of a kind.
    """

    library: ShapeLibrary
    keep: int = 8
    """How many shapes are kept for an object."""
    cells: int = 36
    """Resolution of the silhouettes, both ways."""
    size_weight: float = 0.45
    silhouette_weight: float = 0.4
    """Of a mask that can be trusted; less for doubtful ones."""
    colour_weight: float = 0.15

    def __repr__(self) -> str:
        numbers = (self.keep, self.cells, self.size_weight, self.silhouette_weight, self.colour_weight)
        return f"EmbeddedRetrieval({_fingerprint(self.library)}, {', '.join(map(str, numbers))})"

    def retrieve(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> tuple[RankedShapes, ...]:
        """Ranked shapes of every object that has a cuboid, in the order of `objects`."""
        cuboids = {c.object_id: c for c in geometry.cuboids}
        measured = [o for o in objects if o.id in cuboids]
        holders = {s.parent for s in geometry.supports}
        centres = np.array([cuboids[o.id].centre for o in measured]).reshape(-1, 3)
        parents = _parent_indices(measured, geometry.supports)
        scores: list[dict[str, float]] = []
        notes: list[str] = []
        for index, thing in enumerate(measured):
            progress.report(index / len(measured), f"Looking for shapes: {thing.label}")
            cuboid = cuboids[thing.id]
            pool = pool_for(self.library, thing.category, cuboid.size_m, thing.id in holders)
            seen = observe_among(geometry.camera, measured, centres, parents, index, self.cells)
            palette = palette_of_crop(inputs.photo.rgb, thing.mask)
            scores.append(
                {m.shape.id: m.kind_factor * self._score(m.shape, cuboid, seen, palette) for m in pool.members}
            )
            notes.append(pool.note)
        shared = _agreed([o.category for o in measured], [cuboids[o.id].size_m for o in measured], scores)
        return tuple(
            RankedShapes(thing.id, _best(ranking, self.keep), note)
            for thing, ranking, note in zip(measured, shared, notes, strict=True)
        )

    def _score(self, shape: Shape, cuboid: Cuboid, seen: Observed, palette: Palette) -> float:
        """0 to 1: the best of the shape's quarter turns in the cuboid."""
        targets, poses = quarter_turns(shape, cuboid)
        cost = np.array([size_cost(shape.size_m, t) for t in targets])
        outline = seen.agreement(seen.silhouettes(self._caster(shape), poses))
        outline_weight = self.silhouette_weight * (0.25 + 0.75 * seen.mask_trust)
        fit = self.size_weight * np.exp(-cost / 2) + outline_weight * outline
        colour = palette_agreement(palette, self._palette(shape))
        total = self.size_weight + outline_weight + self.colour_weight
        return float((fit.max() + self.colour_weight * colour) / total)

    def _caster(self, shape: Shape) -> ShapeCaster:
        return SHARED_CASTERS.get(shape.content_hash or shape.id, lambda: ShapeCaster(self.library.mesh(shape.id)))

    def _palette(self, shape: Shape) -> Palette:
        return _PALETTES.get(shape.content_hash or shape.id, lambda: palette_of_parts(self.library.parts(shape.id)))


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


def _agreed(
    categories: Sequence[str], sizes_m: Sequence[np.ndarray], scores: Sequence[dict[str, float]]
) -> list[dict[str, float]]:
    """Each object's scores mixed with the mean of those of its own kind and size."""
    shared = []
    for i, own in enumerate(scores):
        alike = [
            scores[j]
            for j in range(len(scores))
            if categories[j] == categories[i] and _alike(sizes_m[i], sizes_m[j]) and scores[j].keys() == own.keys()
        ]
        mean = {key: sum(s[key] for s in alike) / len(alike) for key in own}
        shared.append({key: _OWN_EVIDENCE * own[key] + (1 - _OWN_EVIDENCE) * mean[key] for key in own})
    return shared


def _alike(a_m: np.ndarray, b_m: np.ndarray) -> bool:
    """Whether two cuboids could hold the same thing, either way round."""
    a, b = np.log(np.maximum(a_m, 1e-3)), np.log(np.maximum(b_m, 1e-3))
    return min(np.abs(a - b).max(), np.abs(a - b[[1, 0, 2]]).max()) < _SIMILAR_LOG_SIZE


def _best(scores: dict[str, float], keep: int) -> tuple[tuple[str, float], ...]:
    ranked = sorted(scores.items(), key=lambda item: (-item[1], item[0]))
    return tuple((shape_id, float(score)) for shape_id, score in ranked[:keep])
