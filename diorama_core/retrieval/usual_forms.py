"""How usual a shape's form is among things of its kind: most chairs and tables stand on four legs.

The outlines that a photo without networks gives fill the space between legs, so that closed forms fit them best; how
often each form is met says what they cannot, and so it does of pictures whose outline is lost on a plain wall. Shares
are rough counts in homes and offices.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import cv2
import numpy as np
from jaxtyping import Int32, UInt8

from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.geometry.vectors import cells_of
from diorama_core.library.form import FULL_RECTANGLE
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import category, having, with_kin
from diorama_core.retrieval.feature_cache import cached_features
from diorama_core.retrieval.seen_forms import shape_form
from diorama_core.retrieval.settings import SETTINGS, UsualFormSettings

_CROSSED_LEGS = "crossed legs"
_BASES: Mapping[str, Mapping[str, float]] = {
    "office seat": {"five-star": 0.8, "four legs": 0.1, "pedestal": 0.05, "sled": 0.05},
    "easy seat": {"four legs": 0.7, "plinth": 0.12, "pedestal": 0.08, "sled": 0.06, "panel": 0.04},
    "seat": {"four legs": 0.75, "sled": 0.08, "five-star": 0.07, "pedestal": 0.06, _CROSSED_LEGS: 0.03, "plinth": 0.02},
    "low table": {"four legs": 0.65, "plinth": 0.12, "panel": 0.1, "sled": 0.07, "pedestal": 0.06},
    "small table": {"four legs": 0.6, "pedestal": 0.2, "plinth": 0.08, "sled": 0.05, "panel": 0.05},
    "table": {"four legs": 0.7, "pedestal": 0.12, "panel": 0.08, "sled": 0.05, "plinth": 0.03},
}
"""Shares of bases, by what a kind's row says of its base."""
_TOPS: Mapping[str, float] = {"rectangular": 0.6, "square": 0.6, "round": 0.25, "oval": 0.1}
_TABLES = having("table_form") - having("seat")
_FLAT = {"rectangular": 0.93, "other": 0.07}
"""Shares of what hangs flat or stands in frames; others are round, oval, free outlines, several in a row, panes."""
_MIRRORS = with_kin("mirror")
_FLAT_KINDS = having("framed")
_PLANTS = {"leafy": 0.9, "other": 0.1}
_OTHER_PLANTS = frozenset(
    {"cactus", "bonsai", "succulents", "christmas", "fir", "bell", "plumes", "grasses", "blossom"}
)
"""Words of captions: their filled outlines fit many a plant whose leaves a mask runs together."""

OUTLINE_FEATURES, SIDE_FEATURES, LEGS_FEATURES = "outline-2", "side-1", "legs-1"
"""Cache keys; to be changed with what is measured under them."""


def usual_form_factor(
    library: ShapeLibrary, shape: Shape, appearance: ShapeAppearance, settings: UsualFormSettings = SETTINGS.forms
) -> float:
    """What a shape's score is multiplied by: 1 for the usual base, top or outline of its kind, less for rare ones.

    What has to be drawn for it is kept on disk.

    Args:
        library: where the shape is.
        shape: whose form is judged.
        appearance: its triangles.
        settings: numbers to work with.
    """
    if shape.category in _FLAT_KINDS:
        return float((_FLAT[_outline(shape, appearance, settings)] / max(_FLAT.values())) ** settings.says)
    if shape.category == "plant":
        plant = "other" if _OTHER_PLANTS & set(shape.caption.lower().split()) else "leafy"
        return float((_PLANTS[plant] / max(_PLANTS.values())) ** settings.says)
    row = category(shape.category)
    bases = None if row.base is None else _BASES[row.base]
    tops = _TOPS if shape.category in _TABLES else None
    closed = row.closed_sides
    sides = None if closed is None else {"closed": closed, "open": 1.0 - closed}
    if bases is None and tops is None and sides is None:
        return 1.0
    forms = (*_form(library, shape, appearance, settings), _side(shape, appearance, settings))
    known = [(shares, form) for shares, form in zip((bases, tops, sides), forms, strict=True) if shares is not None]
    usual = [shares.get(form, settings.rare) / max(shares.values()) for shares, form in known]
    return float(np.prod(usual) ** settings.says)


def _form(
    library: ShapeLibrary, shape: Shape, appearance: ShapeAppearance, settings: UsualFormSettings
) -> tuple[str, str]:
    """Base and top."""
    form = shape_form(library, shape, appearance)
    base = str(form.get("base", "none"))
    if (
        base == "four legs"
        and shape.category == "chair"
        and _get_or_compute(LEGS_FEATURES, shape, lambda: _cross(appearance, settings))
    ):
        base = _CROSSED_LEGS
    return base, str(form.get("top", "none"))


