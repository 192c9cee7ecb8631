"""What words say of how an object looks: colours, materials, and the shape of a library that fits them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from PIL import ImageColor

from diorama_core.library.language import narrower, normal, size_request, tokens
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.search import find
from diorama_core.library.taxonomy import with_kin
from diorama_core.scene.types import Finish

Colour = tuple[float, float, float]

MATERIALS: dict[str, tuple[Colour, Finish]] = {
    "wood": ((0.58, 0.41, 0.26), "satin"), "oak": ((0.68, 0.52, 0.35), "satin"), "walnut": ((0.38, 0.26, 0.18), "satin"),
    "pine": ((0.80, 0.63, 0.42), "satin"), "birch": ((0.84, 0.74, 0.58), "satin"),
    "mahogany": ((0.38, 0.18, 0.13), "gloss"), "teak": ((0.55, 0.38, 0.23), "satin"),
    "bamboo": ((0.80, 0.68, 0.44), "satin"), "metal": ((0.62, 0.63, 0.65), "metal"), "steel": ((0.66, 0.67, 0.69), "metal"),
    "iron": ((0.25, 0.25, 0.26), "metal"), "brass": ((0.72, 0.56, 0.28), "metal"), "chrome": ((0.78, 0.78, 0.80), "metal"),
    "copper": ((0.72, 0.45, 0.32), "metal"), "leather": ((0.42, 0.26, 0.16), "satin"),
    "fabric": ((0.70, 0.67, 0.62), "matt"), "velvet": ((0.30, 0.34, 0.45), "matt"), "linen": ((0.82, 0.77, 0.68), "matt"),
    "wicker": ((0.72, 0.58, 0.40), "matt"), "rattan": ((0.72, 0.58, 0.40), "matt"), "marble": ((0.90, 0.89, 0.87), "gloss"),
    "stone": ((0.62, 0.60, 0.57), "matt"), "glass": ((0.78, 0.86, 0.87), "gloss"), "plastic": ((0.85, 0.85, 0.84), "satin"),
}  # fmt: skip
"""Colour and finish that stand for a material where no shape is made of it."""
HOME_COLOURS: dict[str, Colour] = {
    "cream": (0.95, 0.91, 0.81), "sage": (0.64, 0.71, 0.60), "mustard": (0.80, 0.62, 0.20), "charcoal": (0.24, 0.25, 0.27),
    "burgundy": (0.45, 0.10, 0.16), "terracotta": (0.76, 0.42, 0.30), "blush": (0.91, 0.76, 0.73), "lilac": (0.75, 0.66, 0.82),
    "golden": (0.83, 0.66, 0.25), "emerald": (0.08, 0.45, 0.33), "sand": (0.84, 0.76, 0.63), "mint": (0.68, 0.88, 0.78),
    "rust": (0.66, 0.30, 0.16), "sky": (0.62, 0.79, 0.92), "oatmeal": (0.85, 0.80, 0.71), "taupe": (0.55, 0.49, 0.44),
    "red": (0.70, 0.13, 0.13), "green": (0.22, 0.46, 0.27), "blue": (0.18, 0.33, 0.62), "yellow": (0.92, 0.78, 0.24),
    "orange": (0.88, 0.48, 0.15), "pink": (0.91, 0.62, 0.68), "purple": (0.43, 0.25, 0.55), "brown": (0.42, 0.28, 0.18),
    "black": (0.09, 0.09, 0.10), "white": (0.95, 0.95, 0.94), "grey": (0.55, 0.55, 0.56), "silver": (0.75, 0.76, 0.78),
    "warmwhite": (0.96, 0.93, 0.86), "coolwhite": (0.93, 0.95, 0.97), "offwhite": (0.94, 0.92, 0.87),
    "warmgrey": (0.60, 0.57, 0.53), "coolgrey": (0.53, 0.56, 0.60),
}  # fmt: skip
"""Paints and cloths, less pure than the colours of screens that go by these names."""
_SHADES = {"light": 0.55, "pale": 0.65, "pastel": 0.6, "bright": 0.0, "dark": -0.5, "deep": -0.4}
_AROUND = ("a", "an", "the", "it", "into", "in", "to", "all", "be", "more", "look", "made", "of", "colour", "color")
EVEN_SIDED, EVEN_RATIO = frozenset({"round", "square", "circular"}), 1.15
"""Words for what is as wide as deep, and how far a shape may be from that."""
ALIKE_RATIO = 1.35
"""Shapes whose sizes differ by no more are stretched into one another's box."""


@dataclass(frozen=True)
class Look:
    """A colour, a material, or both, in words that were understood."""

    words: str
    colour: Colour
    finish: Finish | None
    material: str = ""


