"""What shapes are made of: small procedural textures with their physical properties.

A material always has a picture, if only a plain one, because pictures are sRGB by the glTF standard and so every
viewer shows the same colour. Everything is seeded by the material's name: same name, same bytes.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import trimesh
from jaxtyping import Float
from PIL import Image
from scipy.ndimage import gaussian_filter

TEXTURE_SIZE = 192


@dataclass(frozen=True)
class Material:
    """One material. Hashable: materials with equal fields are one."""

    name: str
    kind: str
    """Key of `_PAINTERS`: which picture is painted."""
    colour: str
    """sRGB, as "#rrggbb": the average colour."""
    roughness: float = 0.7
    metallic: float = 0.0
    tile_m: float = 0.5
    """Metres that one picture covers."""

    @property
    def rgb(self) -> Float[np.ndarray, "3"]:
        """`colour` as numbers 0 to 1."""
        return np.array([int(self.colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0


def wood(name: str, colour: str, roughness: float = 0.55) -> Material:
    """Grained wood; the grain runs along the first texture coordinate."""
    return Material(name, "wood", colour, roughness, 0.0, 0.7)


def paint(name: str, colour: str, roughness: float = 0.55) -> Material:
    """Smooth lacquer, plastic or enamel."""
    return Material(name, "plain", colour, roughness)


def fabric(name: str, colour: str, tile_m: float = 0.16) -> Material:
    """Woven cloth."""
    return Material(name, "weave", colour, 0.92, 0.0, tile_m)


def leather(name: str, colour: str) -> Material:
    """Grained leather."""
    return Material(name, "leather", colour, 0.48, 0.0, 0.3)


def metal(name: str, colour: str, roughness: float = 0.35, metallic: float = 0.45) -> Material:
    """Metal; not fully metallic, so that it stays bright where there is nothing to reflect."""
    return Material(name, "plain", colour, roughness, metallic)


def art(name: str, kind: str, colour: str, roughness: float = 0.6) -> Material:
    """A whole picture, to be spread once over a face (`Solid.pictured`)."""
    return Material(name, kind, colour, roughness, 0.0, 1.0)


OAK = wood("oak", "#b8926a")
LIGHT_OAK = wood("light oak", "#cfb08a")
WALNUT = wood("walnut", "#6e4c34")
DARK_WALNUT = wood("dark walnut", "#4a3325")
PINE = wood("pine", "#d3ac77")
BIRCH = wood("birch", "#dcc6a2")
CHERRY = wood("cherry", "#8c5438")
MAHOGANY = wood("mahogany", "#5e3023", 0.42)
BLACK_WOOD = wood("black ash", "#2d2a28")
RECLAIMED = wood("reclaimed wood", "#86694e", 0.8)
WHITEWASH = wood("whitewashed wood", "#d8d1c5", 0.7)

WHITE = paint("white lacquer", "#ecebe6")
CREAM = paint("cream paint", "#e4dac6")
LIGHT_GREY = paint("light grey lacquer", "#c4c5c3")
GREY = paint("grey lacquer", "#8b8e8f")
CHARCOAL = paint("charcoal lacquer", "#3f4245")
SHADOW = paint("shadow gap", "#3a3735", 0.95)
BLACK = paint("black plastic", "#232325", 0.5)
SAGE = paint("sage paint", "#93a08c")
NAVY = paint("navy paint", "#36455a")
TERRACOTTA = Material("terracotta", "clay", "#a8745a", 0.85, 0.0, 0.4)
STONEWARE = Material("stoneware", "clay", "#b9ae9c", 0.6, 0.0, 0.4)
DARK_STONEWARE = Material("dark stoneware", "clay", "#54565a", 0.6, 0.0, 0.4)
PORCELAIN = paint("porcelain", "#f1efea", 0.18)
BLUE_GLAZE = Material("blue glaze", "clay", "#5e7586", 0.3, 0.0, 0.4)
GREEN_GLAZE = Material("green glaze", "clay", "#6f8470", 0.3, 0.0, 0.4)
MARBLE = Material("marble", "marble", "#e4e1dc", 0.25, 0.0, 0.8)
GRANITE = Material("granite", "speckle", "#6b6a68", 0.3, 0.0, 0.4)
CONCRETE = Material("concrete", "clay", "#a3a09a", 0.85, 0.0, 0.8)
CARDBOARD = Material("cardboard", "paper", "#b8946a", 0.9, 0.0, 0.3)
PAPER = Material("paper", "pages", "#ece6d8", 0.9, 0.0, 0.06)
SOIL = Material("soil", "speckle", "#4a3a2e", 1.0, 0.0, 0.2)
GLASS = paint("glass", "#cbd3d2", 0.08)
DARK_GLASS = paint("dark glass", "#24282b", 0.1)

LINEN = fabric("linen", "#d6cbb8")
OATMEAL = fabric("oatmeal wool", "#c2b59f")
GREY_FABRIC = fabric("grey cloth", "#8f9192")
LIGHT_FABRIC = fabric("light grey cloth", "#b9b9b5")
CHARCOAL_FABRIC = fabric("charcoal cloth", "#4c4f53")
BLUE_FABRIC = fabric("slate blue cloth", "#5d7287")
NAVY_FABRIC = fabric("navy cloth", "#3b4a60")
OLIVE_FABRIC = fabric("olive cloth", "#76774f")
GREEN_FABRIC = fabric("forest cloth", "#53645a")
RUST_FABRIC = fabric("rust cloth", "#99674c")
MUSTARD_FABRIC = fabric("ochre cloth", "#b0945c")
ROSE_FABRIC = fabric("dusty rose cloth", "#b98c84")
WHITE_COTTON = fabric("white cotton", "#ebe8e1", 0.1)
BEIGE_FABRIC = fabric("beige cloth", "#b7a284")
TAUPE_FABRIC = fabric("taupe cloth", "#8a7c6c")
TAN_LEATHER = leather("tan leather", "#9a7150")
BROWN_LEATHER = leather("brown leather", "#61402c")
BLACK_LEATHER = leather("black leather", "#2e2b2a")
CREAM_LEATHER = leather("cream leather", "#d9cdb8")

BLACK_STEEL = metal("black steel", "#2c2d2f", 0.5, 0.25)
STEEL = metal("brushed steel", "#b5b7b8", 0.35)
CHROME = metal("chrome", "#cfd2d4", 0.18)
BRASS = metal("brass", "#b4935a", 0.32)
COPPER = metal("copper", "#a86f4f", 0.35)
IRON = metal("wrought iron", "#45423f", 0.65, 0.3)
STAINLESS = Material("stainless steel", "brushed", "#b9bbbb", 0.35, 0.4, 0.5)
WICKER = Material("wicker", "wicker", "#b58f5f", 0.85, 0.0, 0.12)
RATTAN = Material("rattan cane", "wicker", "#cdae7f", 0.8, 0.0, 0.09)
DARK_WICKER = Material("dark wicker", "wicker", "#6f5138", 0.85, 0.0, 0.12)
LAMP_GLOW = paint("warm lampshade", "#f4e8cf", 0.9)
LINEN_SHADE = fabric("linen lampshade", "#ece1cb", 0.1)
LEAF = Material("leaf", "leaf", "#668453", 0.55, 0.0, 0.15)
DARK_LEAF = Material("dark leaf", "leaf", "#4d6c4a", 0.5, 0.0, 0.15)
PALE_LEAF = Material("pale leaf", "leaf", "#84986a", 0.6, 0.0, 0.15)
BARK = wood("bark", "#6a543f", 0.95)
SCREEN = art("dark screen", "screen", "#15181b", 0.12)
MIRROR = art("mirror glass", "mirror", "#b9c3c7", 0.05)
PANE = art("window pane", "sky", "#c5d5de", 0.08)


Picture = Float[np.ndarray, "h w 3"]


def _noise(rng: np.random.Generator, sigma: tuple[float, float], size: int = TEXTURE_SIZE) -> Float[np.ndarray, "h w"]:
    """Tileable smooth noise with zero mean and unit deviation; sigma is (down, across) in pixels."""
    field: np.ndarray = gaussian_filter(rng.standard_normal((size, size)), sigma, mode="wrap")
    return (field - field.mean()) / max(float(field.std()), 1e-9)


def _shade(rgb: Float[np.ndarray, "3"], amount: Float[np.ndarray, "h w"]) -> Picture:
    """The colour lightened and darkened by a relative amount."""
    return np.clip(rgb * (1.0 + amount[..., None]), 0, 1)


def _plain(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return np.broadcast_to(rgb, (8, 8, 3)).copy()


def _wood(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    across = np.arange(n)[:, None] / n
    warp = _noise(rng, (14, 60)) * 0.035
    rings = np.sin(2 * np.pi * (7 * across + 3.0 * warp)) * 0.5 + np.sin(2 * np.pi * (17 * across + 6 * warp)) * 0.3
    fibre = _noise(rng, (0.6, 22))
    broad = _noise(rng, (9, 70))
    return _shade(rgb, 0.055 * rings + 0.04 * fibre + 0.05 * broad)


def _weave(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    threads = 48
    over = ((i * threads // n) + (j * threads // n)) % 2
    warp = np.abs(np.sin(np.pi * j * threads / n))
    weft = np.abs(np.sin(np.pi * i * threads / n))
    relief = np.where(over == 0, warp, weft) - 0.64
    slub = _noise(rng, (0.8, 12)) + _noise(rng, (12, 0.8))
    return _shade(rgb, 0.06 * relief + 0.014 * slub + 0.006 * _noise(rng, (20, 20)))


def _leather(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    pores = _noise(rng, (1.6, 1.6))
    return _shade(rgb, 0.045 * np.tanh(pores) + 0.02 * _noise(rng, (28, 28)))


def _clay(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return _shade(rgb, 0.03 * _noise(rng, (16, 16)) + 0.018 * _noise(rng, (1, 1)))


def _marble(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    veins = np.exp(-((_noise(rng, (14, 22)) + 0.25 * _noise(rng, (4, 4))) ** 2) * 60)
    return _shade(rgb, -0.17 * gaussian_filter(veins, 0.8, mode="wrap") + 0.02 * _noise(rng, (18, 18)))


def _speckle(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return _shade(rgb, 0.16 * _noise(rng, (0.8, 0.8)) + 0.08 * _noise(rng, (3, 3)))


def _paper(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return _shade(rgb, 0.02 * _noise(rng, (0.7, 5)) + 0.02 * _noise(rng, (18, 18)))


def _pages(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    lines: np.ndarray = gaussian_filter(rng.standard_normal((TEXTURE_SIZE, 1)), (0.6, 0), mode="wrap")
    return _shade(rgb, np.repeat(0.07 * lines, TEXTURE_SIZE, axis=1))


def _brushed(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return _shade(rgb, 0.012 * _noise(rng, (0.6, 40)))


def _wicker(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n, cells = 128, 8
    i, j = np.meshgrid(np.arange(n) * cells / n, np.arange(n) * cells / n, indexing="ij")
    over = (i.astype(int) + j.astype(int)) % 2 == 0
    a, b = i % 1.0 - 0.5, j % 1.0 - 0.5
    bulge = np.where(over, np.cos(a * np.pi) * (0.6 + 0.4 * np.cos(b * np.pi)), np.cos(b * np.pi) * 0.8)
    return _shade(rgb, 0.5 * (bulge - 0.62) + 0.04 * _noise(rng, (1, 1), n))


def _leaf(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    return _shade(rgb, 0.08 * _noise(rng, (10, 10)) + 0.05 * _noise(rng, (1.5, 6)))


def _screen(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    v, u = np.meshgrid(np.linspace(1, 0, 96), np.linspace(0, 1, 96), indexing="ij")
    sheen = 0.5 * np.clip(u + v - 0.9, 0, 1) + 0.9 * ((u - 0.7 * v > 0.15) & (u - 0.7 * v < 0.5)) * v * 0.4
    return np.clip(rgb + 0.16 * sheen[..., None] * np.array([0.8, 0.95, 1.1]), 0, 1)


def _mirror(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    v, u = np.meshgrid(np.linspace(1, 0, 96), np.linspace(0, 1, 96), indexing="ij")
    d = u + 0.8 * v
    streaks = 0.10 * ((d > 0.55) & (d < 0.8)) + 0.07 * ((d > 0.88) & (d < 0.96))
    return _shade(rgb, gaussian_filter(streaks, 1.2) + 0.16 * (v - 0.5))


def _sky(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    v, u = np.meshgrid(np.linspace(1, 0, 96), np.linspace(0, 1, 96), indexing="ij")
    haze = np.array([0.90, 0.92, 0.92])
    return np.clip(rgb * v[..., None] + haze * (1 - v[..., None]) + 0.05 * np.clip(u + v - 1, 0, 1)[..., None], 0, 1)


def _hills(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    v = np.linspace(1, 0, n)[:, None]
    sky = np.array([0.90, 0.87, 0.81])
    picture = sky * (1 - 0.12 * v[..., None]) * np.ones((n, n, 1))
    for k, (level, tone) in enumerate(((0.55, 0.62), (0.42, 0.42), (0.28, 0.22), (0.13, 0.0))):
        ridge = level + 0.055 * _noise(rng, (1, 16 + 4 * k))[:1]
        picture[np.broadcast_to(v, (n, n)) < ridge] = rgb * (1 - tone) + sky * tone
    return picture * (1 + 0.02 * _noise(rng, (1, 1))[..., None])


def _abstract(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    v, u = np.meshgrid(np.linspace(1, 0, n), np.linspace(0, 1, n), indexing="ij")
    picture = np.ones((n, n, 3)) * np.array([0.91, 0.88, 0.82])
    tones = (rgb, np.array([0.76, 0.55, 0.41]), np.array([0.28, 0.29, 0.30]), np.array([0.82, 0.72, 0.55]))
    spots = ((0.36, 0.62, 0.20), (0.62, 0.36, 0.24), (0.68, 0.74, 0.09), (0.28, 0.26, 0.12))
    for tone, (x, y, r) in zip(tones, spots, strict=True):
        wobble = 1 + 0.06 * np.sin(3 * np.arctan2(v - y, u - x) + 9 * r)
        picture[np.hypot(u - x, v - y) < r * wobble] = tone
    return picture * (1 + 0.015 * _noise(rng, (1.2, 1.2))[..., None])


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
    drift: np.ndarray = gaussian_filter(_noise(rng, (5, 34)), 1)
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
    return np.clip(gaussian_filter(picture, (0.8, 0.8, 0)) * (1 + 0.04 * _noise(rng, (0.7, 0.7), n)[..., None]), 0, 1)


def _stripes(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    bands = (np.sin(np.linspace(0, 14 * np.pi, n)) > 0.5)[:, None, None]
    pale = np.array([0.88, 0.85, 0.78])
    picture = np.where(bands, rgb, pale) * np.ones((n, n, 1))
    return np.clip(picture * (1 + 0.035 * _noise(rng, (0.7, 0.7))[..., None]), 0, 1)


def _diamonds(rgb: Float[np.ndarray, "3"], rng: np.random.Generator) -> Picture:
    n = TEXTURE_SIZE
    y, x = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij")
    line = (np.abs((4 * x + 4 * y) % 1 - 0.5) > 0.465) | (np.abs((4 * x - 4 * y) % 1 - 0.5) > 0.465)
    picture = np.where(gaussian_filter(line.astype(float), 0.8)[..., None] > 0.4, rgb * 0.35, rgb)
    return np.clip(picture * (1 + 0.04 * _noise(rng, (1, 1))[..., None]), 0, 1)


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


_PAINTERS: dict[str, Callable[[Float[np.ndarray, "3"], np.random.Generator], Picture]] = {
    "plain": _plain,
    "wood": _wood,
    "weave": _weave,
    "leather": _leather,
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


@lru_cache(maxsize=512)
def picture_bytes(material: Material) -> bytes:
    """The material's base colour picture, sRGB: PNG when plain, else JPEG."""
    rng = np.random.default_rng(zlib.crc32(f"{material.kind} {material.name}".encode()))
    pixels = np.round(_PAINTERS[material.kind](material.rgb, rng) * 255).astype(np.uint8)
    buffer = io.BytesIO()
    if material.kind == "plain":
        Image.fromarray(pixels).save(buffer, "PNG")
    else:
        Image.fromarray(pixels).save(buffer, "JPEG", quality=88, subsampling=0)
    return buffer.getvalue()


def pbr(material: Material) -> trimesh.visual.material.PBRMaterial:
    """The material for trimesh and glTF."""
    return trimesh.visual.material.PBRMaterial(
        name=material.name,
        baseColorTexture=Image.open(io.BytesIO(picture_bytes(material))),
        roughnessFactor=material.roughness,
        metallicFactor=material.metallic,
    )
