"""Inner edges of shapes against those of a picture."""

from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.geometry.observed import Observed, observe
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster, ShapeHits
from diorama_core.pose.inner_edges import InnerEdges
from diorama_core.scene.types import Pose
from tests.pose.rooms import camera_at

CAMERA = camera_at()
POSE = Pose.upright((0.0, 3.0, 0.6), np.deg2rad(-90.0))


def chest(drawers: int) -> trimesh.Trimesh:
    """A block with grooves across its front."""
    boards = []
    for k in range(drawers):
        height = 1.2 / drawers
        front = trimesh.creation.box((0.05, 1.0, height - 0.03))
        boards.append(front.apply_translation((0.2, 0.0, -0.6 + (k + 0.5) * height)))
    return trimesh.util.concatenate([trimesh.creation.box((0.4, 1.0, 1.2)), *boards])


def hits_of(mesh: trimesh.Trimesh, seen: Observed) -> ShapeHits:
    batch = PoseBatch(POSE.R_world_object[None], POSE.position[None], POSE.scale[None])
    return ShapeCaster(mesh).cast(seen.origin_world, seen.directions_world, batch)


def photo_of(mesh: trimesh.Trimesh) -> tuple[np.ndarray, Observed]:
    """The chest in a photo, its grooves dark."""
    k = CAMERA.intrinsics
    x, y = np.meshgrid(np.arange(k.width) + 0.5, np.arange(k.height) + 0.5)
    batch = PoseBatch(POSE.R_world_object[None], POSE.position[None], POSE.scale[None])
    rays = CAMERA.rays(np.stack([x.ravel(), y.ravel()], axis=1))
    hits = ShapeCaster(mesh).cast(CAMERA.position, rays, batch)
    mask = hits.covered.reshape(k.height, k.width)
    local = CAMERA.position + rays * np.where(hits.covered[0], hits.depth_m[0], 0)[:, None] - POSE.position
    front = (local @ POSE.R_world_object)[:, 0].reshape(mask.shape)
    grey = np.where(mask, np.where(front > 0.215, 190, 120), 60).astype(np.uint8)
    rows, columns = np.nonzero(mask)
    box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
    return np.repeat(grey[..., None], 3, axis=2), observe(CAMERA, box, mask, 1.0, (), 56)


def test_the_right_number_of_drawers_agrees_best() -> None:
    for drawers in (2, 3, 5):
        rgb, seen = photo_of(chest(drawers))
        edges = InnerEdges.of(rgb, seen)
        scores = {n: float(edges.agreement(hits_of(chest(n), seen))[0]) for n in (1, 2, 3, 4, 5)}
        assert max(scores, key=scores.__getitem__) == drawers
        assert scores[drawers] > 0.5


def test_a_picture_without_edges_says_nothing() -> None:
    rgb, seen = photo_of(chest(3))
    edges = InnerEdges.of(np.full_like(rgb, 128), seen)
    assert float(edges.agreement(hits_of(chest(3), seen))[0]) == 0.0
