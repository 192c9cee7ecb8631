"""What surfaces mirror, and their colours without it."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.render.gloss import gloss_share, roughness_seen, without_gloss

COSINE = np.linspace(0.3, 1.0, 8)[:, None]
WALNUT = np.tile([0.12, 0.05, 0.03], (8, 1))


@pytest.mark.parametrize(("metallic", "roughness"), [(0.0, 0.55), (0.0, 0.9), (0.45, 0.35)])
def test_a_colour_without_its_gloss_is_the_base_colour(metallic: float, roughness: float) -> None:
    bright = 4.0 * WALNUT
    constant = np.ones_like(COSINE)
    gloss = gloss_share(bright, metallic * constant, (1 - roughness) * constant, COSINE)
    seen = bright * (1 - metallic) + gloss
    np.testing.assert_allclose(without_gloss(seen, metallic, roughness, COSINE), bright, rtol=0.02, atol=0.002)


def test_more_is_mirrored_at_grazing_angles() -> None:
    gloss = gloss_share(WALNUT, 0 * COSINE, 0.5 + 0 * COSINE, COSINE)
    assert (np.diff(gloss[:, 0]) < 0).all()


def test_what_is_nearly_black_mirrors_little() -> None:
    black = np.tile([0.01, 0.002, 0.001], (8, 1))
    rough = roughness_seen(black, 0.0, 0.45)
    assert rough > 0.95
    gloss = gloss_share(black, 0 * COSINE, 1 - rough + 0 * COSINE, np.ones_like(COSINE))
    assert (gloss <= black.min()).all()
    assert roughness_seen(4 * WALNUT, 0.0, 0.45) == pytest.approx(0.45)


def test_a_colour_never_turns_black() -> None:
    seen = np.tile([0.02, 0.01, 0.005], (8, 1))
    assert (without_gloss(seen, 0.0, 0.2, COSINE) > 0).all()