def _cross(appearance: ShapeAppearance, settings: UsualFormSettings) -> bool:
    """Whether front and back legs meet below the seat, as those of folding chairs do."""
    points = appearance.spread_points(settings.leg_points)
    height = (points[:, 2] - points[:, 2].min()) / max(float(np.ptp(points[:, 2])), 1e-9)
    levels = np.arange(0.0, settings.below_seat, settings.foot / 2)
    depths = [
        np.ptp(np.quantile(at, [0.05, 0.95]))
        for z in levels
        if len(at := points[abs(height - z) < settings.foot / 2, 0])
    ]
    return bool(min(depths[1:], default=np.inf) < settings.crossing * depths[0])


def _outline(shape: Shape, appearance: ShapeAppearance, settings: UsualFormSettings) -> str:
    """From the front: whether it is one piece, and one pane, that fills the rectangle around it."""

    def is_rectangular() -> bool:
        outline = cv2.convexHull(np.ascontiguousarray(appearance.vertices[:, 1:], np.float32))
        around = max(float(np.prod(np.ptp(outline[:, 0], axis=0))), 1e-9)
        whole = _pieces(appearance, settings) == 1 and (
            shape.category not in _MIRRORS or _panes(appearance, settings) <= 1
        )
        return whole and cv2.contourArea(outline) >= FULL_RECTANGLE * around

    return "rectangular" if _get_or_compute(OUTLINE_FEATURES, shape, is_rectangular) else "other"


def _side(shape: Shape, appearance: ShapeAppearance, settings: UsualFormSettings) -> str:
    """Whether a seat is seen through from the side."""

    def is_closed() -> bool:
        drawn = _draw_outline(appearance, [0, 2], settings)
        around = cv2.contourArea(cv2.convexHull(np.argwhere(drawn).astype(np.int32)))
        return float(drawn.sum()) >= settings.closed * around

    return "closed" if _get_or_compute(SIDE_FEATURES, shape, is_closed) else "open"


def _get_or_compute(kind: str, shape: Shape, make: Callable[[], bool]) -> bool:
    """An answer about a shape: from memory, from disk, or found now."""
    return bool(cached_features(kind, shape, lambda: np.array([[float(make())]]))[0, 0])


def _pieces(appearance: ShapeAppearance, settings: UsualFormSettings) -> int:
    """How many separate pieces are seen from the front: a row of prints is several."""
    return int(cv2.connectedComponents(_draw_outline(appearance, [1, 2], settings))[0]) - 1


def _panes(appearance: ShapeAppearance, settings: UsualFormSettings) -> int:
    """How many large regions the colour has that covers most of the front: bars cut a mirror into panes."""
    colours = cells_of(appearance.face_rgba)[0] + 1
    back_to_front = np.argsort(appearance.vertices[appearance.faces][:, :, 0].mean(axis=1), kind="stable")
    drawn = np.zeros((settings.drawn_px, settings.drawn_px), np.int32)
    triangles = _triangles_px(appearance, [1, 2], settings)
    for face in back_to_front:
        cv2.fillConvexPoly(drawn, triangles[face], int(colours[face]))
    most = np.argmax(np.bincount(drawn[drawn > 0], minlength=2))
    areas = cv2.connectedComponentsWithStats((drawn == most).astype(np.uint8), connectivity=4)[2][1:, cv2.CC_STAT_AREA]
    return int((areas >= settings.min_pane * (drawn > 0).sum()).sum())


def _draw_outline(
    appearance: ShapeAppearance, axes: list[int], settings: UsualFormSettings
) -> UInt8[np.ndarray, "p p"]:
    """The outline along the remaining axis, 1 where there is something, stretched to a square."""
    drawn = np.zeros((settings.drawn_px, settings.drawn_px), np.uint8)
    for triangle in _triangles_px(appearance, axes, settings):
        cv2.fillConvexPoly(drawn, triangle, 1)
    return drawn


def _triangles_px(
    appearance: ShapeAppearance, axes: list[int], settings: UsualFormSettings
) -> Int32[np.ndarray, "f 3 2"]:
    """The triangles along the remaining axis, in pixels of the square to which the shape is stretched."""
    flat = appearance.vertices[:, axes]
    at = (flat - flat.min(axis=0)) / np.maximum(np.ptp(flat, axis=0), 1e-9) * (settings.drawn_px - 1)
    return np.rint(at[appearance.faces]).astype(np.int32)
