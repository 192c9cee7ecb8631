"""Blanket boxes, trunks and lidded benches."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def blanket_box(
    size: Size,
    wood: Material,
    panels: int,
    feet: Material,
    metal: Material | None = None,
    cushioned: Material | None = None,
) -> Parts:
    """A lidded box with framed panels; plain when `panels` is 0, a padded lid when `cushioned`."""
    d, w, h = size
    thick = 0.028
    top = h - (0.07 if cushioned is not None else 0.0)
    cavity = Cavity((d - 0.03, w - 0.03, top - thick - 0.06), (0, 0, 0.055), opens="top")
    cover = of(wood, box((d, w, thick), 0.009, 2).moved(z=top - thick))
    gap = box((d - 0.034, w - 0.034, 0.01), 0.002).moved(z=top - thick - 0.008)
    base = [
        box((d - 0.01, w - 0.01, 0.03), 0.008, 2).moved(z=0.045),
        *four(box((0.07, 0.07, 0.05), 0.012, 2).moved(d / 2 - 0.045, w / 2 - 0.045)),
    ]
    parts = cavity.body(wood, 0.006, 2) + of(feet, *base) + with_role("filler", of(m.SHADOW, gap))
    tall = top - thick - 0.13
    if panels:
        x, each = d / 2 - 0.013, (w - 0.05) / panels
        stiles = [
            box((0.014, 0.055, tall + 0.05), 0.003).moved(x, -w / 2 + 0.025 + each * k, 0.085)
            for k in range(panels + 1)
        ]
        rails = [box((0.014, w - 0.03, 0.055), 0.003).moved(x, 0, z) for z in (0.085, top - thick - 0.065)]
        ends = both_sides(
            *(box((d - 0.03, 0.014, 0.055), 0.003).moved(0, w / 2 - 0.013, z) for z in (0.085, top - thick - 0.065))
        )
        parts += of(wood, *stiles, *rails, *ends)
    if metal is not None:
        parts += of(metal, box((0.012, 0.05, 0.07), 0.004).moved(d / 2 - 0.008, 0, top - thick - 0.06))
    if cushioned is not None:
        cover += of(cushioned, cushion((d, w, 0.075), 12, 3.6, 12).moved(z=h - 0.075))
    return parts + hinged_lid(-d / 2, top - thick, cover)


def trunk(size: Size, hide: Material, straps: Material, metal: Material, domed: bool = False) -> Parts:
    """A travelling trunk: corners, straps and handles; with a domed lid when asked."""
    d, w, h = size
    split = 0.64 * h if domed else 0.7 * h
    cavity = Cavity((d - 0.012, w - 0.012, split - 0.025), (0, 0, 0.02), wall=0.01, opens="top")
    feet = four(cylinder(0.022, 0.025, 0.003, 12).moved(d / 2 - 0.07, w / 2 - 0.07))
    if domed:
        t = np.linspace(0, np.pi, 15)
        arc = np.column_stack([-np.cos(t) * (d - 0.012) / 2, np.sin(t) * (h - split - 0.006)])
        ring = np.vstack([arc, [[(d - 0.012) / 2, -0.0]], [[-(d - 0.012) / 2, -0.0]]])
        rings = np.array(
            [
                np.column_stack([ring[:, 0], np.full(len(ring), y), ring[:, 1] + split + 0.004])
                for y in (-(w - 0.012) / 2, (w - 0.012) / 2)
            ]
        )
        cover = of(hide, loft(rings, crease_rad=0.6))
    else:
        cover = of(hide, box((d - 0.012, w - 0.012, h - split - 0.008), 0.012, 2).moved(z=split + 0.004))
    parts = cavity.body(hide, 0.008, 2) + of(metal, *feet)
    parts += of(straps, box((d, w, 0.018), 0.003).moved(z=0.02)) + _rim(d, w, split - 0.02, straps)
    cover += of(straps, box((d, w, 0.016), 0.003).moved(z=split + 0.006))
    for y in (-0.3 * w, 0.3 * w):
        if domed:
            t = np.linspace(0, np.pi, 15)
            hoop = np.column_stack([-np.cos(t) * d / 2, np.full(15, y), split + np.sin(t) * (h - split)])
            cover += of(straps, tube(hoop, 0.011, 6))
            parts += of(
                straps,
                *(box((0.01, 0.035, split - 0.03), 0.003).moved(f * (d / 2 - 0.003), y, 0.02) for f in (1, -1)),
            )
        else:
            cover += of(straps, box((d + 0.006, 0.04, 0.007), 0.003).moved(0, y, h - 0.008))
            whole, below, above = (
                of(straps, *(box((0.008, 0.04, top - low), 0.003).moved(f * (d / 2 - 0.001), y, low) for f in (1, -1)))
                for low, top in ((0.02, h - 0.01), (0.02, split), (split + 0.006, h - 0.01))
            )
            parts += with_role("filler", whole) + with_role("inside", below)
            cover += with_role("inside", above)
        parts += of(metal, box((0.012, 0.028, 0.055), 0.004).moved(d / 2 + 0.002, y, split - 0.035))
    corners = four(
        box((0.05, 0.05, 0.05), 0.008).moved(d / 2 - 0.022, w / 2 - 0.022, 0.018),
    )
    lock = box((0.012, 0.06, 0.08), 0.004).moved(d / 2, 0, split - 0.05)
    grips = both_sides(
        tube(
            [
                (-0.07, w / 2 + 0.002, 0.5 * split),
                (-0.06, w / 2 + 0.022, 0.48 * split),
                (0.06, w / 2 + 0.022, 0.48 * split),
                (0.07, w / 2 + 0.002, 0.5 * split),
            ],
            0.008,
            6,
        )
    )
    parts += of(metal, *corners, lock) + of(straps, *grips)
    return parts + hinged_lid(-d / 2 - 0.012, split + 0.004, cover)


def _rim(d: float, w: float, z: float, straps: Material) -> Parts:
    """The band round the upper edge: a plate while the trunk is closed, a ring once it opens."""
    bars = [box((d, 0.016, 0.018), 0.003).moved(0, s * (w - 0.016) / 2, z) for s in (1, -1)]
    bars += [box((0.016, w - 0.032, 0.018), 0.003).moved(s * (d - 0.016) / 2, 0, z) for s in (1, -1)]
    return with_role("filler", of(straps, box((d, w, 0.018), 0.003).moved(z=z))) + with_role(
        "inside", of(straps, *bars)
    )


DESIGNS: tuple[Design, ...] = (
    design("chest", "pine-panelled", "panelled pine blanket box", (0.46, 1.05, 0.52), "rustic", blanket_box, wood=m.PINE, panels=3, feet=m.PINE, metal=m.IRON),
    design("chest", "cream-oak", "cream toy chest", (0.42, 0.85, 0.48), "classic", blanket_box, wood=m.CREAM, panels=2, feet=m.CREAM, metal=m.BRASS),
    design("chest", "birch-plain", "plain birch storage chest", (0.42, 0.95, 0.44), "minimal", blanket_box, wood=m.BIRCH, panels=0, feet=m.BIRCH),
    design("chest", "walnut-seat", "walnut chest with a padded seat", (0.45, 1.10, 0.50), "modern", blanket_box, wood=m.WALNUT, panels=0, feet=m.BLACK_WOOD, cushioned=m.GREY_FABRIC),
    design("chest", "steamer", "leather steamer trunk with brass corners", (0.50, 0.90, 0.48), "classic", trunk, hide=m.BROWN_LEATHER, straps=m.DARK_WALNUT, metal=m.BRASS),
    design("chest", "domed", "domed trunk with wooden bands", (0.48, 0.85, 0.56), "rustic", trunk, hide=s.GREY_OAK, straps=m.DARK_WALNUT, metal=m.IRON, domed=True),
    design("chest", "metal-trunk", "charcoal metal trunk", (0.46, 0.92, 0.42), "industrial", trunk, hide=m.CHARCOAL, straps=m.STEEL, metal=m.STEEL),
)  # fmt: skip
