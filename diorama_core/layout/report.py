"""Quality of a layout: costs, structure, overlap and displacements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.sat import pair_axes, place_bodies
from diorama_core.layout import gradients
from diorama_core.layout.gradients import BoxPairs, candidate_pairs
from diorama_core.layout.problem.problem import Problem, build_problem, reach_of
from diorama_core.layout.problem.volumes import Volumes, contact_templates
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Scene

USUAL_ERRORS = np.array([np.deg2rad(1.0), 1e-3, 1e-3])
"""Up to these `support_errors` an object is aligned with its support, on it and inside its bounds."""


def measure(observed: Problem, now: Problem) -> dict[str, float]:
    """The report's figures for a layout of some objects, against how they were observed.

    `orientation`, `placement`, `structure`, `in_support`: shares of supported objects within 1 degree and 0.1 cm of
    their support, and inside its bounds and clearance. `part_overlap_m`: deepest overlap of convex parts (0 when
    apart); `part_overlap_mean_m` and `overlapping_pairs` say how widespread. `box_overlap_m`: overlap of bounding
    boxes per object, tucked chairs included. `moved_m`: mean distance from the observed positions. `e_...`: the
    published costs.
    """
    supported = [surface is not None for surface in now.surface]
    aligned, placed, inside = (support_errors(now)[supported] <= USUAL_ERRORS).T
    depths = part_overlaps(now)
    moved = np.linalg.norm(now.p - observed.p, axis=1)
    return {
        "orientation": _share(aligned),
        "placement": _share(placed),
        "structure": _share(aligned & placed),
        "in_support": _share(inside),
        "part_overlap_m": max(depths.values(), default=0.0),
        "part_overlap_mean_m": sum(depths.values()) / max(now.count, 1),
        "overlapping_pairs": float(len(depths)),
        "box_overlap_m": _box_overlap(now),
        "moved_m": float(moved.mean()) if len(moved) else 0.0,
        "moved_most_m": float(moved.max()) if len(moved) else 0.0,
        **cost_values(observed, now),
    }


def layout_figures(start: Scene, now: Scene, library: ShapeLibrary) -> dict[str, float]:
    """The report's figures for a scene, against how its objects were observed at the start of a run.

    Objects may be new now, or lack.
    """
    remaining = tuple(o for o in start.objects if now.has_object(o.id))
    gone = {o.id for o in start.objects} - {o.id for o in remaining}
    supports = tuple(s for s in start.supports if gone.isdisjoint((s.child, s.parent)))
    problem = build_problem(replace(start, objects=remaining, supports=supports), library)
    return measure(problem, problem.with_poses_of(now))


def cost_values(observed: Problem, now: Problem) -> dict[str, float]:
    """The published costs of a layout (`layout.costs`), support edges only."""
    R, p, scale = now.R, now.p, now.scale
    volumes = Volumes.of(now)
    supported = volumes.supported
    if not len(supported):
        return dict.fromkeys(("e_align", "e_sem", "e_place", "e_rel", "e_vol", "e_col"), 0.0)
    here, size = volumes.world_volumes(R, p, scale), now.shape_size * scale
    faces, half = contact_templates(now, supported)
    corners = p[supported][:, None] + np.matmul(faces * scale[supported][:, None], R[supported].transpose(0, 2, 1))
    tilt = np.abs(np.matmul(here.normal[:, None, :], R[supported])[:, 0]) * half * scale[supported]
    top = (here.normal * p[supported]).sum(axis=1) - here.level + tilt.sum(axis=1)
    inward = -np.matmul(R[supported], now.contact[supported][..., None])[..., 0]
    centre = corners.mean(axis=1)
    foot = centre - ((centre * here.normal).sum(axis=1) - here.level)[:, None] * here.normal
    pairs = candidate_pairs(R, p, size, ~now.kin, 0.0)
    boxes = BoxPairs.of(R, size, pairs, walls_from=now.count)
    links = gradients.incidence(now.relations, now.count)
    return {
        "e_align": gradients.align(inward, here.normal)[0],
        "e_sem": gradients.semantic(R[:, :, 0].copy(), observed.R[:, :, 0])[0],
        "e_place": gradients.place(centre, foot, here.normal)[0],
        "e_rel": gradients.relative(p - observed.p, now.relations, links)[0],
        "e_vol": gradients.volume(corners, top, here.outward, here.offset, here.clearance)[0],
        "e_col": boxes.collision(p, gradients.incidence(pairs, now.count))[0] if len(pairs) else 0.0,
    }


def _share(good: np.ndarray) -> float:
    return float(good.mean()) if len(good) else 1.0


def support_errors(problem: Problem) -> Float[np.ndarray, "n 3"]:
    """How far each object is from resting on its support: radians by which it is tilted, metres by which it is off the
    surface, and metres by which it leaves the bounds and the clearance of that; 0 where nothing supports it.
    """
    R, p, scale = problem.R, problem.p, problem.scale
    volumes = Volumes.of(problem)
    here, supported = volumes.world_volumes(R, p, scale), volumes.supported
    size, contact = problem.shape_size[supported] * scale[supported], problem.contact[supported]
    R_supported = R[supported]
    outward = np.matmul(R_supported, contact[..., None])[..., 0]
    centre = p[supported] + np.matmul(R_supported, (contact * size / 2)[..., None])[..., 0]
    tilted = np.arccos(np.clip(-(outward * here.normal).sum(axis=1), -1.0, 1.0))
    off = np.abs((centre * here.normal).sum(axis=1) - here.level)
    reach = np.array([reach_of(problem.footing[i], R[i], scale[i], m) for i, m in zip(supported, here.outward)])
    reach = reach.reshape(here.offset.shape)
    past = np.matmul(here.outward, centre[..., None])[..., 0] + reach - here.offset
    half = 0.5 * (np.abs(np.matmul(here.normal[:, None, :], R_supported)[:, 0]) * size).sum(axis=1)
    top = (p[supported] * here.normal).sum(axis=1) - here.level + half
    # Squares, so that what hangs over on all sides is best in the middle.
    outside = np.linalg.norm(np.maximum(np.column_stack([past, top - here.clearance]), 0.0), axis=1)
    errors = np.zeros((problem.count, 3))
    errors[supported] = np.column_stack([tilted, off, outside])
    return errors


def _box_overlap(problem: Problem) -> float:
    """Overlap depth of bounding boxes, summed over the pairs that should be apart, per object."""
    p, size = problem.p, problem.shape_size * problem.scale
    pairs = candidate_pairs(problem.R, p, size, ~problem.kin, 0.0)
    if not len(pairs):
        return 0.0
    boxes = BoxPairs.of(problem.R, size, pairs, walls_from=problem.count)
    depth = (boxes.reach - np.abs(np.matmul(boxes.axes, (p[boxes.i] - p[boxes.j])[..., None])[..., 0])).min(axis=1)
    return float(np.maximum(depth, 0.0).sum()) / problem.count


def part_overlaps(
    problem: Problem, *, only: int | None = None, supporters: bool = False
) -> dict[tuple[int, int], float]:
    """Depth in metres by which convex parts of two objects overlap, for the pairs that do; of one object only those.

    With supporters those of an object and what holds it up, which touch, are looked at too; rugs and soft things are
    left out.
    """
    apart = ~(np.eye(problem.count, dtype=bool) | problem.yielding if supporters else problem.kin)
    packed = problem.packed
    if only is not None:
        near = _neighbours(problem, only) & apart[only]
        packed = packed.select(near | (np.arange(problem.count) == only))
    bodies = place_bodies(packed, problem.R, problem.p, problem.scale)
    near_parts = np.triu(apart, 1)[bodies.owner[:, None], bodies.owner[None]]
    if only is not None:
        near_parts &= (bodies.owner[:, None] == only) | (bodies.owner[None] == only)
    for axis in range(3):
        low, high = bodies.low[:, axis], bodies.high[:, axis]
        near_parts &= (low[:, None] < high[None]) & (low[None] < high[:, None])
    a, b = np.nonzero(near_parts)
    depths: dict[tuple[int, int], float] = {}
    for block in pair_axes(bodies, a, b):
        depth = -block.gaps.max(axis=1)
        for k in np.flatnonzero(depth > 1e-9):
            pair = (int(bodies.owner[block.a[k]]), int(bodies.owner[block.b[k]]))
            depths[pair] = max(depths.get(pair, 0.0), float(depth[k]))
    return depths


def _neighbours(problem: Problem, i: int) -> Bool[np.ndarray, " n"]:
    """Objects of which the upright box around their parts meets that of object i."""
    half = np.matmul(np.abs(problem.R), (problem.packed.reach * problem.scale)[..., None])[..., 0]
    return (np.abs(problem.p - problem.p[i]) < half + half[i]).all(axis=1)
