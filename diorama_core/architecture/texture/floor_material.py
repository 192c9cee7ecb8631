"""Which texels of a floor's picture are floor: a robust model of its colours rejects what stands on it.

What nobody marked is projected onto the floor like the floor itself. The floor's material covers much of what is seen,
shows on many sides, and is there right before the feet of what stands on it; everything of another colour is rejected,
unless it is a pattern of the material, intermingled with it nearly everywhere, or turns into it gradually: so does the
same material in the light of a window and of a lamp, while things have edges.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int, UInt8

from diorama_core.architecture.texture.quilting import broad_shading
from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.vectors import alike
from diorama_core.library.taxonomy import RUGS

_CELL_LAB = np.array([14.0, 8.0, 8.0])
"""Colours within about this much are one material in light and shade."""
_USUAL_LAB = np.array([58.0, 5.0, 12.0])
"""Floors' colours in a photo whose brightest parts are white: wood, carpet, tiles; hardly black, white or blue."""
_USUAL_AXES = np.array([[1.0, 0.0, 0.0], [0.0, 0.45, 0.89], [0.0, 0.89, -0.45]]) / np.array([[24.0], [20.0], [9.0]])
"""They vary in lightness, from grey to the orange of pine boards, and less across: by these deviations."""
_TOLERANCE_LAB = np.array([16.0, 7.0, 7.0])
"""A texel is foreign when it differs by more than this many typical deviations, and by this much at least."""
_LIT_LAB = np.array([16.0, 17.5, 17.5])
"""Bound of the whole difference: a wall above its floor may be no edge but a gradient, too."""


@dataclass(frozen=True)
class FloorMaterialSettings:
    """When a texel is floor."""

    cells_tried: int = 8
    core: float = 0.5
    """A material's own colour is a mode: a mean of colours within this share of a cell about it. A cell's middle may
    lie between two materials and hold both."""
    mean_shifts: int = 12
    samples: int = 4000
    contact_band: tuple[float, float] = (0.012, 0.06)
    """Before the feet of things, beyond their contact shadows: distances below masks, as shares of the photo's
    height."""
    quantiles: tuple[float, float] = (0.16, 0.84)
    """Quantiles of a normal distribution, one standard deviation to either side."""
    without_contact: float = 0.15
    """How much a colour counts that is seen at nobody's feet, beside one that is at all of them."""
    of_shade: float = 0.75
    """What a shade of a colour at the feet of things says for it, beside the colour itself."""
    shade_cover: float = 1.5
    """A dark colour is another's shade when the lighter one, darkened, is about the same and covers so much more."""
    sky_lit: float = 0.5
    """How much of its chroma a colour keeps at least in the shade."""
    black_l: float = 16.0
    """Darkening moves a colour of CIELAB towards L = -16, a = b = 0: the cube root of its definition."""
    white_share: float = 95.0
    """Percentile of the photo's lightness that is about white."""
    spreads: float = 3.0
    widest: float = 1.5
    """Likewise whenever it differs by so many times that much."""
    shadow_l: float = 14.0
    """What is so much darker is a shadow of what stands there, which will not stay where it is."""
    pattern_m: float = 0.15
    pattern_share: float = 0.75
    """Colours of a pattern are within this distance of each other over at least this share of both."""
    between_share: float = 0.4
    """So much of the one must also lie between pieces of the other."""
    other_colours: int = 4
    """So many colours beside the main one are looked at."""
    min_of_pattern: float = 0.03
    gradual: float = 0.8 / 0.1
    """Light changes a floor's colour by fewer tolerances a metre than this, an edge by more."""
    gradual_m: float = 0.04
    """Finer than this is grain."""
    piece_m2: float = 0.01
    border_m2: float = 0.003
    """Smaller pieces of another colour are not looked at, nor those that share a smaller border with the floor."""
    speck_m: float = 0.02
    rim_m: float = 0.03
    """Foreign pieces narrower than the one are grain; so much around the others has their rims and shadows."""


