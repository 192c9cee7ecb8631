"""Procedural floors, walls and ceilings: planks, tiles, carpet, paint, paper, plaster and brick.

A finish is a name such as `floor:planks:oak:17` kept in `Plane.texture`; the same name on the same plane always
gives the same picture. Nothing is read from files.
"""

from __future__ import annotations

import zlib
from functools import lru_cache

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.types import Architecture, Plane
from diorama_core.synthesis.splits import Split, share_out

TEXELS_PER_M = 160
LARGEST_TEXELS = 1400

FLOORS: dict[str, tuple[str, ...]] = {
    "planks": ("oak", "walnut", "ash", "pine", "grey"),
    "parquet": ("oak", "walnut", "ash"),
    "tiles": ("stone", "white", "slate", "terracotta"),
    "checker": ("slate", "terracotta"),
    "carpet": ("sand", "grey", "blue", "moss"),
}
WALLS: dict[str, tuple[str, ...]] = {
    "paint": ("white", "cream", "sage", "sky", "clay", "grey", "blush", "ochre"),
    "paper": ("cream", "sage", "sky", "blush"),
    "tiles": ("white", "sky", "sage"),
    "brick": ("clay", "white"),
    "panelled": ("white", "sage", "grey"),
}
COLOURS: dict[str, tuple[float, float, float]] = {
    "oak": (0.70, 0.54, 0.37), "walnut": (0.44, 0.30, 0.21), "ash": (0.80, 0.71, 0.58), "pine": (0.80, 0.63, 0.42),
    "grey": (0.66, 0.66, 0.66), "stone": (0.74, 0.71, 0.66), "white": (0.93, 0.92, 0.89), "slate": (0.36, 0.38, 0.41),
    "terracotta": (0.70, 0.42, 0.30), "sand": (0.76, 0.69, 0.58),
    "blue": (0.36, 0.44, 0.55), "moss": (0.46, 0.50, 0.40),
    "cream": (0.93, 0.88, 0.78), "sage": (0.72, 0.78, 0.69), "sky": (0.73, 0.81, 0.87), "clay": (0.74, 0.52, 0.43),
    "blush": (0.90, 0.79, 0.75), "ochre": (0.85, 0.72, 0.47),
}  # fmt: skip

TEXTURE_VALIDATION = 0.2
"""Share of finishes and room styles that are for validation; there are few of them."""
WET_ROOMS = ("bathroom", "kitchen", "lab")


def choose_finishes(rng: np.random.Generator, kind: str, split: Split | None = None) -> tuple[str, str, str]:
    """Names of the finishes of floor, walls and ceiling that suit a kind of room.

    Args:
        rng: The source of chance.
        kind: What the room is for.
        split: Only room styles and colours of this split; any by default.
    """
    styles = room_styles(kind, split)
    pair = styles[int(rng.integers(len(styles)))]
    chosen = []
    for part, style in zip(("floor", "wall"), pair):
        colours = colours_of(part, style, split)
        chosen.append(f"{part}:{style}:{colours[int(rng.integers(len(colours)))]}:{int(rng.integers(1000))}")
    return chosen[0], chosen[1], f"ceiling:paint:white:{int(rng.integers(1000))}"


def room_styles(kind: str, split: Split | None = None) -> tuple[tuple[str, str], ...]:
    """What floors and walls go together in a kind of room, (floor, wall), likelier pairs repeated."""
    wet = kind in WET_ROOMS
    floors = ("tiles", "checker", "planks") if wet else ("planks", "planks", "parquet", "carpet", "tiles")
    walls = ("tiles", "paint") if kind == "bathroom" else ("paint", "paint", "paint", "paper", "panelled", "brick")
    pairs = tuple((f, w) for f in floors for w in walls)
    if split is None:
        return pairs
    possible = {p for p in pairs if colours_of("floor", p[0], split) and colours_of("wall", p[1], split)}
    splits = _style_splits()
    return tuple(p for p in pairs if p in possible and splits[" on ".join(p)] == split)


