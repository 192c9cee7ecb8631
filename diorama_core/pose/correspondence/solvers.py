"""The paper's pose solver and the baselines it is compared with, as pose stages.

- `correspondence` (the paper's): the views nearest to the picture by cyclic matches, those matches lifted to 3D by
  depth, RANSAC-Umeyama over them, and a second hypothesis from the scale network where it is present.
- `zsp` (Goodwin et al. 2022): the same from the one best view, as published.
- `gigapose-like` (Nguyen et al. 2024): the best view, one correspondence, relative scale and in-plane rotation; without
  the publication's network for these two they are read from the matches.
- `best-match`: the turn of the most similar view; place and size from the mask and the depth under it.

All give one scale for all three axes: what is nine degrees of freedom comes later or from `RenderAndCompare`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from diorama_core.artefacts import DepthMap, DetectedObject, Inputs, ObjectGeometry, PosedCandidates, RankedShapes
from diorama_core.io.cache import LruCache
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.models.gigapose import ScaleNetwork
from diorama_core.pose.correspondence.crops import PatchCrop, crop_object, template_view
from diorama_core.pose.correspondence.features import EncodedViews, GeometricFeatures, PatchFeatures
from diorama_core.pose.correspondence.matching import cyclic_matches, similarities, template_scores
from diorama_core.pose.correspondence.rigid import (
    POOLED_VIEWS,
    Compared,
    Rigid,
    from_matches,
    from_one_match,
    from_view,
)
from diorama_core.progress import Progress
from diorama_core.render.template_cache import TemplateCache
from diorama_core.render.templates import PAPER_GRID, TemplateGrid
from diorama_core.scene.types import Camera, Candidate, Pose

Kind = Literal["correspondence", "zsp", "gigapose-like", "best-match"]
KINDS: tuple[Kind, ...] = ("correspondence", "zsp", "gigapose-like", "best-match")

HALF_GRID = TemplateGrid(size_px=112)
"""The paper's 180 views at half its resolution: embedded patch features are means over patches."""

_CACHED_SHAPES = 12
_MAX_NUMBERS = 2**25
"""In one matrix of similarities: as many candidates are compared at once as that allows."""


