"""Bean bags."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from diorama_core.library.furniture.kit import *


def bean_bag(size: Size, cloth: Material, seam: Material, tall: float = 1.0, panels: int = 6) -> Parts:
    """A slumped sack with a hollow to sit in; its top leans back, creases run down from it.

    `tall` is how much of the back rises over the seat (0 is a floor cushion).
    """
    d, w, h = size
    n, rows = 56, 24
    a = np.arange(n) * 2 * np.pi / n
    v = np.linspace(0, 1, rows)
    radius = PchipInterpolator(
        [0, 0.04, 0.14, 0.34, 0.55, 0.75, 0.9, 0.97, 1], [0.6, 0.84, 0.98, 1.0, 0.9, 0.7, 0.44, 0.24, 0.02]
    )(v)
    height = PchipInterpolator(
        [0, 0.04, 0.14, 0.34, 0.55, 0.75, 0.9, 1], [0, 0.012, 0.11, 0.34, 0.58, 0.80, 0.94, 1.0]
    )(v)
    slump = -0.34 * d * tall * np.clip(height - 0.35, 0, 1) ** 1.2
    front = np.cos(a)[None, :]
    hollow = 0.46 * tall * np.clip(height[:, None] - 0.38, 0, 1) * np.clip(front + 0.2, 0, 1.2)
    crease = (
        1
        + 0.028 * np.cos(panels * a)[None, :] * np.sin(np.pi * v)[:, None]
        + 0.012 * np.cos(11 * a + 3)[None, :] * np.sin(np.pi * v)[:, None] ** 2
    )
    r = radius[:, None] * crease
    x = 0.48 * d * r * np.cos(a) * (1 - 0.5 * hollow) + slump[:, None] - 0.35 * d * hollow * 0.4
    y = 0.49 * w * r * np.sin(a)
    z = h * (height[:, None] - 0.55 * hollow * radius[:, None])
    rings = np.stack([x, y, np.broadcast_to(z, x.shape)], axis=-1)
    seams = [tube(rings[1:-1, int(k * n / panels)], 0.004, 4) for k in range(panels)]
    return of(cloth, loft(rings, crease_rad=np.pi)) + of(seam, *seams)


DESIGNS: tuple[Design, ...] = (
    design("bean bag", "grey", "grey bean bag", (0.92, 0.85, 0.78), "modern", bean_bag, cloth=m.GREY_FABRIC, seam=m.CHARCOAL_FABRIC),
    design("bean bag", "cord-rust", "rust bean bag", (0.95, 0.90, 0.82), "rustic", bean_bag, cloth=m.RUST_FABRIC, seam=m.RUST_FABRIC, panels=8),
    design("bean bag", "leather", "brown leather bean bag", (0.88, 0.84, 0.70), "classic", bean_bag, cloth=m.BROWN_LEATHER, seam=m.DARK_WALNUT),
    design("bean bag", "canvas", "charcoal canvas bean bag", (0.98, 0.94, 0.80), "industrial", bean_bag, cloth=m.CHARCOAL_FABRIC, seam=m.BLACK_LEATHER, panels=5),
    design("bean bag", "boucle-round", "low ivory bouclé bean bag", (0.82, 0.82, 0.52), "minimal", bean_bag, cloth=s.IVORY_BOUCLE, seam=s.IVORY_BOUCLE, tall=0.35),
)  # fmt: skip
