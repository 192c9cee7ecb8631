"""Wooden chairs: slatted, ladder, cross and panel backs, Windsors, folding chairs."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def curved_back(
    width: float, height: float, sag: float, thickness: float, lean: float = 0.0, grow: float = 1.0
) -> Solid:
    """A back rest bent round the sitter, its foot at z = 0, middle at x = 0, ends `sag` further forward."""
    v, u = np.meshgrid(np.linspace(0, 1, 7), np.linspace(-1, 1, 13), indexing="ij")
    round_off = np.sqrt(np.clip(1 - np.abs(u) ** 6, 0, 1)) * 0.5 + 0.5
    half = width / 2 * (1 + (grow - 1) * v)
    y, z = -u * half, 0.5 * height + (v - 0.5) * height * round_off
    x = sag * u**2 - lean * v
    return slab(np.stack([x, y, z], axis=-1), thickness)


def dining_chair(size: Size, wood: Material, seat: Material | None, back: str, splay: float = 0.02) -> Parts:
    """A wooden four-legged chair; `back` is "slats", "ladder", "panel" or "cross"."""
    d, w, h = size
    seat_z, t = 0.45, 0.026
    lean = 0.07
    x_back, half = -d / 2 + lean + 0.02, w / 2 - 0.025
    legs = both_sides(
        taper(
            (d / 2 - 0.025 + splay * 0.3, half + splay * 0.2, 0), (d / 2 - 0.045, half - 0.01, seat_z - t), 0.026, 0.038
        ),
        taper((x_back - splay * 1.5, half, 0), (x_back, half - 0.01, seat_z), 0.027, 0.038),
        taper((x_back, half - 0.01, seat_z - 0.01), (x_back - lean, half - 0.012, h), 0.036, 0.024),
    )
    rails = (
        beam((d / 2 - 0.05, -half, seat_z - 0.055), (d / 2 - 0.05, half, seat_z - 0.055), 0.02, 0.055),
        beam((x_back, -half, seat_z - 0.055), (x_back, half, seat_z - 0.055), 0.02, 0.055),
        *both_sides(
            beam((x_back, half - 0.01, seat_z - 0.055), (d / 2 - 0.05, half - 0.01, seat_z - 0.055), 0.02, 0.055)
        ),
    )
    outline = superellipse(d / 2 - x_back + 0.005, w, 7, 32)
    middle = (d / 2 + x_back) / 2
    parts = of(wood, *legs, *rails, prism(outline, t, 0.008).moved(middle, 0, seat_z - t))
    if seat is not None:
        parts += of(
            seat, cushion((d / 2 - x_back - 0.03, w - 0.06, 0.055), 7, 2.4).moved(middle + 0.01, 0, seat_z - 0.015)
        )
    return parts + of(wood, *_chair_back(back, x_back, lean, half, seat_z, h))


def _chair_back(kind: str, x: float, lean: float, half: float, seat_z: float, h: float) -> list[Solid]:
    """What fills the space between the two back posts."""

    def at(z: float) -> float:
        return x - lean * (z - seat_z) / (h - seat_z)

    width = 2 * half
    top = curved_back(width + 0.01, 0.085, 0.0, 0.02, 0.012).moved(at(h - 0.085) - 0.004, 0, h - 0.088)
    if kind == "slats":
        low = beam((at(seat_z + 0.12), -half, seat_z + 0.12), (at(seat_z + 0.12), half, seat_z + 0.12), 0.018, 0.03)
        ys = np.linspace(-half, half, 7)[1:-1]
        return [
            top,
            low,
            *(beam((at(seat_z + 0.12), y, seat_z + 0.12), (at(h - 0.06), y, h - 0.06), 0.026, 0.011) for y in ys),
        ]
    if kind == "ladder":
        zs = np.linspace(seat_z + 0.13, h - 0.22, 3)
        return [top, *(curved_back(width, 0.055, 0.0, 0.014, 0.01).moved(at(z), 0, z) for z in zs)]
    if kind == "cross":
        z0, z1 = seat_z + 0.06, h - 0.07
        bars = both_sides(beam((at(z0), half - 0.01, z0), (at(z1), -half + 0.01, z1), 0.024, 0.014))
        return [top, *bars]
    z = seat_z + 0.16
    return [curved_back(width, h - z - 0.005, 0.0, 0.018, 0.05).moved(at(z), 0, z)]


def windsor_chair(size: Size, wood: Material) -> Parts:
    """A Windsor: saddle seat, turned legs, bow and spindles."""
    d, w, h = size
    seat_z = 0.45
    parts = [prism(superellipse(d * 0.9, w * 0.94, 3.4, 36), 0.034, 0.012).moved(d * 0.03, 0, seat_z - 0.034)]
    top, foot = (d * 0.30, w * 0.30), (d * 0.46, w * 0.46)
    for sx in (1, -1):
        for sy in (1, -1):
            leg = bend(
                [
                    (sx * foot[0], sy * foot[1], 0),
                    (sx * 0.36 * d, sy * 0.37 * w, seat_z * 0.55),
                    (sx * top[0], sy * top[1], seat_z - 0.02),
                ],
                5,
            )
            parts.append(
                tube(
                    leg,
                    np.interp(
                        np.linspace(0, 1, len(leg)), [0, 0.25, 0.55, 0.8, 1], [0.011, 0.017, 0.021, 0.016, 0.012]
                    ),
                )
            )
    parts += both_sides(rod((0.4 * d, 0.4 * w, seat_z * 0.4), (-0.4 * d, 0.4 * w, seat_z * 0.4), 0.009))
    parts.append(rod((0, 0.4 * w, seat_z * 0.4), (0, -0.4 * w, seat_z * 0.4), 0.009))
    t = np.linspace(-np.pi / 2, np.pi / 2, 25)
    lean = 0.16 * d
    rise = (np.cos(t)) ** 0.55
    bow = np.stack(
        [
            -0.32 * d - lean * rise,
            0.43 * w * np.sign(t) * np.abs(np.sin(t)) ** 0.8 * (0.78 + 0.22 * rise**0.5),
            seat_z + (h - seat_z - 0.012) * rise,
        ],
        axis=1,
    )
    parts.append(tube(bow, 0.012))
    for k in np.linspace(-0.78, 0.78, 7):
        edge = bow[np.abs(bow[:, 1] - k * 0.44 * w).argmin()]
        parts.append(rod((-0.31 * d, k * 0.34 * w, seat_z - 0.01), edge, 0.008, 0.006, 7))
    return of(wood, *parts)


def folding_chair(size: Size, wood: Material, frame: Material) -> Parts:
    """Crossed legs, slatted seat and back."""
    d, w, h = size
    seat_z, half = 0.45, w / 2 - 0.015
    long_leg = beam((0.46 * d, half, 0.0), (-0.42 * d, half, h - 0.02), 0.02, 0.03)
    short_leg = beam((-0.47 * d, half - 0.03, 0.0), (0.38 * d, half - 0.03, seat_z - 0.01), 0.02, 0.03)
    slats = [box((0.052, w - 0.03, 0.016), 0.005).moved(x, 0, seat_z) for x in np.linspace(-0.28 * d, 0.42 * d, 6)]
    backs = [
        curved_back(w, 0.06, 0.0, 0.014, 0.012).moved(-0.42 * d * (z / h) - 0.005, 0, z) for z in (h - 0.2, h - 0.1)
    ]
    rung = rod((0.3 * d, half, 0.15), (0.3 * d, -half, 0.15), 0.009)
    rung_back = rod((-0.33 * d, half - 0.03, 0.09), (-0.33 * d, -half + 0.03, 0.09), 0.009)
    return of(frame, *both_sides(long_leg, short_leg), rung, rung_back) + of(wood, *slats, *backs)


DESIGNS: tuple[Design, ...] = (
    design("chair", "slat-oak", "oak dining chair with a slatted back", (0.53, 0.46, 0.88), "classic", dining_chair, wood=m.OAK, seat=None, back="slats"),
    design("chair", "ladder-walnut", "walnut ladder-back chair with a linen seat", (0.52, 0.47, 0.98), "rustic", dining_chair, wood=m.WALNUT, seat=m.LINEN, back="ladder"),
    design("chair", "panel-birch", "birch chair with a plain panel back", (0.51, 0.46, 0.80), "minimal", dining_chair, wood=m.BIRCH, seat=None, back="panel"),
    design("chair", "cross-black", "black cross-back chair with a cane seat", (0.52, 0.48, 0.89), "rustic", dining_chair, wood=m.BLACK_WOOD, seat=m.RATTAN, back="cross"),
    design("chair", "slat-mahogany", "mahogany dining chair with a leather seat", (0.55, 0.50, 1.02), "classic", dining_chair, wood=m.MAHOGANY, seat=m.BROWN_LEATHER, back="slats"),
    design("chair", "windsor-oak", "oak Windsor chair with a hooped spindle back", (0.54, 0.50, 0.93), "classic", windsor_chair, wood=m.OAK),
    design("chair", "windsor-black", "black Windsor chair", (0.52, 0.48, 0.86), "rustic", windsor_chair, wood=m.BLACK_WOOD),
    design("chair", "folding-pine", "slatted pine folding chair", (0.50, 0.45, 0.79), "minimal", folding_chair, wood=m.PINE, frame=m.PINE),
    design("chair", "folding-black", "folding chair with a black frame and oak slats", (0.48, 0.43, 0.80), "industrial", folding_chair, wood=m.OAK, frame=m.BLACK_STEEL),
)  # fmt: skip
