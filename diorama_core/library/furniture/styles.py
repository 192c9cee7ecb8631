"""What makes a piece modern, classic, industrial, rustic or minimal: its woods, cloths, metals, legs and fronts.

A kind of furniture is one parametric design; a style fills in what the kind leaves open, so every kind can be had in
every style and swapping one chair for another offers real alternatives.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.cases import Base
from diorama_core.library.furniture.legs import Leg
from diorama_core.library.furniture.materials import Material

EMERALD_VELVET = Material("emerald velvet", "velvet", "#3f5f52", 0.8, 0.0, 0.5)
TEAL_VELVET = Material("teal velvet", "velvet", "#3f6570", 0.8, 0.0, 0.5)
BLUSH_VELVET = Material("blush velvet", "velvet", "#c3978c", 0.8, 0.0, 0.5)
GOLD_VELVET = Material("gold velvet", "velvet", "#b08b4c", 0.8, 0.0, 0.5)
PLUM_VELVET = Material("plum velvet", "velvet", "#624656", 0.8, 0.0, 0.5)
IVORY_BOUCLE = Material("ivory bouclé", "boucle", "#e4ddd0", 0.95, 0.0, 0.14)
SAND_BOUCLE = Material("sand bouclé", "boucle", "#cbbba3", 0.95, 0.0, 0.14)
COGNAC_LEATHER = m.leather("cognac leather", "#8a5433")
OXBLOOD_LEATHER = m.leather("oxblood leather", "#57272a")
SKY_FABRIC = m.fabric("pale blue cloth", "#9db1bd")
PLYWOOD = m.wood("plywood", "#c9a876", 0.5)
SMOKED_OAK = m.wood("smoked oak", "#5d4939")
GREY_OAK = m.wood("grey oak", "#9a9185")
DUCK_EGG = m.paint("duck egg paint", "#b7c6c2")
FOREST = m.paint("forest paint", "#3f5248")
BLUSH = m.paint("blush lacquer", "#d6b3a6")


@dataclass(frozen=True)
class Style:
    """The choices that run through every piece of one style."""

    name: str
    """Value of `Shape.style`."""
    wood: Material
    frame: Material
    """Legs and frames."""
    cloth: Material
    hide: Material
    fitting: Material
    """Handles, hinges, castors, foot rings."""
    leg: Leg
    edge_m: float
    """How round an edge is."""
    handle: str
    panel: str
    base: Base
    base_h: float
    top: Material | None = None
    """Another material for the top of a case."""
    infill: Material | None = None
    """What fills the panels of doors, where it is not wood."""

    def but(self, **changes: Any) -> Style:
        """A style with other materials or details."""
        return replace(self, **changes)


MODERN = Style(
    "modern", m.WALNUT, m.WALNUT, m.GREY_FABRIC, m.TAN_LEATHER, m.BRASS, "splay", 0.010, "bar", "flat", "splay", 0.16
)
CLASSIC = Style(
    "classic",
    m.MAHOGANY,
    m.MAHOGANY,
    m.NAVY_FABRIC,
    m.BROWN_LEATHER,
    m.BRASS,
    "turned",
    0.008,
    "knob",
    "shaker",
    "legs",
    0.12,
    m.MAHOGANY,
)
INDUSTRIAL = Style(
    "industrial",
    m.RECLAIMED,
    m.BLACK_STEEL,
    m.CHARCOAL_FABRIC,
    COGNAC_LEATHER,
    m.BLACK_STEEL,
    "steel",
    0.004,
    "cup",
    "flat",
    "steel",
    0.14,
)
RUSTIC = Style(
    "rustic",
    m.PINE,
    m.PINE,
    m.LINEN,
    m.BROWN_LEATHER,
    m.IRON,
    "square",
    0.009,
    "cup",
    "shaker",
    "plinth",
    0.07,
    m.OAK,
)
MINIMAL = Style(
    "minimal", m.BIRCH, m.BIRCH, m.LIGHT_FABRIC, m.CREAM_LEATHER, m.STEEL, "slim", 0.005, "none", "flat", "plinth", 0.05
)
STYLES = (MODERN, CLASSIC, INDUSTRIAL, RUSTIC, MINIMAL)