SETTINGS = FloorMaterialSettings()


def contact_pixels(shape: tuple[int, int], objects: Sequence[DetectedObject]) -> Bool[np.ndarray, "h w"]:
    """Pixels of the photo a little below the feet of things, where the floor is usually seen.

    Within the box of a rug whose outline is only a guess, it is rather the rug.
    """
    near, far = (round(share * shape[0]) for share in SETTINGS.contact_band)
    contacts = np.zeros(shape, dtype=bool)
    for item in objects:
        columns = np.flatnonzero(item.mask.any(axis=0))
        feet = shape[0] - 1 - np.argmax(item.mask[::-1, columns], axis=0)
        for below in range(near, far + 1):
            rows = feet + below
            inside = rows < shape[0]
            contacts[rows[inside], columns[inside]] = True
    for item in objects:
        contacts &= ~item.mask
        if item.category in RUGS and item.mask_confidence < 1.0:
            x1, y1, x2, y2 = (max(round(v), 0) for v in item.box)
            contacts[y1:y2, x1:x2] = False
    return contacts


def white_level(rgb: UInt8[np.ndarray, "h w 3"]) -> float:
    """Lightness L* of what is about white in a photo: a dark one's floor is as dark as the rest of it."""
    small = cv2.resize(rgb, (96, 72), interpolation=cv2.INTER_AREA).astype(np.float32) / 255.0
    lightness = cv2.cvtColor(small, cv2.COLOR_RGB2LAB)[..., 0]
    return max(float(np.percentile(lightness, SETTINGS.white_share)), 1.0)


def floor_colour(
    rgb: UInt8[np.ndarray, "n 3"], places: Float[np.ndarray, "n 2"], white: float
) -> tuple[float, float, float]:
    """The colour (sRGB 0 to 1) of a floor among pixels of it and of what nobody marked.

    Args:
        rgb: at least one pixel.
        places: where they are in the photo.
        white: lightness L* that the photo's white has (`white_level`).
    """
    lab = cv2.cvtColor(rgb[:, None].astype(np.float32) / 255.0, cv2.COLOR_RGB2LAB)[:, 0].astype(np.float64)
    main = _main_colour(lab, places, np.ones(len(lab)), np.zeros(len(lab), dtype=bool), white)
    red, green, blue = (float(c) / 255.0 for c in np.median(rgb[_matches_material(lab, main)], axis=0))
    return red, green, blue


