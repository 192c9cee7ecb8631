"""Bar and counter stools with backs, and saddles."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.seating.wooden_chairs import curved_back


def bar_frame(d: float, w: float, seat_z: float, profile: Leg, metal: bool) -> tuple[list[Solid], list[Solid]]:
    """Four legs leaning inward under a seat and the foot rails between them."""
    x, y, top = d / 2 - 0.025, w / 2 - 0.025, seat_z - 0.03
    thick = 0.026 if metal else 0.036
    foot, head = (x, y), (x * 0.78, y * 0.80)
    if profile in ("splay", "turned"):
        one = rod((*foot, 0), (*head, top), 0.013, 0.02, 12)
    else:
        one = taper((*foot, 0), (*head, top), thick * (1.0 if metal else 0.8), thick)
    legs = [one, one.mirrored(), one.mirrored(0), one.mirrored().mirrored(0)]

    def at(z: float) -> tuple[float, float]:
        share = z / top
        return foot[0] + (head[0] - foot[0]) * share, foot[1] + (head[1] - foot[1]) * share

    rails: list[Solid] = []
    for z, sides in ((0.24 * seat_z, "front"), (0.36 * seat_z, "sides")):
        px, py = at(z)
        if sides == "front":
            rails += [beam((f * px, -py, z), (f * px, py, z), 0.02, 0.026) for f in (1, -1)]
        else:
            rails += both_sides(beam((-px, py, z), (px, py, z), 0.02, 0.024))
    return legs, rails


def bar_chair(
    size: Size,
    frame: Material,
    seat: Material,
    seat_h: float,
    back: str,
    profile: Leg = "taper",
    rail: Material | None = None,
) -> Parts:
    """A bar stool with a back: "ladder", "low", "padded", "shell" or "none" (a saddle)."""
    d, w, h = size
    metal = frame.metallic > 0.2
    legs, rails = bar_frame(d, w, seat_h, profile, metal)
    parts = of(frame, *legs) + of(rail or frame, *rails)
    soft = seat.kind not in ("wood", "plain")
    if back == "shell":
        return parts + of(seat, _bucket(d, w, seat_h, h))
    if back == "none":
        return parts + of(seat, _saddle(d, w, seat_h))
    base = prism(superellipse(d * 0.9, w * 0.94, 6, 32), 0.026, 0.009).moved(0, 0, seat_h - (0.05 if soft else 0.026))
    parts += of(frame if soft else seat, base)
    if soft:
        parts += of(seat, cushion((d * 0.9, w * 0.95, 0.075), 6, 3, 12).moved(0, 0, seat_h - 0.055))
    xb = -d * 0.39
    posts = both_sides(beam((xb, 0.36 * w, seat_h - 0.06), (-d / 2 + 0.02, 0.38 * w, h - 0.01), 0.026, 0.024))

    def at(z: float) -> float:
        return xb + (-d / 2 + 0.02 - xb) * (z - seat_h) / (h - seat_h)

    if back == "padded":
        pad = cushion((h - seat_h - 0.06, w * 0.92, 0.06), 6, 3.2, 12).turned("y", -97)
        return parts + of(frame, *posts) + of(seat, pad.moved(at((h + seat_h) / 2), 0, (h + seat_h) / 2 + 0.03))
    if back == "low":
        band = curved_back(w * 0.98, 0.09, 0.05, 0.022, 0.01).moved(-d / 2 + 0.015, 0, h - 0.09)
        return parts + of(frame, *posts, band)
    zs = np.linspace(seat_h + 0.1, h - 0.07, 3)
    slats = [curved_back(0.78 * w, 0.055, 0.0, 0.015, 0.008).moved(at(z), 0, z) for z in zs]
    return parts + of(frame, *posts, *slats)


def _bucket(d: float, w: float, seat_h: float, h: float) -> Solid:
    """A moulded seat that turns up into a low back and sides."""
    u, v = np.meshgrid(np.linspace(-1, 1, 15), np.linspace(0, 1, 11))
    x = d / 2 - 0.01 - (d * 0.86) * np.minimum(v / 0.62, 1) - 0.06 * np.clip(v - 0.62, 0, 1) / 0.38
    x = x + 0.08 * u**2 * np.clip(v - 0.45, 0, 1)
    rise = (h - seat_h) * np.clip((v - 0.5) / 0.5, 0, 1) ** 1.5
    z = (
        seat_h
        + rise * (1 - 0.45 * u**4)
        + 0.05 * u**4 * (1 - v) * np.clip(v * 4, 0, 1)
        - 0.02 * np.clip(1 - 8 * v, 0, 1)
    )
    half = w / 2 * np.interp(v, [0, 0.1, 0.5, 0.8, 1], [0.84, 0.95, 1.0, 0.97, 0.86])
    return slab(np.stack([x, u * half, z], axis=-1), 0.014)


def _saddle(d: float, w: float, seat_h: float) -> Solid:
    """A thick wooden seat, dished across."""
    u, v = np.meshgrid(np.linspace(-1, 1, 13), np.linspace(-1, 1, 9))
    x = -v * d * 0.45 * (1 - 0.06 * np.abs(u) ** 4)
    z = seat_h - 0.03 + 0.022 * u**2 - 0.006 * np.abs(v) ** 6
    return slab(np.stack([x, u * w / 2 * (1 - 0.05 * np.abs(v) ** 4), z], axis=-1), 0.036)


def cafe_bar_stool(size: Size, colour: Material, seat: Material | None) -> Parts:
    """A pressed-steel café stool with a handle hole, no back."""
    d, w, h = size
    x, y = d / 2 - 0.022, w / 2 - 0.022
    one = taper((x, y, 0), (x * 0.72, y * 0.72, h - 0.012), 0.026, 0.05)
    legs = [one, one.mirrored(), one.mirrored(0), one.mirrored().mirrored(0)]
    z = 0.3 * h
    px, py = x * (1 - 0.28 * 0.3), y * (1 - 0.28 * 0.3)
    rails = [
        *(beam((f * px, -py, z), (f * px, py, z), 0.008, 0.03) for f in (1, -1)),
        *both_sides(beam((-px, py, z), (px, py, z), 0.008, 0.03)),
    ]
    z2 = 0.62 * h
    qx, qy = x * (1 - 0.28 * 0.62), y * (1 - 0.28 * 0.62)
    cross = [rod((qx, qy, z2), (-qx, -qy, z2), 0.005), rod((qx, -qy, z2), (-qx, qy, z2), 0.005)]
    top = box((d * 0.78, w * 0.78, 0.03), 0.014, 3).moved(z=h - (0.03 if seat is None else 0.048))
    parts = of(colour, *legs, *rails, *cross, top)
    if seat is not None:
        return parts + of(seat, box((d * 0.8, w * 0.8, 0.022), 0.008, 2).moved(z=h - 0.022))
    return parts + of(m.SHADOW, prism(superellipse(0.035, 0.1, 4, 20), 0.002, 0.0005).moved(z=h - 0.001))


DESIGNS: tuple[Design, ...] = (
    design("bar stool", "ladder-oak", "oak ladder-back bar chair", (0.46, 0.43, 1.06), "rustic", bar_chair, frame=m.OAK, seat=m.OAK, seat_h=0.72, back="ladder"),
    design("bar stool", "padded-navy", "navy upholstered bar chair on walnut legs", (0.50, 0.45, 1.04), "classic", bar_chair, frame=m.DARK_WALNUT, seat=m.NAVY_FABRIC, seat_h=0.70, back="padded", profile="turned", rail=m.BRASS),
    design("bar stool", "padded-velvet", "blush velvet counter stool on brass legs", (0.48, 0.44, 0.94), "modern", bar_chair, frame=m.BRASS, seat=s.BLUSH_VELVET, seat_h=0.64, back="padded"),
    design("bar stool", "low-back-walnut", "walnut counter stool with a low curved back", (0.48, 0.48, 0.84), "modern", bar_chair, frame=m.WALNUT, seat=m.BLACK_LEATHER, seat_h=0.65, back="low", profile="splay", rail=m.BLACK_STEEL),
    design("bar stool", "shell-white", "white shell bar stool on birch legs", (0.46, 0.46, 0.92), "minimal", bar_chair, frame=m.BIRCH, seat=m.WHITE, seat_h=0.70, back="shell", profile="splay", rail=m.STEEL),
    design("bar stool", "saddle-birch", "birch saddle stool", (0.36, 0.46, 0.65), "minimal", bar_chair, 2, frame=m.BIRCH, seat=m.BIRCH, seat_h=0.65, back="none"),
    design("bar stool", "saddle-reclaimed", "reclaimed-wood saddle bar stool on black steel", (0.38, 0.46, 0.76), "industrial", bar_chair, 2, frame=m.BLACK_STEEL, seat=m.RECLAIMED, seat_h=0.76, back="none"),
    design("bar stool", "cafe-red", "oxblood pressed-steel bar stool", (0.44, 0.44, 0.76), "industrial", cafe_bar_stool, 4, colour=m.metal("oxblood steel", "#6d3230", 0.45, 0.2), seat=None),
    design("bar stool", "cafe-pine", "iron bar stool with a pine seat", (0.42, 0.42, 0.68), "rustic", cafe_bar_stool, 4, colour=m.IRON, seat=m.PINE),
    design("bar stool", "cross-cherry", "cherry bar chair with a leather seat", (0.47, 0.44, 1.10), "classic", bar_chair, frame=m.CHERRY, seat=m.BROWN_LEATHER, seat_h=0.76, back="ladder", profile="turned"),
)  # fmt: skip
