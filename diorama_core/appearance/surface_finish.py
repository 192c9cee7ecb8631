"""Pictures of the finishes that people give to walls, floor and ceiling.

The scene says what a plane is finished with (`SurfaceFinish`); its picture follows from that and from the plane's
rectangle alone, so it can be made again at any time. Pictures hold the bare colour of the material, without light.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import UInt8

from diorama_core.appearance import patterns
from diorama_core.appearance.patterns import Swatch
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.types import Plane, PlaneRole, Scene, SurfaceFinish, SurfacePattern

MARK = "finish-"
"""Begins the names of pictures of finishes."""

Pictures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
Painter = Callable[[Swatch], np.ndarray]


@dataclass(frozen=True)
class PatternKind:
    """What people know of a pattern."""

    name: str
    paint: Painter
    colours: tuple[str, ...]
    """Colours that it usually has, by their names in `patterns.COLOURS`; the first is its usual one."""
    directed: bool = True
    """Whether a direction makes a difference."""
    skirted: bool = False
    """Whether a wall has a skirting board below it."""
    role: PlaneRole = "floor"
    """What kind of plane the painter is told of: it paints smaller tiles on walls, for instance."""
    turned_rad: float = 0.0
    """How it lies when its direction is 0."""


WOODS = ("oak", "ash", "pine", "walnut", "grey", "white")
PAINTS = ("white", "cream", "sage", "sky", "blush", "clay", "ochre", "grey", "blue", "moss", "slate")
STONES = ("stone", "white", "grey", "slate", "terracotta", "sand")

KINDS: dict[SurfacePattern, PatternKind] = {
    "paint": PatternKind("Paint", patterns.paint, PAINTS, directed=False, skirted=True),
    "plaster": PatternKind("Plaster", patterns.plaster, ("stone", "white", "sand", "grey", "clay"), directed=False),
    "stripes": PatternKind("Stripes", patterns.stripes, PAINTS, skirted=True),
    "dots": PatternKind("Dots", patterns.dots, PAINTS, skirted=True),
    "leaves": PatternKind(
        "Leaves",
        patterns.leaves,
        ("sage", "white", "cream", "sky", "blush", "clay", "ochre", "grey", "blue", "moss"),
        skirted=True,
    ),
    "panelling": PatternKind("Panelling", patterns.panelling, ("white", "sage", "grey", "blue"), directed=False),
    "tiles": PatternKind("Tiles", patterns.tiles, STONES),
    "metro": PatternKind("Metro tiles", patterns.tiles, ("white", "sky", "sage", "slate", "blue"), role="wall"),
    "checker": PatternKind("Chequered", patterns.checker, ("slate", "terracotta", "moss", "blue")),
    "brick": PatternKind("Brick", patterns.brick, ("clay", "white", "grey", "terracotta"), role="wall"),
    "boards": PatternKind("Boards", patterns.planks, WOODS),
    "parquet": PatternKind("Parquet", patterns.parquet, WOODS),
    "herringbone": PatternKind("Herringbone", patterns.herringbone, WOODS, turned_rad=np.pi / 4),
    "carpet": PatternKind("Carpet", patterns.carpet, ("sand", "grey", "blue", "moss", "cream"), directed=False),
}
USUAL: dict[PlaneRole, tuple[SurfacePattern, ...]] = {
    "floor": ("boards", "parquet", "herringbone", "tiles", "checker", "carpet", "plaster", "paint"),
    "wall": (
        "paint", "plaster", "stripes", "dots", "leaves", "panelling", "boards", "metro", "tiles", "brick",
    ),
    "ceiling": ("paint", "plaster", "boards", "panelling"),
}  # fmt: skip
"""What each kind of plane is offered, the likeliest first."""


def usual_finish(pattern: SurfacePattern) -> SurfaceFinish:
    """A pattern in its usual colour and size."""
    return SurfaceFinish(pattern, patterns.COLOURS[KINDS[pattern].colours[0]])


def finish_picture(finish: SurfaceFinish, role: PlaneRole, size_m: tuple[float, float]) -> UInt8[np.ndarray, "h w 3"]:
    """The picture of a finish over a rectangle.

    Args:
        finish: what it is finished with.
        role: of the plane; walls have a skirting board where the finish asks for one.
        size_m: width and height of the rectangle.

    Returns:
        sRGB, laid out as `geometry.planes.plane_uv` says; the same for the same values.
    """
    kind = KINDS[finish.pattern]
    texels = min(200.0, 1600 / max(size_m))  # a metre: no side has more than 1600
    width, height = (max(8, round(e * texels)) for e in size_m)
    rng = np.random.default_rng(zlib.crc32(finish.pattern.encode()))
    turn = finish.direction_rad + kind.turned_rad if kind.directed else 0.0
    c, s = abs(np.cos(turn)), abs(np.sin(turn))
    w, h = (int(np.ceil(e - 1e-6)) for e in (width * c + height * s, width * s + height * c))
    picture = kind.paint(Swatch(h, w, texels * finish.scale, np.array(finish.colour), rng, kind.role))
    if abs(turn) > 1e-6:
        rotation = cv2.getRotationMatrix2D(((w - 1) / 2, (h - 1) / 2), float(np.degrees(turn)), 1.0)
        rotation[:, 2] += ((width - w) / 2, (height - h) / 2)
        picture = cv2.warpAffine(picture, rotation, (width, height), borderMode=cv2.BORDER_REFLECT)
    if kind.skirted:
        picture = patterns.with_skirting(picture, texels, role)
    return np.clip(np.rint(picture * 255), 0, 255).astype(np.uint8)


def finish_name(plane: Plane) -> str | None:
    """Name of the picture of a plane's finish; None where it has none. Another size or finish has another name."""
    if plane.finish is None:
        return None
    origin, axes, extents = plane_rectangle(plane)
    numbers = [*plane.finish.colour, plane.finish.scale, plane.finish.direction_rad, *(origin @ axes), *extents]
    key = (np.round(np.array(numbers), 4) + 0.0).tobytes() + f"{plane.finish.pattern} {plane.role}".encode()
    return f"{MARK}{plane.finish.pattern}-{zlib.crc32(key):08x}"


def with_finish_pictures(scene: Scene, known: Pictures) -> tuple[Scene, dict[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """The scene whose finished planes name the pictures of their finishes, and those that are not known yet.

    Args:
        scene: Any; planes that were resized or finished name pictures that no longer fit, or none.
        known: Pictures that there are, by name.
    """
    made: dict[str, UInt8[np.ndarray, "_ _ 3"]] = {}
    planes = []
    for plane in scene.architecture.planes:
        name = finish_name(plane)
        if plane.finish is not None and name is not None:
            if name not in known and name not in made:
                width, height = (float(e) for e in plane_rectangle(plane)[2])
                made[name] = finish_picture(plane.finish, plane.role, (width, height))
            plane = plane if plane.texture == name else replace(plane, texture=name)
        planes.append(plane)
    if all(a is b for a, b in zip(planes, scene.architecture.planes, strict=True)):
        return scene, made
    return replace(scene, architecture=replace(scene.architecture, planes=tuple(planes))), made
