"""Side tables."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.tables.tops import frame_table, leg_table, pedestal_table


def tripod_table(size: Size, top: Material, legs: Material) -> Parts:
    """A small round top on three splayed legs."""
    d, _, h = size
    r, t = d / 2, 0.022
    sticks = [rod((0.92 * r, 0, 0), (0.42 * r, 0, h - t), 0.011, 0.018).turned("z", 60 + 120 * k) for k in range(3)]
    return of(top, prism(superellipse(d, d, 2, 48), t, 0.007).moved(z=h - t)) + of(legs, *sticks)


def tray_table(size: Size, tray: Material, legs: Material) -> Parts:
    """A rimmed metal tray on a crossed stand."""
    d, _, h = size
    r = d / 2
    rim = lathe(
        [
            (r * 0.9, h - 0.042),
            (r, h - 0.03),
            (r, h),
            (r - 0.006, h),
            (r - 0.008, h - 0.026),
            (r * 0.5, h - 0.03),
            (0.01, h - 0.03),
        ],
        44,
    )
    hoops = []
    for a in (45, 135):
        hoop = bend([(0.78 * r, 0, 0.008), (0.62 * r, 0, h * 0.5), (0.7 * r, 0, h - 0.04)], 6)
        hoops += [
            tube(hoop, 0.007).turned("z", a),
            tube(hoop, 0.007).turned("z", a + 180),
            rod((-0.78 * r, 0, 0.008), (0.78 * r, 0, 0.008), 0.007).turned("z", a),
        ]
    return of(tray, rim) + of(legs, *hoops)


def block_table(size: Size, wood: Material, groove: Material) -> Parts:
    """A solid low block, as a plinth or a stump."""
    d, w, h = size
    return of(wood, prism(rounded_rectangle(d, w, 0.06, 6), h - 0.02, 0.012).moved(z=0.02)) + of(
        groove, prism(rounded_rectangle(d * 0.92, w * 0.92, 0.05, 6), 0.03, 0.002)
    )


def stump_table(size: Size, bark: Material, core: Material) -> Parts:
    """A length of tree trunk."""
    d, w, h = size
    a = np.arange(44) * 2 * np.pi / 44
    wobble = 1 + 0.035 * np.sin(3 * a + 0.4) + 0.02 * np.sin(7 * a)
    outline = np.stack([np.cos(a) * wobble * d / 2.1, np.sin(a) * wobble * w / 2.1], axis=1)
    return of(bark, prism(outline, h - 0.012, 0.01)) + of(core, prism(outline * 0.965, 0.02, 0.006).moved(z=h - 0.02))


def shell_pouf_table(size: Size, wicker: Material, top: Material) -> Parts:
    """A woven drum with a wooden lid."""
    d, _, h = size
    r = d / 2
    drum = lathe([(r * 0.8, 0), (r * 0.86, 0.01), (r * 0.98, h * 0.45), (r * 0.88, h - 0.03)], 40, np.pi / 2)
    return of(wicker, drum) + of(top, prism(superellipse(d * 0.94, d * 0.94, 2, 44), 0.028, 0.008).moved(z=h - 0.028))


DESIGNS: tuple[Design, ...] = (
    design("side table", "tripod-oak", "round oak tripod side table", (0.45, 0.45, 0.52), "minimal", tripod_table, 3, top=m.OAK, legs=m.OAK),
    design("side table", "tulip", "white tulip side table with a marble top", (0.45, 0.45, 0.53), "modern", pedestal_table, 36, top=m.MARBLE, foot=m.WHITE),
    design("side table", "tray", "brass tray table", (0.46, 0.46, 0.55), "modern", tray_table, 4, tray=m.BRASS, legs=m.BLACK_STEEL),
    design("side table", "stump", "tree-stump side table", (0.38, 0.40, 0.46), "rustic", stump_table, bark=m.BARK, core=m.PINE),
    design("side table", "frame", "steel-framed side table with a walnut top", (0.40, 0.45, 0.58), "industrial", frame_table, 2, top=m.WALNUT, frame=m.BLACK_STEEL, shelf=m.WALNUT),
    design("side table", "classic-shelf", "cherry side table with a shelf", (0.45, 0.50, 0.60), "classic", leg_table, 2, top=m.CHERRY, legs=m.CHERRY, shelf=m.CHERRY),
    design("side table", "wicker", "wicker drum side table", (0.45, 0.45, 0.48), "rustic", shell_pouf_table, 36, wicker=m.WICKER, top=m.OAK),
)  # fmt: skip
