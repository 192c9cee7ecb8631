"""Pictures to hang and patterns to print: abstract art of our own, weaves, tiles and dials, as small as textures."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter

from diorama_core.library.furniture.textures import TEXTURE_SIZE, Painter, Picture, noise, shade

Rgb = Float[np.ndarray, "3"]
PAPER = np.array([0.93, 0.90, 0.84])
CLAY = np.array([0.74, 0.53, 0.41])
INK = np.array([0.24, 0.25, 0.27])
SAND = np.array([0.83, 0.74, 0.59])


def _uv(n: int = TEXTURE_SIZE) -> tuple[np.ndarray, np.ndarray]:
    """Across 0 to 1, and up 1 to 0 from the first row."""
    v, u = np.meshgrid(np.linspace(1, 0, n), np.linspace(0, 1, n), indexing="ij")
    return u, v


def _page(colour: Rgb = PAPER, n: int = TEXTURE_SIZE) -> Picture:
    return np.ones((n, n, 3)) * colour


def _grained(picture: Picture, rng: np.random.Generator, amount: float = 0.018) -> Picture:
    soft: Picture = gaussian_filter(picture, (0.6, 0.6, 0))
    return np.clip(soft * (1 + amount * noise(rng, (0.9, 0.9), len(picture))[..., None]), 0, 1)


def _arches(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Arches within arches, a small sun above."""
    u, v = _uv()
    picture = _page()
    r = np.where(v < 0.34, np.abs(u - 0.5), np.hypot(u - 0.5, v - 0.34))
    for outer, inner, tone in ((0.38, 0.31, rgb), (0.28, 0.21, CLAY), (0.18, 0.115, SAND), (0.085, 0.0, INK)):
        picture[(r < outer) & (r >= inner) & (v > 0.1)] = tone
    picture[np.hypot(u - 0.78, v - 0.84) < 0.075] = CLAY * 1.1
    return _grained(picture, rng)


