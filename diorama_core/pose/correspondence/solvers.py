"""The paper's pose solver and the baselines it is compared with, as pose stages.

- `correspondence` (the paper's): the views nearest to the picture by cyclic matches, those matches lifted to 3D by
  depth, RANSAC-Umeyama over them.
- `zsp` (Goodwin et al. 2022): the same from the one best view, as published.
- `gigapose-like` (Nguyen et al. 2024): the best view, one correspondence, relative scale and in-plane rotation; these
  two are read from the matches, where the publication has a network for them.
- `best-match`: the turn of the most similar view; place and size from the mask and the depth under it.

All give one scale for all three axes: what is nine degrees of freedom comes later or from `RenderAndCompare`.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from jaxtyping import Float, Float32, Int

from diorama_core.artefacts import (
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    PosedCandidates,
    RankedShapes,
)
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.pose.correspondence.crops import Crop, View, crop_object, patch_pixels, template_view
from diorama_core.pose.correspondence.features import GeometricFeatures, PatchFeatures
from diorama_core.pose.correspondence.matching import Matches, cyclic_matches, similarities, template_scores
from diorama_core.pose.correspondence.umeyama import ransac_umeyama, umeyama
from diorama_core.progress import Progress
from diorama_core.render.template_cache import TemplateCache
from diorama_core.render.templates import PAPER_GRID, TemplateGrid, Templates
from diorama_core.scene.types import Camera, Candidate, Pose

Kind = Literal["correspondence", "zsp", "gigapose-like", "best-match"]
KINDS: tuple[Kind, ...] = ("correspondence", "zsp", "gigapose-like", "best-match")

_POOLED_VIEWS = 5
"""Views whose matches are taken together: their points are all in the shape's one frame."""
_THRESHOLDS = (0.02, 0.05, 0.1)
"""Distances within which lifted matches agree, tightest first, as shares of the object's extent."""
_ENOUGH_INLIERS = 0.35
_FEATURES_HELD = 12


@dataclass(frozen=True, eq=False)
class _Encoded:
    """One shape's views with their features."""

    templates: Templates
    view: View
    features: Float32[np.ndarray, "v p d"]


@dataclass(frozen=True, eq=False)
class _Rigid:
    """A pose in the photo camera's frame, one scale, and how alike picture and views are."""

    R: Float[np.ndarray, "3 3"]
    t: Float[np.ndarray, "3"]
    scale: float
    similarity: float


@dataclass(frozen=True)
class CorrespondencePose:
    """Poses every ranked shape by patches that it shares with the picture.

    Needs the views of the shapes (rendered when first needed, then kept) and depth, measured or rendered.
    """

    library: ShapeLibrary
    kind: Kind = "correspondence"
    features: PatchFeatures = field(default_factory=GeometricFeatures)
    grid: TemplateGrid = PAPER_GRID
    cache: TemplateCache = field(default_factory=TemplateCache, repr=False, compare=False)
    _encoded: OrderedDict[str, _Encoded] = field(default_factory=OrderedDict, repr=False, compare=False)

    def __repr__(self) -> str:
        return f"CorrespondencePose({self.kind}, {self.features!r}, {self.grid.key})"

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """Posed candidates, most alike first; shapes for which no pose was found are left out."""
        ranked = {r.object_id: r.ranked for r in shapes if r.ranked}
        records = {s.id: s for s in self.library.shapes()}
        wanted = [o for o in objects if o.id in ranked]
        found = []
        for index, thing in enumerate(wanted):
            progress.report(index / len(wanted), f"Matching: {thing.label}")
            crop = crop_object(
                inputs.photo.rgb, thing.mask, thing.box, depth.depth_m, depth.normals_world, geometry.camera, self.grid
            )
            posed = [(records[i], self._pose_shape(crop, records[i])) for i, _ in ranked[thing.id]]
            found.append(_candidates(thing, geometry.camera, [(s, p) for s, p in posed if p is not None]))
        return tuple(f for f in found if f.candidates)

    def _pose_shape(self, crop: Crop, shape: Shape) -> _Rigid | None:
        inside = np.flatnonzero(crop.view.foreground[0])
        known = np.isfinite(crop.points_camera).all(axis=1)
        if len(inside) == 0 or not known.any():
            return None
        encoded = self._views(shape)
        query = self.features.encode(crop.view)[0]
        alike = similarities(query, encoded.features, crop.view.foreground[0], encoded.view.foreground)
        if self.kind == "best-match":
            best = int(template_scores(alike).argmax())
            return _from_view(crop, encoded.templates, best, float(template_scores(alike)[best]))
        matches = cyclic_matches(alike, inside)
        believed = matches.mean_similarity * np.sqrt(matches.count)
        order = np.argsort(-believed, kind="stable")
        if self.kind == "gigapose-like":
            best = int(template_scores(alike).argmax())
            return _from_one_match(crop, encoded.templates, matches, best)
        views = order[: _POOLED_VIEWS if self.kind == "correspondence" else 1]
        return _from_matches(crop, encoded.templates, matches, views)

    def _views(self, shape: Shape) -> _Encoded:
        """Features of a shape's views, held for the next object that may be it."""
        key = shape.content_hash or shape.id
        if key not in self._encoded:
            templates = self.cache.get(self.library, shape, self.grid)
            view = template_view(templates)
            self._encoded[key] = _Encoded(templates, view, self.features.encode(view))
            while len(self._encoded) > _FEATURES_HELD:
                self._encoded.popitem(last=False)
        self._encoded.move_to_end(key)
        return self._encoded[key]


