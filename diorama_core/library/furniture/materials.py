"""What shapes are made of: small procedural textures with their physical properties.

A material always has a picture, if only a plain one, because pictures are sRGB by the glTF standard and so every
viewer shows the same colour. Everything is seeded by the material's name: same name, same bytes.
"""

from __future__ import annotations

import io
import zlib
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import trimesh
from jaxtyping import Float
from PIL import Image

from diorama_core.library.furniture.prints import PRINTS
from diorama_core.library.furniture.textures import PAINTERS, Painter


@dataclass(frozen=True)
class Material:
    """One material. Hashable: materials with equal fields are one."""

    name: str
    kind: str
    """Key of `textures.PAINTERS` or `prints.PRINTS`: which picture is painted."""
    colour: str
    """sRGB, as "#rrggbb": the average colour."""
    roughness: float = 0.7
    metallic: float = 0.0
    tile_m: float = 0.5
    """Metres that one picture covers."""
    alpha: float = 1.0
    """Opacity; less than 1 is seen through (glass, sheer cloth)."""
    glow: float = 0.0
    """Light it gives off, as a share of its colour at full brightness (lampshades, bulbs)."""

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


def glass(name: str, colour: str, alpha: float = 0.3, roughness: float = 0.06) -> Material:
    """Clear or tinted glass; `alpha` is how much of what lies behind it hides."""
    return Material(name, "plain", colour, roughness, alpha=alpha)


def lit(name: str, colour: str, glow: float, kind: str = "plain") -> Material:
    """Something that shines by itself or through, as a bulb or a lampshade does."""
    return Material(name, kind, colour, 0.9, 0.0, 0.1, glow=glow)


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
GLASS = glass("glass", "#a6b8b3", 0.15)
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
LAMP_GLOW = lit("warm lampshade", "#f4e8cf", 0.35)
LINEN_SHADE = lit("linen lampshade", "#ece1cb", 0.12, "weave")
LEAF = Material("leaf", "leaf", "#668453", 0.55, 0.0, 0.15)
DARK_LEAF = Material("dark leaf", "leaf", "#4d6c4a", 0.5, 0.0, 0.15)
PALE_LEAF = Material("pale leaf", "leaf", "#84986a", 0.6, 0.0, 0.15)
BARK = wood("bark", "#6a543f", 0.95)
SCREEN = art("dark screen", "screen", "#15181b", 0.12)
MIRROR = Material("mirror glass", "mirror", "#c6cfd2", 0.04, 0.5, 1.0)
PANE = Material("window pane", "sky", "#a9c3d6", 0.06, 0.0, 1.0, glow=0.05)


@lru_cache(maxsize=512)
def picture_bytes(material: Material) -> bytes:
    """The material's base colour picture, sRGB: PNG when plain, else JPEG."""
    rng = np.random.default_rng(zlib.crc32(f"{material.kind} {material.name}".encode()))
    pixels = np.round(_painter(material.kind)(material.rgb, rng) * 255).astype(np.uint8)
    buffer = io.BytesIO()
    if material.kind == "plain":
        Image.fromarray(pixels).save(buffer, "PNG")
    else:
        Image.fromarray(pixels).save(buffer, "JPEG", quality=88, subsampling=0)
    return buffer.getvalue()


def _painter(kind: str) -> Painter:
    return PAINTERS[kind] if kind in PAINTERS else PRINTS[kind]


def pbr(material: Material) -> trimesh.visual.material.PBRMaterial:
    """The material for trimesh and glTF."""
    optional: dict[str, object] = {}
    if material.alpha < 1:
        optional |= {"alphaMode": "BLEND", "baseColorFactor": [255, 255, 255, round(255 * material.alpha)]}
    if material.glow:
        optional["emissiveFactor"] = [float(c) for c in material.glow * material.rgb**2.2]
    return trimesh.visual.material.PBRMaterial(
        name=material.name,
        baseColorTexture=Image.open(io.BytesIO(picture_bytes(material)), formats=("JPEG", "PNG")),
        roughnessFactor=material.roughness,
        metallicFactor=material.metallic,
        **optional,
    )
