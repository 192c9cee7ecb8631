"""Patches of points as OpenShape was trained with them."""

from __future__ import annotations

import numpy as np

from diorama_core.models.openshape import NEIGHBOURS, PATCHES, RADIUS, patches_of


def points_of(rng: np.random.Generator, count: int = 3000) -> tuple[np.ndarray, np.ndarray]:
    return rng.uniform([-1.0, -0.4, 0.0], [1.0, 0.4, 0.7], (count, 3)), rng.random((count, 3))


def test_patches_are_near_their_middles_and_middles_far_apart(rng: np.random.Generator) -> None:
    points, colours = points_of(rng)
    centres, patches = patches_of(points, colours)
    assert patches.shape == (PATCHES, NEIGHBOURS, 9)
    assert np.linalg.norm(patches[..., :3], axis=2).max() <= RADIUS + 1e-6
    np.testing.assert_allclose(
        patches[..., 3:6] - patches[..., :3], np.repeat(centres[:, None], NEIGHBOURS, 1), atol=1e-6
    )
    apart = np.linalg.norm(centres[:, None] - centres[None], axis=2) + 2 * np.eye(PATCHES)
    some = points[rng.permutation(len(points))[:PATCHES]]
    by_chance = np.linalg.norm(some[:, None] - some[None], axis=2) + 2 * np.eye(PATCHES)
    assert apart.min() > 5 * by_chance.min()


def test_neither_place_nor_size_counts_and_colours_stay_with_their_points(rng: np.random.Generator) -> None:
    points, colours = points_of(rng)
    centres, patches = patches_of(points, colours)
    moved = patches_of(points * 3.0 + [5.0, 1.0, -2.0], colours)
    np.testing.assert_allclose(moved[0], centres, atol=1e-5)
    # Mirrored, as the network's own data were: a point is found again by its place, with its colour.
    scaled = points - points.mean(axis=0)
    scaled = scaled / np.linalg.norm(scaled, axis=1).max() * [1.0, -1.0, 1.0]
    for row in patches[::40, 0]:
        nearest = int(np.linalg.norm(scaled - row[3:6], axis=1).argmin())
        np.testing.assert_allclose(row[3:6], scaled[nearest], atol=1e-5)
        np.testing.assert_allclose(row[6:], colours[nearest], atol=1e-5)


def test_few_points_are_seen_several_times() -> None:
    centres, patches = patches_of(np.eye(3), np.zeros((3, 3)))
    assert centres.shape == (PATCHES, 3)
    assert len(np.unique(patches.reshape(-1, 9), axis=0)) == 3
