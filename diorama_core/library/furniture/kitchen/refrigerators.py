"""Refrigerators."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def refrigerator(size: Size, body: Material, layout: str, round_edge: float = 0.012) -> Parts:
    """`layout`: "top" (freezer above), "bottom" (freezer below), "double" (side by side), "single"."""
    d, w, h = size
    door_t = 0.06
    x = d / 2 - 0.045 - door_t
    core = Cavity((d - 0.05 - door_t, w - 0.006, h - 0.05), (-d / 2 + (d - 0.05 - door_t) / 2, 0, 0.045), wall=0.03)
    parts = core.body(body if layout != "double" else m.GREY, 0.008)
    parts += of(m.BLACK, box((d - 0.14, w - 0.04, 0.06), 0.003).moved(-0.02))
    z0, z1 = 0.06, h
    split = {"top": 0.68, "bottom": 0.38}.get(layout, 0.0)
    spans = [(z0, z1)] if not split else [(z0, z0 + split * (z1 - z0)), (z0 + split * (z1 - z0), z1)]
    columns = (-w / 4, w / 4) if layout == "double" else (0.0,)
    for y in columns:
        for low, high in spans:
            width, height = (w / 2 if layout == "double" else w) - 0.004, high - low - 0.008
            leaf = of(body, box((door_t, width, height), round_edge, 3).moved(x + door_t / 2, y, low + 0.004))
            side = -np.sign(y) if y else 1.0
            length = min(0.5, height * 0.62) if height > 0.6 else min(0.25, 0.6 * height)
            near_split = (
                high - length / 2 - 0.09
                if split and low == z0
                else low + length / 2 + 0.09
                if split
                else (low + high) / 2
            )
            leaf += at(bar_handle(length, True), x + door_t - 0.004, y + side * (width / 2 - 0.05), near_split)
            parts += jointed(door_hinge(x + door_t, y - side * width / 2, -int(side)), leaf)
    return parts


DESIGNS: tuple[Design, ...] = (
    design("refrigerator", "white-top", "white refrigerator with a freezer above", (0.68, 0.66, 1.55), "minimal", refrigerator, body=m.WHITE, layout="top"),
    design("refrigerator", "steel-bottom", "stainless-steel fridge freezer", (0.68, 0.62, 1.86), "modern", refrigerator, body=m.STAINLESS, layout="bottom"),
    design("refrigerator", "double", "side-by-side stainless-steel refrigerator", (0.74, 0.92, 1.78), "modern", refrigerator, body=m.STAINLESS, layout="double"),
    design("refrigerator", "retro", "rounded sage refrigerator", (0.70, 0.60, 1.52), "classic", refrigerator, body=m.SAGE, layout="single", round_edge=0.055),
    design("refrigerator", "small", "small white refrigerator", (0.56, 0.52, 0.84), "minimal", refrigerator, body=m.WHITE, layout="single"),
)  # fmt: skip
