"""Masses and friction: one table of materials, applied to the closed volumes of a shape.

Shapes model most objects as solids that are hollow in truth: drawers, tubes, vases, housings. Each material therefore
has the thickness of its usual walls, and weighs no more than its surface at that thickness.
"""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from jaxtyping import Float, Float32

from diorama_core.geometry.vectors import unique_rows
from diorama_core.library.record import Shape
from diorama_core.render.appearance import Material, Surface

MIN_SHEET_M, MAX_SHEET_M = 0.0005, 0.003
"""Thickness of surfaces that enclose no volume (leaves, lamp shades, cloth) lies between these."""
MAX_PRIOR_RATIO = 1.25
"""A mass may differ from the usual one of its category and size by this factor at most: a shape shows its outer
materials, which says less than what such things weigh."""
UNKNOWN_MASS_KG = 1.0
"""Default mass of a library record without an estimate."""
MIN_MASS_KG = 0.01
MIN_RADIUS_M = 0.005
"""Radius of gyration that is added to all, so that thin objects do not spin without end."""


@dataclass(frozen=True)
class Substance:
    """Physical properties of one kind of material."""

    name: str
    density: float
    """Kilograms per cubic metre: metals, stone, concrete, glass, rubber, soil and wood as in the table of J. M. Gere,
    Mechanics of Materials, 5th edition; wood is oak's and pine's mean. Ceramic is porcelain, plastic ABS, foam that of
    seats; cloth and leather are foam under a cover."""
    wall_m: float
    """Thickness of the walls of hollow objects made of it; infinite for what is solid throughout."""
    friction: float
    """Coefficient of sliding friction against wood."""
    words: tuple[str, ...]
    """A material is of this kind when its name holds one of these."""


SUBSTANCES: tuple[Substance, ...] = (
    Substance("leather", 70.0, np.inf, 0.6, ("leather",)),
    Substance("cloth", 60.0, np.inf, 0.7, ("cloth", "fabric", "linen", "wool", "cotton", "felt", "velvet", "canvas")),
    Substance("stone", 2600.0, 0.02, 0.5, ("marble", "granite", "stone", "slate", "terrazzo")),
    Substance("concrete", 2200.0, 0.03, 0.6, ("concrete", "brick")),
    Substance("ceramic", 2300.0, 0.005, 0.4, ("porcelain", "ceramic", "glaze", "terracotta", "clay", "enamel")),
    Substance("glass", 2500.0, 0.005, 0.35, ("glass", "mirror", "crystal")),
    Substance("steel", 7800.0, 0.0012, 0.4, ("steel", "chrome", "iron", "metal", "brass", "copper", "bronze")),
    Substance("aluminium", 2700.0, 0.002, 0.4, ("aluminium", "aluminum")),
    Substance("soil", 1300.0, np.inf, 0.6, ("soil", "earth")),
    Substance("paper", 700.0, np.inf, 0.5, ("paper", "book", "cardboard", "pages", "print", "card")),
    Substance("leaf", 300.0, 0.004, 0.5, ("leaf", "leaves", "foliage", "moss", "flower", "petal", "stem", "bark")),
    Substance("wicker", 350.0, 0.008, 0.5, ("wicker", "rattan", "cane", "straw", "jute", "seagrass", "bamboo")),
    Substance("rubber", 1100.0, 0.01, 0.9, ("rubber", "tyre", "silicone")),
    Substance("foam", 40.0, np.inf, 0.7, ("foam", "mattress", "pillow", "duvet")),
    Substance("plastic", 1050.0, 0.003, 0.4, ("plastic", "screen", "acrylic")),
    Substance("lacquer", 650.0, 0.014, 0.45, ("lacquer", "paint", "laminate")),
    Substance(
        "wood",
        620.0,
        0.018,
        0.5,
        ("oak", "walnut", "pine", "birch", "cherry", "mahogany", "beech", "teak", "maple", "wood", "black ash", "ply"),
    ),
)
OTHER = Substance("other", 600.0, 0.01, 0.5, ())
"""What a material that no word names is taken to be."""
FLOOR_FRICTION = 0.7
GRAVITY = 9.81
"""Metres per second squared."""


def substance_of(material: Material) -> Substance:
    """The kind of a material, by its name, else by how it reflects and lets light through."""
    name = material.name.casefold()
    for substance in SUBSTANCES:
        if any(word in name for word in substance.words):
            return substance
    if material.alpha < 0.9:
        return _substance("glass")
    return _substance("steel") if material.metallic > 0.5 else OTHER


@dataclass(frozen=True, eq=False)
class Inertia:
    """Inertia of a rigid body about its centre of mass, in the axes of its frame."""

    mass_kg: float
    centre: Float[np.ndarray, "3"]
    tensor: Float[np.ndarray, "3 3"]

    def weighing(self, mass_kg: float) -> Inertia:
        """This distribution at another mass."""
        return Inertia(mass_kg, self.centre, self.tensor * (mass_kg / self.mass_kg))

    @property
    def principal(self) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3 3"]]:
        """Moments about the principal axes, and the rotation whose columns they are."""
        moments, axes = np.linalg.eigh(self.tensor)
        if np.linalg.det(axes) < 0:
            axes[:, 2] = -axes[:, 2]
        return moments, axes


