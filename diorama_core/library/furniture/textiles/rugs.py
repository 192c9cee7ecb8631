"""Carpets, runners and mats."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *


def rug(size: Size, pile: Material, pictured: bool, fringe: Material | None = None) -> Parts:
    """A flat carpet; fringes at both ends (+X and -X)."""
    d, w, h = size
    length = d - (0.1 if fringe else 0.0)
    body = box((length, w, h), h * 0.4)
    if pictured:
        x, y = body.vertices[:, 0], body.vertices[:, 1]
        body = replace(body, uv=np.stack([y / w + 0.5, x / length + 0.5], axis=1))
    parts = of(pile, body)
    if fringe is not None:
        n = int(w / 0.04)
        tufts = [
            rod((s * length / 2, y, h * 0.3), (s * (length / 2 + 0.05), y + 0.004, h * 0.2), 0.003, 0.005, 4)
            for s in (1, -1)
            for y in -w / 2 + w * (np.arange(n) + 0.5) / n
        ]
        parts += of(fringe, *tufts)
    return parts


def braided_rug(size: Size, jute: Material) -> Parts:
    """Concentric braids."""
    d, w, h = size
    rings = max(int(min(d, w) / 2 / 0.055), 4)
    step = min(d, w) / 2 / rings
    braids = [
        tube(
            ring_path(superellipse(d - 2 * step * (k + 0.5), w - 2 * step * (k + 0.5), 2.0, 40), 0.0),
            step * 0.52,
            5,
            closed=True,
        )
        for k in range(rings)
    ]
    return of(jute, *(b.scaled(z=h / (step * 1.04)).moved(z=h / 2) for b in braids))


RED_RUG = Material("madder carpet", "persian", "#7f4d45", 0.95, 0.0, 1.0)


BLUE_RUG = Material("indigo carpet", "persian", "#566276", 0.95, 0.0, 1.0)


STRIPED_RUG = Material("striped carpet", "stripes", "#7d8288", 0.95, 0.0, 1.0)


BERBER_RUG = Material("berber carpet", "diamonds", "#dcd3c2", 0.95, 0.0, 1.0)


JUTE = Material("jute", "wicker", "#b79e75", 0.95, 0.0, 0.1)


def round_rug(size: Size, pile: Material, pictured: bool = True, fringe: Material | None = None) -> Parts:
    """A round carpet, its picture spread once over it; with a fringe all round if asked."""
    d, w, h = size
    inner = 0.94 if fringe else 1.0
    body = prism(superellipse(d * inner, w * inner, 2.0, 64), h, h * 0.4)
    if pictured:
        body = replace(body, uv=body.vertices[:, :2] / np.array([d, w]) / inner + 0.5)
    parts = of(pile, body)
    if fringe is not None:
        tuft = rod((0.465 * d, 0, 0.4 * h), (0.498 * d, 0.006, 0.2 * h), 0.004, 0.006, 4)
        parts += of(fringe, *(tuft.turned("z", 360 / 72 * k).scaled(y=w / d) for k in range(72)))
    return parts


def shag_rug(size: Size, pile: Material) -> Parts:
    """A deep-pile carpet with a soft, uneven surface."""
    d, w, h = size
    v, u = np.meshgrid(np.linspace(-0.5, 0.5, 33), np.linspace(-0.5, 0.5, 33), indexing="ij")
    rng = np.random.default_rng(8)
    edge = np.minimum(0.5 - np.abs(u), 0.5 - np.abs(v))
    rise = h * (0.62 + 0.3 * rng.random(u.shape)) * np.clip(edge / 0.03, 0.25, 1) ** 0.5
    top = np.stack([v * d, u * w, rise], axis=-1)
    low = top.copy()
    low[..., 2] = 0.0
    return of(pile, shell(top, low, np.pi))


def hide(size: Size, fur: Material) -> Parts:
    """A sheepskin or cowhide of natural outline."""
    d, w, h = size
    t = np.arange(64) * 2 * np.pi / 64
    r = 1 + 0.10 * np.cos(2 * t) + 0.13 * np.cos(4 * t + 0.2) + 0.04 * np.cos(7 * t + 1)
    o = np.stack([r * np.cos(t) * d / 2, r * np.sin(t) * w / 2], axis=1)
    o = (o - (o.max(axis=0) + o.min(axis=0)) / 2) / np.ptp(o, axis=0) * np.array([d, w])
    rows = [(0.97, 0.0), (1.0, 0.35 * h), (0.96, 0.85 * h), (0.8, 0.97 * h), (0.4, h)]
    return of(fur, loft(np.array([ring_path(o * s, z) for s, z in rows]), crease_rad=np.pi))


def bath_mat(size: Size, pile: Material, border: Material) -> Parts:
    """A towelling mat with a flat border woven in."""
    d, w, h = size
    ridges = [
        box((d * 0.84, w * 0.9 / 15 * 0.8, h), h * 0.35).moved(0, -w * 0.45 + w * 0.9 * (k + 0.5) / 15)
        for k in range(15)
    ]
    return of(border, box((d, w, h * 0.6), h * 0.25)) + of(pile, *ridges)


def slat_mat(size: Size, wood: Material) -> Parts:
    """A duckboard of wooden slats."""
    d, w, h = size
    n = 7
    boards = [box((d / n - 0.01, w, h * 0.6), 0.005).moved(-d / 2 + d / n * (k + 0.5), 0, h * 0.4) for k in range(n)]
    return of(wood, *boards, *(box((d * 0.96, 0.035, h * 0.45), 0.004).moved(0, y * w) for y in (-0.36, 0.36)))


def contour_mat(size: Size, pile: Material) -> Parts:
    """A soft mat with a bay for the lavatory's foot."""
    d, w, h = size
    t = np.linspace(-1, 1, 15)
    u = np.linspace(0, 1, 9)
    back = -d / 2 + 0.5 * d * np.sqrt(np.clip(1 - (t / 0.46) ** 2, 0, 1))
    top = np.array(
        [
            [
                (
                    b + (d / 2 - b) * s,
                    y * w / 2,
                    h * (0.86 + 0.14 * ((i * 7 + j * 3) % 5) / 5) * (0.72 if s in (0.0, 1.0) or abs(y) == 1 else 1.0),
                )
                for j, s in enumerate(u)
            ]
            for i, (b, y) in enumerate(zip(back, t, strict=True))
        ]
    )
    low = top.copy()
    low[..., 2] = 0.0
    return of(pile, shell(top[:, ::-1], low[:, ::-1], np.pi))


