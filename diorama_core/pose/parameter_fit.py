"""The parameters of a design that agree best with the picture, each compared where the shape fits best with it.

One after the other the parameters take their other values, and a value is kept where outline, measured depth and inner
edges agree clearly better with it. A pose that was fitted to other legs or another top speaks for those: so every
promising value is compared in a pose fitted to it, sizes included.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, repeat

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Cuboid
from diorama_core.geometry.silhouette import ShapeCaster
from diorama_core.library.furniture.measures import Value, can_be_made, made_id, varied
from diorama_core.library.furniture.reshaping import MIRRORED
from diorama_core.library.hands import other_hand
from diorama_core.library.record import BUILT_IN, Shape, ShapeLibrary, record_of
from diorama_core.pose.outline_fit import FitRange, fit_pose, resizing_cost
from diorama_core.pose.seen_objects import SeenObject
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings, PoseSettings, ShapeFitSettings
from diorama_core.scene.types import Candidate, Pose


@dataclass(frozen=True, eq=False)
class _Fit:
    """One variant of a design, as it agrees with the objects that have it."""

    score: float
    """Mean over the objects: logarithm, higher is better."""
    poses: tuple[Pose, ...]


@dataclass(frozen=True, eq=False)
class _Variant:
    """A design as it is built, to be compared with the picture."""

    shape_id: str
    library: ShapeLibrary
    settings: PoseSettings

    @cached_property
    def caster(self) -> ShapeCaster:
        """Its form."""
        return ShapeCaster(self.library.mesh(self.shape_id))

    @cached_property
    def shape(self) -> Shape:
        """With the surfaces on which things lie."""
        return self.library.shape(self.shape_id)

    def score(self, seen: SeenObject, pose: Pose, start: Float[np.ndarray, "3"]) -> float:
        """How well it agrees with one object, whatever lies on that: a logarithm, higher is better.

        What its size costs is counted from `start`, its scale before any fit.
        """
        cost = seen.outline_weight * float(
            resizing_cost(seen.evidence.seen, (pose.scale / start)[None], self.settings.shapes)[0]
        )
        return seen.score(self.caster, pose) - cost

    def level_cost(self, seen: SeenObject, pose: Pose) -> float:
        """What the things that lie on the object say against it."""
        return level_cost(self.shape, pose, seen.carried, self.settings.evidence) if seen.carried else 0.0


@dataclass(frozen=True, eq=False)
class ParameterFit:
    """Fits the parameters of one candidate's design to the objects that have it."""

    library: ShapeLibrary = field(repr=False)
    seen: Sequence[SeenObject]
    resize: bool
    """Whether sizes may change; those of a set stay alike."""
    settings: PoseSettings = SETTINGS

    def fit(self, best: Candidate, poses: Sequence[Pose]) -> tuple[dict[str, Value], tuple[Pose, ...]] | None:
        """The changed parameters that agree best, and where they do, with scales of the retrieved shape.

        None where that is rather stretched than built.

        Args:
            best: The retrieved shape.
            poses: Where it stands for every object.
        """
        size_m = np.asarray(best.shape_size_m)
        if not self._may_be_built(best.shape_id):
            return None
        retrieved = self._variant(best.shape_id)
        as_is = self._fit(retrieved, size_m, self._fit_at(retrieved, poses, best.pose.scale), best.pose.scale)
        size = np.round(size_m * as_is.poses[0].scale, 3)
        if not can_be_made(best.shape_id, size):
            return None
        poses = [Pose(p.R_world_object, p.position, p.scale * size_m / size) for p in as_is.poses]
        changes, fit = self._search(best.shape_id, size, poses, best.pose.scale * size_m / size, as_is.score)
        if fit.score < as_is.score - self.settings.shapes.size_loss:
            return None
        return changes, tuple(Pose(p.R_world_object, p.position, p.scale * size / size_m) for p in fit.poses)

    def _search(
        self,
        design_id: str,
        size_m: Float[np.ndarray, "3"],
        poses: Sequence[Pose],
        start: Float[np.ndarray, "3"],
        as_is: float,
    ) -> tuple[dict[str, Value], _Fit]:
        """The changes that are worth it, and how the shape with them agrees.

        Args:
            design_id: A built-in design.
            size_m: At which it is built.
            poses: Where it stands, scales of that size.
            start: The size from before any fit, as a share of that size.
            as_is: What the retrieved shape scores, stretched to that size.
        """
        changes: dict[str, Value] = {}
        best, left = (
            self._fit_at(self._variant(made_id(design_id, size_m, changes)), poses, start),
            self.settings.shapes.max_variants,
        )
        parameters, unchanged = tuple(varied(design_id)), 0
        if other_hand(self.library, design_id) is not None:
            parameters = ((MIRRORED, (True,)), *parameters)
        for name, values in chain.from_iterable(repeat(parameters, self.settings.shapes.passes)):
            if unchanged == len(parameters):
                break  # each was tried beside the values that all others have now
            others = [v for v in values if v != changes.get(name) and can_have(name, v, size_m, self.settings.shapes)][
                :left
            ]
            left -= len(others)
            variants = {v: self._variant(made_id(design_id, size_m, {**changes, name: v})) for v in others}
            enough = (best.score if changes else max(best.score, as_is)) + self._worth
            least = enough - (
                self.settings.shapes.promising_with_depth if self._with_depth else self.settings.shapes.promising
            )
            roughly = {v: self._fit_at(variant, best.poses, start, least) for v, variant in variants.items()}
            promising = [v for v in others if roughly[v].score > least]
            tried = {v: self._fit(variants[v], size_m, roughly[v], start, enough) for v in promising}
            value = max(tried, key=lambda v: tried[v].score, default=None)
            unchanged += 1
            if value is not None and tried[value].score > enough:
                changes, best, unchanged = {**changes, name: value}, tried[value], 0
        return changes, best

    @property
    def _worth(self) -> float:
        """By how much a changed parameter must agree better."""
        if self._with_depth:
            return self.settings.shapes.worth_with_depth
        return (
            self.settings.shapes.worth
            if all(one.has_given_mask for one in self.seen)
            else self.settings.shapes.worth_of_unsure
        )

    @property
    def _with_depth(self) -> bool:
        """Whether depth was measured."""
        return all(one.evidence.surface is not None for one in self.seen)

    def _variant(self, shape_id: str) -> _Variant:
        return _Variant(shape_id, self.library, self.settings)

    def _fit_at(
        self, variant: _Variant, poses: Sequence[Pose], start: Float[np.ndarray, "3"], least: float = -np.inf
    ) -> _Fit:
        """The variant in these poses; one that does not score `least` anyway is not searched for its levels."""
        scores = np.array([variant.score(o, p, start) for o, p in zip(self.seen, poses, strict=True)])
        if scores.mean() >= least:
            scores -= [variant.level_cost(o, p) for o, p in zip(self.seen, poses, strict=True)]
        return _Fit(float(scores.mean()), tuple(poses))

    def _fit(
        self,
        variant: _Variant,
        size_m: Float[np.ndarray, "3"],
        roughly: _Fit,
        start: Float[np.ndarray, "3"],
        enough: float = -np.inf,
    ) -> _Fit:
        """The variant in the poses that fit best near rough ones; not finely where it would not score enough anyway."""
        fit = roughly
        for step in self.settings.shapes.size_steps:
            near = FitRange(start, (step,), self.settings.shapes.size_rounds)
            poses = [
                fit_pose(
                    o.evidence, variant.caster, p, size_m, resize=self.resize, near=near, settings=self.settings.shapes
                )
                for o, p in zip(self.seen, fit.poses, strict=True)
            ]
            if any(pose is not before for pose, before in zip(poses, fit.poses, strict=True)):
                fit = self._fit_at(variant, poses, start)
            if fit.score < enough - self.settings.shapes.finely:
                break
        return fit

    def _may_be_built(self, shape_id: str) -> bool:
        built_in = record_of(self.library, shape_id).source == BUILT_IN
        return built_in and len(self.library.mesh(shape_id).faces) <= self.settings.shapes.max_triangles


