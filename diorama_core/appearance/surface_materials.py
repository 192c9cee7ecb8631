"""Materials of surfaces from the pixels that show them: albedo, and a texture by example where there is a pattern."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.appearance.light import Shade
from diorama_core.appearance.lit_colour import is_shade, select_material_colour
from diorama_core.appearance.plainness import shows_plain
from diorama_core.appearance.surface_view import SurfaceView
from diorama_core.appearance.texture_example import Example, best_example, tileable
from diorama_core.geometry.vectors import cells_of
from diorama_core.io.srgb import linear_to_srgb, luminance, srgb_to_linear
from diorama_core.library.slots import Role, Slot
from diorama_core.render.gloss import roughness_seen, without_gloss

READ_ROLES: frozenset[Role] = frozenset(
    {"fabric", "leather", "wood", "metal", "stone", "paint", "wicker", "paper", "leaf", "material"}
)
PRINTED: Role = "picture"
"""Role of slots that wear a print: the photo's, or what is seen of its colours where the print cannot be read."""
PATTERNED_ROLES = (READ_ROLES | {PRINTED}) - {"metal", "leaf"}
"""Roles whose texture is taken: what metal mirrors and how leaves lie is no pattern."""
WOVEN_ROLES: frozenset[Role] = frozenset({"fabric", "leather", "paper", "material"})
"""Roles whose texture in the library gives way to a plain colour where the photo shows none; wood keeps its grain."""
ROUGHNESS: Mapping[str, tuple[float, float]] = {
    "fabric": (0.92, 0.0), "leather": (0.45, 0.0), "wood": (0.55, 0.0), "metal": (0.35, 0.45), "stone": (0.4, 0.0),
    "paint": (0.55, 0.0), "wicker": (0.85, 0.0), "paper": (0.9, 0.0), "leaf": (0.55, 0.0), "material": (0.7, 0.0),
    "glass": (0.06, 0.0), "picture": (0.8, 0.0),
}  # fmt: skip
"""Roughness and metalness by role; what is seen too dark to mirror that much is rougher."""
MIN_OF_WHOLE = 16
"""Pixels from which the main slot is read of a thing whose slots are too small to be told apart."""
BIN_LAB = np.array([40.0, 20.0, 20.0])
MIN_LINEAR, MAX_LINEAR = 0.015, 0.9
"""Albedos of what is called black and white; soot and velvet apart nothing is a hole in the picture."""


@dataclass(frozen=True)
class SurfaceMaterialSettings:
    """How materials are estimated from pixels."""

    plain_px: int = 4
    """Sides of the picture of a plain surface."""
    min_pixels: int = 40
    min_share: float = 0.2
    """A slot is read from at least so many pixels, of which such a share is of about one colour."""
    min_outlined: float = 0.35
    """Share that a mask must hold of the pixels where the posed shape is. Where it holds less of one slot, it has lost
    that part of the object (white bedding on a dark bed), and the slot is read where the shape shows it; where it holds
    less of the whole, mask and pose do not belong together, and the mask alone counts."""
    min_visible: float = 0.015
    """Least share of all that is seen of its object: a pose a little off misses smaller slots."""
    beside: float = 1.3
    """A colour is rather that of what is behind when it covers so many times more of that: much of a room is grey."""
    coloured: float = 25.0
    crossed: float = 4.0
    """Another material than its neighbour's of one vivid colour (chroma) with a neighbour of so many times its pixels
    is not read: a metal arm that crosses a red back in the picture is not red."""
    clearly: float = 2.0
    """A thing's lit side has a colour that covers so many times more of the thing than of the background."""
    mostly: float = 0.5
    clearly_own: float = 1.5
    """A colour that covers less than half of a slot covers so many times more of it than of all others together, or it
    is of none of them: a white board before a chair's arm and seat."""
    as_good: float = 0.8
    """A colour is as good as the best when it is nearly as much the slot's own."""
    behind: float = 0.5
    """Share of the background from which a vivid colour there is not read of a part that the mask lost: legs are not
    red because the carpet below them is."""
    min_of_bin: float = 0.02
    """Bins that hold less of a slot are left out."""
    near_lab: float = 20.0
    normal_cell: float = 0.35
    """Normals within about this are one face of a shade."""
    min_face_pixels: int = 30


SETTINGS = SurfaceMaterialSettings()


@dataclass(frozen=True, eq=False)
class SlotAppearance:
    """What the photo shows of one slot."""

    slot: Slot
    colour: tuple[float, float, float]
    """Albedo, sRGB 0 to 1."""
    texture: UInt8[np.ndarray, "h w 3"] | None
    tile_m: float
    roughness: float


