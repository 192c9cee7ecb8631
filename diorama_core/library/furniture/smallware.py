"""Small things that stand on furniture and floors: vessels, books, boxes, bins, toys."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, of, turned
from diorama_core.library.furniture.solids import Solid, ball, bend, box, cushion, cylinder, lathe, loft, prism, ring_path, rod, rounded_rectangle, shell, superellipse, tube
from diorama_core.library.record import SymmetryFold

Profile = tuple[tuple[float, float], ...]

VASES: dict[str, Profile] = {
    "urn": ((0.42, 0), (0.5, 0.02), (0.95, 0.42), (1.0, 0.58), (0.8, 0.8), (0.42, 0.92), (0.5, 1.0)),
    "bottle": ((0.7, 0), (0.78, 0.02), (1.0, 0.25), (0.85, 0.48), (0.32, 0.66), (0.24, 0.85), (0.34, 1.0)),
    "cylinder": ((0.94, 0), (1.0, 0.015), (1.0, 0.985), (0.99, 1.0)),
    "moon": ((0.36, 0), (0.42, 0.02), (0.86, 0.22), (1.0, 0.5), (0.86, 0.78), (0.42, 0.95), (0.4, 1.0)),
    "tulip": ((0.5, 0), (0.54, 0.02), (0.5, 0.1), (0.72, 0.45), (0.8, 0.7), (0.86, 0.88), (1.0, 1.0)),
}


def hollow(profile: Profile, radius: float, height: float, wall: float, bottom: float = 0.012) -> Solid:
    """A turned vessel with an inside, from an outer profile in fractions."""
    outside = [(a * radius, b * height) for a, b in profile]
    inside = [(max(r - wall, 0.004), max(z, bottom)) for r, z in reversed(outside) if z > bottom]
    return lathe([*outside, *inside, (0.004, bottom)], 36, np.deg2rad(55))


def vase(size: Size, clay: Material, kind: str, handles: bool = False) -> Parts:
    """A vase; with two handles if asked."""
    d, w, h = size
    r = min(d, w) / 2 * (0.78 if handles else 1.0)
    parts = of(clay, hollow(VASES[kind], r, h, 0.008))
    if handles:
        ear = tube(bend([(0, r * 0.46, 0.93 * h), (0, r * 1.0, 0.92 * h), (0, r * 1.2, 0.78 * h), (0, r * 0.93, 0.62 * h)], 5), 0.011, 8)
        parts += of(clay, *both_sides(ear))
    return parts


def jug(size: Size, clay: Material) -> Parts:
    """A pitcher with a lip and a handle at its back."""
    d, w, h = size
    r = w / 2
    body = hollow(((0.72, 0), (0.78, 0.02), (1.0, 0.35), (0.9, 0.6), (0.62, 0.82), (0.7, 1.0)), r, h, 0.006)
    handle = tube(bend([(-r * 0.6, 0, 0.88 * h), (-r * 1.35, 0, 0.86 * h), (-r * 1.45, 0, 0.6 * h), (-r * 0.96, 0, 0.38 * h)], 5), 0.011, 8)
    lip = cushion((0.05, 0.05, 0.03), 2, 2, 6).moved(r * 0.72, 0, h - 0.032)
    return of(clay, body, handle, lip)


def bowl(size: Size, clay: Material, kind: Literal["deep", "plate", "tray", "footed"]) -> Parts:
    """A bowl, plate, rectangular tray or footed dish."""
    d, w, h = size
    r = d / 2
    if kind == "tray":
        o = rounded_rectangle(d, w, 0.04, 6)
        rings = [(0.96, 0), (0.97, 0.004), (1.0, h - 0.003), (0.99, h), (0.97, h), (0.955, 0.01), (0.04, 0.009)]
        grips = both_sides(tube(bend([(-0.06, w / 2 - 0.004, h * 0.8), (-0.05, w / 2 + 0.012, h + 0.01), (0.05, w / 2 + 0.012, h + 0.01), (0.06, w / 2 - 0.004, h * 0.8)], 4), 0.006, 8))
        return of(clay, loft(np.array([ring_path(o * s, z) for s, z in rings]), crease_rad=np.deg2rad(50))) + of(m.BRASS, *grips)
    if kind == "plate":
        return of(clay, lathe([(0.55 * r, 0), (0.6 * r, 0.003), (0.72 * r, h * 0.35), (r, h - 0.003), (0.995 * r, h), (0.97 * r, h), (0.68 * r, h * 0.45), (0.004, h * 0.4)], 48, np.deg2rad(50)))
    if kind == "footed":
        return of(clay, lathe([(0.45 * r, 0), (0.47 * r, 0.01), (0.14 * r, 0.12 * h), (0.12 * r, 0.4 * h), (0.5 * r, 0.55 * h), (0.92 * r, 0.85 * h), (r, h), (0.97 * r, h), (0.88 * r, 0.86 * h), (0.45 * r, 0.62 * h), (0.004, 0.56 * h)], 44, np.deg2rad(50)))
    return of(clay, lathe([(0.4 * r, 0), (0.43 * r, 0.004), (0.46 * r, 0.06 * h), (0.8 * r, 0.35 * h), (0.96 * r, 0.75 * h), (r, h), (0.965 * r, h), (0.92 * r, 0.74 * h), (0.75 * r, 0.38 * h), (0.4 * r, 0.14 * h), (0.004, 0.1 * h)], 44, np.deg2rad(50)))


def cup(size: Size, clay: Material, kind: Literal["mug", "tea", "tumbler", "wine"]) -> Parts:
    """A mug, a teacup with saucer, a glass or a wine glass."""
    d, w, h = size
    if kind == "wine":
        r = w / 2
        return of(clay, lathe([(0.82 * r, 0), (0.84 * r, 0.003), (0.2 * r, 0.012), (0.1 * r, 0.05 * h), (0.1 * r, 0.42 * h), (0.4 * r, 0.47 * h), (0.95 * r, 0.66 * h), (r, 0.75 * h), (0.8 * r, h), (0.77 * r, h), (0.94 * r, 0.75 * h), (0.85 * r, 0.64 * h), (0.004, 0.5 * h)], 36, np.deg2rad(50)))
    if kind == "tumbler":
        return of(clay, hollow(((0.82, 0), (0.85, 0.02), (1.0, 0.98), (0.99, 1.0)), w / 2, h, 0.0035, 0.008))
    r = 0.39 * w if kind == "mug" else 0.31 * w
    lift = 0.0 if kind == "mug" else 0.012
    profile: Profile = ((0.88, 0), (0.94, 0.02), (1.0, 0.08), (1.0, 0.98), (0.98, 1.0)) if kind == "mug" else ((0.45, 0), (0.5, 0.03), (0.82, 0.4), (0.98, 0.9), (1.0, 1.0))
    body = hollow(profile, r, h - lift, 0.004, 0.006).moved(0, 0.09 * w if kind == "mug" else 0, lift)
    y0 = (0.09 * w if kind == "mug" else 0.0) - r * 0.95
    ear = tube(bend([(0, y0, lift + 0.82 * h), (0, y0 - 0.26 * w * 0.9, lift + 0.72 * h), (0, y0 - 0.22 * w, lift + 0.34 * h), (0, y0 + (0.0 if kind == "mug" else 0.004), lift + 0.2 * h)], 5), 0.0055, 8)
    parts = of(clay, body, ear)
    if kind == "tea":
        s = w / 2
        parts += of(clay, lathe([(0.5 * s, 0), (0.55 * s, 0.002), (s, 0.012), (0.98 * s, 0.015), (0.5 * s, 0.007), (0.004, 0.006)], 40, np.deg2rad(50)))
    return parts


def bottle(size: Size, glass: Material, kind: Literal["wine", "water", "spray"], cap: Material) -> Parts:
    """A wine or water bottle, or a pump dispenser."""
    d, _, h = size
    r = d / 2
    if kind == "wine":
        body = lathe([(0.9 * r, 0), (r, 0.01), (r, 0.58 * h), (0.86 * r, 0.66 * h), (0.4 * r, 0.76 * h), (0.34 * r, 0.9 * h), (0.38 * r, 0.92 * h), (0.36 * r, 0.95 * h)], 28, np.deg2rad(50))
        return of(glass, body) + of(cap, cylinder(0.36 * r, 0.12 * h, 0.002, 20).moved(z=0.88 * h)) + of(m.PAPER, cylinder(r * 1.006, 0.24 * h, 0.001, 28).moved(z=0.2 * h))
    if kind == "water":
        return of(glass, lathe([(0.92 * r, 0), (r, 0.01), (r, 0.68 * h), (0.7 * r, 0.8 * h), (0.42 * r, 0.86 * h)], 28, np.deg2rad(50))) + of(cap, cylinder(0.48 * r, 0.15 * h, 0.003, 24).moved(z=0.85 * h))
    pump = [cylinder(0.34 * r, 0.06 * h, 0.002, 18).moved(z=0.72 * h), cylinder(0.14 * r, 0.18 * h, 0.001, 12).moved(z=0.76 * h), box((1.1 * r, 0.4 * r, 0.06 * h), 0.004, 2).moved(0.28 * r, 0, 0.94 * h)]
    return of(glass, lathe([(0.94 * r, 0), (r, 0.008), (r, 0.64 * h), (0.85 * r, 0.7 * h), (0.4 * r, 0.73 * h)], 28, np.deg2rad(50))) + of(cap, *pump)


COVERS = tuple(m.Material(f"book cover {k}", "leather", c, 0.7, 0.0, 0.3) for k, c in enumerate(("#7a4a3f", "#3f5566", "#8c8467", "#4d5a4a", "#a58a5c", "#5a4a52", "#b9ab96", "#40434a", "#93705a", "#6f7f86")))


def book(d: float, w: float, t: float, cover: Material) -> Parts:
    """A closed book lying flat on z = 0, its spine toward +X, `d` from spine to fore-edge."""
    board = 0.003
    covers = [box((d, w, board), 0.001).moved(z=z) for z in (0.0, t - board)]
    spine = prism(superellipse(t, 0.02, 3, 16), w, 0.001).turned("x", 90).turned("y", 90).moved(d / 2 - 0.006, w / 2, t / 2)
    bands = [box((0.003, 0.004, t * 0.94), 0.001).moved(d / 2 + 0.003, f * w, t * 0.03) for f in (-0.36, -0.3, 0.3, 0.36)]
    return of(cover, *covers, spine) + of(m.PAPER, box((d - 0.012, w - 0.01, t - 2 * board), 0.001).moved(-0.003, 0, board)) + of(m.BRASS, *bands)


def book_stack(size: Size, count: int, seed: int) -> Parts:
    """Books lying on each other, a little askew."""
    d, w, h = size
    rng = np.random.default_rng(seed)
    share = rng.uniform(0.7, 1.4, count)
    heights = share / share.sum() * h
    parts: Parts = []
    z = 0.0
    for k, t in enumerate(heights):
        f = 1.0 - 0.16 * k / count * rng.uniform(0.6, 1.4)
        one = book(d * 0.93 * f, w * 0.93 * f, float(t) - 0.0004, COVERS[(seed * 3 + k * 7) % len(COVERS)])
        parts += [p.moved(0, 0, z) for p in turned(one, "z", float(rng.uniform(-6, 6)) if k else 0.0)]
        z += float(t)
    return parts


def book_row(size: Size, seed: int, leaning: bool = True) -> Parts:
    """Books standing in a row along y, spines toward +X."""
    d, w, h = size
    rng = np.random.default_rng(seed)
    parts: Parts = []
    y, k = -w / 2, 0
    stop = w / 2 - (0.055 if leaning else 0.0)
    while y < stop - 0.012:
        t = min(float(rng.uniform(0.016, 0.042)), stop - y)
        hh = h * float(rng.uniform(0.78, 1.0)) if k else h
        dd = d * float(rng.uniform(0.84, 1.0)) if k != 1 else d
        parts += _standing(dd, hh, t, COVERS[(seed + k * 3) % len(COVERS)], d / 2 - dd / 2, y + t / 2)
        y, k = y + t + 0.0008, k + 1
    if leaning:
        last = [p.turned("x", 11) for p in _standing(d * 0.9, h * 0.84, 0.02, COVERS[(seed + 5) % len(COVERS)], d * 0.04, 0.0)]
        parts += [p.moved(0, w / 2 - 0.013, 0.0) for p in last]
    return parts


def _standing(d: float, h: float, t: float, cover: Material, x: float, y: float) -> Parts:
    lying = book(d, h, t, cover)
    return [p.moved(0, 0, -t / 2).turned("x", 90).moved(x, y, h / 2) for p in lying]


def open_book(size: Size, cover: Material) -> Parts:
    """An open book, read from +X."""
    d, w, h = size
    half = w / 2
    u = np.linspace(0, 1, 9)
    rise = h * (0.35 + 0.65 * np.sin(np.pi * np.clip(u * 1.05, 0, 1)) ** 0.8) * np.where(u < 0.1, 0.6 + 4 * u, 1)
    grid = np.stack([np.stack([np.full(9, x), half * u, rise], axis=1) for x in (d / 2 - 0.006, -d / 2 + 0.006)])
    low = grid.copy()
    low[:, :, 2] = 0.004
    page = shell(grid[::-1], low[::-1])
    return of(m.PAPER, *both_sides(page)) + of(cover, box((d, w + 0.012, 0.004), 0.001))


def magazines(size: Size) -> Parts:
    """A loose pile of magazines."""
    d, w, h = size
    rng = np.random.default_rng(2)
    n = 7
    parts: Parts = []
    for k in range(n):
        one = of(COVERS[(k * 3) % 10], box((d * 0.92, w * 0.92, h / n * 0.9), 0.0015)) + of(m.PAPER, box((d * 0.921, w * 0.921, h / n * 0.5), 0.001).moved(z=h / n * 0.2))
        parts += [p.moved(*rng.uniform(-0.006, 0.006, 2), k * h / n) for p in turned(one, "z", float(rng.uniform(-7, 7)))]
    return parts


def carton(size: Size, card: Material, opened: bool = False) -> Parts:
    """A cardboard box, taped shut or open."""
    d, w, h = size
    if not opened:
        tape = box((0.05, w + 0.001, 0.001), 0.0004).moved(z=h - 0.0008)
        drops = both_sides(box((0.05, 0.001, 0.07), 0.0004).moved(0, w / 2, h - 0.07))
        return of(card, box((d, w, h - 0.001), 0.003)) + of(m.LINEN, tape, *drops) + of(m.SHADOW, box((0.0015, w * 0.995, 0.0006), 0.0002).moved(z=h - 0.0002))
    body = 0.8 * h
    t, bd, bw = 0.005, d * 0.74, w * 0.78
    walls = [box((t, bw, body), 0.002).moved(s * (bd - t) / 2, 0, 0) for s in (1, -1)] + [box((bd, t, body), 0.002).moved(0, s * (bw - t) / 2, 0) for s in (1, -1)]
    flap_x = [box((t, bw * 0.98, 0.3 * bd), 0.002).turned("y", s * 40).moved(s * (bd / 2 - 0.001), 0, body - 0.003) for s in (1, -1)]
    flap_y = [box((bd * 0.98, t, 0.26 * bw), 0.002).turned("x", -s * 55).moved(0, s * (bw / 2 - 0.001), body - 0.003) for s in (1, -1)]
    return of(card, *walls, box((bd, bw, t), 0.002), *flap_x, *flap_y)


def crate(size: Size, wood: Material) -> Parts:
    """A slatted wooden crate."""
    d, w, h = size
    t, n = 0.012, 3
    slat = (h - 0.02 * (n - 1)) / n
    sides = [box((d - 2 * t, t, slat), 0.002).moved(0, s * (w - t) / 2, k * (slat + 0.02)) for s in (1, -1) for k in range(n)]
    ends = [box((t, w, slat), 0.002).moved(s * (d - t) / 2, 0, k * (slat + 0.02)) for s in (1, -1) for k in range(n)]
    posts = four(box((0.022, 0.022, h - 0.004), 0.002).moved(d / 2 - t - 0.011, w / 2 - t - 0.011))
    floor = [box((d - 2 * t, w / 4.4, 0.008), 0.002).moved(0, y, 0.002) for y in np.linspace(-0.37 * w, 0.37 * w, 4)]
    return of(wood, *sides, *ends, *posts, *floor)


def storage_tub(size: Size, tub: Material, lid: Material) -> Parts:
    """A plastic storage box with a clipped lid."""
    d, w, h = size
    o = rounded_rectangle(d, w, 0.04, 6)
    body = loft(np.array([ring_path(o * s, z) for s, z in ((0.86, 0), (0.88, 0.01), (0.955, h - 0.05), (0.985, h - 0.048), (0.985, h - 0.03))]), crease_rad=np.deg2rad(50))
    clips = both_sides(box((0.09, 0.012, 0.06), 0.004, 2).moved(0, w / 2 - 0.012, h - 0.085))
    return of(tub, body) + of(lid, prism(o, 0.022, 0.008).moved(z=h - 0.032), prism(o * 0.9, 0.012, 0.005).moved(z=h - 0.012), *clips)


def suitcase(size: Size, case: Material, trim: Material) -> Parts:
    """An upright suitcase on wheels."""
    d, w, h = size
    body = box((d, w, h - 0.16), 0.045, 3).moved(z=0.05)
    ribs = [box((d + 0.008, 0.012, h - 0.3), 0.004).moved(0, y, 0.12) for y in np.linspace(-0.34 * w, 0.34 * w, 6)]
    wheels = four(cylinder(0.026, 0.022, 0.005, 14).turned("x", 90).moved(d / 2 - 0.045, w / 2 - 0.06, 0.026))
    rods = both_sides(rod((-d * 0.3, w * 0.2, h - 0.12), (-d * 0.3, w * 0.2, h - 0.012), 0.007))
    return of(case, body, *ribs) + of(trim, *wheels, *rods, rod((-d * 0.3, -w * 0.22, h - 0.014), (-d * 0.3, w * 0.22, h - 0.014), 0.013), box((0.03, 0.13, 0.02), 0.006).moved(0.02, 0, h - 0.11))


def chest(size: Size, wood: Material, strap: Material) -> Parts:
    """A trunk with metal bands."""
    d, w, h = size
    lid = 0.3 * h
    bands = [box((d + 0.004, 0.035, h - 0.002), 0.003).moved(0, s * w * 0.3, 0.001) for s in (1, -1)]
    return of(wood, box((d, w, h - lid - 0.004), 0.006, 2), box((d, w, lid), 0.02, 2).moved(z=h - lid)) + of(strap, *bands, box((0.012, 0.07, 0.07), 0.003).moved(d / 2 + 0.003, 0, h - lid - 0.045))


def woven_basket(size: Size, cane: Material, outline: Literal["round", "square"], handles: bool = True, lid: bool = False) -> Parts:
    """A woven basket."""
    d, w, h = size
    o = superellipse(d, w, 2.0 if outline == "round" else 7.0, 44)
    body_h = h - (0.05 if handles and not lid else 0.03 if lid else 0.012)
    layers = [(0.8, 0), (0.84, 0.012), (0.97, body_h * 0.6), (0.95, body_h), (0.91, body_h), (0.92, body_h * 0.6), (0.8, 0.02), (0.03, 0.016)]
    parts = of(cane, loft(np.array([ring_path(o * s, z) for s, z in layers]), crease_rad=np.deg2rad(50)), tube(ring_path(o * 0.945, body_h), 0.013, 7, closed=True))
    if lid:
        parts += of(cane, loft(np.array([ring_path(o * s, z) for s, z in ((0.96, body_h + 0.002), (0.98, body_h + 0.012), (0.6, h - 0.012), (0.05, h - 0.01))]), crease_rad=np.deg2rad(60)))
    if handles and not lid:
        ear = tube(bend([(-0.07, 0.455 * w, body_h - 0.01), (-0.05, 0.475 * w, h - 0.008), (0.05, 0.475 * w, h - 0.008), (0.07, 0.455 * w, body_h - 0.01)], 4), 0.009, 8)
        parts += of(m.TAN_LEATHER, *both_sides(ear))
    return parts


def wire_basket(size: Size, wire: Material) -> Parts:
    """A basket of welded wire."""
    d, w, h = size
    hoops = [tube(ring_path(superellipse(d * s, w * s, 6, 36), z), 0.003 if z < h - 0.02 else 0.005, 5, closed=True) for s, z in ((0.84, 0.004), (0.89, h * 0.33), (0.94, h * 0.66), (0.985, h - 0.006))]
    o, top = superellipse(d * 0.84, w * 0.84, 6, 28), superellipse(d * 0.985, w * 0.985, 6, 28)
    ribs = [rod((*a, 0.004), (*b, h - 0.006), 0.002, segments=5) for a, b in zip(o, top, strict=True)]
    floor = [rod((-0.42 * d, y, 0.004), (0.42 * d, y, 0.004), 0.002, segments=5) for y in np.linspace(-0.4 * w, 0.4 * w, 9)]
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
        hoops = [tube(ring_path(o * (0.76 + 0.225 * f), 0.006 + (h - 0.012) * f), 0.002 if 0 < f < 1 else 0.006, 5, closed=True) for f in np.linspace(0, 1, 9)]
        return of(body, *ribs, *hoops, cylinder(r * 0.75, 0.006, 0.001, 32))
    if kind == "pedal":
        can = cylinder(r * 0.96, h * 0.8, 0.006, 40).moved(z=0.03)
        dome = lathe([(r * 0.98, 0.84 * h), (r, 0.86 * h), (r * 0.97, 0.92 * h), (r * 0.6, 0.985 * h), (0.005, h)], 40, np.deg2rad(60))
        return of(body, can, dome) + of(m.BLACK, cylinder(r, 0.035, 0.006, 40), box((0.06, 0.07, 0.012), 0.004).moved(r + 0.01, 0, 0.008))
    o = rounded_rectangle(d, w, 0.05, 6)
    can = loft(np.array([ring_path(o * s, z) for s, z in ((0.84, 0), (0.86, 0.012), (0.97, 0.76 * h))]))
    hood = loft(np.array([ring_path(o * s, z) for s, z in ((1.0, 0.75 * h), (1.0, 0.8 * h), (0.86, 0.96 * h), (0.7, h))]), crease_rad=np.deg2rad(45))
    return of(body, can, hood) + of(m.CHARCOAL, box((0.012, w * 0.6, 0.16 * h), 0.004).turned("y", -26).moved(d * 0.475, 0, 0.79 * h))


def teddy(size: Size, fur: Material, muzzle: Material) -> Parts:
    """A sitting teddy bear."""
    d, w, h = size
    body = cushion((0.55 * d, 0.52 * w, 0.52 * h), 2, 2.2, 10).moved(-0.1 * d, 0, 0.02)
    head = cushion((0.5 * d, 0.5 * w, 0.42 * h), 2, 2.1, 10).moved(-0.05 * d, 0, 0.5 * h)
    nose = cushion((0.2 * d, 0.22 * w, 0.15 * h), 2, 2, 6).moved(0.19 * d, 0, 0.56 * h)
    ears = both_sides(cushion((0.12 * d, 0.2 * w, 0.17 * h), 2, 2, 6).moved(-0.06 * d, 0.2 * w, 0.82 * h))
    arms = both_sides(cushion((0.22 * d, 0.2 * w, 0.36 * h), 2, 2.2, 8).turned("x", 28).moved(0.06 * d, 0.33 * w, 0.2 * h))
    legs = both_sides(cushion((0.6 * d, 0.24 * w, 0.22 * h), 2.2, 2.2, 8).turned("z", 16).moved(0.2 * d, 0.27 * w, 0.0))
    soles = both_sides(cushion((0.05 * d, 0.16 * w, 0.15 * h), 2, 2, 5).moved(0.475 * d, 0.345 * w, 0.035 * h))
    eyes = both_sides(ball(0.036 * h, 4).moved(0.172 * d, 0.1 * w, 0.735 * h))
    return of(fur, body, head, *ears, *arms, *legs) + of(muzzle, nose, *soles) + of(m.BLACK, *eyes, cushion((0.05 * d, 0.09 * w, 0.05 * h), 2, 2, 4).moved(0.275 * d, 0, 0.645 * h))


def toy_blocks(size: Size) -> Parts:
    """A little tower of wooden blocks."""
    d, w, h = size
    b = h / 3
    tones = (m.RUST_FABRIC.colour, m.BLUE_GLAZE.colour, m.MUSTARD_FABRIC.colour, m.SAGE.colour)
    paints = [m.paint(f"block {c}", c) for c in tones]
    spots = [(0.2, -0.25, 0, 8), (-0.1, 0.25, 0, -14), (0.02, 0.0, 1, 20), (0.0, 0.03, 2, -6)]
    return [p for k, (x, y, z, turn) in enumerate(spots) for p in (q.moved(x * d, y * w, z * b) for q in turned(of(m.BIRCH if k == 1 else paints[k % 4], box((b, b, b), 0.006, 2)), "z", turn))]


def toy_car(size: Size, paint: Material, wheel: Material) -> Parts:
    """A wooden car, driving toward +X."""
    d, w, h = size
    body = box((d, w * 0.78, h * 0.4), 0.02, 3).moved(z=h * 0.18)
    cabin = box((d * 0.5, w * 0.7, h * 0.48), 0.03, 3).moved(-0.06 * d, 0, h * 0.52)
    wheels = four(cylinder(h * 0.22, w * 0.16, 0.006, 24).turned("x", 90).moved(0.29 * d, w / 2, h * 0.22))
    panes = [box((d * 0.36, w * 0.71, h * 0.2), 0.01).moved(-0.06 * d, 0, h * 0.68), box((d * 0.51, w * 0.5, h * 0.2), 0.01).moved(-0.06 * d, 0, h * 0.68)]
    return of(paint, body, cabin) + of(wheel, *wheels) + of(m.DARK_GLASS, *panes)


def toy_ball(size: Size, a: Material, b: Material) -> Parts:
    """A ball with a band."""
    d = size[0]
    band = lathe([(d * 0.488, d * 0.38), (d * 0.503, d * 0.42), (d * 0.503, d * 0.58), (d * 0.488, d * 0.62)], 40, np.pi)
    return of(a, ball(d, 12)) + of(b, band)


def rounded_block(size: Size, material: Material, radius: float) -> Parts:
    """A neutral rounded box."""
    return of(material, box(size, min(radius, 0.35 * min(size)), 3))


def drum(size: Size, material: Material, band: Material) -> Parts:
    """A neutral cylinder with a lid's line."""
    d, w, h = size
    o = superellipse(d, w, 2.0, 48)
    return of(material, prism(o, h * 0.8, 0.01), prism(o, h * 0.196, 0.01).moved(z=h * 0.804)) + of(band, prism(o * 0.985, h * 0.02, 0.001).moved(z=h * 0.79))


