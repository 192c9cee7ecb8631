"""Benches."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def wooden_bench(size: Size, wood: Material, legs: Material, planks: int = 2) -> Parts:
    """Planks on two trestles."""
    d, w, h = size
    gap = 0.008
    each = (d - gap * (planks - 1)) / planks
    tops = [
        box((each, w, 0.034), 0.006).moved(-d / 2 + each / 2 + k * (each + gap), 0, h - 0.034) for k in range(planks)
    ]
    leg = taper((d * 0.42, w / 2 - 0.09, 0), (d * 0.38, w / 2 - 0.13, h - 0.034), 0.042, 0.056)
    ties = both_sides(beam((-d * 0.42, w / 2 - 0.125, h - 0.07), (d * 0.42, w / 2 - 0.125, h - 0.07), 0.03, 0.07))
    return of(wood, *tops) + of(
        legs, *four(leg), *ties, beam((0, -w / 2 + 0.12, h * 0.72), (0, w / 2 - 0.12, h * 0.72), 0.03, 0.05)
    )


def padded_bench(size: Size, cloth: Material, legs: Material) -> Parts:
    """An upholstered hall or bed-end bench."""
    d, w, h = size
    leg = taper((d / 2 - 0.04, w / 2 - 0.07, 0), (d / 2 - 0.06, w / 2 - 0.1, h - 0.13), 0.024, 0.04)
    frame = box((d - 0.04, w - 0.04, 0.045), 0.006).moved(z=h - 0.15)
    pad = cushion((d, w, 0.12), 12, 3.6, 14).moved(z=h - 0.12)
    piping = tube(ring_path(superellipse(d * 0.985, w * 0.99, 11, 64), h - 0.06), 0.004, 6, closed=True)
    return of(legs, *four(leg), frame) + of(cloth, pad, piping)


def hairpin_bench(size: Size, wood: Material, steel: Material) -> Parts:
    """A thick plank on bent steel rod."""
    d, w, h = size
    pin = bend(
        [
            (d * 0.44, w / 2 - 0.1, h - 0.04),
            (d * 0.40, w / 2 - 0.07, 0.02),
            (d * 0.385, w / 2 - 0.075, 0.007),
            (d * 0.36, w / 2 - 0.09, 0.02),
            (d * 0.3, w / 2 - 0.19, h - 0.04),
        ],
        5,
    )
    return of(wood, box((d, w, 0.045), 0.009).moved(z=h - 0.045)) + of(steel, *four(tube(pin, 0.006)))


DESIGNS: tuple[Design, ...] = (
    design("bench", "plank-oak", "oak plank bench", (0.36, 1.30, 0.45), "rustic", wooden_bench, 2, wood=m.OAK, legs=m.OAK),
    design("bench", "plank-reclaimed", "reclaimed-wood bench with black legs", (0.38, 1.50, 0.46), "industrial", wooden_bench, 2, wood=m.RECLAIMED, legs=m.BLACK_WOOD, planks=3),
    design("bench", "padded-linen", "linen upholstered bench", (0.42, 1.20, 0.48), "classic", padded_bench, 2, cloth=m.LINEN, legs=m.WALNUT),
    design("bench", "padded-green", "forest green upholstered bench", (0.44, 1.05, 0.46), "modern", padded_bench, 2, cloth=m.GREEN_FABRIC, legs=m.BRASS),
    design("bench", "hairpin", "walnut bench on hairpin legs", (0.36, 1.10, 0.45), "industrial", hairpin_bench, 2, wood=m.WALNUT, steel=m.BLACK_STEEL),
)  # fmt: skip