def can_have(
    name: str, value: Value, size_m: Float[np.ndarray, "3"], settings: ShapeFitSettings = SETTINGS.shapes
) -> bool:
    """Whether a shape of this depth, width and height can have a parameter's value: its drawers are for things.

    Args:
        name: of the parameter.
        value: that it would have.
        size_m: depth, width and height.
        settings: smallest drawers.
    """
    bays = value if name == "bays" and isinstance(value, tuple) else ()
    drawers = [int(v) for v in bays if str(v).isdecimal()]
    if not drawers:
        return True
    return bool(
        size_m[1] / len(bays) >= settings.min_drawer_m[0] and size_m[2] / max(drawers) >= settings.min_drawer_m[1]
    )


def level_cost(
    shape: Shape, pose: Pose, carried: Sequence[Cuboid], settings: PoseEvidenceSettings = SETTINGS.evidence
) -> float:
    """What speaks against a shape, by the heights at which the things that it carries lie; half squared sigmas.

    Args:
        shape: with its support surfaces; where none is known, nothing speaks against it.
        pose: upright, in the world.
        carried: what lies on it, measured without knowing the shape.
    """
    if not carried or not shape.surfaces:
        return 0.0
    levels = pose.position[2] + pose.scale[2] * np.array([s.height_m for s in shape.surfaces])
    bases: Float[np.ndarray, "n"] = np.array([c.centre[2] - c.size_m[2] / 2 for c in carried])
    sigma = np.hypot(settings.level_sigma_m, settings.level_share_sigma * pose.scale[2] * shape.size_m[2])
    off = np.abs(bases[:, None] - levels).min(axis=1) / sigma
    return float(np.minimum(0.5 * off**2, settings.max_level_cost).mean())