MEDALLION_RUG = Material("medallion carpet", "medallion", "#6d6a72", 0.95, 0.0, 1.0)
SAGE_MEDALLION = Material("sage medallion carpet", "medallion", "#7d8a78", 0.95, 0.0, 1.0)
KILIM_RUG = Material("kilim", "kilim", "#87584c", 0.95, 0.0, 1.0)
BLUE_KILIM = Material("blue kilim", "kilim", "#5d7186", 0.95, 0.0, 1.0)
FIELD_RUG = Material("colour-field carpet", "field", "#8a7f70", 0.95, 0.0, 1.0)
BLOCK_RUG = Material("block carpet", "blocks", "#7a8a8d", 0.95, 0.0, 1.0)
SHAG = Material("ivory shag", "shag", "#e0d9ca", 0.98, 0.0, 0.5)
GREY_SHAG = Material("grey shag", "shag", "#9a9a98", 0.98, 0.0, 0.5)
FLEECE = Material("sheepskin", "shag", "#e8e2d4", 0.98, 0.0, 0.3)
COWHIDE = Material("cowhide", "marble", "#8f6f55", 0.8, 0.0, 1.2)
TERRY = Material("white towelling", "terry", "#e9e6df", 0.96, 0.0, 0.08)
GREY_TERRY = Material("grey towelling", "terry", "#9fa3a5", 0.96, 0.0, 0.08)
BLUE_TERRY = Material("blue towelling", "terry", "#6f8798", 0.96, 0.0, 0.08)


