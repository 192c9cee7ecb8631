"""Flat objects wear the photo: pictures, boards, lit screens, dials, rugs, doors, curtains, books, pillows.

The rectangle of the slot that has the face is placed by the object's pose, brought in line with the object's box in
the photo, and rectified. Frames, mats and stands stay what they are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import cv2
import numpy as np
import trimesh
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.appearance.rectify import Rectified, face_homography, is_cut, outline_px, rectify
from diorama_core.architecture.texture.continuation import complete_texture
from diorama_core.artefacts import SURE_MASK, DetectedObject
from diorama_core.geometry.projection import box_iou
from diorama_core.library.slots import Slot, rectangle_of, slots_of
from diorama_core.library.taxonomy import category, column
from diorama_core.scene.types import Camera, SceneObject, TextureLayout

MAIN = "main"
FACES: Mapping[str, tuple[tuple[str, ...], TextureLayout]] = {
    kind: (roles, category(kind).face_side) for kind, roles in column("face").items()
}
"""By category: roles of the slots that have the face (or the main slot), and which way it faces."""
NOT_RECTANGULAR = frozenset({"pillow"})
"""Categories that fill only the part of their rectangle that their mask holds."""
COVERS = ("leather", "paint", "fabric", "paper", "material")
"""Roles of what books are bound in."""
SEEN_THROUGH = {"screen", "pane"}
"""A shape without a slot of these roles has no such face; of other flat things the main slot has it."""
ROUGHNESS: Mapping[str, float] = {"screen": 0.2, "pane": 0.1, "picture": 0.6, "dial": 0.5, "fabric": 0.95}
Picture = Float32[np.ndarray, "h w 3"]
Mirror = Callable[[np.ndarray], np.ndarray]
MIRRORS: tuple[Mirror, ...] = (
    lambda picture: picture[:, ::-1],
    lambda picture: picture[::-1, ::-1],
    lambda picture: picture[::-1],
)
"""Left to right, half a turn, top to bottom."""


@dataclass(frozen=True)
class FlatFaceSettings:
    """Which flat objects get the photo as their surface."""

    upright: float = 1.15
    lying: float = 0.35
    """Books stand in a row when they are so many times as high as deep, and one lies flat when it is so high against
    its shorter side; stacks show too little of any one face."""
    other_roughness: float = 0.6
    min_seen: float = 0.2
    """A face of which less is seen keeps its own picture."""
    min_in_mask: float = 0.4
    """Share of the posed face that must be the object's own: with less, its picture would be of what is beside it."""
    rim: float = 0.014
    mostly: float = 0.5
    """A box that ends so near the photo's edge (as a share of its longer side; undistorted photos have frames), or
    where that much of what is just inside its side is hidden, does not end the object."""
    pale: int = 245
    """Frames are at least so bright (of 255)."""
    min_box_iou: float = 0.5
    """Boxes that overlap less tell nothing of where exactly the face is."""
    sure_mask: float = SURE_MASK
    dark_side_px: int = 8
    """A screen that is off is of one colour, whatever is mirrored in it."""
    far_px: float = 20_000.0
    lit_l: float = 30.0
    lit_spread_l: float = 12.0
    """A screen is on when its typical lightness, or its lightness' deviation, is at least this."""


SETTINGS = FlatFaceSettings()


@dataclass(frozen=True, eq=False)
class FlatFace:
    """The picture of one slot."""

    slot: Slot
    layout: TextureLayout
    picture: UInt8[np.ndarray, "h w 3"]
    roughness: float


def faces_of(
    item: SceneObject,
    parts: trimesh.Scene,
    rgb: UInt8[np.ndarray, "h w 3"],
    hidden: Bool[np.ndarray, "h w"],
    detected: DetectedObject,
    camera: Camera,
) -> tuple[FlatFace, ...]:
    """The faces of an object that show in the photo; none for objects without a flat face.

    Args:
        item: In the pose in which the photo shows it.
        parts: Its shape.
        rgb: The photo.
        hidden: Where something else stands before it.
        detected: The object in the photo.
        camera: The photo's.
    """
    kind = face_kind(item.category, item.size_m)
    if kind is None:
        return ()
    roles, layout = kind
    slots = slots_of(parts)
    chosen = [s for s in slots if s.role in roles or (s.main and MAIN in roles)]
    if not chosen and not SEEN_THROUGH & set(roles):
        chosen = [s for s in slots if s.main]
    by_mask = detected.mask_confidence >= SETTINGS.sure_mask or item.category in NOT_RECTANGULAR
    unseen = (hidden | ~detected.mask if by_mask else hidden) | pale_frame(rgb) | _pixels_outside_box(detected)
    made = [_face(item, parts, slot, layout, rgb, (hidden, unseen), detected, camera) for slot in chosen]
    return tuple(face for face in made if face is not None)


