"""Cushions and pillows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *

STRIPED_CLOTH = Material("striped linen", "stripes", "#8b98a5", 0.92, 0.0, 0.5)


def scatter_cushion(size: Size, cloth: Material, piping: Material | None = None, lean: float = 68.0) -> Parts:
    """A cushion leaning back as against a sofa; its face toward +X."""
    _, w, h = size
    thick = 0.15
    face = pillow((h, w, thick), 14)
    parts = of(cloth, replace(face, uv=face.vertices[:, 1::-1]))
    if piping is not None:
        a = np.sin(np.linspace(-1, 1, 15) * np.pi / 2)
        edge = np.concatenate(
            [
                [(x, -1) for x in a[:-1]],
                [(1, y) for y in a[:-1]],
                [(x, 1) for x in a[:0:-1]],
                [(-1, y) for y in a[:0:-1]],
            ]
        )
        u, v = edge.T
        outline = np.stack(
            [u * (1 - 0.05 * (1 - v**2) * np.abs(u)) * h / 2, v * (1 - 0.05 * (1 - u**2) * np.abs(v)) * w / 2], axis=1
        )
        parts += of(piping, tube(ring_path(outline, thick / 2), 0.006, 6, closed=True))
    return [p.turned("y", -lean) for p in parts]


def bed_pillow(size: Size, cloth: Material) -> Parts:
    """A bed pillow lying flat."""
    return of(cloth, pillow(size, 14, 0.025))


def round_cushion(size: Size, cloth: Material) -> Parts:
    """A round cushion with a button, lying flat."""
    d, w, h = size
    rim = tube(ring_path(superellipse(d * 0.985, w * 0.985, 2, 48), h / 2), 0.006, 6, closed=True)
    return of(cloth, cushion((d, w, h), 2.0, 2.5, 14), rim, cylinder(0.02, 0.012, 0.004, 16).moved(z=h - 0.008))


def bolster(size: Size, cloth: Material) -> Parts:
    """A cylindrical bolster lying along y."""
    _, w, h = size
    r = h / 2
    body = cylinder(r, w, 0.03, 32).turned("x", 90).moved(0, w / 2, r)
    rims = [
        tube(ring_path(superellipse(2 * r * 0.985, 2 * r * 0.985, 2, 32)), 0.006, 6, closed=True)
        .turned("x", 90)
        .moved(0, s * (w / 2 - 0.028), r)
        for s in (1, -1)
    ]
    return of(cloth, body, *rims)


def tasselled(size: Size, cloth: Material, tassel: Material, pattern: float = 0.0) -> Parts:
    """A scatter cushion with a tassel at every corner; the cloth's picture is spread once if `pattern` is given."""
    _, w, h = size
    flat = [*scatter_cushion((0.0, w * 0.94, h * 0.94), cloth, lean=0.0)]
    if pattern:
        flat = [replace(p, solid=replace(p.solid, uv=p.solid.uv / np.array([w, h]) * pattern + 0.5)) for p in flat]
    ends = [
        lathe([(0.002, 0), (0.006, 0.004), (0.009, 0.016), (0.011, 0.042), (0.004, 0.044)], 8)
        .turned("y", 90)
        .turned("z", a)
        .moved(x * h * 0.46, y * w * 0.46, 0.075)
        for x, y, a in ((1, 1, 45), (-1, 1, 135), (-1, -1, 225), (1, -1, 315))
    ]
    return [p.turned("y", -68) for p in flat + of(tassel, *ends)]


def pillow_pair(size: Size, cloth: Material, second: Material) -> Parts:
    """Two bed pillows, one on the other."""
    d, w, h = size
    return of(cloth, pillow((d, w, h * 0.56), 14, 0.025)) + of(
        second, pillow((d * 0.94, w * 0.92, h * 0.54), 14, 0.025).turned("z", 4).moved(0.01, 0.01, h * 0.46)
    )