DESIGNS: tuple[Design, ...] = (
    design("rug", "persian-red", "madder red Persian rug", (2.40, 1.60, 0.014), "classic", rug, 2, pile=RED_RUG, pictured=True, fringe=m.LINEN),
    design("rug", "persian-blue", "indigo Persian rug", (2.90, 2.00, 0.014), "classic", rug, 2, pile=BLUE_RUG, pictured=True, fringe=m.LINEN),
    design("rug", "striped", "striped flat-weave rug", (2.00, 1.40, 0.012), "modern", rug, 2, pile=STRIPED_RUG, pictured=True),
    design("rug", "berber", "cream berber rug with diamonds", (2.30, 1.60, 0.022), "modern", rug, 2, pile=BERBER_RUG, pictured=True),
    design("rug", "plain-grey", "plain grey rug", (2.00, 1.40, 0.018), "minimal", rug, 2, pile=m.LIGHT_FABRIC, pictured=False),
    design("rug", "round-jute", "round braided jute rug", (1.60, 1.60, 0.016), "rustic", braided_rug, 36, jute=JUTE),
    design("rug", "mat", "small taupe mat", (0.90, 0.60, 0.014), "minimal", rug, 2, pile=m.TAUPE_FABRIC, pictured=False),
    design("rug", "medallion-round", "round carpet with a medallion", (1.80, 1.80, 0.014), "classic", round_rug, 4, pile=MEDALLION_RUG),
    design("rug", "sage-round", "round sage carpet with a fringe", (1.50, 1.50, 0.014), "rustic", round_rug, 4, pile=SAGE_MEDALLION, fringe=m.LINEN),
    design("rug", "round-grey", "round grey carpet", (1.60, 1.60, 0.018), "minimal", round_rug, 36, pile=m.GREY_FABRIC, pictured=False),
    design("rug", "runner-persian", "Persian runner", (2.80, 0.80, 0.014), "classic", rug, 2, pile=RED_RUG, pictured=True, fringe=m.LINEN),
    design("rug", "runner-striped", "striped runner", (2.40, 0.70, 0.012), "modern", rug, 2, pile=STRIPED_RUG, pictured=True),
    design("rug", "kilim", "flat-woven kilim", (2.00, 1.40, 0.010), "rustic", rug, 2, pile=KILIM_RUG, pictured=True, fringe=m.LINEN),
    design("rug", "kilim-blue", "blue flat-woven kilim", (1.80, 1.20, 0.010), "rustic", rug, 2, pile=BLUE_KILIM, pictured=True),
    design("rug", "colour-field", "carpet with two soft fields of colour", (2.40, 1.70, 0.016), "modern", rug, 2, pile=FIELD_RUG, pictured=True),
    design("rug", "blocks", "carpet of coloured blocks", (2.30, 1.60, 0.014), "modern", rug, pile=BLOCK_RUG, pictured=True),
    design("rug", "shag-ivory", "ivory shag carpet", (2.00, 1.40, 0.035), "minimal", shag_rug, 2, pile=SHAG),
    design("rug", "shag-grey", "grey shag carpet", (1.70, 1.20, 0.035), "industrial", shag_rug, 2, pile=GREY_SHAG),
    design("rug", "sheepskin", "sheepskin", (1.00, 0.65, 0.045), "rustic", hide, fur=FLEECE),
    design("rug", "cowhide", "cowhide", (2.00, 1.70, 0.008), "industrial", hide, fur=COWHIDE),
    design("bath mat", "white", "white bath mat", (0.50, 0.80, 0.016), "minimal", bath_mat, 2, pile=TERRY, border=m.WHITE_COTTON),
    design("bath mat", "blue", "blue bath mat", (0.55, 0.85, 0.018), "classic", bath_mat, 2, pile=BLUE_TERRY, border=m.BLUE_FABRIC),
    design("bath mat", "teak", "slatted wooden bath mat", (0.45, 0.70, 0.035), "rustic", slat_mat, 2, wood=m.OAK),
    design("bath mat", "contour", "grey pedestal mat", (0.50, 0.55, 0.022), "modern", contour_mat, pile=GREY_TERRY),
)  # fmt: skip