def _candidates(thing: DetectedObject, camera: Camera, posed: list[tuple[Shape, _Rigid]]) -> PosedCandidates:
    R_world, position = camera.T_world_camera[:3, :3], camera.position
    ordered = sorted(posed, key=lambda item: (-item[1].similarity, item[0].id))
    candidates = tuple(
        Candidate(
            shape.id,
            shape.size_m,
            float(np.clip(found.similarity, 0.0, 1.0)),
            Pose(R_world @ found.R, R_world @ found.t + position, np.full(3, found.scale)),
        )
        for shape, found in ordered
    )
    confidence = float(np.clip(ordered[0][1].similarity, 0.0, 1.0)) * thing.mask_confidence if ordered else 0.0
    return PosedCandidates(thing.id, candidates, confidence)


def _lifted(
    crop: Crop, templates: Templates, view: int, query: Int[np.ndarray, " k"], patches: Int[np.ndarray, " k"]
) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]]:
    """Matched points on the shape and in the photo camera's frame; pairs without depth are left out."""
    source = templates.points_at(view, patch_pixels(templates.grid.size_px)[patches]).astype(float)
    target = crop.points_camera[query].astype(float)
    known = np.isfinite(source).all(axis=1) & np.isfinite(target).all(axis=1)
    return source[known], target[known]


def _from_matches(crop: Crop, templates: Templates, matches: Matches, views: Int[np.ndarray, " n"]) -> _Rigid | None:
    """RANSAC-Umeyama over the lifted matches of the chosen views, the tightest tolerance first."""
    pairs = [
        _lifted(crop, templates, int(v), matches.query[v, : matches.count[v]], matches.template[v, : matches.count[v]])
        for v in views
    ]
    source, target = (np.concatenate(side) for side in zip(*pairs, strict=True))
    best = int(views[0])
    similarity = float(matches.mean_similarity[best])
    if len(target):
        extent = float(np.linalg.norm(np.ptp(target, axis=0)))
        for share in _THRESHOLDS:
            found = ransac_umeyama(source, target, share * extent, seed=best)
            if found is not None and (found.inliers.mean() >= _ENOUGH_INLIERS or share == _THRESHOLDS[-1]):
                return _Rigid(found.R, found.t, found.scale, similarity)
    return _from_view(crop, templates, best, similarity)


def _from_view(crop: Crop, templates: Templates, view: int, similarity: float) -> _Rigid | None:
    """The turn of one view; size and place from what the mask and the depth under it span."""
    seen = crop.points_camera[np.isfinite(crop.points_camera).all(axis=1)].astype(float)
    shown = templates.points_at(view, patch_pixels(templates.grid.size_px)).astype(float)
    shown = shown[np.isfinite(shown).all(axis=1)]
    if len(seen) == 0 or len(shown) == 0:
        return None
    R = crop.R_camera_crop @ templates.grid.R_object_camera[view].T
    mask = templates.depth_codes[view] > 0
    z_seen = float(np.median(seen @ crop.R_camera_crop[:, 2]))
    z_shown = float(np.median(templates.depth_m(view)[mask]))
    span_seen = _span(crop.view.mask[0]) / crop.focal_px * z_seen
    span_shown = _span(mask) / templates.grid.intrinsics.fx * z_shown
    scale = float(span_seen / max(span_shown, 1e-9))
    return _Rigid(R, np.median(seen, axis=0) - scale * R @ np.median(shown, axis=0), scale, similarity)


def _from_one_match(crop: Crop, templates: Templates, matches: Matches, view: int) -> _Rigid | None:
    """The turn of a view turned further in the picture's plane, hung on its best match."""
    count = int(matches.count[view])
    query, patches = matches.query[view, :count], matches.template[view, :count]
    coarse = _from_view(crop, templates, view, float(matches.mean_similarity[view]))
    source, target = _lifted(crop, templates, view, query[:1], patches[:1])
    if coarse is None or count < 3 or len(target) == 0:
        return coarse
    pixels = patch_pixels(templates.grid.size_px).astype(float)
    size2d, turn, _ = umeyama(_flat(pixels[patches]), _flat(pixels[query]))
    angle = float(np.arctan2(turn[0, 1, 0], turn[0, 0, 0]))
    c, s = np.cos(angle), np.sin(angle)
    in_plane = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    R = crop.R_camera_crop @ in_plane @ templates.grid.R_object_camera[view].T
    z_seen = float(target[0] @ crop.R_camera_crop[:, 2])
    camera = templates.camera(view)
    z_shown = float(camera.to_camera(source)[0, 2])
    scale = float(size2d[0] * (z_seen / crop.focal_px) / (z_shown / templates.grid.intrinsics.fx))
    return _Rigid(R, target[0] - scale * R @ source[0], scale, coarse.similarity)


def _flat(pixels: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "1 n 3"]:
    return np.column_stack([pixels, np.zeros(len(pixels))])[None]


def _span(mask: np.ndarray) -> float:
    """The diagonal of a mask's box, pixels."""
    rows, columns = np.nonzero(mask)
    return float(np.hypot(np.ptp(rows) + 1, np.ptp(columns) + 1)) if len(rows) else 0.0
