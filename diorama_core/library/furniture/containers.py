"""Boxes, baskets and bins."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.hollow_ware import hollow
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, of
from diorama_core.library.furniture.solids import (
    bend,
    box,
    cylinder,
    lathe,
    loft,
    prism,
    ring_path,
    rod,
    rounded_rectangle,
    superellipse,
    tube,
)
from diorama_core.library.record import SymmetryFold


def carton(size: Size, card: Material, opened: bool = False) -> Parts:
    """A cardboard box, taped shut or open."""
    d, w, h = size
    if not opened:
        tape = box((0.05, w + 0.001, 0.001), 0.0004).moved(z=h - 0.0008)
        drops = both_sides(box((0.05, 0.001, 0.07), 0.0004).moved(0, w / 2, h - 0.07))
        return (
            of(card, box((d, w, h - 0.001), 0.003))
            + of(m.LINEN, tape, *drops)
            + of(m.SHADOW, box((0.0015, w * 0.995, 0.0006), 0.0002).moved(z=h - 0.0002))
        )
    body = 0.8 * h
    t, bd, bw = 0.005, d * 0.74, w * 0.78
    walls = [box((t, bw, body), 0.002).moved(s * (bd - t) / 2, 0, 0) for s in (1, -1)] + [
        box((bd, t, body), 0.002).moved(0, s * (bw - t) / 2, 0) for s in (1, -1)
    ]
    flap_x = [
        box((t, bw * 0.98, 0.3 * bd), 0.002).turned("y", s * 40).moved(s * (bd / 2 - 0.001), 0, body - 0.003)
        for s in (1, -1)
    ]
    flap_y = [
        box((bd * 0.98, t, 0.26 * bw), 0.002).turned("x", -s * 55).moved(0, s * (bw / 2 - 0.001), body - 0.003)
        for s in (1, -1)
    ]
    return of(card, *walls, box((bd, bw, t), 0.002), *flap_x, *flap_y)


def crate(size: Size, wood: Material) -> Parts:
    """A slatted wooden crate."""
    d, w, h = size
    t, n = 0.012, 3
    slat = (h - 0.02 * (n - 1)) / n
    sides = [
        box((d - 2 * t, t, slat), 0.002).moved(0, s * (w - t) / 2, k * (slat + 0.02)) for s in (1, -1) for k in range(n)
    ]
    ends = [box((t, w, slat), 0.002).moved(s * (d - t) / 2, 0, k * (slat + 0.02)) for s in (1, -1) for k in range(n)]
    posts = four(box((0.022, 0.022, h - 0.004), 0.002).moved(d / 2 - t - 0.011, w / 2 - t - 0.011))
    floor = [box((d - 2 * t, w / 4.4, 0.008), 0.002).moved(0, y, 0.002) for y in np.linspace(-0.37 * w, 0.37 * w, 4)]
    return of(wood, *sides, *ends, *posts, *floor)


def storage_tub(size: Size, tub: Material, lid: Material) -> Parts:
    """A plastic storage box with a clipped lid."""
    d, w, h = size
    o = rounded_rectangle(d, w, 0.04, 6)
    body = loft(
        np.array(
            [
                ring_path(o * s, z)
                for s, z in ((0.86, 0), (0.88, 0.01), (0.955, h - 0.05), (0.985, h - 0.048), (0.985, h - 0.03))
            ]
        ),
        crease_rad=np.deg2rad(50),
    )
    clips = both_sides(box((0.09, 0.012, 0.06), 0.004, 2).moved(0, w / 2 - 0.012, h - 0.085))
    return of(tub, body) + of(
        lid, prism(o, 0.022, 0.008).moved(z=h - 0.032), prism(o * 0.9, 0.012, 0.005).moved(z=h - 0.012), *clips
    )


def suitcase(size: Size, case: Material, trim: Material) -> Parts:
    """An upright suitcase on wheels."""
    d, w, h = size
    body = box((d, w, h - 0.16), 0.045, 3).moved(z=0.05)
    ribs = [box((d + 0.008, 0.012, h - 0.3), 0.004).moved(0, y, 0.12) for y in np.linspace(-0.34 * w, 0.34 * w, 6)]
    wheels = four(cylinder(0.026, 0.022, 0.005, 14).turned("x", 90).moved(d / 2 - 0.045, w / 2 - 0.06, 0.026))
    rods = both_sides(rod((-d * 0.3, w * 0.2, h - 0.12), (-d * 0.3, w * 0.2, h - 0.012), 0.007))
    return of(case, body, *ribs) + of(
        trim,
        *wheels,
        *rods,
        rod((-d * 0.3, -w * 0.22, h - 0.014), (-d * 0.3, w * 0.22, h - 0.014), 0.013),
        box((0.03, 0.13, 0.02), 0.006).moved(0.02, 0, h - 0.11),
    )


def chest(size: Size, wood: Material, strap: Material) -> Parts:
    """A trunk with metal bands."""
    d, w, h = size
    lid = 0.3 * h
    bands = [box((d + 0.004, 0.035, h - 0.002), 0.003).moved(0, s * w * 0.3, 0.001) for s in (1, -1)]
    return of(wood, box((d, w, h - lid - 0.004), 0.006, 2), box((d, w, lid), 0.02, 2).moved(z=h - lid)) + of(
        strap, *bands, box((0.012, 0.07, 0.07), 0.003).moved(d / 2 + 0.003, 0, h - lid - 0.045)
    )


def woven_basket(
    size: Size, cane: Material, outline: Literal["round", "square"], handles: bool = True, lid: bool = False
) -> Parts:
    """A woven basket."""
    d, w, h = size
    o = superellipse(d, w, 2.0 if outline == "round" else 7.0, 44)
    body_h = h - (0.05 if handles and not lid else 0.03 if lid else 0.012)
    layers = [
        (0.8, 0),
        (0.84, 0.012),
        (0.97, body_h * 0.6),
        (0.95, body_h),
        (0.91, body_h),
        (0.92, body_h * 0.6),
        (0.8, 0.02),
        (0.03, 0.016),
    ]
    parts = of(
        cane,
        loft(np.array([ring_path(o * s, z) for s, z in layers]), crease_rad=np.deg2rad(50)),
        tube(ring_path(o * 0.945, body_h), 0.013, 7, closed=True),
    )
    if lid:
        parts += of(
            cane,
            loft(
                np.array(
                    [
                        ring_path(o * s, z)
                        for s, z in ((0.96, body_h + 0.002), (0.98, body_h + 0.012), (0.6, h - 0.012), (0.05, h - 0.01))
                    ]
                ),
                crease_rad=np.deg2rad(60),
            ),
        )
    if handles and not lid:
        ear = tube(
            bend(
                [
                    (-0.07, 0.455 * w, body_h - 0.01),
                    (-0.05, 0.475 * w, h - 0.008),
                    (0.05, 0.475 * w, h - 0.008),
                    (0.07, 0.455 * w, body_h - 0.01),
                ],
                4,
            ),
            0.009,
            8,
        )
        parts += of(m.TAN_LEATHER, *both_sides(ear))
    return parts


def wire_basket(size: Size, wire: Material) -> Parts:
    """A basket of welded wire."""
    d, w, h = size
    hoops = [
        tube(ring_path(superellipse(d * s, w * s, 6, 36), z), 0.003 if z < h - 0.02 else 0.005, 5, closed=True)
        for s, z in ((0.84, 0.004), (0.89, h * 0.33), (0.94, h * 0.66), (0.985, h - 0.006))
    ]
    o, top = superellipse(d * 0.84, w * 0.84, 6, 28), superellipse(d * 0.985, w * 0.985, 6, 28)
    ribs = [rod((*a, 0.004), (*b, h - 0.006), 0.002, segments=5) for a, b in zip(o, top, strict=True)]
    floor = [
        rod((-0.42 * d, y, 0.004), (0.42 * d, y, 0.004), 0.002, segments=5) for y in np.linspace(-0.4 * w, 0.4 * w, 9)
    ]
    return of(wire, *hoops, *ribs, *floor)


def bin_(size: Size, body: Material, kind: Literal["open", "pedal", "swing", "mesh"]) -> Parts:
    """A waste bin."""
    d, w, h = size
    r = min(d, w) / 2
    if kind == "open":
        return of(body, hollow(((0.78, 0), (0.8, 0.01), (0.98, 0.97), (1.0, 0.985), (0.99, 1.0)), r, h, 0.006))
    if kind == "mesh":
        o = superellipse(2 * r, 2 * r, 2, 40)
        ribs = [rod((*(a * 0.76), 0.01), (*(a * 0.985), h - 0.01), 0.0018, segments=4) for a in o]
        hoops = [
            tube(
                ring_path(o * (0.76 + 0.225 * f), 0.006 + (h - 0.012) * f),
                0.002 if 0 < f < 1 else 0.006,
                5,
                closed=True,
            )
            for f in np.linspace(0, 1, 9)
        ]
        return of(body, *ribs, *hoops, cylinder(r * 0.75, 0.006, 0.001, 32))
    if kind == "pedal":
        can = cylinder(r * 0.96, h * 0.8, 0.006, 40).moved(z=0.03)
        dome = lathe(
            [(r * 0.98, 0.84 * h), (r, 0.86 * h), (r * 0.97, 0.92 * h), (r * 0.6, 0.985 * h), (0.005, h)],
            40,
            np.deg2rad(60),
        )
        return of(body, can, dome) + of(
            m.BLACK, cylinder(r, 0.035, 0.006, 40), box((0.06, 0.07, 0.012), 0.004).moved(r + 0.01, 0, 0.008)
        )
    o = rounded_rectangle(d, w, 0.05, 6)
    can = loft(np.array([ring_path(o * s, z) for s, z in ((0.84, 0), (0.86, 0.012), (0.97, 0.76 * h))]))
    hood = loft(
        np.array([ring_path(o * s, z) for s, z in ((1.0, 0.75 * h), (1.0, 0.8 * h), (0.86, 0.96 * h), (0.7, h))]),
        crease_rad=np.deg2rad(45),
    )
    return of(body, can, hood) + of(
        m.CHARCOAL, box((0.012, w * 0.6, 0.16 * h), 0.004).turned("y", -26).moved(d * 0.475, 0, 0.79 * h)
    )


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1
) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d("box", "carton", "closed cardboard box", (0.35, 0.45, 0.32), "minimal", partial(carton, card=m.CARDBOARD), 2),
    _d(
        "box",
        "carton-open",
        "open cardboard box",
        (0.50, 0.55, 0.42),
        "minimal",
        partial(carton, card=m.CARDBOARD, opened=True),
        2,
    ),
    _d("box", "crate", "pine crate", (0.32, 0.46, 0.28), "rustic", partial(crate, wood=m.PINE), 2),
    _d(
        "box",
        "tub",
        "storage box with a lid",
        (0.38, 0.54, 0.30),
        "modern",
        partial(storage_tub, tub=m.LIGHT_GREY, lid=m.WHITE),
        2,
    ),
    _d(
        "box",
        "suitcase",
        "upright navy suitcase",
        (0.26, 0.44, 0.68),
        "modern",
        partial(suitcase, case=m.NAVY, trim=m.BLACK),
    ),
    _d("box", "trunk", "old wooden trunk", (0.46, 0.85, 0.46), "rustic", partial(chest, wood=m.WALNUT, strap=m.IRON)),
    _d(
        "basket",
        "round",
        "round wicker basket with handles",
        (0.42, 0.44, 0.38),
        "rustic",
        partial(woven_basket, cane=m.WICKER, outline="round"),
        2,
    ),
    _d(
        "basket",
        "hamper",
        "lidded laundry hamper",
        (0.40, 0.46, 0.58),
        "classic",
        partial(woven_basket, cane=m.RATTAN, outline="square", lid=True),
        2,
    ),
    _d(
        "basket",
        "shelf",
        "dark rectangular shelf basket",
        (0.30, 0.40, 0.26),
        "modern",
        partial(woven_basket, cane=m.DARK_WICKER, outline="square"),
        2,
    ),
    _d(
        "basket",
        "wire",
        "black wire basket",
        (0.30, 0.38, 0.24),
        "industrial",
        partial(wire_basket, wire=m.BLACK_STEEL),
        2,
    ),
    _d(
        "trash can",
        "open-white",
        "white waste-paper bin",
        (0.28, 0.28, 0.32),
        "minimal",
        partial(bin_, body=m.WHITE, kind="open"),
        36,
    ),
    _d(
        "trash can",
        "pedal",
        "steel pedal bin",
        (0.34, 0.30, 0.62),
        "modern",
        partial(bin_, body=m.STAINLESS, kind="pedal"),
    ),
    _d(
        "trash can",
        "swing",
        "grey swing-lid bin",
        (0.30, 0.38, 0.66),
        "classic",
        partial(bin_, body=m.GREY, kind="swing"),
    ),
    _d(
        "trash can",
        "mesh",
        "black mesh waste basket",
        (0.29, 0.29, 0.34),
        "industrial",
        partial(bin_, body=m.BLACK_STEEL, kind="mesh"),
        36,
    ),
)