def face_kind(category: str, size_m: Float[np.ndarray, "3"]) -> tuple[tuple[str, ...], TextureLayout] | None:
    """Roles of the slots that have an object's face, and which way it faces; None where it has none.

    Spines of a row of books face the front, the cover of one that lies flat faces up.
    """
    if category != "books":
        return FACES.get(category)
    if size_m[2] >= SETTINGS.upright * size_m[0]:
        return COVERS, "front"
    return (COVERS, "top") if size_m[2] <= SETTINGS.lying * min(size_m[:2]) else None


def _face(
    item: SceneObject,
    parts: trimesh.Scene,
    slot: Slot,
    layout: TextureLayout,
    rgb: UInt8[np.ndarray, "h w 3"],
    hidden: tuple[Bool[np.ndarray, "h w"], Bool[np.ndarray, "h w"]],
    detected: DetectedObject,
    camera: Camera,
) -> FlatFace | None:
    """The face of one slot; `hidden` is what others hide, and everything that is not to be read."""
    others, unseen = hidden
    rectangle = rectangle_of(parts, slot, layout)
    H = face_homography(camera, item.pose.apply(rectangle.corners))
    if H is None:
        return None
    if not is_cut(H):  # or the box in the photo does not end where the object does
        H = box_alignment(_outline_box(item, parts, camera), detected.box, sides_told(detected.box, others)) @ H
    if _share_in_mask(outline_px(H), others, detected) < SETTINGS.min_in_mask:
        return None
    picture = rectify(rgb, unseen, H)
    if picture is None or picture.seen.mean() < SETTINGS.min_seen:
        return None
    roughness = ROUGHNESS.get(slot.role, SETTINGS.other_roughness)
    if "screen" in FACES.get(item.category, ((), ""))[0] and not is_lit(picture):
        dark = np.median(picture.colours[picture.seen], axis=0).clip(0, 255).astype(np.uint8)
        return FlatFace(slot, layout, np.tile(dark, (SETTINGS.dark_side_px, SETTINGS.dark_side_px, 1)), roughness)
    pixel_m = float(np.linalg.norm(rectangle.across * item.pose.scale)) / picture.seen.shape[1]
    return FlatFace(slot, layout, complete_picture(picture, pixel_m), roughness)


def _pixels_outside_box(detected: DetectedObject) -> Bool[np.ndarray, "h w"]:
    """Pixels that are not in the object's box: whatever its pose says, they show something else."""
    outside = np.ones(detected.mask.shape, dtype=bool)
    x1, y1, x2, y2 = detected.box
    outside[max(math.floor(y1), 0) : math.ceil(y2), max(math.floor(x1), 0) : math.ceil(x2)] = False
    return outside


def _share_in_mask(
    outline: Float[np.ndarray, "n 2"], hidden: Bool[np.ndarray, "h w"], detected: DetectedObject
) -> float:
    """Share of a convex outline, as far as it is in the photo and not hidden, that is within the object's mask."""
    region = np.zeros(detected.mask.shape, np.uint8)
    cv2.fillConvexPoly(region, np.rint(np.clip(outline, -SETTINGS.far_px, SETTINGS.far_px)).astype(np.int32), 1)
    free = region.astype(bool) & ~hidden
    return float((free & detected.mask).sum() / max(int(free.sum()), 1))


