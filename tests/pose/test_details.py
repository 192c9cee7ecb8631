"""Inner edges of shapes against those of a picture. What a photo shows within an outline, and which of two shapes of
one outline it tells.
"""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.geometry.observed import Observed, observe
from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster, ShapeHits
from diorama_core.pose.details import Details, InnerEdges
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
    batch = PoseBatch.single(POSE)
    return ShapeCaster(mesh).cast(seen.origin_world, seen.directions_world, batch)


def photo_of_chest(mesh: trimesh.Trimesh) -> tuple[np.ndarray, Observed]:
    """The chest in a photo, its grooves dark."""
    k = CAMERA.intrinsics
    x, y = np.meshgrid(np.arange(k.width) + 0.5, np.arange(k.height) + 0.5)
    batch = PoseBatch.single(POSE)
    rays = CAMERA.rays(np.stack([x.ravel(), y.ravel()], axis=1))
    hits = ShapeCaster(mesh).cast(CAMERA.position, rays, batch)
    mask = hits.is_hit.reshape(k.height, k.width)
    local = CAMERA.position + rays * np.where(hits.is_hit[0], hits.depth_m[0], 0)[:, None] - POSE.position
    front = (local @ POSE.R_world_object)[:, 0].reshape(mask.shape)
    grey = np.where(mask, np.where(front > 0.215, 190, 120), 60).astype(np.uint8)
    rows, columns = np.nonzero(mask)
    box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
    return np.repeat(grey[..., None], 3, axis=2), observe(CAMERA, box, mask, 1.0, (), 56)


def test_the_right_number_of_drawers_agrees_best() -> None:
    for drawers in (2, 3, 5):
        rgb, seen = photo_of_chest(chest(drawers))
        edges = InnerEdges.of(rgb, seen)
        scores = {n: float(edges.agreement(hits_of(chest(n), seen))[0]) for n in (1, 2, 3, 4, 5)}
        assert max(scores, key=scores.__getitem__) == drawers
        assert scores[drawers] > 0.5


def test_a_picture_without_edges_says_nothing() -> None:
    rgb, seen = photo_of_chest(chest(3))
    edges = InnerEdges.of(np.full_like(rgb, 128), seen)
    assert float(edges.agreement(hits_of(chest(3), seen))[0]) == 0.0


LIGHT, DARK, BLUE = (200, 180, 150, 255), (90, 70, 50, 255), (60, 70, 150, 255)


def block(*colours: tuple[int, int, int, int]) -> ShapeAppearance:
    """A block of layers as high as one another, from below, of these colours."""
    layers = []
    for k in range(len(colours)):
        layer = trimesh.creation.box((0.4, 1.0, 1.2 / len(colours)))
        layers.append(layer.apply_translation((0.0, 0.0, -0.6 + (k + 0.5) * 1.2 / len(colours))))
    whole = trimesh.util.concatenate(layers)
    rgba = np.repeat(np.array(colours, np.uint8), 12, axis=0)
    vertices, faces = np.asarray(whole.vertices, np.float32), np.asarray(whole.faces, np.int32)
    return ShapeAppearance(vertices, faces, rgba[::12, :3], np.ones(len(colours)), rgba)


def photo_of(shape: ShapeAppearance, brightness: float) -> tuple[np.ndarray, Observed]:
    """The block in its colours, in some light."""
    k = CAMERA.intrinsics
    x, y = np.meshgrid(np.arange(k.width) + 0.5, np.arange(k.height) + 0.5)
    batch = PoseBatch.single(POSE)
    hits = shape.caster.cast(CAMERA.position, CAMERA.rays(np.stack([x.ravel(), y.ravel()], axis=1)), batch)
    mask = hits.is_hit.reshape(k.height, k.width)
    rgb = shape.face_rgba[np.where(hits.is_hit[0], hits.triangles[0], 0), :3].reshape(k.height, k.width, 3)
    rows, columns = np.nonzero(mask)
    box = (float(columns.min()), float(rows.min()), float(columns.max() + 1), float(rows.max() + 1))
    lit = np.where(mask[..., None], brightness * rgb, 60).astype(np.uint8)
    return lit, observe(CAMERA, box, mask, 1.0, (), 56)


def told(details: Details, seen: Observed, shape: ShapeAppearance) -> tuple[float, float]:
    """Share of colours explained, and the log likelihood."""
    batch = PoseBatch.single(POSE)
    hits = shape.caster.cast(seen.origin_world, seen.directions_world, batch)
    return details.share_between_parts(shape, hits), details.log_likelihood(shape, hits)


@pytest.mark.parametrize("brightness", [0.4, 1.0])
def test_parts_where_the_picture_changes_its_colour_come_first_whatever_their_colours(brightness: float) -> None:
    true = block(DARK, LIGHT)
    rgb, seen = photo_of(true, brightness)
    details = Details.of(rgb, seen)
    same, recoloured = told(details, seen, true), told(details, seen, block(BLUE, LIGHT))
    plain, thirds = told(details, seen, block(LIGHT)), told(details, seen, block(DARK, LIGHT, BLUE))
    assert same[0] > 0.9
    assert recoloured[0] == pytest.approx(same[0])
    assert plain[0] == pytest.approx(0.0)
    assert thirds[0] < same[0]
    assert same[1] > max(plain[1], thirds[1])


def test_a_picture_of_one_colour_and_a_shape_without_any_say_nothing_of_parts() -> None:
    true = block(DARK, LIGHT)
    rgb, seen = photo_of(true, 1.0)
    assert told(Details.of(np.full_like(rgb, 128), seen), seen, true)[0] == pytest.approx(0.0)
    unknown = block((0, 0, 0, 0), (0, 0, 0, 0))
    assert told(Details.of(rgb, seen), seen, unknown)[0] == 0.0