@dataclass(frozen=True, eq=False)
class SlotPixels:
    """The pixels that show one slot, those of its main colour."""

    slot: Slot
    index: int
    near: Bool[np.ndarray, "h w"]
    """Cells of the view's grid."""
    mine: Bool[np.ndarray, "h w"]
    """Those of the slot of any colour, on the same grid."""


def slot_pixels(
    view: SurfaceView,
    slots: tuple[Slot, ...],
    rgb: UInt8[np.ndarray, "h w 3"],
    visible: Bool[np.ndarray, "h w"],
    unhidden: Bool[np.ndarray, "h w"],
    background: Bool[np.ndarray, "h w"],
    faces: Collection[str] = (),
) -> tuple[SlotPixels, ...]:
    """The slots that are seen well enough, with the pixels of their main colours.

    Args:
        view: The shape in its pose.
        slots: Its slots.
        rgb: The photo.
        visible: The object's inner pixels, without what stands before it.
        unhidden: Pixels in the object's box that nothing else hides; of use where the mask is doubtful.
        background: Pixels in its box that show what is behind or below it.
        faces: Names of slots whose print was read from the photo.
    """
    seen, colours = view.crop(visible) & (view.slot >= 0), view.crop(rgb)
    shown = view.crop(unhidden) & (cv2.erode((view.slot >= 0).astype(np.uint8), np.ones((5, 5), np.uint8)) > 0)
    together = seen.sum() >= SETTINGS.min_outlined * shown.sum()
    lab = cv2.cvtColor(np.ascontiguousarray(colours, dtype=np.float32) / 255.0, cv2.COLOR_RGB2Lab)
    of_slots: dict[int, Bool[np.ndarray, "gh gw"]] = {}
    lost: set[int] = set()
    for index, slot in enumerate(slots):
        mine, posed = seen & (view.slot == index), shown & (view.slot == index)
        if together and mine.sum() < SETTINGS.min_outlined * posed.sum():
            mine = posed
            lost.add(index)
        count = int(mine.sum())
        printed = slot.role == PRINTED and slot.name not in faces
        read = printed or slot.role in READ_ROLES or (slot.main and slot.role == "glass")
        large = count * view.step**2 >= SETTINGS.min_pixels
        if read and large and count >= SETTINGS.min_visible * max(seen.sum(), shown.sum()):
            of_slots[index] = mine
    beside = view.crop(background) & (view.slot < 0)
    seeds = _own_colours(lab, of_slots, beside)
    pixels_of_slots = []
    like = {index: _is_near(lab - seeds[index]) for index in of_slots}
    near = {index: mine & like[index] for index, mine in of_slots.items()}
    for index, mine in of_slots.items():
        unlike = [k for k in of_slots if slots[k].role != slots[index].role and _is_near(seeds[k] - seeds[index])]
        vivid, covered = _is_vivid(seeds[index]), _covers(like[index], beside)
        crossed = vivid and any(near[k].sum() >= SETTINGS.crossed * near[index].sum() for k in unlike)
        behind = index in lost and vivid and covered >= SETTINGS.behind
        others = [of_slots[k] for k in of_slots if k != index and not _is_near(seeds[k] - seeds[index])]
        # A colour of the background is on other slots where one looks past them.
        before = covered < SETTINGS.behind and _is_before_all(like[index], mine, others)
        if not crossed and not behind and not before:
            pixels_of_slots.append(SlotPixels(slots[index], index, near[index], mine))
    return tuple(pixels_of_slots)


def whole_pixels(
    view: SurfaceView, slots: tuple[Slot, ...], visible: Bool[np.ndarray, "h w"]
) -> tuple[SlotPixels, ...]:
    """All that is seen of a small thing as its main slot, of one colour; none where that is hardly anything.

    Args:
        view: The shape in its pose.
        slots: Its slots.
        visible: The object's inner pixels, without what stands before it.
    """
    seen = view.crop(visible) & (view.slot >= 0)
    if np.count_nonzero(seen) * view.step**2 < MIN_OF_WHOLE:
        return ()
    main = ((k, s) for k, s in enumerate(slots) if s.main and (s.role in READ_ROLES or s.role == "glass"))
    return tuple(SlotPixels(s, k, seen, np.zeros_like(seen)) for k, s in main)


