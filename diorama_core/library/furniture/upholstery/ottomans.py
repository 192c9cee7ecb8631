"""Ottomans, footstools and poufs."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def square_ottoman(size: Size, cloth: Material, legs: Material) -> Parts:
    """An upholstered footstool with piping."""
    d, w, h = size
    piping = [
        tube(ring_path(superellipse(d * 0.975, w * 0.975, 10, 56), z), 0.005, 5, closed=True) for z in (h - 0.13,)
    ]
    return of(
        legs, *four(taper((d / 2 - 0.05, w / 2 - 0.05, 0), (d / 2 - 0.065, w / 2 - 0.065, 0.12), 0.024, 0.04))
    ) + of(
        cloth,
        box((d - 0.02, w - 0.02, h - 0.2), 0.02, 2).moved(z=0.1),
        cushion((d, w, 0.15), 10, 4, 12).moved(z=h - 0.15),
        *piping,
    )


def round_pouf(size: Size, cloth: Material, ribs: int = 0) -> Parts:
    """A floor pouf; ribbed like a knitted or leather one when `ribs` is given."""
    d, _, h = size
    n, rows = max(8 * ribs, 40), 13
    a = np.arange(n) * 2 * np.pi / n
    groove = 1 - 0.035 * np.abs(np.cos(ribs * a / 2)) ** 6 if ribs else np.ones(n)
    t = np.linspace(-1, 1, rows)
    r = (1 - np.abs(t) ** 3.2) ** (1 / 2.4)
    r[0] = r[-1] = 0.03
    rings = np.stack(
        [
            np.stack([np.cos(a) * groove * rr, np.sin(a) * groove * rr, np.full(n, tt)], axis=1)
            for rr, tt in zip(r, t, strict=True)
        ]
    )
    rings *= np.array([d / 2, d / 2, h / 2])
    rings[:, :, 2] += h / 2
    return of(cloth, loft(rings, crease_rad=np.pi), cylinder(0.022, 0.008, 0.003, 16).moved(z=h - 0.006))


DESIGNS: tuple[Design, ...] = (
    design("ottoman", "square-grey", "square grey footstool", (0.55, 0.60, 0.42), "modern", square_ottoman, 2, cloth=m.GREY_FABRIC, legs=m.OAK),
    design("ottoman", "wide-leather", "wide brown leather ottoman", (0.60, 0.90, 0.43), "classic", square_ottoman, 2, cloth=m.BROWN_LEATHER, legs=m.DARK_WALNUT),
    design("ottoman", "pouf-oatmeal", "ribbed oatmeal pouf", (0.55, 0.55, 0.38), "rustic", round_pouf, 36, cloth=m.OATMEAL, ribs=16),
    design("ottoman", "pouf-leather", "tan leather pouf", (0.52, 0.52, 0.36), "modern", round_pouf, 36, cloth=m.TAN_LEATHER, ribs=10),
    design("ottoman", "pouf-ochre", "smooth ochre pouf", (0.58, 0.58, 0.40), "modern", round_pouf, 36, cloth=m.MUSTARD_FABRIC),
)  # fmt: skip
