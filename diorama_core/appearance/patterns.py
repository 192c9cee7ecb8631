"""Procedural patterns of floors, walls and ceilings: boards, tiles, carpet, paint, paper, plaster and brick.

Each pattern is a function of a `Swatch`. Nothing is read from files.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Float

COLOURS: dict[str, tuple[float, float, float]] = {
    "oak": (0.70, 0.54, 0.37), "walnut": (0.44, 0.30, 0.21), "ash": (0.80, 0.71, 0.58), "pine": (0.80, 0.63, 0.42),
    "grey": (0.66, 0.66, 0.66), "stone": (0.74, 0.71, 0.66), "white": (0.93, 0.92, 0.89), "slate": (0.36, 0.38, 0.41),
    "terracotta": (0.70, 0.42, 0.30), "sand": (0.76, 0.69, 0.58),
    "blue": (0.36, 0.44, 0.55), "moss": (0.46, 0.50, 0.40),
    "cream": (0.93, 0.88, 0.78), "sage": (0.72, 0.78, 0.69), "sky": (0.73, 0.81, 0.87), "clay": (0.74, 0.52, 0.43),
    "blush": (0.90, 0.79, 0.75), "ochre": (0.85, 0.72, 0.47),
}  # fmt: skip

Picture = Float[np.ndarray, "h w 3"]


@dataclass(frozen=True, eq=False)
class Swatch:
    """What a pattern is painted for: the picture's size, and what the plane and its finish say."""

    height: int
    width: int
    """Both in texels."""
    texels_per_m: float
    colour: Float[np.ndarray, "3"]
    """sRGB, 0 to 1."""
    rng: np.random.Generator
    role: str
    """Kind of plane: walls have smaller tiles, and a skirting board."""

    def grid(self) -> tuple[Float[np.ndarray, "h w"], Float[np.ndarray, "h w"]]:
        """Row and column of every texel."""
        y, x = np.mgrid[0 : self.height, 0 : self.width].astype(np.float32)
        return y, x

    def noise(self, cell: tuple[float, float]) -> Float[np.ndarray, "h w"]:
        """Smooth noise, about -1 to 1, whose bumps are `cell` (rows, columns) texels across."""
        size = max(2, round(self.height / cell[0])), max(2, round(self.width / cell[1]))
        small = self.rng.normal(0.0, 0.5, size).astype(np.float32)
        return cv2.resize(small, (self.width, self.height), interpolation=cv2.INTER_CUBIC)

    def shade(self, tone: Float[np.ndarray, "h w"]) -> Picture:
        """The colour made brighter by a share of itself, texel by texel."""
        return np.broadcast_to(self.colour, (self.height, self.width, 3)) * (1 + tone)[..., None]