def floor_cushion(size: Size, cloth: Material) -> Parts:
    """A thick square cushion to sit on, tufted in the middle."""
    d, w, h = size
    pad = cushion(size, 6.0, 3.4, 14)
    v = pad.vertices.copy()
    v[:, 2] -= (
        np.sign(v[:, 2] - h / 2) * 0.16 * h * np.exp(-((v[:, 0] / (0.14 * d)) ** 2) - (v[:, 1] / (0.14 * w)) ** 2)
    )
    rims = [
        tube(ring_path(superellipse(d * 0.985, w * 0.985, 6.0, 48), z), 0.007, 6, closed=True)
        for z in (0.34 * h, 0.66 * h)
    ]
    return of(cloth, replace(pad, vertices=v), *rims) + of(cloth, cylinder(0.018, 0.012, 0.004, 14).moved(z=0.83 * h))


KNITTED = Material("chunky knit", "knit", "#d5c9b4", 0.95, 0.0, 0.24)
KILIM_CLOTH = Material("kilim cloth", "kilim", "#8d6458", 0.95, 0.0, 1.0)
TARTAN = Material("green tartan", "plaid", "#556b5c", 0.95, 0.0, 0.26)
CHECKED = Material("checked cotton", "check", "#6d8193", 0.92, 0.0, 0.14)
HERRINGBONE = Material("herringbone tweed", "herringbone", "#8a8378", 0.95, 0.0, 0.2)
VELVET = m.fabric("green velvet", "#4f665a", 0.05)


DESIGNS: tuple[Design, ...] = (
    design("pillow", "linen", "linen scatter cushion", (0.24, 0.46, 0.44), "modern", scatter_cushion, cloth=m.LINEN),
    design("pillow", "rust", "rust scatter cushion", (0.24, 0.44, 0.43), "rustic", scatter_cushion, cloth=m.RUST_FABRIC),
    design("pillow", "navy-piped", "navy cushion with light piping", (0.25, 0.48, 0.46), "classic", scatter_cushion, cloth=m.NAVY_FABRIC, piping=m.LINEN),
    design("pillow", "lumbar-grey", "long grey lumbar cushion", (0.20, 0.60, 0.32), "minimal", scatter_cushion, cloth=m.GREY_FABRIC),
    design("pillow", "striped", "striped linen cushion", (0.24, 0.48, 0.45), "classic", scatter_cushion, cloth=STRIPED_CLOTH, piping=m.BLUE_FABRIC),
    design("pillow", "bed-white", "white bed pillow", (0.46, 0.68, 0.16), "minimal", bed_pillow, 2, cloth=m.WHITE_COTTON),
    design("pillow", "round-rose", "round dusty rose cushion", (0.40, 0.40, 0.14), "modern", round_cushion, 36, cloth=m.ROSE_FABRIC),
    design("pillow", "bolster-olive", "olive bolster", (0.19, 0.55, 0.19), "classic", bolster, 2, cloth=m.OLIVE_FABRIC),
    design("pillow", "knit", "chunky knitted cushion", (0.25, 0.47, 0.45), "rustic", scatter_cushion, cloth=KNITTED),
    design("pillow", "kilim", "patterned cushion with tassels", (0.26, 0.50, 0.48), "rustic", tasselled, cloth=KILIM_CLOTH, tassel=m.LINEN, pattern=1.0),
    design("pillow", "tartan", "green tartan cushion", (0.24, 0.46, 0.44), "classic", scatter_cushion, cloth=TARTAN),
    design("pillow", "checked", "blue checked cushion", (0.24, 0.45, 0.44), "rustic", scatter_cushion, cloth=CHECKED),
    design("pillow", "velvet", "green velvet cushion with piping", (0.25, 0.50, 0.48), "modern", scatter_cushion, cloth=VELVET, piping=VELVET),
    design("pillow", "tweed", "tweed cushion", (0.24, 0.47, 0.45), "industrial", scatter_cushion, cloth=HERRINGBONE),
    design("pillow", "leather", "tan leather cushion", (0.24, 0.48, 0.46), "industrial", scatter_cushion, cloth=m.TAN_LEATHER, piping=m.TAN_LEATHER),
    design("pillow", "bed-pair", "two bed pillows", (0.48, 0.70, 0.27), "minimal", pillow_pair, cloth=m.WHITE_COTTON, second=m.LINEN),
    design("pillow", "floor", "thick ochre floor cushion", (0.60, 0.60, 0.20), "rustic", floor_cushion, 4, cloth=m.MUSTARD_FABRIC),
)  # fmt: skip
