"""Pictures on surfaces: sharp from near, without specks from afar."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.render.appearance import Material, Surface
from diorama_core.render.world import PlacedSurface, World, _filter, _pyramid

CHECKS = (255 * ((np.indices((64, 64)) // 4).sum(axis=0) % 2)).astype(np.uint8)[..., None].repeat(3, axis=2)


def wall() -> World:
    """A square of 4 m at y = 0, on which fine checks are repeated four times each way."""
    vertices = np.array([[-2.0, 0, -2], [2, 0, -2], [2, 0, 2], [-2, 0, 2]], np.float32)
    surface = Surface(
        vertices=vertices,
        faces=np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        normals=np.tile(np.array([0, -1, 0], np.float32), (4, 1)),
        material=Material(colour=(1.0, 1.0, 1.0), texture=CHECKS),
        uv=np.array([[0, 0], [4, 0], [4, 4], [0, 4]], np.float32),
    )
    return World([PlacedSurface((surface,), np.eye(4), 0)])


def albedo(footprint_m: float | None, slant: float = 0.0) -> np.ndarray:
    targets = np.random.default_rng(0).uniform(-1.5, 1.5, (400, 2))
    away = np.array([np.sin(slant), -np.cos(slant), 0.0]) * 5.0
    points = np.column_stack([targets[:, 0], np.zeros(400), targets[:, 1]])
    rays = np.concatenate([points + away, np.tile(-away / 5.0, (400, 1))], axis=1).astype(np.float32)
    world = wall()
    hits = world.caster.first_hits(rays)
    footprint = None if footprint_m is None else np.full(400, footprint_m, np.float32)
    return world.places(rays, hits, footprint).albedo


def test_from_near_every_check_is_seen_and_from_afar_their_mean() -> None:
    near, far = albedo(0.001), albedo(0.4)
    assert near.std() > 0.2
    assert far.std() < 0.02
    assert far.mean() == pytest.approx(0.5, abs=0.02)


def test_without_a_footprint_pictures_are_as_sharp_as_from_near() -> None:
    np.testing.assert_allclose(albedo(None), albedo(1e-4), atol=1e-6)


def test_a_surface_seen_aslant_is_blurred_more() -> None:
    assert albedo(0.05, slant=1.3).std() < albedo(0.05).std()


@given(st.integers(1, 37), st.integers(1, 37), st.floats(0.0, 3.0), st.integers(0, 50))
def test_a_plain_picture_stays_plain_at_every_level(height: int, width: int, spread: float, seed: int) -> None:
    levels = _pyramid(np.full((height, width, 3), 0.3, np.float32))
    uv = np.random.default_rng(seed).uniform(-2, 2, (9, 2)).astype(np.float32)
    found = _filter(levels, uv, np.full(9, spread, np.float32), repeat=True)
    np.testing.assert_allclose(found, 0.3, atol=1e-6)
