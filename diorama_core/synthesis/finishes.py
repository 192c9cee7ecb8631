"""Procedural floors, walls and ceilings: planks, tiles, carpet, paint, paper, plaster and brick.

A finish is a name such as `floor:planks:oak:17` kept in `Plane.texture`; the same name on the same plane always
gives the same picture. Nothing is read from files.
"""

from __future__ import annotations

import zlib
from functools import lru_cache

import numpy as np
from jaxtyping import UInt8

from diorama_core.appearance import patterns
from diorama_core.appearance.patterns import COLOURS, Swatch
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
PATTERNS = {
    "planks": patterns.planks, "parquet": patterns.parquet, "tiles": patterns.tiles, "checker": patterns.checker,
    "carpet": patterns.carpet, "paint": patterns.paint, "paper": patterns.paper, "brick": patterns.brick,
    "panelled": patterns.panelling,
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
    picture = PATTERNS[style](Swatch(height, width, scale, np.array(COLOURS[colour]), rng, role))
    return np.clip(np.rint(picture * 255), 0, 255).astype(np.uint8)
