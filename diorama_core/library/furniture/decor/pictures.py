"""Pictures: prints of our own in frames, canvases, gallery walls and photographs to stand up."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def picture(size: Size, bar: Material, image: Material, width: float = 0.03, mount: float = 0.0) -> Parts:
    """A framed picture, in a passe-partout if `mount` is given."""
    d, w, h = size
    inner_w, inner_h = w - 2 * width, h - 2 * width
    parts = of(bar, *frame(d, w, h, width)) if width else []
    x = 0.0 if width else d / 2 - 0.002
    if mount:
        parts += of(m.PORCELAIN, box((0.004, inner_w + 0.01, inner_h + 0.01), 0.001).moved(x, 0, width - 0.005))
    face = box(
        (0.003, inner_w - 2 * mount + (0 if mount else 0.008), inner_h - 2 * mount + (0 if mount else 0.008)), 0.0005
    ).pictured()
    parts += of(image, face.moved(x + (0.002 if mount else 0.0), 0, width + mount - (0 if mount else 0.004)))
    return parts + of(
        m.SHADOW if width else m.LINEN, box((d * 0.4, w - width, h - width), 0.002).moved(-d * 0.3, 0, width / 2)
    )


def canvas(size: Size, image: Material) -> Parts:
    """A frameless canvas."""
    d, w, h = size
    return of(m.LINEN, box((d - 0.002, w, h), 0.004).moved(-0.001)) + of(
        image, box((0.004, w - 0.006, h - 0.006), 0.001).pictured().moved(d / 2 - 0.002, 0, 0.003)
    )


def gallery(size: Size, bar: Material, images: tuple[Material, ...]) -> Parts:
    """Several framed prints hung together: one large, the others beside it."""
    d, w, h = size
    gap = 0.035
    left = 0.5 * w
    spots = [(left, h, -w / 2 + left / 2, 0.0)]
    rest = w - left - gap
    tall = (h - gap) / 2
    spots += [(rest, tall, w / 2 - rest / 2, tall + gap), (rest, tall, w / 2 - rest / 2, 0.0)]
    parts: Parts = []
    for (each_w, each_h, y, z), image in zip(spots, images, strict=True):
        one = picture((d, each_w, each_h), bar, image, 0.02, 0.12 * min(each_w, each_h))
        parts += [p.moved(0, -y, z) for p in one]
    return parts


def trio(size: Size, bar: Material, images: tuple[Material, ...], upright: bool = False) -> Parts:
    """A row of equal prints, or a column of them."""
    d, w, h = size
    n, gap = len(images), 0.04
    parts: Parts = []
    for k, image in enumerate(images):
        each = ((h if upright else w) - gap * (n - 1)) / n
        at = k * (each + gap)
        one = picture((d, w, each) if upright else (d, each, h), bar, image, 0.018, 0.05)
        parts += [p.moved(0, 0, at) if upright else p.moved(0, w / 2 - each / 2 - at) for p in one]
    return parts


def round_picture(size: Size, bar: Material, image: Material) -> Parts:
    """A round print in a thin ring."""
    d, w, h = size
    o = superellipse(w, h, 2.0, 48)
    ring = tube(np.column_stack([np.zeros(len(o)), o * (1 - d / w)]), d / 2, 8, closed=True)
    return (
        of(bar, ring)
        + of(image, stand_up(o * (1 - d / w), 0.006).pictured())
        + of(m.SHADOW, stand_up(o * (1 - d / w), d * 0.4).moved(-d / 2))
    )


def scroll(size: Size, wood: Material, image: Material) -> Parts:
    """A print between wooden rails, on a cord."""
    d, w, h = size
    low, high = 0.0, h - 0.12
    rails = [box((d, w, 0.024), 0.006, 2).moved(0, 0, z) for z in (low, high - 0.024)]
    sheet = box((0.003, w - 0.02, high - 0.02), 0.0006).pictured().moved(0, 0, 0.01)
    cord = [rod((0, s * w * 0.4, high - 0.01), (0, 0, h - 0.004), 0.0018, segments=6) for s in (1, -1)]
    return of(wood, *rails) + of(image, sheet) + of(m.SHADOW, *cord)


def relief(size: Size, base: Material, tones: tuple[Material, ...]) -> Parts:
    """Wooden slats of different heights in a frame: a picture made of wood."""
    d, w, h = size
    parts = of(base, *frame(d, w, h, 0.02), box((d * 0.3, w - 0.02, h - 0.02), 0.002).moved(-d * 0.33, 0, 0.01))
    n = 14
    rng = np.random.default_rng(5)
    each = (w - 0.04) / n
    for k in range(n):
        cut = (h - 0.04) * (0.35 + 0.3 * np.sin(2.2 * np.pi * k / n + 0.6))
        tone = tones[k % len(tones)]
        depth = d * float(rng.uniform(0.35, 0.6))
        y = w / 2 - 0.02 - each * (k + 0.5)
        parts += of(tone, box((depth, each * 0.94, cut - 0.004), 0.003).moved(-d * 0.2 + depth / 2, y, 0.02))
        parts += of(
            tones[(k + 1) % len(tones)],
            box((depth * 0.8, each * 0.94, h - 0.04 - cut), 0.003).moved(-d * 0.2 + depth * 0.4, y, 0.02 + cut),
        )
    return parts


def tapestry(size: Size, rod_of: Material, cloth: Material, fringe: Material) -> Parts:
    """A woven hanging on a rod, its fringe cut to a point."""
    _, w, h = size
    bar = rod((0, -w / 2, h - 0.09), (0, w / 2, h - 0.09), 0.011, segments=12)
    cord = [rod((0, s * w * 0.46, h - 0.085), (0, 0, h - 0.004), 0.0025, segments=6) for s in (1, -1)]
    low = 0.42 * h
    v, u = np.meshgrid(np.linspace(0, 1, 4), np.linspace(-0.5, 0.5, 13), indexing="ij")
    sheet = np.stack([0.004 * np.sin(9 * u), u * w * 0.9, low + v * (h - 0.085 - low)], axis=-1)
    face = slab(sheet, 0.008).pictured()
    ys = np.linspace(-0.445, 0.445, 46) * w
    tassels = [
        rod(
            (0, float(y), low + 0.01),
            (0.002 * (-1) ** k, float(y), low * (0.62 * abs(2 * y / w)) + 0.002),
            0.0045,
            0.003,
            5,
        )
        for k, y in enumerate(ys)
    ]
    return of(rod_of, bar) + of(m.LINEN, *cord) + of(cloth, face) + of(fringe, *tassels)


def plates_on_wall(size: Size, clay: tuple[Material, ...]) -> Parts:
    """Decorated plates hung in a group."""
    d, w, h = size
    spots = ((0.0, 0.5, 0.25), (-0.31, 0.72, 0.18), (0.31, 0.70, 0.17), (-0.30, 0.27, 0.16), (0.31, 0.26, 0.19))
    parts: Parts = []
    for k, (y, z, r) in enumerate(spots):
        radius = r * min(w, h)
        dish = lathe(
            [
                (0.5 * radius, 0),
                (0.58 * radius, 0.004),
                (radius, d * 0.9),
                (0.985 * radius, d),
                (0.6 * radius, d * 0.35),
                (0.003, d * 0.3),
            ],
            36,
            np.deg2rad(50),
        )
        ring = lathe(
            [
                (0.9 * radius, d * 0.78),
                (0.95 * radius, d * 0.92),
                (0.955 * radius, d * 0.88),
                (0.9 * radius, d * 0.74),
                (0.9 * radius, d * 0.78),
            ],
            36,
        )
        parts += of(clay[k % len(clay)], dish.turned("y", 90).moved(-d / 2, y * w, z * h)) + of(
            clay[(k + 1) % len(clay)], ring.turned("y", 90).moved(-d / 2 + 0.001, y * w, z * h)
        )
    return parts


def photo_frame(size: Size, bar: Material, image: Material, mount: float = 0.02) -> Parts:
    """A framed photograph that leans back on its strut."""
    d, w, h = size
    lean = 14.0
    tall = h / np.cos(np.deg2rad(lean)) * 0.98
    upright = picture((0.016, w, tall), bar, image, 0.016, mount)
    back = [p.turned("y", -lean) for p in upright]
    low = min(float(p.solid.vertices[:, 2].min()) for p in back)
    high = 0.6 * tall * np.cos(np.deg2rad(lean))
    x = d / 2 - 0.045 - 0.6 * tall * np.sin(np.deg2rad(lean))
    strut = beam((x, 0, high), (-d / 2 + 0.006, 0, 0.003), 0.05, 0.005, 0.002)
    return [p.moved(d / 2 - 0.03, 0, -low) for p in back] + of(m.SHADOW, lowered(strut))


def twin_frame(size: Size, bar: Material, images: tuple[Material, Material]) -> Parts:
    """Two hinged frames that stand like an open book."""
    d, w, h = size
    parts: Parts = []
    for s, image in zip((1, -1), images, strict=True):
        one = picture((0.016, w * 0.49, h), bar, image, 0.014, 0.016)
        parts += [p.moved(0, s * w * 0.245).turned("z", s * 14).moved(d * 0.1) for p in one]
    return parts


HILLS = m.art("hills print", "hills", "#5c6f74")


WARM_HILLS = m.art("dusk hills print", "hills", "#8a6656")


ABSTRACT = m.art("abstract print", "abstract", "#6d7f83")


ABSTRACT_TWO = m.art("abstract print in ochre", "abstract", "#9c7a55")


BOTANIC = m.art("botanical print", "botanic", "#5f7355")


SEASCAPE = m.art("seascape", "waves", "#5e7887")


ARCHES = m.art("arches print", "arches", "#5f7a80")
SUN = m.art("sun print", "sun", "#67735f")
FIELD = m.art("colour field", "field", "#8a6152")
BLUE_FIELD = m.art("blue colour field", "field", "#5a7187")
RIDGES = m.art("ridges print", "ridges", "#3c3f44")
BLOCKS = m.art("blocks print", "blocks", "#5f7787")
STROKES = m.art("brush strokes", "strokes", "#5d7768")
SKYLINE = m.art("skyline print", "skyline", "#5d6670")
STILL_LIFE = m.art("still life", "vessels", "#5e7278")
FERN = m.art("fern print", "fern", "#5f7a5e")
PORTRAIT = m.art("portrait photograph", "portrait", "#8b9298")
PORTRAIT_TWO = m.art("warm portrait", "portrait", "#9c8570")
MAP = m.art("old map", "map", "#a7b3ae")
WEAVING = m.art("wall weaving", "kilim", "#8d6a5a", 0.95)


DESIGNS: tuple[Design, ...] = (
    design("picture", "hills-oak", "landscape print in an oak frame", (0.03, 0.80, 0.60), "modern", picture, bar=m.OAK, image=HILLS, mount=0.06),
    design("picture", "abstract-black", "abstract print in a black frame", (0.028, 0.60, 0.80), "modern", picture, bar=m.BLACK_WOOD, image=ABSTRACT, width=0.02, mount=0.07),
    design("picture", "botanic", "botanical print in a walnut frame", (0.028, 0.42, 0.58), "classic", picture, bar=m.WALNUT, image=BOTANIC, mount=0.04),
    design("picture", "seascape-gilt", "seascape in a gilt frame", (0.045, 0.95, 0.70), "classic", picture, bar=m.BRASS, image=SEASCAPE, width=0.06),
    design("picture", "canvas", "large abstract canvas", (0.036, 1.10, 0.80), "minimal", canvas, image=ABSTRACT_TWO),
    design("picture", "small-photo", "small framed photograph", (0.022, 0.24, 0.30), "minimal", picture, bar=m.WHITE, image=WARM_HILLS, width=0.018, mount=0.03),
    design("picture", "panorama", "wide landscape print", (0.026, 1.30, 0.50), "modern", picture, bar=m.BLACK_WOOD, image=WARM_HILLS, width=0.02),
    design("picture", "arches", "print of arches in an oak frame", (0.028, 0.50, 0.70), "minimal", picture, bar=m.LIGHT_OAK, image=ARCHES, width=0.02, mount=0.05),
    design("picture", "sun", "print of a red sun in a walnut frame", (0.028, 0.60, 0.80), "modern", picture, bar=m.WALNUT, image=SUN, width=0.02, mount=0.06),
    design("picture", "field", "large colour-field canvas", (0.04, 1.00, 1.30), "modern", canvas, image=FIELD),
    design("picture", "field-blue", "blue colour-field painting in a floating frame", (0.04, 1.20, 0.90), "minimal", picture, bar=m.BLACK_WOOD, image=BLUE_FIELD, width=0.012),
    design("picture", "ridges", "poster of ridge lines in a black frame", (0.024, 0.50, 0.70), "industrial", picture, bar=m.BLACK_STEEL, image=RIDGES, width=0.014),
    design("picture", "blocks", "geometric painting", (0.036, 0.70, 0.70), "modern", canvas, image=BLOCKS),
    design("picture", "strokes", "print of brush strokes", (0.026, 0.70, 1.00), "modern", picture, bar=m.WHITE, image=STROKES, width=0.02, mount=0.08),
    design("picture", "skyline", "city skyline in a steel frame", (0.026, 1.00, 0.70), "industrial", picture, bar=m.BLACK_STEEL, image=SKYLINE, width=0.016, mount=0.05),
    design("picture", "still-life", "still life in a gilt frame", (0.05, 0.62, 0.74), "classic", picture, bar=m.BRASS, image=STILL_LIFE, width=0.07),
    design("picture", "fern", "pressed ferns in a thin oak frame", (0.024, 0.40, 0.52), "rustic", picture, bar=m.OAK, image=FERN, width=0.016, mount=0.04),
    design("picture", "map", "old map in a mahogany frame", (0.032, 0.95, 0.68), "classic", picture, bar=m.MAHOGANY, image=MAP, width=0.035, mount=0.05),
    design("picture", "portrait", "portrait in a dark frame", (0.045, 0.55, 0.70), "classic", picture, bar=m.DARK_WALNUT, image=PORTRAIT_TWO, width=0.06),
    design("picture", "gallery", "group of three framed prints", (0.026, 1.20, 0.90), "modern", gallery, bar=m.BLACK_WOOD, images=(SUN, STROKES, ARCHES)),
    design("picture", "gallery-oak", "gallery of prints in oak frames", (0.026, 1.05, 0.80), "minimal", gallery, bar=m.LIGHT_OAK, images=(ABSTRACT, FERN, BOTANIC)),
    design("picture", "triptych", "row of three landscapes", (0.026, 1.40, 0.60), "modern", trio, bar=m.OAK, images=(HILLS, WARM_HILLS, SEASCAPE)),
    design("picture", "column", "two botanical prints one above the other", (0.024, 0.42, 1.10), "classic", trio, bar=m.WALNUT, images=(BOTANIC, FERN), upright=True),
    design("picture", "round", "round print in a brass ring", (0.03, 0.60, 0.60), "modern", round_picture, bar=m.BRASS, image=SUN),
    design("picture", "scroll", "hanging print between wooden rails", (0.026, 0.60, 0.95), "rustic", scroll, wood=m.OAK, image=STILL_LIFE),
    design("picture", "slats", "wooden relief", (0.06, 1.00, 0.60), "rustic", relief, base=m.WALNUT, tones=(m.OAK, m.RECLAIMED, m.DARK_WALNUT, m.BIRCH)),
    design("picture", "weaving", "woven wall hanging with a fringe", (0.03, 0.60, 0.95), "rustic", tapestry, rod_of=m.BIRCH, cloth=WEAVING, fringe=m.LINEN),
    design("picture", "plates", "group of plates on a wall", (0.03, 0.90, 0.75), "classic", plates_on_wall, clay=(m.PORCELAIN, m.BLUE_GLAZE)),
    design("photo frame", "oak", "photograph in an oak frame", (0.10, 0.17, 0.21), "modern", photo_frame, bar=m.OAK, image=PORTRAIT),
    design("photo frame", "silver", "photograph in a silver frame", (0.11, 0.19, 0.24), "classic", photo_frame, bar=m.CHROME, image=PORTRAIT_TWO, mount=0.0),
    design("photo frame", "black", "landscape photograph in a black frame", (0.09, 0.23, 0.18), "minimal", photo_frame, bar=m.BLACK_WOOD, image=HILLS),
    design("photo frame", "rustic", "photograph in a reclaimed frame", (0.10, 0.20, 0.25), "rustic", photo_frame, bar=m.RECLAIMED, image=WARM_HILLS, mount=0.0),
    design("photo frame", "twin", "two photographs in hinged brass frames", (0.055, 0.32, 0.20), "classic", twin_frame, bar=m.BRASS, images=(PORTRAIT, PORTRAIT_TWO)),
)  # fmt: skip