def lidded(size: Size, body: Material, lid: Material) -> Parts:
    """A neutral box with a lid."""
    d, w, h = size
    t = max(0.12 * h, 0.012)
    return of(body, box((d * 0.97, w * 0.97, h - t), 0.006, 2)) + of(lid, box((d, w, t), min(0.01, t / 3), 2).moved(z=h - t))


def _d(category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


BROWN_FUR = m.fabric("brown plush", "#96744f", 0.05)
PALE_FUR = m.fabric("pale plush", "#d5c4a5", 0.05)
GREEN_BOTTLE = m.paint("green bottle glass", "#3c4b3a", 0.12)

DESIGNS: tuple[Design, ...] = (
    _d("vase", "urn-blue", "blue glazed urn", (0.20, 0.20, 0.30), "classic", partial(vase, clay=m.BLUE_GLAZE, kind="urn"), 36),
    _d("vase", "bottle-white", "white bottle vase", (0.14, 0.14, 0.34), "modern", partial(vase, clay=m.PORCELAIN, kind="bottle"), 36),
    _d("vase", "cylinder-glass", "glass cylinder vase", (0.14, 0.14, 0.28), "minimal", partial(vase, clay=m.GLASS, kind="cylinder"), 36),
    _d("vase", "moon-stone", "round stoneware vase", (0.24, 0.24, 0.25), "modern", partial(vase, clay=m.STONEWARE, kind="moon"), 36),
    _d("vase", "amphora", "terracotta vase with two handles", (0.24, 0.30, 0.42), "rustic", partial(vase, clay=m.TERRACOTTA, kind="urn", handles=True), 2),
    _d("vase", "tulip-green", "green glazed tulip vase", (0.15, 0.15, 0.24), "classic", partial(vase, clay=m.GREEN_GLAZE, kind="tulip"), 36),
    _d("vase", "jug", "stoneware jug", (0.22, 0.16, 0.24), "rustic", partial(jug, clay=m.STONEWARE)),
    _d("bowl", "deep-white", "white bowl", (0.24, 0.24, 0.10), "minimal", partial(bowl, clay=m.PORCELAIN, kind="deep"), 36),
    _d("bowl", "wood", "turned wooden bowl", (0.30, 0.30, 0.11), "rustic", partial(bowl, clay=m.WALNUT, kind="deep"), 36),
    _d("bowl", "plate", "stoneware plate", (0.27, 0.27, 0.028), "modern", partial(bowl, clay=m.STONEWARE, kind="plate"), 36),
    _d("bowl", "tray", "walnut tray with brass handles", (0.30, 0.45, 0.05), "modern", partial(bowl, clay=m.WALNUT, kind="tray"), 2),
    _d("bowl", "footed", "footed dish", (0.26, 0.26, 0.14), "classic", partial(bowl, clay=m.BLUE_GLAZE, kind="footed"), 36),
    _d("cup", "mug-white", "white mug", (0.085, 0.12, 0.095), "minimal", partial(cup, clay=m.PORCELAIN, kind="mug")),
    _d("cup", "mug-stone", "stoneware mug", (0.09, 0.125, 0.10), "rustic", partial(cup, clay=m.DARK_STONEWARE, kind="mug")),
    _d("cup", "tea", "teacup on a saucer", (0.145, 0.145, 0.075), "classic", partial(cup, clay=m.PORCELAIN, kind="tea")),
    _d("cup", "tumbler", "glass tumbler", (0.08, 0.08, 0.11), "modern", partial(cup, clay=m.GLASS, kind="tumbler"), 36),
    _d("cup", "wine", "wine glass", (0.085, 0.085, 0.20), "classic", partial(cup, clay=m.GLASS, kind="wine"), 36),
    _d("bottle", "wine", "bottle of wine", (0.078, 0.078, 0.30), "classic", partial(bottle, glass=GREEN_BOTTLE, kind="wine", cap=m.MAHOGANY), 36),
    _d("bottle", "water", "steel water bottle", (0.07, 0.07, 0.25), "modern", partial(bottle, glass=m.SAGE, kind="water", cap=m.STEEL), 36),
    _d("bottle", "dispenser", "soap dispenser", (0.075, 0.075, 0.19), "minimal", partial(bottle, glass=m.STONEWARE, kind="spray", cap=m.BRASS)),
    _d("books", "stack-small", "stack of three books", (0.17, 0.24, 0.09), "classic", partial(book_stack, count=3, seed=1)),
    _d("books", "stack-tall", "tall stack of books", (0.20, 0.28, 0.22), "modern", partial(book_stack, count=7, seed=4)),
    _d("books", "stack-large", "stack of large picture books", (0.25, 0.33, 0.13), "minimal", partial(book_stack, count=4, seed=9)),
    _d("books", "row", "row of books", (0.19, 0.42, 0.26), "classic", partial(book_row, seed=3)),
    _d("books", "row-long", "long row of books", (0.18, 0.72, 0.25), "classic", partial(book_row, seed=8, leaning=False)),
    _d("books", "open", "open book", (0.24, 0.34, 0.035), "minimal", partial(open_book, cover=COVERS[1])),
    _d("books", "single", "single book", (0.15, 0.22, 0.03), "minimal", partial(book_stack, count=1, seed=6)),
    _d("books", "magazines", "pile of magazines", (0.24, 0.31, 0.05), "modern", magazines),
    _d("box", "carton", "closed cardboard box", (0.35, 0.45, 0.32), "minimal", partial(carton, card=m.CARDBOARD), 2),
    _d("box", "carton-open", "open cardboard box", (0.50, 0.55, 0.42), "minimal", partial(carton, card=m.CARDBOARD, opened=True), 2),
    _d("box", "crate", "pine crate", (0.32, 0.46, 0.28), "rustic", partial(crate, wood=m.PINE), 2),
    _d("box", "tub", "storage box with a lid", (0.38, 0.54, 0.30), "modern", partial(storage_tub, tub=m.LIGHT_GREY, lid=m.WHITE), 2),
    _d("box", "suitcase", "upright navy suitcase", (0.26, 0.44, 0.68), "modern", partial(suitcase, case=m.NAVY, trim=m.BLACK)),
    _d("box", "trunk", "old wooden trunk", (0.46, 0.85, 0.46), "rustic", partial(chest, wood=m.WALNUT, strap=m.IRON)),
    _d("basket", "round", "round wicker basket with handles", (0.42, 0.44, 0.38), "rustic", partial(woven_basket, cane=m.WICKER, outline="round"), 2),
    _d("basket", "hamper", "lidded laundry hamper", (0.40, 0.46, 0.58), "classic", partial(woven_basket, cane=m.RATTAN, outline="square", lid=True), 2),
    _d("basket", "shelf", "dark rectangular shelf basket", (0.30, 0.40, 0.26), "modern", partial(woven_basket, cane=m.DARK_WICKER, outline="square"), 2),
    _d("basket", "wire", "black wire basket", (0.30, 0.38, 0.24), "industrial", partial(wire_basket, wire=m.BLACK_STEEL), 2),
    _d("trash can", "open-white", "white waste-paper bin", (0.28, 0.28, 0.32), "minimal", partial(bin_, body=m.WHITE, kind="open"), 36),
    _d("trash can", "pedal", "steel pedal bin", (0.34, 0.30, 0.62), "modern", partial(bin_, body=m.STAINLESS, kind="pedal")),
    _d("trash can", "swing", "grey swing-lid bin", (0.30, 0.38, 0.66), "classic", partial(bin_, body=m.GREY, kind="swing")),
    _d("trash can", "mesh", "black mesh waste basket", (0.29, 0.29, 0.34), "industrial", partial(bin_, body=m.BLACK_STEEL, kind="mesh"), 36),
    _d("toy", "teddy", "brown teddy bear", (0.26, 0.28, 0.34), "classic", partial(teddy, fur=BROWN_FUR, muzzle=PALE_FUR)),
    _d("toy", "teddy-pale", "small cream teddy bear", (0.20, 0.22, 0.26), "modern", partial(teddy, fur=PALE_FUR, muzzle=BROWN_FUR)),
    _d("toy", "blocks", "wooden toy blocks", (0.18, 0.22, 0.21), "minimal", toy_blocks),
    _d("toy", "car", "wooden toy car", (0.24, 0.13, 0.12), "rustic", partial(toy_car, paint=m.SAGE, wheel=m.OAK)),
    _d("toy", "ball", "striped ball", (0.22, 0.22, 0.22), "modern", partial(toy_ball, a=m.CREAM, b=m.NAVY), 36),
    _d("object", "cube", "rounded light grey cube", (0.60, 0.60, 0.60), "minimal", partial(rounded_block, material=m.LIGHT_GREY, radius=0.04), 4),
    _d("object", "tall", "tall rounded block", (0.50, 0.50, 1.20), "minimal", partial(rounded_block, material=m.LIGHT_GREY, radius=0.04), 4),
    _d("object", "flat", "low wide rounded block", (0.60, 1.00, 0.25), "minimal", partial(rounded_block, material=m.LIGHT_GREY, radius=0.04), 2),
    _d("object", "slab", "upright thin panel", (0.08, 0.80, 0.90), "minimal", partial(rounded_block, material=m.LIGHT_GREY, radius=0.02), 2),
    _d("object", "drum", "grey drum with a lid", (0.45, 0.45, 0.60), "modern", partial(drum, material=m.LIGHT_GREY, band=m.GREY), 36),
    _d("object", "pillar", "tall cylinder", (0.30, 0.30, 1.10), "modern", partial(drum, material=m.LIGHT_GREY, band=m.GREY), 36),
    _d("object", "lidded", "oak box with a lid", (0.40, 0.55, 0.35), "classic", partial(lidded, body=m.OAK, lid=m.OAK), 2),
    _d("object", "small", "small lidded box", (0.16, 0.22, 0.12), "classic", partial(lidded, body=m.STONEWARE, lid=m.WALNUT), 2),
)  # fmt: skip