def look_of(text: str) -> Look | None:
    """The colour or material that words name; None where they name anything else or nothing."""
    words = [w for w in tokens(text) if w not in _AROUND]
    shade = sum(_SHADES[w] for w in words if w in _SHADES)
    shaded = any(w in _SHADES for w in words)
    material = next(
        (m for w in words for m in (w, {"wooden": "wood", "metallic": "metal"}.get(w, w)) if m in MATERIALS), ""
    )
    names = [w for w in words if w not in _SHADES and w not in MATERIALS and w not in ("wooden", "metallic")]
    named = _colour("".join(names))
    if named is None and len(names) == 2 and _colour(names[1]) is not None:
        named = _colour(names[0])  # "sage green" is sage
    if (names and named is None) or not (names or material or shaded):
        return None
    plain, finish = MATERIALS.get(material, (None, None))
    colour = named or plain or (0.5, 0.5, 0.5)
    return Look(" ".join(words), _shade(colour, shade), finish, material)


def _colour(name: str) -> Colour | None:
    if not name:
        return None
    name = {"gray": "grey"}.get(name, name)
    if name in HOME_COLOURS:
        return HOME_COLOURS[name]
    try:
        r, g, b = ImageColor.getrgb(name)[:3]
    except ValueError:
        return None
    return r / 255, g / 255, b / 255


def _shade(colour: Colour, shade: float) -> Colour:
    target = 1.0 if shade > 0 else 0.0
    r, g, b = (float(c + (target - c) * min(abs(shade), 0.85)) for c in colour)
    return r, g, b


def main_words(shape: Shape) -> frozenset[str]:
    """What a caption says of most of a shape: its words before "with"."""
    head: list[str] = []
    for word in shape.caption.lower().replace("-", " ").split():
        if word in ("with", "on", "under", "in", "and"):
            break
        head.append(normal(word))
    return frozenset(head)


def has_look(shape: Shape, word: str) -> bool:
    """Whether a caption or a style names a look or a special kind of it: oak for wood.

    Colours and materials are those of most of the shape: a sofa in a black frame is not black.
    """
    asked = normal({"wooden": "wood", "metallic": "metal"}.get(word, word))
    if asked in EVEN_SIDED and max(shape.size_m[:2]) > EVEN_RATIO * min(shape.size_m[:2]):
        return False
    kinds = {asked, *narrower(asked)}
    words_of_shape = main_words(shape) | set(tokens(shape.style))
    if look_of(word) is None:
        words_of_shape |= set(tokens(shape.caption))
    return bool(kinds & words_of_shape)


def is_made_of(shape: Shape, material: str) -> bool:
    """Whether most of a shape is of a material, as its caption says."""
    return bool({material, *narrower(material)} & main_words(shape))


def fitting_shapes(
    library: ShapeLibrary,
    category: str,
    label: str,
    appearance: Sequence[str],
    usable: Callable[[Shape], bool] | None = None,
) -> tuple[tuple[Shape, ...], tuple[str, ...]]:
    """Shapes of a category, those that fit the words best first, and the words that even the first does not fit.

    Args:
        library: where shapes come from.
        category: of the shapes.
        label: what the object is called.
        appearance: words of colour and material.
        usable: tells which shapes may be taken; all by default.
    """
    kinds = frozenset({category}) if library.in_category(category) else with_kin(category)
    words = " ".join((*appearance, label or category))
    shapes = [s for s in find(library, words, k=400).shapes if s.category in kinds]
    known = {s.id for s in shapes}
    shapes += [s for s in library.in_category(category) if s.id not in known]
    shapes = [s for s in shapes if usable is None or usable(s)]
    asked = [normal(w) for w in appearance if size_request(w) is None]

    def misses(shape: Shape) -> tuple[int, int]:
        """Words that do not fit, and words that only a special kind of them fits."""
        words_of_shape = set(tokens(f"{shape.caption} {shape.style}"))
        return sum(not has_look(shape, w) for w in asked), sum(w not in words_of_shape for w in asked)

    ordered = sorted(shapes, key=misses)
    if not ordered:
        return (), ()
    lacking = tuple(w for w in appearance if size_request(w) is None and not has_look(ordered[0], w))
    return tuple(ordered), lacking


def nearest_in_size(shapes: Sequence[Shape], size_m: np.ndarray) -> Shape:
    """The shape whose extents differ least in proportion."""
    return min(shapes, key=lambda s: float(np.abs(np.log(np.asarray(s.size_m) / size_m)).sum()))


def scale_into(shape: Shape, size_m: np.ndarray) -> tuple[float, float, float]:
    """Stretched to a box where the sizes are alike, else evenly, so that it fits in."""
    ratios = np.asarray(size_m, dtype=float) / np.asarray(shape.size_m)
    if float(np.max(ratios) / np.min(ratios)) <= ALIKE_RATIO:
        x, y, z = ratios
        return float(x), float(y), float(z)
    even = float(np.clip(np.cbrt(np.prod(ratios)), np.min(ratios), 1.1 * np.min(ratios)))
    return even, even, even