def _own_colours(
    lab: Float32[np.ndarray, "gh gw 3"],
    of_slots: Mapping[int, Bool[np.ndarray, "gh gw"]],
    beside: Bool[np.ndarray, "gh gw"],
) -> dict[int, Float32[np.ndarray, "3"]]:
    """The colour of every slot: of those that cover much of it, the first that is not rather its neighbour's.

    A pose a little off, a duvet that hangs over its bed, and the floor between legs put other colours on a slot. Such
    a colour covers more of another slot, in share and in pixels, or of what is `beside` the object; where all of a
    slot's colours do, the one of which that is least true is taken. A large slot does not give up its colour because a
    small one that crosses it is all of it.
    """
    options = {index: _colours_of(lab, mine) for index, mine in of_slots.items()}
    seeds = {index: colours[0] for index, colours in options.items()}
    for index, mine in of_slots.items():
        others = [(of_slots[k], seeds[k]) for k in of_slots if k != index]
        own, shares = [], []
        for seed in options[index]:
            near = _is_near(lab - seed)
            share, pixels = _share(near, mine), np.count_nonzero(near & mine)
            alike = [(near, where) for where, main in others if _is_near(main - seed)]
            # The lit side of a neighbour is its colour, too; what is darker may be something black.
            alike += [(near | _is_near(lab - main), where) for where, main in others if is_shade(main, seed)]
            elsewhere = [_share(of, where) for of, where in alike if np.count_nonzero(of & where) >= pixels]
            elsewhere.append(_covers(near, beside) / SETTINGS.beside)
            own.append(share / max([share, *elsewhere, 1e-9]))
            shares.append(share)
        chosen = int(np.argmax(own))
        main = options[index][chosen]
        as_good = [k for k, score in enumerate(own) if score >= SETTINGS.as_good * own[chosen]]
        much = [options[index][k] for k in as_good if shares[k] >= SETTINGS.min_outlined]
        of_it = [s for s in much if s[0] <= main[0] or _is_not_behind(lab, mine, beside, s)]
        seeds[index] = select_material_colour(main, of_it)
    return seeds


def _is_before_all(
    alike: Bool[np.ndarray, "gh gw"], mine: Bool[np.ndarray, "gh gw"], foreign: Sequence[Bool[np.ndarray, "gh gw"]]
) -> bool:
    """Whether a slot's colour is of what is before the object: on it in part, and as much on slots of other colours."""
    share = _share(alike, mine)
    if share >= SETTINGS.mostly or not foreign:
        return False
    return share < SETTINGS.clearly_own * _share(alike, np.any(foreign, axis=0))


def _is_not_behind(
    lab: Float32[np.ndarray, "gh gw 3"],
    mine: Bool[np.ndarray, "gh gw"],
    beside: Bool[np.ndarray, "gh gw"],
    seed: np.ndarray,
) -> bool:
    """Whether a light colour is a thing's lit side, and not the background seen beside a dark thing."""
    exactly = np.linalg.norm(lab - seed, axis=-1) < SETTINGS.near_lab / 2
    return bool(beside.sum() < SETTINGS.min_pixels or exactly[mine].mean() > SETTINGS.clearly * exactly[beside].mean())


def _is_vivid(seed: np.ndarray) -> bool:
    return bool(np.hypot(*seed[1:]) >= SETTINGS.coloured)


def _covers(alike: Bool[np.ndarray, "gh gw"], where: Bool[np.ndarray, "gh gw"]) -> float:
    """Share of a region that is among pixels of about one colour; 0 of one too small to tell."""
    return _share(alike, where) if np.count_nonzero(where) >= SETTINGS.min_pixels else 0.0


def _colours_of(lab: Float32[np.ndarray, "gh gw 3"], mine: Bool[np.ndarray, "gh gw"]) -> list[Float32[np.ndarray, "3"]]:
    """Medians of the bins of a coarse Lab grid that hold much of a slot, those of the colour that covers most first.

    Bins have grey in their middle, or whites and greys would lie in four of them. Of a colour that lies in several
    bins the fullest one counts, however little it holds: a red back in light and shade covers more than a white board.
    """
    pixels = lab[mine]
    cells = np.floor(pixels / BIN_LAB + (0.0, 0.5, 0.5))
    label, counts = cells_of(cells)
    order = [k for k in np.argsort(-counts, kind="stable") if counts[k] >= SETTINGS.min_of_bin * len(pixels)]
    medians = {k: np.median(pixels[label == k], axis=0) for k in order}
    colours: list[Float32[np.ndarray, "3"]] = []
    while order:
        alike = {k: [j for j in order if _is_near(medians[j] - medians[k])] for k in order}
        covers = {k: sum(int(counts[j]) for j in alike[k]) for k in order}
        group = alike[max(order, key=covers.__getitem__)]
        if colours and sum(int(counts[j]) for j in group) < SETTINGS.min_share * len(pixels):
            break
        colours += [medians[j] for j in group if j == group[0] or counts[j] >= SETTINGS.min_share * len(pixels)]
        order = [k for k in order if k not in group]
    return colours