def colours_of(part: str, style: str, split: Split | None = None) -> tuple[str, ...]:
    """Colours that a style of floor or wall comes in; within a split, only its own."""
    colours = (FLOORS if part == "floor" else WALLS)[style]
    if split is None:
        return colours
    splits = share_out((f"{part}:{style}:{c}" for c in colours), TEXTURE_VALIDATION)
    return tuple(c for c in colours if splits[f"{part}:{style}:{c}"] == split)


@lru_cache(maxsize=1)
def _style_splits() -> dict[str, Split]:
    return share_out((f"{f} on {w}" for f in FLOORS for w in WALLS), TEXTURE_VALIDATION)


def finish_textures(architecture: Architecture) -> dict[str, UInt8[np.ndarray, "_ _ 3"]]:
    """Pictures of all planes whose `texture` names a finish, by plane id, laid out as `plane_uv` says.

    Planes share a finish's name but not its picture, which has each plane's own size.
    """
    return {p.id: finish_picture(p) for p in architecture.planes if p.texture and p.texture.count(":") == 3}


def finish_picture(plane: Plane) -> UInt8[np.ndarray, "h w 3"]:
    """The picture of one plane's finish."""
    assert plane.texture is not None
    u, v = (round(float(e), 4) for e in plane_rectangle(plane)[2])
    return _picture(plane.texture, plane.role, plane.id, u, v)


@lru_cache(maxsize=24)
def _picture(name: str, role: str, plane_id: str, width_m: float, height_m: float) -> UInt8[np.ndarray, "h w 3"]:
    _, style, colour, seed = name.split(":")
    scale = min(TEXELS_PER_M, LARGEST_TEXELS / max(width_m, height_m))
    width, height = (max(8, round(e * scale)) for e in (width_m, height_m))
    rng = np.random.default_rng((int(seed), zlib.crc32(f"{role}{plane_id}".encode())))
    paint = {
        "planks": _planks, "parquet": _parquet, "tiles": _tiles, "checker": _checker, "carpet": _carpet,
        "paint": _paint, "paper": _paper, "brick": _brick, "panelled": _panelled,
    }[style]  # fmt: skip
    picture = paint(height, width, scale, np.array(COLOURS[colour]), rng, role)
    return np.clip(np.rint(picture * 255), 0, 255).astype(np.uint8)


Picture = Float[np.ndarray, "h w 3"]


def _noise(rng: np.random.Generator, height: int, width: int, cell: tuple[float, float]) -> Float[np.ndarray, "h w"]:
    """Smooth noise, about -1 to 1, whose bumps are `cell` (rows, columns) texels across."""
    small = rng.normal(0.0, 0.5, (max(2, round(height / cell[0])), max(2, round(width / cell[1])))).astype(np.float32)
    return cv2.resize(small, (width, height), interpolation=cv2.INTER_CUBIC)


def _grid(height: int, width: int) -> tuple[np.ndarray, np.ndarray]:
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)
    return y, x


def _shaded(height: int, width: int, colour: np.ndarray, tone: np.ndarray) -> Picture:
    return np.broadcast_to(colour, (height, width, 3)) * (1 + tone)[..., None]


