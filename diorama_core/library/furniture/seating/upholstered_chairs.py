"""Upholstered dining chairs."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def padded_chair(size: Size, cloth: Material, legs: Material, arms: bool = False) -> Parts:
    """An upholstered dining chair on tapered legs."""
    d, w, h = size
    seat_z, back_t = 0.47, 0.075
    parts = of(legs, *four(taper((d * 0.44, w * 0.42, 0), (d * 0.36, w * 0.38, seat_z - 0.09), 0.024, 0.036)))
    parts += of(cloth, box((d * 0.92, w * 0.96, 0.05), 0.02, 2).moved(0.02, 0, seat_z - 0.105))
    parts += of(cloth, cushion((d * 0.94, w, 0.085), 8, 3.4, 12).moved(0.02, 0, seat_z - 0.065))
    back = (
        cushion((h - seat_z + 0.05, w * 0.98, back_t), 6, 3.2, 12)
        .turned("y", -97)
        .moved(-d * 0.36, 0, seat_z + (h - seat_z) / 2)
    )
    parts += of(cloth, back)
    if arms:
        arm = bend(
            [
                (0.3 * d, 0.47 * w, seat_z - 0.05),
                (0.3 * d, 0.5 * w, seat_z + 0.17),
                (0.1 * d, 0.5 * w, seat_z + 0.2),
                (-0.38 * d, 0.47 * w, seat_z + 0.22),
            ],
            6,
        )
        parts += of(legs, *both_sides(tube(arm, 0.014)))
    return parts


DESIGNS: tuple[Design, ...] = (
    design("chair", "padded-grey", "grey upholstered dining chair", (0.58, 0.49, 0.87), "modern", padded_chair, cloth=m.GREY_FABRIC, legs=m.OAK),
    design("chair", "padded-blue", "slate blue upholstered chair with arms", (0.59, 0.56, 0.84), "modern", padded_chair, cloth=m.BLUE_FABRIC, legs=m.BLACK_STEEL, arms=True),
    design("chair", "padded-tan", "tan leather dining chair", (0.60, 0.48, 0.95), "classic", padded_chair, cloth=m.TAN_LEATHER, legs=m.DARK_WALNUT),
)  # fmt: skip