def _sun(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """A large sun over two dunes."""
    u, v = _uv()
    picture = _page(PAPER * 0.97)
    picture[np.hypot(u - 0.52, v - 0.62) < 0.26] = CLAY * 1.12
    picture[v < 0.40 + 0.09 * np.sin(3.1 * u + 0.4)] = rgb
    picture[v < 0.26 + 0.10 * np.sin(4.0 * u + 3.0)] = rgb * 0.62
    picture[v < 0.10 + 0.03 * np.sin(6.0 * u)] = SAND
    return _grained(picture, rng, 0.025)


def _field(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Two soft fields of colour, one above the other."""
    u, v = _uv()
    ground = rgb * 0.62 + 0.06
    picture = _page(ground)
    edge = 0.02 * noise(rng, (7, 7))
    for low, high, tone in ((0.47, 0.92, rgb * 1.1), (0.08, 0.42, SAND * 0.9)):
        inside = np.minimum(np.minimum(u - 0.08, 0.92 - u), np.minimum(v - low, high - v)) + edge
        share = np.clip(inside / 0.05, 0, 1)[..., None]
        picture = picture * (1 - share) + tone * share
    return np.clip(picture * (1 + 0.03 * noise(rng, (2, 14))[..., None]), 0, 1)


def _ridges(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Fine lines that rise to a range of peaks in the middle."""
    n = TEXTURE_SIZE
    u, v = _uv()
    picture = _page(INK * 0.55)
    bell = np.exp(-(((u[0] - 0.5) / 0.17) ** 2))
    hills: np.ndarray = gaussian_filter(rng.standard_normal((17, n)), (0, 3.5))
    for k in range(16, -1, -1):
        level = 0.16 + 0.038 * k + 0.30 * bell * np.abs(hills[k]) * 1.1
        inside = (u > 0.14) & (u < 0.86)
        picture[inside & (v < level[None, :])] = INK * 0.55
        picture[inside & (np.abs(v - level[None, :]) < 0.0045)] = PAPER
    return _grained(picture, rng, 0.008)


def _blocks(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Rectangles of quiet colour between dark lines."""
    u, v = _uv()
    picture = _page()
    spots = (
        (0.0, 0.34, 0.55, 1.0, rgb),
        (0.34, 0.72, 0.72, 1.0, PAPER),
        (0.72, 1.0, 0.38, 1.0, SAND),
        (0.34, 0.72, 0.38, 0.72, CLAY),
        (0.0, 0.34, 0.0, 0.22, INK * 1.2),
        (0.34, 1.0, 0.0, 0.18, rgb * 0.72),
    )
    for left, right, low, high, tone in spots:
        picture[(u > left) & (u < right) & (v > low) & (v < high)] = tone
    for x in (0.34, 0.72):
        picture[np.abs(u - x) < 0.012] = INK
    for y, start in ((0.55, 0.0), (0.38, 0.34), (0.72, 0.34), (0.22, 0.0), (0.18, 0.34)):
        picture[(np.abs(v - y) < 0.012) & (u > start - 0.01) & (u < (0.35 if start == 0 else 1.0))] = INK
    return _grained(picture, rng)


def _strokes(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Broad dry brush strokes."""
    u, v = _uv()
    picture = _page()
    bristles = noise(rng, (0.7, 30))
    for y, bow, width, tone, left, right in (
        (0.70, 0.10, 0.10, rgb, 0.12, 0.86),
        (0.52, -0.08, 0.07, INK, 0.20, 0.92),
        (0.34, 0.06, 0.085, CLAY, 0.10, 0.72),
        (0.20, -0.03, 0.04, SAND * 0.92, 0.34, 0.88),
    ):
        off = np.abs(v - y - bow * np.sin(3.0 * u)) / width
        fade = np.minimum(u - left, right - u) * 9
        wet = (off < 1) & (bristles * 0.5 + 1.1 > off**3 * 1.6 + np.clip(0.9 - fade, 0, 3))
        picture[wet & (u > left) & (u < right)] = tone
    return _grained(picture, rng, 0.02)


def _skyline(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Towers in the mist, three rows of them."""
    u, v = _uv()
    sky = np.array([0.90, 0.86, 0.80])
    picture = _page(sky) * (1 - 0.10 * (1 - v))[..., None]
    for level, tone, count in ((0.52, 0.62, 14), (0.38, 0.34, 11), (0.22, 0.0, 9)):
        heights = level + 0.17 * rng.random(count) - 0.06
        tops = heights[np.minimum((u * count).astype(int), count - 1)]
        picture[v < tops] = rgb * (1 - tone) * 0.8 + sky * tone
    return _grained(picture, rng)


def _vessels(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """A still life of three jars in silhouette."""
    u, v = _uv()
    picture = _page(np.array([0.88, 0.83, 0.75]))
    picture[v < 0.24] = SAND * 0.82
    for x, r, neck, top, tone in (
        (0.34, 0.13, 0.045, 0.72, rgb),
        (0.66, 0.15, 0.06, 0.56, CLAY),
        (0.51, 0.075, 0.03, 0.42, INK * 1.3),
    ):
        body = np.hypot((u - x) / r, (v - 0.18 - r * 1.15) / (r * 1.2)) < 1
        throat = (
            (np.abs(u - x) < neck * (1 + 1.2 * np.clip((v - top + 0.05) / 0.05, 0, 1) ** 2)) & (v > 0.3) & (v < top)
        )
        picture[(body & (v > 0.16)) | throat] = tone
    return _grained(picture, rng, 0.02)


def _fern(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Pressed fronds."""
    u, v = _uv()
    picture = _page()
    for x0, lean, tone in ((0.5, 0.0, rgb), (0.3, -0.10, rgb * 0.8), (0.7, 0.12, rgb * 1.12)):
        axis = x0 + lean * (v - 0.1) ** 2
        side = u - axis
        length = 0.155 * np.clip((0.9 - v) / 0.75, 0, 1) ** 0.7
        lift = v - 0.55 * np.abs(side)
        comb = np.abs((lift * 21) % 1 - 0.5) < 0.30
        picture[(np.abs(side) < length) & comb & (v > 0.14) & (v < 0.9)] = tone
        picture[(np.abs(side) < 0.005) & (v > 0.06) & (v < 0.9)] = tone * 0.8
    return _grained(picture, rng)


def _portrait(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """A photograph, in its way: somebody before a soft background."""
    u, v = _uv()
    glow = np.exp(-(((u - 0.5) / 0.4) ** 2) - ((v - 0.6) / 0.5) ** 2)[..., None]
    picture = rgb * 0.55 * (1 - glow) + (rgb * 0.5 + 0.45) * glow
    skin, hair, coat = np.array([0.78, 0.61, 0.50]), np.array([0.27, 0.21, 0.18]), INK * 1.15
    picture[np.hypot((u - 0.5) / 0.36, (v - 0.02) / 0.32) < 1] = coat
    picture[(np.abs(u - 0.5) < 0.06) & (v > 0.28) & (v < 0.45)] = skin * 0.85
    picture[np.hypot((u - 0.5) / 0.165, (v - 0.60) / 0.20) < 1] = hair
    picture[np.hypot((u - 0.505) / 0.115, (v - 0.555) / 0.15) < 1] = skin
    return np.clip(gaussian_filter(picture, (2.6, 2.6, 0)) * (1 + 0.02 * noise(rng, (0.8, 0.8))[..., None]), 0, 1)


def _map(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Land and sea, as on a globe, with a graticule; tiles from left to right."""
    u, v = _uv()
    land = noise(rng, (15, 20)) + 0.35 * noise(rng, (4, 5)) - 0.25 - 1.2 * (np.abs(v - 0.5) > 0.45)
    picture = np.where(land[..., None] > 0.25, np.array([0.72, 0.66, 0.48]), rgb)
    picture[np.abs(land - 0.25) < 0.05] *= 0.72
    lines = (np.abs((u * 12) % 1 - 0.5) > 0.487) | (np.abs((v * 8) % 1 - 0.5) > 0.487)
    picture[lines] *= 0.9
    return _grained(picture, rng)


def _plaid(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """A tartan of two widths of stripe; tiles."""
    t = np.arange(TEXTURE_SIZE) / TEXTURE_SIZE
    wide = (np.abs((t * 2) % 1 - 0.5) < 0.2).astype(float)
    thin = (np.abs((t * 2 + 0.5) % 1 - 0.5) < 0.03).astype(float)
    warp = wide[:, None] + wide[None, :]
    fine = thin[:, None] + thin[None, :]
    base = rgb * (1.16 - 0.22 * warp[..., None])
    picture = base * (1 - 0.35 * fine[..., None]) + PAPER * 0.35 * fine[..., None]
    twill = np.sin(2 * np.pi * 48 * (t[:, None] + t[None, :]))
    return np.clip(picture * (1 + 0.05 * twill[..., None]), 0, 1)


def _knit(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Rows of stitches, each a slanted pair; tiles."""
    n = TEXTURE_SIZE
    i, j = np.meshgrid(np.arange(n) / n, np.arange(n) / n, indexing="ij")
    across = (j * 16) % 1 - 0.5
    along = (i * 20 + 0.9 * np.abs(across)) % 1 - 0.5
    bulge = np.cos(along * np.pi) * np.cos((np.abs(across) - 0.25) * 2 * np.pi) ** 2
    return shade(rgb, 0.34 * (bulge - 0.32) + 0.02 * noise(rng, (1, 1)))


def _terry(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Loops of towelling; tiles."""
    return shade(rgb, 0.05 * noise(rng, (1.1, 1.1)) + 0.025 * noise(rng, (0.6, 3)))


def _shag(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Long pile, lying this way and that; tiles."""
    return shade(
        rgb, 0.10 * np.tanh(noise(rng, (1.5, 5))) + 0.07 * np.tanh(noise(rng, (5, 1.5))) + 0.03 * noise(rng, (14, 14))
    )


def _herringbone(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Zigzag twill; tiles."""
    n = TEXTURE_SIZE
    i, j = np.meshgrid(np.arange(n) / n, np.arange(n) / n, indexing="ij")
    fold = np.abs((j * 8) % 2 - 1)
    twill = np.sin(2 * np.pi * (24 * i + 2.5 * fold))
    return shade(rgb, 0.13 * twill + 0.015 * noise(rng, (1, 1)))


def _check(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Gingham; tiles."""
    t = (np.arange(TEXTURE_SIZE) * 8 // TEXTURE_SIZE) % 2
    share = (t[:, None] + t[None, :]) / 2.0
    picture = rgb * share[..., None] + PAPER * (1 - share[..., None])
    return np.clip(picture * (1 + 0.02 * noise(rng, (0.8, 0.8))[..., None]), 0, 1)


def _kilim(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Bands of stepped diamonds, as flat-woven carpets have."""
    n = 240
    u, v = _uv(n)
    picture = _page(SAND, n)
    bands = 6
    row, at = (v * bands).astype(int), (v * bands) % 1 - 0.5
    step = np.round(np.abs(at) * 10) / 10
    diamond = np.round(np.abs((u * 6) % 1 - 0.5) * 10) / 10 + step
    tones = (rgb, INK * 1.2, CLAY, rgb * 0.7, PAPER, CLAY * 0.8)
    for k, tone in enumerate(tones):
        mine = row == k
        picture[mine] = tone
        picture[mine & (diamond < 0.46)] = PAPER if k % 2 else SAND
        picture[mine & (diamond < 0.26)] = tones[(k + 2) % 6]
    picture[np.abs(np.abs(at) - 0.5) < 0.05] = INK
    return np.clip(gaussian_filter(picture, (0.7, 0.7, 0)) * (1 + 0.04 * noise(rng, (0.7, 0.7), n)[..., None]), 0, 1)


def _medallion(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Rings of petals about the middle, for a round carpet."""
    n = 240
    u, v = _uv(n)
    x, y = 2 * u - 1, 2 * v - 1
    r, t = np.hypot(x, y), np.arctan2(y, x)
    picture = _page(rgb, n)
    picture[r > 0.93] = PAPER * 0.92
    for low, high, petals, tone in ((0.70, 0.90, 24, PAPER * 0.9), (0.42, 0.66, 16, SAND), (0.0, 0.36, 8, CLAY)):
        reach = low + (high - low) * np.abs(np.cos(petals / 2 * t)) ** 0.6
        picture[(r > low) & (r < reach)] = tone
    picture[(np.abs(r - 0.92) < 0.012) | (np.abs(r - 0.68) < 0.01) | (np.abs(r - 0.39) < 0.01)] = INK * 1.2
    picture[r < 0.09] = rgb * 0.6
    return np.clip(gaussian_filter(picture, (0.8, 0.8, 0)) * (1 + 0.04 * noise(rng, (0.7, 0.7), n)[..., None]), 0, 1)


def _brick(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Courses of brick in pale mortar; tiles."""
    n, rows, columns = TEXTURE_SIZE, 8, 4
    i, j = np.meshgrid(np.arange(n) / n, np.arange(n) / n, indexing="ij")
    row = (i * rows).astype(int)
    x = (j * columns + 0.5 * (row % 2)) % columns
    tones = 1 + 0.16 * (rng.random((rows, columns)) - 0.5)
    picture = rgb * tones[row, x.astype(int)][..., None] * (1 + 0.06 * noise(rng, (1.2, 1.2)))[..., None]
    mortar = (np.abs((i * rows) % 1 - 0.5) > 0.44) | (np.abs(x % 1 - 0.5) > 0.47)
    picture[mortar] = np.array([0.70, 0.67, 0.62])
    return np.clip(gaussian_filter(picture, (0.5, 0.5, 0), mode="wrap"), 0, 1)


def _cork(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Pressed cork; tiles."""
    return shade(rgb, 0.07 * np.tanh(noise(rng, (1.8, 1.8))) + 0.05 * noise(rng, (0.7, 0.7)))


def _tiles(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Square tiles with pale joints; tiles."""
    n, count = TEXTURE_SIZE, 4
    i, j = np.meshgrid(np.arange(n) * count / n, np.arange(n) * count / n, indexing="ij")
    picture = shade(rgb, 0.02 * noise(rng, (5, 5)))
    picture[(np.abs(i % 1 - 0.5) > 0.475) | (np.abs(j % 1 - 0.5) > 0.475)] = 0.82
    return picture


def _mesh(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """Perforated metal or a loudspeaker's cloth: fine dark dots; tiles."""
    n = 96
    i, j = np.meshgrid(np.arange(n) * 12 / n, np.arange(n) * 12 / n, indexing="ij")
    return shade(rgb, -0.34 * (np.hypot(i % 1 - 0.5, j % 1 - 0.5) < 0.27))


def _roman_dial(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """A clock's face with long markers, minutes and spade hands."""
    u, v = _uv(224)
    x, y = 2 * u - 1, 2 * v - 1
    r, t = np.hypot(x, y), np.arctan2(x, y)
    picture = _page(rgb, 224)
    ink = INK * 0.8 if rgb.mean() > 0.5 else PAPER
    minute = np.abs((t / (2 * np.pi) * 60 + 0.5) % 1 - 0.5) < 0.12
    picture[minute & (r > 0.86) & (r < 0.91)] = ink
    picture[(np.abs(r - 0.92) < 0.008) | (np.abs(r - 0.85) < 0.006)] = ink
    for k in range(12):
        a = k * np.pi / 6
        along, side = x * np.sin(a) + y * np.cos(a), x * np.cos(a) - y * np.sin(a)
        for s in (-0.035, 0.035) if k % 3 else (-0.06, 0.0, 0.06):
            picture[(along > 0.6) & (along < 0.8) & (np.abs(side - s) < 0.011)] = ink
    for a, length, width in ((np.deg2rad(305), 0.44, 0.05), (np.deg2rad(60), 0.68, 0.035)):
        along, side = x * np.sin(a) + y * np.cos(a), x * np.cos(a) - y * np.sin(a)
        taper = width * (0.35 + 0.65 * np.exp(-(((along - 0.72 * length) / (0.12 * length)) ** 2)))
        picture[(along > -0.06) & (along < length) & (np.abs(side) < taper)] = ink
    picture[r < 0.05] = ink
    return gaussian_filter(picture, (0.6, 0.6, 0))


def _digits(rgb: Rgb, rng: np.random.Generator) -> Picture:
    """A dark display that shows 10:08."""
    u, v = _uv(128)
    picture = _page(np.array([0.09, 0.10, 0.11]), 128)
    for left, shown in zip((0.08, 0.28, 0.56, 0.76), ("bc", "abcdef", "abcdef", "abcdefg"), strict=True):
        x, y = (u - left) / 0.15, (v - 0.26) / 0.48
        level = np.abs(x - 0.5) < 0.42
        bars = {
            "a": (np.abs(y - 1) < 0.06) & level,
            "g": (np.abs(y - 0.5) < 0.06) & level,
            "d": (np.abs(y) < 0.06) & level,
            "b": (np.abs(x - 1) < 0.1) & (np.abs(y - 0.75) < 0.2),
            "c": (np.abs(x - 1) < 0.1) & (np.abs(y - 0.25) < 0.2),
            "e": (np.abs(x) < 0.1) & (np.abs(y - 0.25) < 0.2),
            "f": (np.abs(x) < 0.1) & (np.abs(y - 0.75) < 0.2),
        }
        for segment in shown:
            picture[bars[segment]] = rgb
    for height in (0.4, 0.6):
        picture[np.hypot(u - 0.5, v - height) < 0.025] = rgb
    return gaussian_filter(picture, (0.7, 0.7, 0))


PRINTS: dict[str, Painter] = {
    "arches": _arches, "sun": _sun, "field": _field, "ridges": _ridges, "blocks": _blocks, "strokes": _strokes,
    "skyline": _skyline, "vessels": _vessels, "fern": _fern, "portrait": _portrait, "map": _map, "plaid": _plaid,
    "knit": _knit, "terry": _terry, "shag": _shag, "herringbone": _herringbone, "check": _check, "kilim": _kilim,
    "medallion": _medallion, "brick": _brick, "cork": _cork, "tiles": _tiles, "mesh": _mesh,
    "roman dial": _roman_dial, "digits": _digits,
}  # fmt: skip
"""By the kind of a material."""