def _planks(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    y, x = _grid(h, w)
    board, long = 0.14 * s, 1.4 * s
    row = (y // board).astype(int)
    shift = rng.uniform(0, long, row.max() + 1)[row]
    number = ((x + shift) // long).astype(int)
    tone = rng.normal(0.0, 0.075, (row.max() + 1, number.max() + 2))[row, number]
    grain = 0.05 * _noise(rng, h, w, (0.008 * s, 0.5 * s)) + 0.04 * _noise(rng, h, w, (0.02 * s, 0.25 * s))
    seam = (np.minimum(y % board, board - y % board) < 0.9) | (((x + shift) % long) < 1.5)
    return _shaded(h, w, colour, tone + grain - 0.35 * seam)


def _parquet(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    y, x = _grid(h, w)
    block = 0.36 * s
    i, j = (y // block).astype(int), (x // block).astype(int)
    across = (i + j) % 2 == 0
    strip = (np.where(across, y % block, x % block) // (block / 5)).astype(int)
    tone = rng.normal(0.0, 0.09, (i.max() + 1, j.max() + 1, 6))[i, j, np.minimum(strip, 5)]
    seam = (np.where(across, y % block, x % block) % (block / 5)) < 1.0
    grain = 0.05 * np.where(across, _noise(rng, h, w, (0.006 * s, 0.2 * s)), _noise(rng, h, w, (0.2 * s, 0.006 * s)))
    return _shaded(h, w, colour, tone + grain - 0.25 * seam)


def _tiles(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    y, x = _grid(h, w)
    tall, wide = (0.1, 0.2) if role == "wall" else (0.42, 0.42)
    tall, wide = tall * s, wide * s
    i = (y // tall).astype(int)
    offset = (i % 2) * wide / 2 if role == "wall" else np.zeros_like(x)
    j = ((x + offset) // wide).astype(int)
    tone = rng.normal(0.0, 0.03, (i.max() + 1, j.max() + 2))[i, j] + 0.03 * _noise(rng, h, w, (0.06 * s, 0.06 * s))
    joint = ((y % tall) < 1.6) | (((x + offset) % wide) < 1.6)
    picture = _shaded(h, w, colour, tone)
    picture[joint] = np.array([0.62, 0.61, 0.59]) if colour.mean() > 0.5 else np.array([0.55, 0.54, 0.52])
    return picture


def _checker(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    y, x = _grid(h, w)
    side = 0.3 * s
    odd = ((y // side).astype(int) + (x // side).astype(int)) % 2 == 0
    picture = np.where(odd[..., None], colour, np.array([0.87, 0.84, 0.78]))
    joint = ((y % side) < 1.2) | ((x % side) < 1.2)
    tone = 0.04 * _noise(rng, h, w, (0.05 * s, 0.05 * s)) - 0.15 * joint
    return picture * (1 + tone)[..., None]


def _carpet(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    fine = rng.normal(0.0, 0.06, (h, w))
    return _shaded(h, w, colour, fine + 0.04 * _noise(rng, h, w, (0.3 * s, 0.3 * s)))


def _paint(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    tone = 0.012 * _noise(rng, h, w, (0.5 * s, 0.5 * s)) + rng.normal(0.0, 0.008, (h, w))
    return _with_skirting(_shaded(h, w, colour, tone), s, role)


def _paper(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    y, x = _grid(h, w)
    period = float(rng.uniform(0.12, 0.3)) * s
    if rng.random() < 0.5:
        figure = np.sin(2 * np.pi * x / period) > 0
    else:
        centred = ((x + (y // period % 2) * period / 2) % period - period / 2, y % period - period / 2)
        figure = np.hypot(*centred) < 0.22 * period
    ink = colour * float(rng.uniform(0.82, 0.9))
    return _with_skirting(colour + (ink - colour) * figure[..., None] + rng.normal(0, 0.006, (h, w, 1)), s, role)


def _brick(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    y, x = _grid(h, w)
    tall, wide = 0.075 * s, 0.24 * s
    i = (y // tall).astype(int)
    shifted = x + (i % 2) * wide / 2
    j = (shifted // wide).astype(int)
    tone = rng.normal(0.0, 0.1, (i.max() + 1, j.max() + 2))[i, j] + 0.06 * _noise(rng, h, w, (0.03 * s, 0.03 * s))
    picture = _shaded(h, w, colour, tone)
    picture[((y % tall) < 0.012 * s) | ((shifted % wide) < 0.012 * s)] = (0.76, 0.73, 0.69)
    return picture


def _panelled(h: int, w: int, s: float, colour: np.ndarray, rng: np.random.Generator, role: str) -> Picture:
    picture = _paint(h, w, s, np.minimum(colour * 1.05, 0.95), rng, role)
    y, x = _grid(h, w)
    board = 0.11 * s
    low = (h - y) < 1.0 * s
    picture[low] = picture[low] * np.where(colour.mean() > 0.85, 0.93, 1.06)
    picture[low & ((x % board) < 1.5)] *= 0.82
    picture[np.abs((h - y) - 1.0 * s) < 0.03 * s] = 0.92
    return picture


def _with_skirting(picture: Picture, s: float, role: str) -> Picture:
    """A white board along the foot of a wall."""
    if role == "wall":
        high = round(0.09 * s)
        picture[-high:] = 0.9
        picture[-high - 1 : -high + 1] *= 0.8
    return picture