def floor_texels(
    colours: Float32[np.ndarray, "h w 3"],
    seen: Bool[np.ndarray, "h w"],
    weight: Float[np.ndarray, "h w"],
    contact: Bool[np.ndarray, "h w"],
    pixel_m: float,
    white: float = 100.0,
) -> Bool[np.ndarray, "h w"]:
    """The seen texels that show the floor's own material.

    Args:
        colours: 0 to 255.
        seen: which texels are.
        weight: how much of the photo each texel covers.
        contact: texels right before the feet of things.
        pixel_m: size of a texel.
        white: lightness L* that the photo's white has (`white_level`).
    """
    rows, columns = np.nonzero(seen)
    if not len(rows):
        return seen.copy()
    lab = cv2.cvtColor((colours[rows, columns] / 255.0)[:, None], cv2.COLOR_RGB2LAB)[:, 0].astype(np.float64)
    every = max(1, len(rows) // SETTINGS.samples)
    main = _main_colour(
        lab[::every],
        np.stack([rows, columns], axis=1)[::every].astype(np.float64),
        weight[rows, columns][::every],
        contact[rows, columns][::every],
        white,
    )
    is_floor = np.zeros(seen.shape, dtype=bool)
    is_floor[rows, columns] = _matches_material(lab, main)
    picture = np.zeros((*seen.shape, 3), np.float32)
    picture[rows, columns] = lab
    is_floor, others = _with_pattern(is_floor, picture, np.stack([rows, columns]), main, pixel_m)
    if others:
        is_floor |= _turning_into(is_floor, others, _change(picture, seen, pixel_m), pixel_m)
    return is_floor & ~_grow_pieces(seen & ~is_floor, pixel_m)


def _with_pattern(
    is_floor: Bool[np.ndarray, "h w"],
    picture: Float32[np.ndarray, "h w 3"],
    seen_at: Int[np.ndarray, "2 n"],
    main: Float[np.ndarray, "3"],
    pixel_m: float,
) -> tuple[Bool[np.ndarray, "h w"], list[Bool[np.ndarray, "h w"]]]:
    """The texels of the main colour with those of colours that alternate with it, and texels of each other colour that
    the main one may have in another light.
    """
    rows, columns = seen_at
    lab, others = picture[rows, columns].astype(np.float64), []
    is_compared = is_floor[rows, columns]
    lit_alike = alike(picture, main, _LIT_LAB) & (picture[..., 0] >= main[0] - SETTINGS.shadow_l)
    for _ in range(SETTINGS.other_colours):
        left = ~is_compared
        if left.mean() < SETTINGS.min_of_pattern:
            break
        fullest = _fullest(lab[left][:: max(1, int(left.sum()) // SETTINGS.samples)])
        texels = _matches_material(lab, fullest) & left
        if texels.mean() < SETTINGS.min_of_pattern:
            break
        is_compared |= texels
        other = np.zeros(is_floor.shape, dtype=bool)
        other[rows, columns] = texels
        if _is_intermingled(is_floor, other, pixel_m):
            is_floor = is_floor | other
        else:
            others.append(other & lit_alike)
    return is_floor, others


def _change(
    picture: Float32[np.ndarray, "h w 3"], seen: Bool[np.ndarray, "h w"], pixel_m: float
) -> Float32[np.ndarray, "h w 3"]:
    """How fast colours without their grain change, per metre; nan at the rim of what is seen."""
    down, across = np.gradient(broad_shading(picture, seen, SETTINGS.gradual_m / pixel_m), axis=(0, 1))
    change = np.hypot(down, across) / pixel_m
    change[cv2.erode(seen.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) == 0] = np.nan
    return np.asarray(change, dtype=np.float32)


def _turning_into(
    is_floor: Bool[np.ndarray, "h w"],
    others: list[Bool[np.ndarray, "h w"]],
    change: Float32[np.ndarray, "h w 3"],
    pixel_m: float,
) -> Bool[np.ndarray, "h w"]:
    """The floor with the pieces of other colours whose border with it is gradual, one after another."""
    reach = _disc(SETTINGS.rim_m, pixel_m)
    pieces = [piece for other in others for piece in _pieces(other, SETTINGS.piece_m2 / pixel_m**2)]
    while True:
        beside = cv2.dilate(is_floor.astype(np.uint8), reach).astype(bool) & ~np.isnan(change[..., 0])
        turning = [piece for piece in pieces if _gradual(piece, beside, change, reach, pixel_m)]
        if not turning:
            return is_floor
        is_floor = np.logical_or.reduce([is_floor, *turning])
        pieces = [piece for piece in pieces if not is_floor[piece].all()]


def _pieces(mask: Bool[np.ndarray, "h w"], least_px: float) -> list[Bool[np.ndarray, "h w"]]:
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8))
    return [labels == k for k in range(1, count) if stats[k, cv2.CC_STAT_AREA] >= least_px]


def _gradual(
    piece: Bool[np.ndarray, "h w"],
    beside: Bool[np.ndarray, "h w"],
    change: Float32[np.ndarray, "h w 3"],
    reach: UInt8[np.ndarray, "k k"],
    pixel_m: float,
) -> bool:
    """Whether colours change slowly along a piece's border with the texels beside the floor."""
    border = beside & cv2.dilate(piece.astype(np.uint8), reach).astype(bool)
    if border.sum() * pixel_m**2 < SETTINGS.border_m2:
        return False
    return bool((np.median(change[border], axis=0) < SETTINGS.gradual * _TOLERANCE_LAB).all())


def _main_colour(
    lab: Float[np.ndarray, "n 3"],
    places: Float[np.ndarray, "n 2"],
    weight: Float[np.ndarray, "n"],
    contact: Bool[np.ndarray, "n"],
    white: float,
) -> Float[np.ndarray, "3"]:
    """The colour that covers much of the photo, lies far apart, is at the feet of things, and is usual for floors."""
    at_feet = max(float(weight[contact].sum()), 1e-12)
    colours, covers, scores = [], [], []
    for cell in _cells(lab, weight):
        cell = _mode(cell, lab, weight)
        near = alike(lab, cell, _CELL_LAB)
        spread = _spread(places[near], weight[near])
        middle = np.median(lab[near], axis=0) if near.any() else cell
        shaded = SETTINGS.of_shade * float(weight[contact & ~near & _shades_of(middle, lab)].sum())
        touched = (float(weight[contact & near].sum()) + shaded) / at_feet
        off = _USUAL_AXES @ (middle * np.array([100.0 / white, 1.0, 1.0]) - _USUAL_LAB)
        colours.append(middle)
        covers.append(float(weight[near].sum()) * spread * (SETTINGS.without_contact + touched))
        scores.append(covers[-1] * float(np.exp(-0.5 * (off**2).sum())))
    return _select_unshaded_colour(int(np.argmax(scores)), np.array(colours), np.array(covers))


def _mode(
    cell: Float[np.ndarray, "3"], lab: Float[np.ndarray, "n 3"], weight: Float[np.ndarray, "n"]
) -> Float[np.ndarray, "3"]:
    """Where colours lie densest near a cell's middle: mean shift (Comaniciu and Meer 2002) with a flat kernel."""
    for _ in range(SETTINGS.mean_shifts):
        near = alike(lab, cell, SETTINGS.core * _CELL_LAB)
        if not weight[near].sum() > 0.0:
            break
        moved = np.average(lab[near], axis=0, weights=weight[near])
        if np.abs(moved - cell).max() < 0.1:
            break
        cell = moved
    return np.asarray(cell)


def _spread(places: Float[np.ndarray, "n 2"], weight: Float[np.ndarray, "n"]) -> float:
    """About the standard deviation of places, by quantiles: a sliver far away covers little of the photo."""
    if not weight.sum() > 0.0:
        return 0.0
    halves = []
    for along in places.T:
        order = np.argsort(along, kind="stable")
        below = np.cumsum(weight[order]) / weight.sum()
        low, high = np.searchsorted(below, SETTINGS.quantiles)
        halves.append((along[order[min(high, len(order) - 1)]] - along[order[low]]) / 2)
    return float(np.hypot(*halves))


def _select_unshaded_colour(
    best: int, colours: Float[np.ndarray, "k 3"], covers: Float[np.ndarray, "k"]
) -> Float[np.ndarray, "3"]:
    """A colour, or the lighter one that it is a shade of and that covers clearly more."""
    shade = np.array([bool(_shades_of(lighter, colours[best : best + 1])[0]) for lighter in colours])
    lighter = shade & (covers > SETTINGS.shade_cover * covers[best])
    return np.asarray(colours[int(np.argmax(np.where(lighter, covers, 0.0))) if lighter.any() else best])


def _shades_of(colour: Float[np.ndarray, "3"], lab: Float[np.ndarray, "n 3"]) -> Bool[np.ndarray, "n"]:
    """Which colours are what a shadow makes of one: before the feet of things most are.

    In the shade of the sun the sky's light is left, which takes most of a warm colour's hue away.
    """
    darkened = colour[1:] * ((lab[:, :1] + SETTINGS.black_l) / (colour[0] + SETTINGS.black_l))
    kept = (lab[:, 1:] * darkened).sum(axis=1) / np.maximum((darkened**2).sum(axis=1), 1e-9)
    shaded = darkened * np.clip(kept, SETTINGS.sky_lit, 1.0)[:, None]
    return np.asarray(
        (np.abs(shaded - lab[:, 1:]) < _CELL_LAB[1:]).all(axis=1) & (lab[:, 0] < colour[0] - _CELL_LAB[0] / 2)
    )


def _cells(lab: Float[np.ndarray, "n 3"], weight: Float[np.ndarray, "n"]) -> Float[np.ndarray, "k 3"]:
    """Middles of the cells of colour that cover most."""
    cells, index = np.unique(np.round(lab / _CELL_LAB), axis=0, return_inverse=True)
    covered = np.bincount(index.ravel(), weights=weight)
    return np.asarray(cells[np.argsort(-covered, kind="stable")][: SETTINGS.cells_tried] * _CELL_LAB)


def _fullest(lab: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3"]:
    cell = _cells(lab, np.ones(len(lab)))[0]
    return np.asarray(np.median(lab[alike(lab, cell, _CELL_LAB)], axis=0))


def _matches_material(lab: Float[np.ndarray, "n 3"], main: Float[np.ndarray, "3"]) -> Bool[np.ndarray, "n"]:
    """Colours that a material of one main colour has in light and shade."""
    near = np.abs(lab - main)
    core = near[(near < _CELL_LAB).all(axis=1)]
    typical = np.median(core, axis=0) if len(core) else np.zeros(3)
    allowed = np.clip(SETTINGS.spreads * typical, _TOLERANCE_LAB, SETTINGS.widest * _TOLERANCE_LAB)
    shadow = lab[:, 0] < main[0] - SETTINGS.shadow_l
    return np.asarray((near <= allowed).all(axis=1) & ~shadow)


def _is_intermingled(one: Bool[np.ndarray, "h w"], other: Bool[np.ndarray, "h w"], pixel_m: float) -> bool:
    """Whether each of two colours has the other near over most of its area, and the other lies between the first.

    A skirting board along a narrow strip of floor is near all of it, but on one side only.
    """
    reach = _disc(SETTINGS.pattern_m, pixel_m)
    beside = [cv2.dilate(part.astype(np.uint8), reach).astype(bool) for part in (one, other)]
    shares = [float(beside[1 - k][part].mean()) if part.any() else 0.0 for k, part in enumerate((one, other))]
    return (
        min(shares) >= SETTINGS.pattern_share
        and float(_is_between(one, pixel_m)[other].mean()) >= SETTINGS.between_share
    )


def _is_between(mask: Bool[np.ndarray, "h w"], pixel_m: float) -> Bool[np.ndarray, "h w"]:
    """The texels with some of a mask near on two opposite sides, along rows or along columns."""
    reach = max(1, round(SETTINGS.pattern_m / pixel_m))
    sides = []
    for shape in ((1, reach + 1), (reach + 1, 1)):
        ends = ((0, 0), (shape[1] - 1, shape[0] - 1))
        before, after = (cv2.dilate(mask.astype(np.uint8), np.ones(shape, np.uint8), anchor=end) for end in ends)
        sides.append((before & after).astype(bool))
    return np.asarray(sides[0] | sides[1])


def _grow_pieces(foreign: Bool[np.ndarray, "h w"], pixel_m: float) -> Bool[np.ndarray, "h w"]:
    """Foreign pieces without specks of grain, with their rims."""
    pieces = cv2.morphologyEx(foreign.astype(np.uint8), cv2.MORPH_OPEN, _disc(SETTINGS.speck_m, pixel_m))
    return cv2.dilate(pieces, _disc(SETTINGS.rim_m, pixel_m)).astype(bool) | foreign


def _disc(radius_m: float, pixel_m: float) -> UInt8[np.ndarray, "k k"]:
    radius = max(1, round(radius_m / pixel_m))
    return cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1)).astype(np.uint8)