def box_alignment(
    projected: Float[np.ndarray, "4"],
    detected: tuple[float, float, float, float],
    cut_sides: tuple[bool, bool, bool, bool] = (True, True, True, True),
) -> Float[np.ndarray, "3 3"]:
    """How pixels move and scale as an object's projected box is to become its box in the photo, as a homography.

    Boxes that hardly overlap leave the pixels where they are.

    Args:
        projected: The whole object's box as it is posed.
        detected: Its box in the photo.
        cut_sides: Which of its left, upper, right and lower side end the object itself (`sides_told`).
    """
    box = np.where(cut_sides, detected, projected)
    A = np.eye(3)
    if float(box_iou(projected, box)) < SETTINGS.min_box_iou:
        return A
    for axis in (0, 1):
        low, high = projected[axis], projected[axis + 2]
        A[axis, axis] = (box[axis + 2] - box[axis]) / max(high - low, 1e-6)
        A[axis, 2] = box[axis] - A[axis, axis] * low
    return A


def pale_frame(rgb: UInt8[np.ndarray, "h w 3"]) -> Bool[np.ndarray, "h w"]:
    """What undistorting left white along a photo's edges, with a small margin."""
    height, width = rgb.shape[:2]
    rim = max(2, round(SETTINGS.rim * max(height, width)))
    white = (rgb.min(axis=2) >= SETTINGS.pale).astype(np.uint8)
    white[rim:-rim, rim:-rim] = 0
    _, labels = cv2.connectedComponents(white)
    lines = [labels[0], labels[-1], labels[:, 0], labels[:, -1]]
    framed = [line[line > 0] for line in lines if (line > 0).mean() >= SETTINGS.mostly]
    if not framed:
        return np.zeros((height, width), dtype=bool)
    frame = np.isin(labels, np.unique(np.concatenate(framed)))
    return cv2.dilate(frame.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(bool)


def sides_told(
    box: tuple[float, float, float, float], hidden: Bool[np.ndarray, "h w"]
) -> tuple[bool, bool, bool, bool]:
    """Which sides of a box (left, upper, right, lower) end the object, and not the photo or what hides it."""
    height, width = hidden.shape
    rim = max(2.0, SETTINGS.rim * max(height, width))
    at_edge = (box[0] <= rim, box[1] <= rim, box[2] >= width - rim, box[3] >= height - rim)
    x1, y1, x2, y2 = (max(round(v), 0) for v in box)
    inside = hidden[y1:y2, x1:x2]
    deep = max(1, round(rim))
    strips = (inside[:, :deep], inside[:deep], inside[:, -deep:], inside[-deep:])
    left, upper, right, lower = (
        not edge and (strip.size == 0 or float(strip.mean()) < SETTINGS.mostly)
        for edge, strip in zip(at_edge, strips, strict=True)
    )
    return left, upper, right, lower


def is_lit(screen: Rectified) -> bool:
    """Whether a screen shows something: one that is off is dark, and has at most a dim reflection."""
    pixels = screen.colours[screen.seen][:, None].clip(0, 255) / 255.0
    lightness = cv2.cvtColor(pixels.astype(np.float32), cv2.COLOR_RGB2Lab)[..., 0]
    return bool(np.median(lightness) >= SETTINGS.lit_l or lightness.std() >= SETTINGS.lit_spread_l)


def _outline_box(item: SceneObject, parts: trimesh.Scene, camera: Camera) -> Float[np.ndarray, "4"]:
    placed = [(parts.geometry[name], to_shape) for to_shape, name in map(parts.graph.get, parts.graph.nodes_geometry)]
    corners = np.concatenate([trimesh.transform_points(mesh.vertices, to_shape) for mesh, to_shape in placed])
    pixels = camera.project(item.pose.apply(corners))
    return np.concatenate([pixels.min(axis=0), pixels.max(axis=0)])


@dataclass(frozen=True)
class CompletionSettings:
    """How a partly seen picture is completed."""

    min_overlap: float = 0.12
    """Share of a picture that must be seen together with its mirror image to tell whether they are alike."""
    alike: float = 0.35
    """Mean difference to the mirror image, as a share of the picture's own variation, at which it is symmetric."""
    max_levels: float = 16.0
    """Largest difference, in levels of 255."""
    completed_side_px: int = 224
    """Longer side at which what was not seen is made up."""
    wholly: float = 0.99
    """A reduced texel is known when so much of it was seen."""
    most: float = 0.75
    much_more: float = 2.0
    """What differs by more than so many times this quantile of all differences is not carried on."""
    rim_share: float = 0.006
    """Beside what is hidden so much of the longer side is given up: masks are a little small."""


COMPLETION_SETTINGS = CompletionSettings()


def complete_picture(rectified: Rectified, pixel_m: float) -> UInt8[np.ndarray, "h w 3"]:
    """The whole picture, of which at least something is seen."""
    rim = round(COMPLETION_SETTINGS.rim_share * max(rectified.seen.shape))
    seen = cv2.erode(rectified.seen.astype(np.uint8), np.ones((2 * rim + 1,) * 2, np.uint8), borderValue=1).astype(bool)
    if not seen.any():
        seen = rectified.seen
    colours, seen = fill_from_mirror_images(rectified.colours, seen)
    if seen.all():
        return colours.clip(0, 255).astype(np.uint8)
    behind = _complete_at_low_resolution(colours, seen, pixel_m)
    share = cv2.GaussianBlur(cv2.erode(seen.astype(np.float32), np.ones((3, 3))), (0, 0), 1.5)[..., None]
    mixed = share * seen[..., None]
    return (mixed * colours + (1.0 - mixed) * behind).clip(0, 255).astype(np.uint8)


def _complete_at_low_resolution(colours: Picture, seen: Bool[np.ndarray, "h w"], pixel_m: float) -> Picture:
    """The picture completed at a reduced size: what nobody saw needs no more than its material and its shade."""
    height, width = seen.shape
    factor = min(1.0, COMPLETION_SETTINGS.completed_side_px / max(height, width))
    size = (max(4, round(width * factor)), max(4, round(height * factor)))
    weight = cv2.resize(seen.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    if weight.max() < COMPLETION_SETTINGS.wholly:
        return np.broadcast_to(np.median(colours[seen], axis=0), colours.shape).astype(np.float32)
    small = cv2.resize(colours, size, interpolation=cv2.INTER_AREA)
    known = weight >= COMPLETION_SETTINGS.wholly
    usual = _usual(small, known)
    red, green, blue = (float(c) / 255.0 for c in np.median(small[usual], axis=0))
    whole = complete_texture(small, known, (red, green, blue), pixel_m / factor, usual, ground=True)
    return cv2.resize(whole, (width, height), interpolation=cv2.INTER_LINEAR).astype(np.float32)


def _usual(colours: Picture, known: Bool[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """What is known without hems, creases and shadows: texels that differ much more than most from the median."""
    difference = np.abs(colours - np.median(colours[known], axis=0)).max(axis=-1)
    most = float(np.quantile(difference[known], COMPLETION_SETTINGS.most))
    return np.asarray(known & (difference <= max(COMPLETION_SETTINGS.much_more * most, COMPLETION_SETTINGS.max_levels)))


def fill_from_mirror_images(colours: Picture, seen: Bool[np.ndarray, "h w"]) -> tuple[Picture, Bool[np.ndarray, "h w"]]:
    """Fill in what is hidden from mirror images of the picture that it is alike."""
    smooth = None
    for mirror in MIRRORS:
        other, is_seen = mirror(colours), mirror(seen)
        both = seen & is_seen
        if not (is_seen & ~seen).any() or both.mean() < COMPLETION_SETTINGS.min_overlap:
            continue
        smooth = _smooth(colours) if smooth is None else smooth
        if not _alike(smooth[both], mirror(smooth)[both]):
            continue
        gained = is_seen & ~seen
        share = cv2.GaussianBlur(cv2.erode(seen.astype(np.float32), np.ones((3, 3))), (0, 0), 1.5)[..., None]
        blended = np.where(seen[..., None], colours, other)
        colours = np.where(both[..., None], share * colours + (1 - share) * other, blended).astype(np.float32)
        seen, smooth = seen | gained, None
    return colours, seen


def _smooth(colours: Picture) -> Picture:
    return cv2.GaussianBlur(colours, (0, 0), max(1.0, 0.01 * max(colours.shape)))


def _alike(a: Float32[np.ndarray, "n 3"], b: Float32[np.ndarray, "n 3"]) -> bool:
    """Whether the smoothed colours of places and of their mirror images are nearly the same."""
    spread = float(a.std(axis=0).mean())
    difference = float(np.abs(a - b).mean())
    return difference < COMPLETION_SETTINGS.max_levels and difference < COMPLETION_SETTINGS.alike * max(spread, 1.0)