def inertia_of(surfaces: tuple[Surface, ...], scale: Float[np.ndarray, "3"]) -> Inertia:
    """Mass and its distribution for surfaces at a scale.

    Each material weighs its closed volume, or its walls where that is less, spread over its surface: a lamp's foot
    outweighs its shade, whatever air the shade encloses.
    """
    total, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for surface in surfaces:
        measured = _measure(surface)
        areas = np.linalg.norm(measured.area_vectors * (np.prod(scale) / scale), axis=1)
        mass = _mass_kg(
            substance_of(surface.material), measured.enclosed_m3 * float(np.prod(scale)), float(areas.sum())
        )
        masses = areas * (mass / max(float(areas.sum()), 1e-12))
        total += mass
        first += masses @ measured.centroids * scale
        second += (measured.centroids * masses[:, None]).T @ measured.centroids * np.outer(scale, scale)
    return _inertia_from_moments(total, first, second)


def _mass_kg(kind: Substance, volume_m3: float, area_m2: float) -> float:
    """Mass of a surface of one material: its volume, or its walls where that is less; a sheet where it is open."""
    if volume_m3 > 0:
        return kind.density * min(volume_m3, area_m2 * kind.wall_m)
    return kind.density * area_m2 * float(np.clip(kind.wall_m, MIN_SHEET_M, MAX_SHEET_M))


def _inertia_from_moments(total: float, first: Float[np.ndarray, "3"], second: Float[np.ndarray, "3 3"]) -> Inertia:
    """Inertia from a mass and its first and second moments about the origin."""
    if total < 1e-9:
        return Inertia(MIN_MASS_KG, np.zeros(3), np.eye(3) * MIN_MASS_KG * MIN_RADIUS_M**2)
    centre = first / total
    spread = second - total * np.outer(centre, centre)
    tensor = np.trace(spread) * np.eye(3) - spread
    inertia = Inertia(total, centre, tensor + np.eye(3) * total * MIN_RADIUS_M**2)
    return inertia.weighing(max(total, MIN_MASS_KG))


def plausible_mass_kg(mass_kg: float, scale: Float[np.ndarray, "3"], record: Shape) -> float:
    """A mass, kept near the usual one of the shape's category and size where the library knows it."""
    if record.mass_kg == UNKNOWN_MASS_KG:
        return mass_kg
    usual = record.mass_kg * float(np.prod(scale))
    return float(np.clip(mass_kg, usual / MAX_PRIOR_RATIO, usual * MAX_PRIOR_RATIO))


def friction_of(surfaces: tuple[Surface, ...]) -> float:
    """Coefficient of the material that covers most of a shape."""
    areas: dict[Substance, float] = {}
    for surface in surfaces:
        kind = substance_of(surface.material)
        areas[kind] = areas.get(kind, 0.0) + surface.area_m2
    return max(areas, key=areas.__getitem__, default=OTHER).friction


@dataclass(frozen=True, eq=False)
class _Measured:
    """What the mass of a surface follows from at any scale."""

    centroids: Float32[np.ndarray, "m 3"]
    """Centroids of the triangles."""
    area_vectors: Float32[np.ndarray, "m 3"]
    """Normals of the triangles, as long as their areas."""
    enclosed_m3: float


_MEASURED: WeakKeyDictionary[Surface, _Measured] = WeakKeyDictionary()


def _measure(surface: Surface) -> _Measured:
    """Measured once a surface."""
    if surface not in _MEASURED:
        a, b, c = (surface.vertices[surface.faces[:, k]].astype(np.float64) for k in range(3))
        vectors = 0.5 * np.cross(b - a, c - a)
        centroids = (a + b + c) / 3.0
        _MEASURED[surface] = _Measured(
            centroids.astype(np.float32), vectors.astype(np.float32), surface_volume_m3(surface)
        )
    return _MEASURED[surface]


def surface_volume_m3(surface: Surface) -> float:
    """Volume that a surface encloses; 0 when it is not closed."""
    _, place = unique_rows(np.round(surface.vertices, 5))
    corners = place[surface.faces]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    count = int(place.max()) + 1
    forward, back = (np.sort(e[:, 0] * count + e[:, 1]) for e in (edges, edges[:, ::-1]))
    closed = np.array_equal(forward, back)  # every edge is walked as often one way as the other
    a, b, c = (surface.vertices[surface.faces[:, k]].astype(np.float64) for k in range(3))
    volume = float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) / 6.0
    return volume if closed and volume > 0 else 0.0


def _substance(name: str) -> Substance:
    return next(s for s in SUBSTANCES if s.name == name)
