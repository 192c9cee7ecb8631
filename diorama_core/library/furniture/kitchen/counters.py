"""Base units under a worktop."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def counter(
    size: Size,
    body: Material,
    top: Material,
    units: tuple[str, ...],
    panel: str = "flat",
    pull: Material = m.STEEL,
    handle: str = "bar",
    basin: bool = False,
) -> Parts:
    """Base units under a worktop; `units` are "door", "drawers" or "pair" from right to left."""
    d, w, h = size
    h -= 0.24 if basin else 0.0  # the tap reaches above the worktop
    t = 0.038
    each, x, z, hh = w / len(units), d / 2 - 0.038, 0.105, h - t - 0.112
    between = tuple(-w / 2 + each * k for k in range(1, len(units)))
    cavity = Cavity((d - 0.05, w - 0.01, h - t - 0.1), (-0.015, 0, 0.1), dividers=() if basin else between)
    parts = cavity.body(body, 0.003) + of(m.CHARCOAL, box((d - 0.1, w - 0.02, 0.1), 0.002).moved(-0.025))
    shadow = of(m.SHADOW, box((0.004, w - 0.014, h - t - 0.104), 0.001).moved(d / 2 - 0.039, 0, 0.102))
    parts += with_role("filler", shadow)
    if basin:
        parts += _worktop_with_basin(d, w, h, t, top)
    else:
        parts += of(top, box((d, w, t), 0.006, 2).moved(z=h - t))
    for k, unit_kind in enumerate(units):
        y = -w / 2 + each * (k + 0.5)
        if unit_kind == "drawers":
            for low, share in ((0.0, 0.4), (0.4, 0.36), (0.76, 0.24)):
                place = (y, z + low * hh, each - 0.006, share * hh - 0.006)
                space = cavity.behind(*place)
                parts += drawer_front(x, *place, body, pull, handle, None if basin and low > 0.7 else space)
        elif unit_kind == "pair":
            for s in (1, -1):
                parts += door_front(
                    x,
                    y + s * each / 4,
                    z,
                    each / 2 - 0.006,
                    hh,
                    body,
                    pull,
                    "tall" if handle == "bar" else handle,
                    s,
                    panel,
                )
        else:
            parts += door_front(
                x, y, z, each - 0.006, hh, body, pull, "tall" if handle == "bar" else handle, 1 if k % 2 else -1, panel
            )
    return parts


def _worktop_with_basin(d: float, w: float, h: float, t: float, top: Material) -> Parts:
    bw, bd = 0.5, d * 0.62
    strips = [box((d, (w - bw) / 2, t), 0.005).moved(0, s * (w + bw) / 4, h - t) for s in (1, -1)]
    strips += [box(((d - bd) / 2, bw + 0.002, t), 0.005).moved(s * (d + bd) / 4, 0, h - t) for s in (1, -1)]
    sides = [box((bd, 0.006, 0.16), 0.002).moved(0, s * (bw / 2 - 0.003), h - 0.165) for s in (1, -1)] + [
        box((0.006, bw, 0.16), 0.002).moved(s * (bd / 2 - 0.003), 0, h - 0.165) for s in (1, -1)
    ]
    floor = box((bd, bw, 0.006), 0.002).moved(z=h - 0.168)
    return of(top, *strips) + of(m.STAINLESS, *sides, floor) + at(tap(0.24), -bd / 2 - 0.04, 0, h)


DESIGNS: tuple[Design, ...] = (
    design("kitchen counter", "white-oak", "white kitchen units with an oak worktop", (0.62, 1.80, 0.90), "modern", counter, body=m.WHITE, top=m.OAK, units=("door", "drawers", "door")),
    design("kitchen counter", "sage-marble", "sage panelled units with a marble top", (0.62, 2.00, 0.91), "classic", counter, body=m.SAGE, top=m.MARBLE, units=("pair", "drawers"), panel="shaker", pull=m.BRASS, handle="knob"),
    design("kitchen counter", "sink-unit", "grey kitchen unit with a steel sink", (0.62, 1.60, 1.14), "modern", counter, body=m.LIGHT_GREY, top=m.GRANITE, units=("door", "pair"), basin=True),
    design("kitchen counter", "island", "navy kitchen island", (0.90, 1.60, 0.92), "modern", counter, body=m.NAVY, top=m.LIGHT_OAK, units=("drawers", "door", "drawers"), panel="shaker", pull=m.BRASS),
    design("kitchen counter", "concrete", "walnut units with a concrete worktop", (0.64, 2.40, 0.90), "industrial", counter, body=m.WALNUT, top=m.CONCRETE, units=("door", "drawers", "drawers", "door"), pull=m.BLACK_STEEL),
)  # fmt: skip
