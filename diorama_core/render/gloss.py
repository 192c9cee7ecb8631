"""How much of its surroundings a surface mirrors (Schlick's Fresnel), and what a photo's colour is without that."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Float32

DIELECTRIC = 0.04
"""Share that everything but metal mirrors when seen head-on."""
MIN_LEFT = 0.2
"""A colour without its gloss is at least this share of it: light and gloss are known roughly only."""


def gloss_share(
    albedo: Float[np.ndarray, "*n 3"],
    metallic: Float[np.ndarray, "*n 1"],
    smooth: Float[np.ndarray, "*n 1"],
    cosine: Float[np.ndarray, "*n 1"],
) -> Float32[np.ndarray, "*n 3"]:
    """Share of the light around that each place mirrors toward the viewer.

    Args:
        albedo: Linear base colours.
        metallic: 0 to 1.
        smooth: One less the roughness.
        cosine: Of the angle between the normal and the direction to the viewer.
    """
    head_on = DIELECTRIC * (1 - metallic) + albedo * metallic
    fresnel = head_on + (np.maximum(smooth, head_on) - head_on) * (1 - cosine) ** 5
    return np.asarray(fresnel * np.where(metallic > 0.5, 1, smooth), dtype=np.float32)


def roughness_seen(seen: Float[np.ndarray, "*n 3"], metallic: float, usual: float) -> float:
    """The roughness of a surface that is usually so rough, and more where it is seen too dark to mirror that much.

    What a surface mirrors is in every channel of its colour, so the darkest one limits it.

    Args:
        seen: Linear colours in even light of 1.
        metallic: 0 to 1, at most half.
        usual: Of its kind of material, 0 to 1.
    """
    most = (1.0 - MIN_LEFT) * float(np.median(seen.min(axis=1))) / (DIELECTRIC * (1 - metallic))
    return 1.0 - min(1.0 - usual, most)


def without_gloss(
    seen: Float[np.ndarray, "n 3"], metallic: float, roughness: float, cosine: Float[np.ndarray, "n 1"]
) -> Float[np.ndarray, "n 3"]:
    """Linear base colours that, with their gloss, look as they were seen in even light of 1.

    Args:
        seen: Linear.
        metallic: 0 to 1, at most half.
        roughness: 0 to 1.
        cosine: Of the angle between the normal and the direction to the viewer.
    """
    smooth, grazing = 1.0 - roughness, (1 - cosine) ** 5
    added = smooth * (DIELECTRIC * (1 - metallic) * (1 - grazing) + smooth * grazing)
    factor = (1 - metallic) + smooth * metallic * (1 - grazing)
    return np.asarray(np.maximum(seen - added, MIN_LEFT * seen) / factor)
