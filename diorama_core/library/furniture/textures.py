"""Small procedural pictures that materials are painted with: grain, weave, veins, prints, dials.

Every painter takes an average colour (sRGB, 0 to 1) and a random generator, and gives a picture with its first row on
top. Surfaces that repeat (wood, cloth, stone) tile without a seam.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter

TEXTURE_SIZE = 192

Picture = Float[np.ndarray, "h w 3"]


def noise(rng: np.random.Generator, sigma: tuple[float, float], size: int = TEXTURE_SIZE) -> Float[np.ndarray, "h w"]:
    """Tileable smooth noise with zero mean and unit deviation; sigma is (down, across) in pixels."""
    field: np.ndarray = gaussian_filter(rng.standard_normal((size, size)), sigma, mode="wrap")
    return (field - field.mean()) / max(float(field.std()), 1e-9)


def shade(rgb: Float[np.ndarray, "3"], amount: Float[np.ndarray, "h w"]) -> Picture:
    """The colour lightened and darkened by a relative amount."""
    return np.clip(rgb * (1.0 + amount[..., None]), 0, 1)


def _plain(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return np.broadcast_to(rgb, (8, 8, 3)).copy()


def _wood(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    across = np.arange(n)[:, None] / n
    warp = noise(rng, (14, 60)) * 0.035
    rings = np.sin(2 * np.pi * (7 * across + 3.0 * warp)) * 0.5 + np.sin(2 * np.pi * (17 * across + 6 * warp)) * 0.3
    fibre = noise(rng, (0.6, 22))
    broad = noise(rng, (9, 70))
    return shade(rgb, 0.055 * rings + 0.04 * fibre + 0.05 * broad)


def _weave(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    threads = 48
    over = ((i * threads // n) + (j * threads // n)) % 2
    warp = np.abs(np.sin(np.pi * j * threads / n))
    weft = np.abs(np.sin(np.pi * i * threads / n))
    relief = np.where(over == 0, warp, weft) - 0.64
    slub = noise(rng, (0.8, 12)) + noise(rng, (12, 0.8))
    return shade(rgb, 0.06 * relief + 0.014 * slub + 0.006 * noise(rng, (20, 20)))


def _leather(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    pores = noise(rng, (1.6, 1.6))
    return shade(rgb, 0.045 * np.tanh(pores) + 0.02 * noise(rng, (28, 28)))


def _velvet(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return shade(rgb, 0.022 * noise(rng, (26, 14)) + 0.018 * noise(rng, (7, 4)) + 0.015 * noise(rng, (0.7, 0.7)))


def _boucle(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    loops = np.tanh(1.4 * noise(rng, (2.2, 2.2)))
    return shade(rgb, 0.07 * loops + 0.03 * noise(rng, (0.8, 0.8)) - 0.02)


def _clay(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return shade(rgb, 0.03 * noise(rng, (16, 16)) + 0.018 * noise(rng, (1, 1)))


def _marble(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    veins = np.exp(-((noise(rng, (14, 22)) + 0.25 * noise(rng, (4, 4))) ** 2) * 60)
    return shade(rgb, -0.17 * gaussian_filter(veins, 0.8, mode="wrap") + 0.02 * noise(rng, (18, 18)))


def _speckle(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return shade(rgb, 0.16 * noise(rng, (0.8, 0.8)) + 0.08 * noise(rng, (3, 3)))


def _paper(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return shade(rgb, 0.02 * noise(rng, (0.7, 5)) + 0.02 * noise(rng, (18, 18)))


def _pages(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    lines: np.ndarray = gaussian_filter(rng.standard_normal((TEXTURE_SIZE, 1)), (0.6, 0), mode="wrap")
    return shade(rgb, np.repeat(0.07 * lines, TEXTURE_SIZE, axis=1))


def _brushed(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return shade(rgb, 0.012 * noise(rng, (0.6, 40)))


def _wicker(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n, cells = 128, 8
    i, j = np.meshgrid(np.arange(n) * cells / n, np.arange(n) * cells / n, indexing="ij")
    over = (i.astype(int) + j.astype(int)) % 2 == 0
    a, b = i % 1.0 - 0.5, j % 1.0 - 0.5
    bulge = np.where(over, np.cos(a * np.pi) * (0.6 + 0.4 * np.cos(b * np.pi)), np.cos(b * np.pi) * 0.8)
    return shade(rgb, 0.5 * (bulge - 0.62) + 0.04 * noise(rng, (1, 1), n))


def _leaf(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return shade(rgb, 0.08 * noise(rng, (10, 10)) + 0.05 * noise(rng, (1.5, 6)))


def _screen(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    v, u = np.meshgrid(np.linspace(1, 0, 96), np.linspace(0, 1, 96), indexing="ij")
    sheen = 0.5 * np.clip(u + v - 0.9, 0, 1) + 0.9 * ((u - 0.7 * v > 0.15) & (u - 0.7 * v < 0.5)) * v * 0.4
    return np.clip(rgb + 0.16 * sheen[..., None] * np.array([0.8, 0.95, 1.1]), 0, 1)


def _mirror(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    v, u = np.meshgrid(np.linspace(1, 0, 96), np.linspace(0, 1, 96), indexing="ij")
    d = u + 0.8 * v
    streaks = 0.10 * ((d > 0.55) & (d < 0.8)) + 0.07 * ((d > 0.88) & (d < 0.96))
    return shade(rgb, gaussian_filter(streaks, 1.2) + 0.16 * (v - 0.5))


def _sky(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    """Out of focus, as behind a window: sky, haze and a line of trees."""
    n = 128
    v, u = np.meshgrid(np.linspace(1, 0, n), np.linspace(0, 1, n), indexing="ij")
    haze, trees = np.array([0.88, 0.91, 0.91]), np.array([0.50, 0.58, 0.49])
    share = np.clip((v - 0.25) / 0.75, 0, 1)[..., None] ** 0.8
    picture = rgb * 0.93 * share + haze * (1 - share)
    crowns = 0.22 + 0.05 * np.sin(9 * u + 1) + 0.035 * np.sin(23 * u + 4 * v)
    picture[v < crowns] = trees + 0.06 * noise(rng, (5, 5), n)[v < crowns][:, None]
    picture[v < 0.08] = trees * 0.5 + haze * 0.4
    return np.clip(gaussian_filter(picture, (2.2, 2.2, 0)), 0, 1)


def _hills(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    v = np.linspace(1, 0, n)[:, None]
    sky = np.array([0.90, 0.87, 0.81])
    picture = sky * (1 - 0.12 * v[..., None]) * np.ones((n, n, 1))
    for k, (level, tone) in enumerate(((0.55, 0.62), (0.42, 0.42), (0.28, 0.22), (0.13, 0.0))):
        ridge = level + 0.055 * noise(rng, (1, 16 + 4 * k))[:1]
        picture[np.broadcast_to(v, (n, n)) < ridge] = rgb * (1 - tone) + sky * tone
    return picture * (1 + 0.02 * noise(rng, (1, 1))[..., None])


def _abstract(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    v, u = np.meshgrid(np.linspace(1, 0, n), np.linspace(0, 1, n), indexing="ij")
    picture = np.ones((n, n, 3)) * np.array([0.91, 0.88, 0.82])
    tones = (rgb, np.array([0.76, 0.55, 0.41]), np.array([0.28, 0.29, 0.30]), np.array([0.82, 0.72, 0.55]))
    spots = ((0.36, 0.62, 0.20), (0.62, 0.36, 0.24), (0.68, 0.74, 0.09), (0.28, 0.26, 0.12))
    for tone, (x, y, r) in zip(tones, spots, strict=True):
        wobble = 1 + 0.06 * np.sin(3 * np.arctan2(v - y, u - x) + 9 * r)
        picture[np.hypot(u - x, v - y) < r * wobble] = tone
    return picture * (1 + 0.015 * noise(rng, (1.2, 1.2))[..., None])


def _botanic(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    v, u = np.meshgrid(np.linspace(1, 0, n), np.linspace(0, 1, n), indexing="ij")
    picture = np.ones((n, n, 3)) * np.array([0.93, 0.91, 0.86])
    stem = 0.5 + 0.05 * np.sin(2.2 * v)
    picture[(np.abs(u - stem) < 0.006) & (v > 0.12) & (v < 0.86)] = rgb * 0.8
    for k in range(9):
        y, side = 0.24 + 0.07 * k, 1 if k % 2 else -1
        a = side * (u - 0.5 - 0.05 * np.sin(2.2 * y)) - 0.02
        b = v - y - 0.55 * a
        length = 0.30 - 0.02 * k
        leaf = (a > 0) & (a < length) & (np.abs(b) < 0.035 * np.sin(np.pi * np.clip(a / length, 0, 1)))
        picture[leaf] = rgb * (0.9 + 0.05 * (k % 4))
    return picture


def _waves(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    drift: np.ndarray = gaussian_filter(noise(rng, (5, 34)), 1)
    v = np.linspace(1, 0, TEXTURE_SIZE)[:, None, None]
    base = rgb * (1 - 0.55 * v) + np.array([0.90, 0.88, 0.84]) * 0.55 * v
    return np.clip(base * (1 + 0.10 * drift[..., None]), 0, 1)


def _persian(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = 256
    y, x = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij")
    a, b = np.abs(x), np.abs(y)
    cream, dark = np.array([0.80, 0.73, 0.62]), rgb * 0.45 + 0.08
    picture = np.ones((n, n, 3)) * rgb
    lattice = np.sin(a * 26) * np.sin(b * 26)
    picture[lattice > 0.55] = rgb * 0.72 + cream * 0.28
    medal = a / 0.42 + b / 0.52
    picture[medal < 1.0] = dark
    picture[(medal < 1.0) & (medal > 0.92)] = cream
    picture[(medal < 0.62)] = rgb * 1.08
    picture[(medal < 0.62) & (np.sin(a * 40) * np.sin(b * 40) > 0.3)] = cream
    edge = np.maximum(a, b)
    border = (edge > 0.78) & (edge < 0.95)
    picture[border] = dark
    picture[border & (np.sin((x + y) * 34) > 0.35) & (np.sin((x - y) * 34) > 0.2)] = cream
    picture[((edge > 0.75) & (edge < 0.78)) | (edge > 0.97)] = cream
    return np.clip(gaussian_filter(picture, (0.8, 0.8, 0)) * (1 + 0.04 * noise(rng, (0.7, 0.7), n)[..., None]), 0, 1)


def _stripes(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    bands = (np.sin(np.linspace(0, 14 * np.pi, n)) > 0.5)[:, None, None]
    pale = np.array([0.88, 0.85, 0.78])
    picture = np.where(bands, rgb, pale) * np.ones((n, n, 1))
    return np.clip(picture * (1 + 0.035 * noise(rng, (0.7, 0.7))[..., None]), 0, 1)


def _diamonds(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    y, x = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij")
    line = (np.abs((4 * x + 4 * y) % 1 - 0.5) > 0.465) | (np.abs((4 * x - 4 * y) % 1 - 0.5) > 0.465)
    picture = np.where(gaussian_filter(line.astype(float), 0.8)[..., None] > 0.4, rgb * 0.35, rgb)
    return np.clip(picture * (1 + 0.04 * noise(rng, (1, 1))[..., None]), 0, 1)


def _dial(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    v, u = np.meshgrid(np.linspace(1, -1, n), np.linspace(-1, 1, n), indexing="ij")
    r, t = np.hypot(u, v), np.arctan2(u, v)
    picture = np.ones((n, n, 3)) * rgb
    ink = 0.12 if rgb.mean() > 0.5 else 0.85
    hour = np.abs((t / (2 * np.pi) * 12 + 0.5) % 1 - 0.5) < 0.055
    picture[hour & (r > 0.74) & (r < 0.88)] = ink
    for angle, length, width in ((np.deg2rad(305), 0.48, 0.032), (np.deg2rad(60), 0.70, 0.022)):
        along, side = u * np.sin(angle) + v * np.cos(angle), u * np.cos(angle) - v * np.sin(angle)
        picture[(along > -0.08) & (along < length) & (np.abs(side) < width)] = ink
    picture[r < 0.05] = ink
    return gaussian_filter(picture, (0.6, 0.6, 0))


Painter = Callable[[Float[np.ndarray, "3"], np.random.Generator], Picture]

PAINTERS: dict[str, Painter] = {
    "plain": _plain,
    "wood": _wood,
    "weave": _weave,
    "leather": _leather,
    "velvet": _velvet,
    "boucle": _boucle,
    "clay": _clay,
    "marble": _marble,
    "speckle": _speckle,
    "paper": _paper,
    "pages": _pages,
    "brushed": _brushed,
    "wicker": _wicker,
    "leaf": _leaf,
    "screen": _screen,
    "mirror": _mirror,
    "sky": _sky,
    "hills": _hills,
    "abstract": _abstract,
    "botanic": _botanic,
    "waves": _waves,
    "persian": _persian,
    "stripes": _stripes,
    "diamonds": _diamonds,
    "dial": _dial,
}
"""By the kind of a material (`materials.Material.kind`)."""