def _share(alike: Bool[np.ndarray, "gh gw"], where: Bool[np.ndarray, "gh gw"]) -> float:
    return float(alike[where].mean())


def _is_near(difference: np.ndarray) -> np.ndarray:
    """Which differences in CIELAB are those of one colour: shade varies over one surface, hue hardly."""
    return np.asarray(np.linalg.norm(difference / (2.0, 1.0, 1.0), axis=-1) < SETTINGS.near_lab)


def shade_of(view: SurfaceView, pixels: SlotPixels, rgb: UInt8[np.ndarray, "h w 3"]) -> Shade:
    """How bright the slot is at each of its normals.

    Args:
        view: The shape in its pose.
        pixels: The slot's.
        rgb: The photo.
    """
    linear = luminance(srgb_to_linear(view.crop(rgb)[pixels.near] / 255.0))
    label, count = cells_of(np.round(view.normals_world[pixels.near] / SETTINGS.normal_cell))
    of = [label == k for k in np.flatnonzero(count >= SETTINGS.min_face_pixels)]
    normals = np.array([view.normals_world[pixels.near][m].mean(axis=0) for m in of]).reshape(-1, 3)
    brightness = np.array([max(float(np.median(linear[m])), 1e-4) for m in of])
    weight = np.array([float(m.mean()) for m in of])
    return Shade(normals, brightness, weight)


def appearance_of(
    view: SurfaceView,
    pixels: SlotPixels,
    rgb: UInt8[np.ndarray, "h w 3"],
    light: Float32[np.ndarray, "h w 3"],
    weave: UInt8[np.ndarray, "th tw 3"] | None = None,
) -> SlotAppearance:
    """The slot's material under a light, without the gloss that a material of its role has.

    Args:
        view: The shape in its pose.
        pixels: Those of the slot.
        rgb: The photo.
        light: How much falls on every pixel of the photo.
        weave: The texture that the slot has in the library; it gives way to a plain one where the photo shows none.
    """
    linear = srgb_to_linear(view.crop(rgb)[pixels.near] / 255.0)
    lit = view.crop(light)[pixels.near]
    usual, metallic = ROUGHNESS[pixels.slot.role]
    roughness = roughness_seen(linear / lit, metallic, usual)
    albedo = np.median(without_gloss(linear / lit, metallic, roughness, view.cosine[pixels.near][:, None]), axis=0)
    albedo *= min(1.0, MAX_LINEAR / max(float(albedo.max()), 1e-6))  # not channel by channel: the hue stays
    albedo += max(MIN_LINEAR - float(luminance(albedo)), 0.0)
    red, green, blue = (float(c) for c in linear_to_srgb(albedo))
    example = None
    if pixels.slot.role in PATTERNED_ROLES:
        example = best_example(view, pixels.mine, pixels.near, rgb)
    if example is None:
        tile_m = pixels.slot.tile_m if pixels.slot.role in {*WOVEN_ROLES, PRINTED} else None
        # A plain picture takes the place of the library's print always: that is another one's.
        if (
            weave is None
            or tile_m is None
            or not (pixels.slot.role == PRINTED or shows_plain(view, pixels.near, rgb, weave, tile_m))
        ):
            return SlotAppearance(pixels.slot, (red, green, blue), None, 1.0, roughness)
        colour = np.rint(255 * np.clip([red, green, blue], 0, 1)).astype(np.uint8)
        plain = np.tile(colour, (SETTINGS.plain_px, SETTINGS.plain_px, 1))
        return SlotAppearance(pixels.slot, (red, green, blue), plain, tile_m, roughness)
    texture = tileable(_scale_to_albedo(example, albedo))
    return SlotAppearance(pixels.slot, (red, green, blue), texture, example.texel_m * texture.shape[0], roughness)


def _scale_to_albedo(example: Example, albedo: Float[np.ndarray, "3"]) -> Example:
    """The example scaled so that its mean is the slot's albedo."""
    linear = srgb_to_linear(example.colours / 255.0)
    gain = albedo / np.maximum(linear.reshape(-1, 3).mean(axis=0), 1e-4)
    scaled = 255.0 * linear_to_srgb(np.clip(linear * gain, 0.0, 1.0))
    return Example(scaled.astype(np.float32), example.texel_m)
