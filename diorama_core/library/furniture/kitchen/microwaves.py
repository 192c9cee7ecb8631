"""Microwaves, mini ovens and toasters."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def microwave(size: Size, body: Material, kind: str = "microwave") -> Parts:
    """`kind`: "microwave", "oven" (a mini oven with knobs) or "toaster"."""
    d, w, h = size
    if kind == "toaster":
        shell = prism(rounded_rectangle(h, w, 0.05, 6), d, 0.02).turned("y", -90).moved(d / 2, 0, h / 2)
        slots = [box((0.026, w * 0.68, 0.012), 0.003).moved(x, 0, h - 0.009) for x in (-0.17 * d, 0.17 * d)]
        lever = box((0.03, 0.03, 0.014), 0.004).moved(0, w / 2 + 0.004, h * 0.6)
        return of(body, shell.moved(0, 0, 0.0)) + of(m.BLACK, *slots, lever, box((d - 0.03, w - 0.03, 0.012), 0.003))
    x, glass_w = d / 2 - 0.032, w * 0.68
    y = w / 2 - glass_w / 2 - 0.014
    hole = (y - glass_w / 2 + 0.002, y + glass_w / 2 - 0.002, 0.03, h - 0.02)
    parts = Cavity((d - 0.03, w, h - 0.012), (-0.015, 0, 0.012), wall=0.012, hole=hole).body(body, 0.008, 2)
    parts += of(m.BLACK, *four(cylinder(0.014, 0.015, 0.002, 10).moved(d / 2 - 0.07, w / 2 - 0.05)))
    leaf = of(
        body if kind == "oven" else m.CHARCOAL, box((0.024, glass_w, h - 0.035), 0.006, 2).moved(x + 0.01, y, 0.022)
    ) + of(m.DARK_GLASS, box((0.004, glass_w - 0.07, h - 0.12), 0.001).moved(x + 0.022, y, 0.06))
    side_y = -w / 2 + (w - glass_w) / 2 - 0.008
    parts += of(
        m.CHARCOAL if kind != "oven" else body,
        box((0.02, w - glass_w - 0.03, h - 0.035), 0.005, 2).moved(x + 0.006, side_y, 0.022),
    )
    if kind == "oven":
        for z in (0.27, 0.52, 0.77):
            parts += at(knob(0.017), x + 0.016, side_y, z * h)
        return parts + drop_front(x + 0.022, 0.022, leaf + at(bar_handle(glass_w * 0.8, False), x + 0.01, y, h - 0.045))
    rows = [(x + 0.016, 0.07 + 0.03 * r) for r in range(4)]
    keys = keypad(box((0.004, 0.02, 0.012), 0.001), rows, spread(3, 0.028, side_y))
    display = box((0.004, 0.085, 0.032), 0.001).moved(x + 0.015, side_y, h - 0.08)
    leaf += at(bar_handle(h * 0.7, True), x + 0.016, y - glass_w / 2 + 0.03, h / 2)
    parts += jointed(door_hinge(x + 0.022, y + glass_w / 2, 1), leaf)
    return parts + of(m.GREY, *keys) + of(m.SCREEN, display)


DESIGNS: tuple[Design, ...] = (
    design("microwave", "black", "black microwave oven", (0.38, 0.50, 0.29), "modern", microwave, body=m.BLACK),
    design("microwave", "steel", "stainless-steel microwave", (0.40, 0.52, 0.31), "modern", microwave, body=m.STAINLESS),
    design("microwave", "white", "white microwave", (0.36, 0.46, 0.27), "minimal", microwave, body=m.WHITE),
    design("microwave", "mini-oven", "small countertop oven with knobs", (0.36, 0.45, 0.27), "classic", microwave, body=m.STAINLESS, kind="oven"),
    design("microwave", "toaster", "cream two-slot toaster", (0.18, 0.30, 0.20), "classic", microwave, body=m.CREAM, kind="toaster"),
)  # fmt: skip