@dataclass(frozen=True)
class CorrespondencePose:
    """Poses every ranked shape by patches that it shares with the picture.

    Needs the views of the shapes (rendered on first use, then cached) and depth, measured or rendered.
    """

    library: ShapeLibrary
    kind: Kind = "correspondence"
    features: PatchFeatures = field(default_factory=GeometricFeatures)
    scale_network: ScaleNetwork | None = None
    """Predicts relative scale and in-plane turn; used by `correspondence` and `gigapose-like`."""
    grid: TemplateGrid = PAPER_GRID
    cache: TemplateCache = field(default_factory=TemplateCache, repr=False, compare=False)
    _encoded: LruCache[str, EncodedViews] = field(
        default_factory=lambda: LruCache(_CACHED_SHAPES), repr=False, compare=False
    )

    def __repr__(self) -> str:
        network = "" if self.scale_network is None else f", {self.scale_network!r}"
        return f"CorrespondencePose({self.kind}, {self.features!r}, {self.grid.key}{network})"

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """Posed candidates, most alike first; shapes for which no pose was found are left out.

        Args:
            inputs, objects, geometry, depth, shapes, progress: as documented in `protocols.PoseStage`.
        """
        return self.pose_by((self.kind,), inputs, objects, geometry, depth, shapes, progress)[self.kind]

    def pose_by(
        self,
        kinds: Sequence[Kind],
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> dict[Kind, tuple[PosedCandidates, ...]]:
        """As `pose`, by several solvers that share one comparison of pictures and views.

        Args:
            kinds: the solvers whose poses are wanted.
            inputs, objects, geometry, depth, shapes, progress: as documented in `protocols.PoseStage`.
        """
        ranked = {r.object_id: r.ranked for r in shapes if r.ranked}
        records = {s.id: s for s in self.library.shapes()}
        wanted = [o for o in objects if o.id in ranked]
        posed: dict[Kind, list[PosedCandidates]] = {kind: [] for kind in kinds}
        for index, obj in enumerate(wanted):
            progress.report(index / len(wanted), f"Matching: {obj.label}")
            crop = crop_object(
                inputs.photo.rgb, obj.mask, obj.box, depth.depth_m, depth.normals_world, geometry.camera, self.grid
            )
            candidates = [records[i] for i, _ in ranked[obj.id]]
            compared = self.compare(crop, candidates)
            for kind in kinds:
                poses = [(s, self._solve(kind, c)) for s, c in zip(candidates, compared, strict=False)]
                posed[kind].append(_candidates(obj, geometry.camera, [(s, p) for s, p in poses if p is not None]))
        return {kind: tuple(f for f in of_kind if f.candidates) for kind, of_kind in posed.items()}

    def compare(self, crop: PatchCrop, shapes: Sequence[Shape]) -> list[Compared]:
        """The picture against all views of all shapes, in their order; nothing where picture or depth are empty."""
        inside = np.flatnonzero(crop.view.foreground[0])
        if len(inside) == 0 or not np.isfinite(crop.points_camera).all(axis=1).any():
            return []
        query = self.features.encode(crop.view)[0]
        width = max(len(inside), query.shape[-1]) * query.shape[0] * len(self.grid)
        at_once = max(_MAX_NUMBERS // width, 1)
        compared: list[Compared] = []
        for start in range(0, len(shapes), at_once):
            encoded = [self._views(s) for s in shapes[start : start + at_once]]
            alike = similarities(
                query,
                np.concatenate([e.features for e in encoded]).astype(np.float32, copy=False),
                crop.view.foreground[0],
                np.concatenate([e.foreground for e in encoded]),
            )
            matches, similarity = cyclic_matches(alike, inside), template_scores(alike)
            for k, e in enumerate(encoded):
                views = slice(k * len(self.grid), (k + 1) * len(self.grid))
                compared.append(Compared(crop, e.templates, matches.select_views(views), similarity[views]))
        return compared

    def _solve(self, kind: Kind, compared: Compared) -> Rigid | None:
        if kind == "correspondence":
            return from_matches(compared, compared.ranked_views[:POOLED_VIEWS], self.scale_network)
        if kind == "zsp":
            return from_matches(compared, compared.ranked_views[:1])
        best = int(compared.similarity.argmax())
        if kind == "gigapose-like":
            return from_one_match(compared, best, self.scale_network)
        return from_view(compared, best, float(compared.similarity[best]))

    def _views(self, shape: Shape) -> EncodedViews:
        """Features of a shape's views, held for the next object that may be it."""
        return self._encoded.get(shape.content_hash or shape.id, lambda: self._encode(shape))

    def _encode(self, shape: Shape) -> EncodedViews:
        templates = self.cache.get(self.library, shape, self.grid)
        return EncodedViews.of(templates, template_view(templates), self.features, shape.content_hash)


def _candidates(obj: DetectedObject, camera: Camera, posed: list[tuple[Shape, Rigid]]) -> PosedCandidates:
    R_world, position = camera.T_world_camera[:3, :3], camera.position
    ordered = sorted(posed, key=lambda item: (-item[1].similarity, item[0].id))
    candidates = tuple(
        Candidate(
            shape.id,
            shape.size_m,
            float(np.clip(fits.similarity, 0.0, 1.0)),
            Pose(R_world @ fits.R, R_world @ fits.t + position, np.full(3, fits.scale)),
        )
        for shape, fits in ordered
    )
    confidence = float(np.clip(ordered[0][1].similarity, 0.0, 1.0)) * obj.mask_confidence if ordered else 0.0
    return PosedCandidates(obj.id, candidates, confidence)
