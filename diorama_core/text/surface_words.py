"""Coverings of walls, floors and ceilings in words: "brick", "oak boards", "light blue", "darker"."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.appearance.patterns import COLOURS
from diorama_core.appearance.surface_finish import KINDS, usual_finish
from diorama_core.library.language import tokens
from diorama_core.scene.types import Plane, SurfaceFinish, SurfacePattern
from diorama_core.text.looks import look_of

_PATTERNS: dict[SurfacePattern, str] = {
    "brick": "brick brickwork",
    "plaster": "plaster stucco concrete cement",
    "stripes": "stripe striped",
    "dots": "dot dotted polka",
    "leaves": "leaf leave floral flowery wallpaper wallpapered",
    "panelling": "panelling paneling panelled paneled panel wainscot wainscoting",
    "metro": "metro subway",
    "tiles": "tile tiled",
    "checker": "checker chequered checkered checkerboard",
    "parquet": "parquet",
    "herringbone": "herringbone chevron",
    "boards": "board plank floorboard wood wooden laminate timber hardwood",
    "carpet": "carpet carpeted carpeting",
}
"""Words that name a pattern; what is special comes before what is common ("metro tiles")."""
_NAMES = frozenset(name for names in _PATTERNS.values() for name in names.split())
_RELATIVE = {"darker": -0.25, "lighter": 0.3, "brighter": 0.3, "paler": 0.3}
"""How far a colour goes toward black or white."""
_BESIDE = frozenset({"pattern", "patterned", "finish", "covering", "made", "very", "much", "bit", "little", "slightly"})
_WOODS = frozenset(KINDS["boards"].colours)


def covering_in_words(text: str, plane: Plane) -> SurfaceFinish | None:
    """What a plane is to be covered with; None where words name anything else or nothing.

    Args:
        text: the words.
        plane: whose colour "darker" and "lighter" change.
    """
    words = [w for w in tokens(text) if w not in _BESIDE]
    relative = next((w for w in words if w in _RELATIVE), None)
    rest = [w for w in words if w != relative and w not in ("a", "an", "the", "in", "of", "with", "colour", "color")]
    if relative is not None:
        return None if rest else _shaded(plane, _RELATIVE[relative])
    pattern = next((p for p, names in _PATTERNS.items() if set(rest) & set(names.split())), None)
    others = [w for w in rest if w not in _NAMES]
    wood = next((w for w in others if w in _WOODS and w in COLOURS and w not in ("grey", "white")), None)
    if pattern is None and wood is not None and plane.role == "floor":
        pattern = "boards"
    look = look_of(" ".join(others)) if others else None
    if others and (look is None or look.colour is None):
        return None
    if pattern is None:
        return None if look is None or look.colour is None else SurfaceFinish("paint", look.colour)
    usual = usual_finish(pattern)
    if wood is not None and pattern in ("boards", "parquet", "herringbone"):
        return replace(usual, colour=COLOURS[wood])
    return usual if look is None or look.colour is None else replace(usual, colour=look.colour)


def _shaded(plane: Plane, by: float) -> SurfaceFinish:
    known = plane.finish or SurfaceFinish("paint", plane.colour)
    toward = 1.0 if by > 0 else 0.0
    r, g, b = (float(c + (toward - c) * abs(by)) for c in known.colour)
    return replace(known, colour=(r, g, b))
