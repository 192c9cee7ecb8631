"""Plain shapes for things without a name."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def rounded_block(size: Size, material: Material, radius: float) -> Parts:
    """A neutral rounded box."""
    return of(material, box(size, min(radius, 0.35 * min(size)), 3))


def drum(size: Size, material: Material, band: Material) -> Parts:
    """A neutral cylinder with a lid's line."""
    d, w, h = size
    o = superellipse(d, w, 2.0, 48)
    return of(material, prism(o, h * 0.8, 0.01), prism(o, h * 0.196, 0.01).moved(z=h * 0.804)) + of(
        band, prism(o * 0.985, h * 0.02, 0.001).moved(z=h * 0.79)
    )


def lidded(size: Size, body: Material, lid: Material) -> Parts:
    """A neutral box with a lid."""
    d, w, h = size
    t = max(0.12 * h, 0.012)
    return of(body, box((d * 0.97, w * 0.97, h - t), 0.006, 2)) + of(
        lid, box((d, w, t), min(0.01, t / 3), 2).moved(z=h - t)
    )


DESIGNS: tuple[Design, ...] = (
    design("object", "cube", "rounded light grey cube", (0.60, 0.60, 0.60), "minimal", rounded_block, 4, material=m.LIGHT_GREY, radius=0.04),
    design("object", "tall", "tall rounded block", (0.50, 0.50, 1.20), "minimal", rounded_block, 4, material=m.LIGHT_GREY, radius=0.04),
    design("object", "flat", "low wide rounded block", (0.60, 1.00, 0.25), "minimal", rounded_block, 2, material=m.LIGHT_GREY, radius=0.04),
    design("object", "slab", "upright thin panel", (0.08, 0.80, 0.90), "minimal", rounded_block, 2, material=m.LIGHT_GREY, radius=0.02),
    design("object", "drum", "grey drum with a lid", (0.45, 0.45, 0.60), "modern", drum, 36, material=m.LIGHT_GREY, band=m.GREY),
    design("object", "pillar", "tall cylinder", (0.30, 0.30, 1.10), "modern", drum, 36, material=m.LIGHT_GREY, band=m.GREY),
    design("object", "lidded", "oak box with a lid", (0.40, 0.55, 0.35), "classic", lidded, 2, body=m.OAK, lid=m.OAK),
    design("object", "small", "small lidded box", (0.16, 0.22, 0.12), "classic", lidded, 2, body=m.STONEWARE, lid=m.WALNUT),
)  # fmt: skip
