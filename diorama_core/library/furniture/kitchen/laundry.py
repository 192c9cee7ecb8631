"""Washing machines and dishwashers."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def washing_machine(size: Size, body: Material, trim: Material, kind: str = "front") -> Parts:
    """`kind`: "front" (porthole), "top" (lid above) or "dish" (a plain dishwasher door)."""
    d, w, h = size
    x, zc, r = d / 2 - 0.047, 0.47 * h, 0.2
    hole = (-r - 0.01, r + 0.01, zc - r - 0.01, zc + r + 0.01) if kind == "front" else None
    drum = Cavity((d - 0.05, w, h - 0.03), (-0.02, 0, 0.02), hole=hole)
    parts = (
        (of(body, box(drum.size, 0.01, 2).moved(*drum.foot)) if kind == "top" else drum.body(body, 0.01, 2))
        + of(body, box((d - 0.03, w, 0.025), 0.008, 2).moved(-0.01, 0, h - 0.025))
        + of(m.BLACK, *four(cylinder(0.022, 0.025, 0.003, 12).moved(d / 2 - 0.1, w / 2 - 0.06)))
    )
    if kind == "dish":
        leaf = of(body, box((0.03, w - 0.01, h - 0.24), 0.006, 2).moved(x + 0.012, 0, 0.1))
        parts += of(trim, box((0.028, w - 0.01, 0.095), 0.006, 2).moved(x + 0.012, 0, h - 0.135))
        return parts + drop_front(x + 0.027, 0.1, leaf + at(bar_handle(w * 0.7, False), x + 0.022, 0, h - 0.2))
    if kind == "top":
        parts += of(trim, box((d * 0.62, w - 0.07, 0.02), 0.008, 2).moved(0.05, 0, h - 0.012)) + of(
            body, box((0.12, w, 0.12), 0.02, 2).moved(-d / 2 + 0.07, 0, h - 0.03)
        )
        return parts + at(knob(0.024), -d / 2 + 0.12, 0.15, h + 0.035)
    rim = (
        lathe(
            [(r * 0.72, 0.0), (r * 0.98, 0.0), (r, 0.012), (r * 0.94, 0.028), (r * 0.78, 0.03), (r * 0.72, 0.012)], 40
        )
        .turned("y", 90)
        .moved(x, 0, zc)
    )
    glass = (
        lathe([(r * 0.76, 0.0), (r * 0.74, 0.016), (r * 0.5, 0.034), (0.01, 0.04)], 36, np.pi / 2)
        .turned("y", 90)
        .moved(x - 0.004, 0, zc)
    )
    panel = box((0.02, w - 0.012, 0.115), 0.008, 2).moved(x + 0.003, 0, h - 0.15)
    tray = box((0.022, 0.16, 0.09), 0.006, 2).moved(x + 0.004, w / 2 - 0.1, h - 0.138)
    display = box((0.004, 0.09, 0.034), 0.001).moved(x + 0.014, -0.16, h - 0.11)
    parts += jointed(door_hinge(x + 0.04, r + 0.005, 1), of(trim, rim) + of(m.DARK_GLASS, glass))
    return parts + of(m.DARK_GLASS, display) + of(body, panel, tray) + at(knob(0.03), x + 0.012, 0.0, h - 0.093)


DESIGNS: tuple[Design, ...] = (
    design("washing machine", "white", "white front-loading washing machine", (0.58, 0.60, 0.85), "minimal", washing_machine, body=m.WHITE, trim=m.LIGHT_GREY),
    design("washing machine", "graphite", "graphite washing machine", (0.60, 0.60, 0.85), "modern", washing_machine, body=m.CHARCOAL, trim=m.STEEL),
    design("washing machine", "top-loader", "white top-loading washing machine", (0.62, 0.62, 1.00), "classic", washing_machine, body=m.WHITE, trim=m.GREY, kind="top"),
    design("dishwasher", "dishwasher", "stainless-steel dishwasher", (0.60, 0.60, 0.84), "modern", washing_machine, id="washing-machine-dishwasher", body=m.STAINLESS, trim=m.BLACK, kind="dish"),
)  # fmt: skip