def planks(swatch: Swatch) -> Picture:
    """Boards along the rows, each of its own tone."""
    s = swatch.texels_per_m
    y, x = swatch.grid()
    board, long = 0.14 * s, 1.4 * s
    row = (y // board).astype(int)
    shift = swatch.rng.uniform(0, long, row.max() + 1)[row]
    number = ((x + shift) // long).astype(int)
    tone = swatch.rng.normal(0.0, 0.075, (row.max() + 1, number.max() + 2))[row, number]
    grain = 0.05 * swatch.noise((0.008 * s, 0.5 * s)) + 0.04 * swatch.noise((0.02 * s, 0.25 * s))
    seam = (np.minimum(y % board, board - y % board) < 0.9) | (((x + shift) % long) < 1.5)
    return swatch.shade(tone + grain - 0.35 * seam)


def parquet(swatch: Swatch) -> Picture:
    """Blocks of five strips, turned by turns."""
    s = swatch.texels_per_m
    y, x = swatch.grid()
    block = 0.36 * s
    i, j = (y // block).astype(int), (x // block).astype(int)
    across = (i + j) % 2 == 0
    strip = (np.where(across, y % block, x % block) // (block / 5)).astype(int)
    tone = swatch.rng.normal(0.0, 0.09, (i.max() + 1, j.max() + 1, 6))[i, j, np.minimum(strip, 5)]
    seam = (np.where(across, y % block, x % block) % (block / 5)) < 1.0
    grain = 0.05 * np.where(across, swatch.noise((0.006 * s, 0.2 * s)), swatch.noise((0.2 * s, 0.006 * s)))
    return swatch.shade(tone + grain - 0.25 * seam)


def tiles(swatch: Swatch) -> Picture:
    """Square tiles; on walls small ones in running bond."""
    s = swatch.texels_per_m
    y, x = swatch.grid()
    tall, wide = (0.1, 0.2) if swatch.role == "wall" else (0.42, 0.42)
    tall, wide = tall * s, wide * s
    i = (y // tall).astype(int)
    offset = (i % 2) * wide / 2 if swatch.role == "wall" else np.zeros_like(x)
    j = ((x + offset) // wide).astype(int)
    tone = swatch.rng.normal(0.0, 0.03, (i.max() + 1, j.max() + 2))[i, j] + 0.03 * swatch.noise((0.06 * s, 0.06 * s))
    joint = ((y % tall) < 1.6) | (((x + offset) % wide) < 1.6)
    picture = swatch.shade(tone)
    picture[joint] = np.array([0.62, 0.61, 0.59]) if swatch.colour.mean() > 0.5 else np.array([0.55, 0.54, 0.52])
    return picture


def checker(swatch: Swatch) -> Picture:
    """Square tiles in two colours by turns."""
    s = swatch.texels_per_m
    y, x = swatch.grid()
    side = 0.3 * s
    odd = ((y // side).astype(int) + (x // side).astype(int)) % 2 == 0
    picture = np.where(odd[..., None], swatch.colour, np.array([0.87, 0.84, 0.78]))
    joint = ((y % side) < 1.2) | ((x % side) < 1.2)
    tone = 0.04 * swatch.noise((0.05 * s, 0.05 * s)) - 0.15 * joint
    return picture * (1 + tone)[..., None]


def carpet(swatch: Swatch) -> Picture:
    """Woven pile."""
    s = swatch.texels_per_m
    fine = swatch.rng.normal(0.0, 0.06, (swatch.height, swatch.width))
    return swatch.shade(fine + 0.04 * swatch.noise((0.3 * s, 0.3 * s)))


def paint(swatch: Swatch) -> Picture:
    """Painted plaster, on walls above a skirting board."""
    s = swatch.texels_per_m
    tone = 0.012 * swatch.noise((0.5 * s, 0.5 * s)) + swatch.rng.normal(0.0, 0.008, (swatch.height, swatch.width))
    return with_skirting(swatch.shade(tone), s, swatch.role)


def paper(swatch: Swatch) -> Picture:
    """Wallpaper of stripes or dots, by chance."""
    s = swatch.texels_per_m
    y, x = swatch.grid()
    period = float(swatch.rng.uniform(0.12, 0.3)) * s
    if swatch.rng.random() < 0.5:
        figure = np.sin(2 * np.pi * x / period) > 0
    else:
        centred = ((x + (y // period % 2) * period / 2) % period - period / 2, y % period - period / 2)
        figure = np.hypot(*centred) < 0.22 * period
    ink = swatch.colour * float(swatch.rng.uniform(0.82, 0.9))
    return with_skirting(_print_figure(swatch, figure, ink), s, swatch.role)


def brick(swatch: Swatch) -> Picture:
    """Bricks in running bond."""
    s = swatch.texels_per_m
    y, x = swatch.grid()
    tall, wide = 0.075 * s, 0.24 * s
    i = (y // tall).astype(int)
    shifted = x + (i % 2) * wide / 2
    j = (shifted // wide).astype(int)
    tone = swatch.rng.normal(0.0, 0.1, (i.max() + 1, j.max() + 2))[i, j] + 0.06 * swatch.noise((0.03 * s, 0.03 * s))
    picture = swatch.shade(tone)
    picture[((y % tall) < 0.012 * s) | ((shifted % wide) < 0.012 * s)] = (0.76, 0.73, 0.69)
    return picture


def panelling(swatch: Swatch) -> Picture:
    """Paint above boards of one metre."""
    s = swatch.texels_per_m
    picture = paint(replace(swatch, colour=np.minimum(swatch.colour * 1.05, 0.95)))
    y, x = swatch.grid()
    board = 0.11 * s
    low = (swatch.height - y) < 1.0 * s
    picture[low] = picture[low] * np.where(swatch.colour.mean() > 0.85, 0.93, 1.06)
    picture[low & ((x % board) < 1.5)] *= 0.82
    picture[np.abs((swatch.height - y) - 1.0 * s) < 0.03 * s] = 0.92
    return picture


def with_skirting(picture: Picture, s: float, role: str) -> Picture:
    """A white board along the foot of a wall."""
    if role == "wall":
        high = round(0.09 * s)
        picture[-high:] = 0.9
        picture[-high - 1 : -high + 1] *= 0.8
    return picture


def plaster(swatch: Swatch) -> Picture:
    """Lime plaster or bare concrete, in clouds."""
    s = swatch.texels_per_m
    clouds = sum(0.03 * 0.6**k * swatch.noise((0.5 * 0.5**k * s, 0.7 * 0.5**k * s)) for k in range(4))
    return swatch.shade(np.asarray(clouds) + swatch.rng.normal(0.0, 0.008, (swatch.height, swatch.width)))


def stripes(swatch: Swatch) -> Picture:
    """Wallpaper of upright stripes."""
    s = swatch.texels_per_m
    _, x = swatch.grid()
    band = 0.08 * s
    edge = np.clip(0.5 + band * np.sin(np.pi * x / band) / np.pi, 0.0, 1.0)
    return _print_figure(swatch, edge)


def dots(swatch: Swatch) -> Picture:
    """Wallpaper of dots."""
    s = swatch.texels_per_m
    dx, dy, _, _ = _stagger_cells(swatch, 0.11 * s)
    return _print_figure(swatch, np.clip(0.5 + 0.02 * s - np.hypot(dx, dy), 0.0, 1.0))


def leaves(swatch: Swatch) -> Picture:
    """Wallpaper of leaves that lean left and right by turns."""
    s = swatch.texels_per_m
    dx, dy, row, column = _stagger_cells(swatch, 0.1 * s)
    lean = np.where((row + column) % 2 == 0, 0.6, -0.6)
    along, across = dx * np.sin(lean) + dy * np.cos(lean), dx * np.cos(lean) - dy * np.sin(lean)
    long, wide = 0.052 * s, 0.016 * s
    inside = wide * (1.0 - (along / long) ** 2) - np.abs(across)
    vein = (np.abs(across) < 0.0012 * s) & (along > -0.7 * long)
    return _print_figure(swatch, np.clip(0.5 + inside, 0.0, 1.0) * ~vein)


def herringbone(swatch: Swatch) -> Picture:
    """Strips six times as long as wide, laid at right angles to one another."""
    s = swatch.texels_per_m
    y, x = swatch.grid()
    ratio, wide = 6, 0.09 * s
    column, row = np.floor(x / wide).astype(int), np.floor(y / wide).astype(int)
    step = (column - row) % (2 * ratio)
    lying = step < ratio
    along = np.where(lying, step, 2 * ratio - 1 - step)
    first = (np.where(lying, column - along, column), np.where(lying, row, row - along))
    number = (first[0] * 7919 + first[1] * 104729) % 4093
    tone = swatch.rng.normal(0.0, 0.085, 4093)[number]
    grain = np.where(lying, swatch.noise((0.006 * s, 0.2 * s)), swatch.noise((0.2 * s, 0.006 * s)))
    px, py = x - column * wide, y - row * wide
    edge = np.where(lying, np.minimum(py, wide - py), np.minimum(px, wide - px))
    end = np.where(lying, px, py)
    edge = np.where(along == 0, np.minimum(edge, end), edge)
    edge = np.where(along == ratio - 1, np.minimum(edge, wide - end), edge)
    return swatch.shade(tone + 0.05 * grain - 0.35 * np.clip(1.3 - edge, 0.0, 1.0))


def _stagger_cells(swatch: Swatch, period: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Texels from the middle of the nearest cell to the right and down, and the cell's row and column."""
    y, x = swatch.grid()
    row = np.floor(y / period).astype(int)
    shifted = x + (row % 2) * period / 2
    column = np.floor(shifted / period).astype(int)
    return shifted - (column + 0.5) * period, y - (row + 0.5) * period, row, column


def _print_figure(swatch: Swatch, figure: np.ndarray, ink: Float[np.ndarray, "3"] | None = None) -> Picture:
    """Paper with a figure, a share of ink for each texel; a darker shade of the paper's colour by default."""
    ink = swatch.colour * 0.84 if ink is None else ink
    noise = swatch.rng.normal(0.0, 0.006, (swatch.height, swatch.width, 1))
    picture: Picture = swatch.colour + (ink - swatch.colour) * figure[..., None] + noise
    return picture
