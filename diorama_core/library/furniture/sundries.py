"""Toys, and plain shapes for things without a name."""

from __future__ import annotations

from functools import partial

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, of, turned
from diorama_core.library.furniture.solids import (
    ball,
    box,
    cushion,
    cylinder,
    lathe,
    prism,
    superellipse,
)
from diorama_core.library.record import SymmetryFold


def teddy(size: Size, fur: Material, muzzle: Material) -> Parts:
    """A sitting teddy bear."""
    d, w, h = size
    body = cushion((0.55 * d, 0.52 * w, 0.52 * h), 2, 2.2, 10).moved(-0.1 * d, 0, 0.02)
    head = cushion((0.5 * d, 0.5 * w, 0.42 * h), 2, 2.1, 10).moved(-0.05 * d, 0, 0.5 * h)
    nose = cushion((0.2 * d, 0.22 * w, 0.15 * h), 2, 2, 6).moved(0.19 * d, 0, 0.56 * h)
    ears = both_sides(cushion((0.12 * d, 0.2 * w, 0.17 * h), 2, 2, 6).moved(-0.06 * d, 0.2 * w, 0.82 * h))
    arms = both_sides(
        cushion((0.22 * d, 0.2 * w, 0.36 * h), 2, 2.2, 8).turned("x", 28).moved(0.06 * d, 0.33 * w, 0.2 * h)
    )
    legs = both_sides(cushion((0.6 * d, 0.24 * w, 0.22 * h), 2.2, 2.2, 8).turned("z", 16).moved(0.2 * d, 0.27 * w, 0.0))
    soles = both_sides(cushion((0.05 * d, 0.16 * w, 0.15 * h), 2, 2, 5).moved(0.475 * d, 0.345 * w, 0.035 * h))
    eyes = both_sides(ball(0.036 * h, 4).moved(0.172 * d, 0.1 * w, 0.735 * h))
    return (
        of(fur, body, head, *ears, *arms, *legs)
        + of(muzzle, nose, *soles)
        + of(m.BLACK, *eyes, cushion((0.05 * d, 0.09 * w, 0.05 * h), 2, 2, 4).moved(0.275 * d, 0, 0.645 * h))
    )


def toy_blocks(size: Size) -> Parts:
    """A little tower of wooden blocks."""
    d, w, h = size
    b = h / 3
    tones = (m.RUST_FABRIC.colour, m.BLUE_GLAZE.colour, m.MUSTARD_FABRIC.colour, m.SAGE.colour)
    paints = [m.paint(f"block {c}", c) for c in tones]
    spots = [(0.2, -0.25, 0, 8), (-0.1, 0.25, 0, -14), (0.02, 0.0, 1, 20), (0.0, 0.03, 2, -6)]
    return [
        p
        for k, (x, y, z, turn) in enumerate(spots)
        for p in (
            q.moved(x * d, y * w, z * b)
            for q in turned(of(m.BIRCH if k == 1 else paints[k % 4], box((b, b, b), 0.006, 2)), "z", turn)
        )
    ]


def toy_car(size: Size, paint: Material, wheel: Material) -> Parts:
    """A wooden car, driving toward +X."""
    d, w, h = size
    body = box((d, w * 0.78, h * 0.4), 0.02, 3).moved(z=h * 0.18)
    cabin = box((d * 0.5, w * 0.7, h * 0.48), 0.03, 3).moved(-0.06 * d, 0, h * 0.52)
    wheels = four(cylinder(h * 0.22, w * 0.16, 0.006, 24).turned("x", 90).moved(0.29 * d, w / 2, h * 0.22))
    panes = [
        box((d * 0.36, w * 0.71, h * 0.2), 0.01).moved(-0.06 * d, 0, h * 0.68),
        box((d * 0.51, w * 0.5, h * 0.2), 0.01).moved(-0.06 * d, 0, h * 0.68),
    ]
    return of(paint, body, cabin) + of(wheel, *wheels) + of(m.DARK_GLASS, *panes)


def toy_ball(size: Size, a: Material, b: Material) -> Parts:
    """A ball with a band."""
    d = size[0]
    band = lathe(
        [(d * 0.488, d * 0.38), (d * 0.503, d * 0.42), (d * 0.503, d * 0.58), (d * 0.488, d * 0.62)], 40, np.pi
    )
    return of(a, ball(d, 12)) + of(b, band)


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


BROWN_FUR = m.fabric("brown plush", "#96744f", 0.05)


PALE_FUR = m.fabric("pale plush", "#d5c4a5", 0.05)


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1
) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "toy",
        "teddy",
        "brown teddy bear",
        (0.26, 0.28, 0.34),
        "classic",
        partial(teddy, fur=BROWN_FUR, muzzle=PALE_FUR),
    ),
    _d(
        "toy",
        "teddy-pale",
        "small cream teddy bear",
        (0.20, 0.22, 0.26),
        "modern",
        partial(teddy, fur=PALE_FUR, muzzle=BROWN_FUR),
    ),
    _d("toy", "blocks", "wooden toy blocks", (0.15, 0.20, 0.21), "minimal", toy_blocks),
    _d("toy", "car", "wooden toy car", (0.24, 0.13, 0.12), "rustic", partial(toy_car, paint=m.SAGE, wheel=m.OAK)),
    _d("toy", "ball", "striped ball", (0.22, 0.22, 0.22), "modern", partial(toy_ball, a=m.CREAM, b=m.NAVY), 36),
    _d(
        "object",
        "cube",
        "rounded light grey cube",
        (0.60, 0.60, 0.60),
        "minimal",
        partial(rounded_block, material=m.LIGHT_GREY, radius=0.04),
        4,
    ),
    _d(
        "object",
        "tall",
        "tall rounded block",
        (0.50, 0.50, 1.20),
        "minimal",
        partial(rounded_block, material=m.LIGHT_GREY, radius=0.04),
        4,
    ),
    _d(
        "object",
        "flat",
        "low wide rounded block",
        (0.60, 1.00, 0.25),
        "minimal",
        partial(rounded_block, material=m.LIGHT_GREY, radius=0.04),
        2,
    ),
    _d(
        "object",
        "slab",
        "upright thin panel",
        (0.08, 0.80, 0.90),
        "minimal",
        partial(rounded_block, material=m.LIGHT_GREY, radius=0.02),
        2,
    ),
    _d(
        "object",
        "drum",
        "grey drum with a lid",
        (0.45, 0.45, 0.60),
        "modern",
        partial(drum, material=m.LIGHT_GREY, band=m.GREY),
        36,
    ),
    _d(
        "object",
        "pillar",
        "tall cylinder",
        (0.30, 0.30, 1.10),
        "modern",
        partial(drum, material=m.LIGHT_GREY, band=m.GREY),
        36,
    ),
    _d(
        "object",
        "lidded",
        "oak box with a lid",
        (0.40, 0.55, 0.35),
        "classic",
        partial(lidded, body=m.OAK, lid=m.OAK),
        2,
    ),
    _d(
        "object",
        "small",
        "small lidded box",
        (0.16, 0.22, 0.12),
        "classic",
        partial(lidded, body=m.STONEWARE, lid=m.WALNUT),
        2,
    ),
)
