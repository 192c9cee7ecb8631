"""Each plane's own picture: the photo rectified onto it, completed where something hides it or it is out of view."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.architecture.colours import object_pixels
from diorama_core.artefacts import DetectedObject, Inputs
from diorama_core.geometry.casting import cast_planes
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.types import Architecture, Camera, Plane

MAX_SIDE_PX = 512
PIXELS_PER_M = 150.0
MIN_SEEN_SHARE = 0.06
"""A plane seen in less of its area keeps its plain colour."""
MIN_SEEN_PX = 400
MAX_GRAZING_COSINE = 0.06
"""Where the plane is seen more edge-on than this the photo is smeared and not used."""
GRAIN_LEAST_PX = 12
EVEN_LEVELS = 14.0
"""A patch whose colour varies more than this (of 255) over its breadth is a pattern or a rug, not a grain."""
FRAME = 0.014
"""Rim of the picture that is not used, as a share of its longer side: undistorted photos have pale frames there."""
ISLAND_M = 0.22
"""Pieces of a plane narrower than this are mostly rims, shadows and leaves of what stands before it."""
ISLAND_SHARE = 0.04
"""Pieces apart from the rest with a smaller share of all that is seen are given up too."""
RIM = 0.008
"""Widening of what hides the room beyond its masks' own margin, as a share of the picture's longer side."""
SURE_MASK = 0.95
FOREIGN_SPREADS = 2.5
FOREIGN_LEAST_LAB = np.array([14.0, 9.0, 9.0])
"""A floor's texel is foreign when it differs by more than this many typical deviations, and by this much at least."""
FADE_M = 0.6
"""Far from what is seen, the picture fades to the plane's plain colour over this length."""


def plane_textures(
    inputs: Inputs, objects: tuple[DetectedObject, ...], camera: Camera, architecture: Architecture
) -> dict[str, UInt8[np.ndarray, "h w 3"]]:
    """RGB pictures of the planes that are seen well enough, by plane id.

    Texture coordinates are `geometry.planes.plane_uv`: row 0 is v = 1. At most `MAX_SIDE_PX` a side.

    Args:
        inputs: The photo.
        objects: What hides the room; their masks are painted out.
        camera: The photo's camera.
        architecture: The room, with its plain colours.
    """
    shape = (inputs.photo.height, inputs.photo.width)
    unsure = [o for o in objects if o.mask_confidence < SURE_MASK]
    hidden = _grown(object_pixels(shape, objects)) | _boxes(shape, unsure)
    found: dict[str, np.ndarray] = {}
    for plane in architecture.planes:
        points, pixel_m = _texel_points(plane)
        colours, seen = _seen_colours(inputs.photo.rgb, hidden, camera, architecture.planes, plane, points)
        if unsure and plane.role == "floor":
            seen &= ~_foreign(colours, seen)
        seen = _without_islands(seen, ISLAND_M / pixel_m)
        if unsure and plane.role == "floor" and not _grain(colours, seen).any():
            # Patches of an uneven floor between guessed masks look worse than its plain colour.
            continue
        if seen.mean() >= MIN_SEEN_SHARE and seen.sum() >= MIN_SEEN_PX:
            found[plane.id] = completed(colours, seen, plane.colour, FADE_M / pixel_m, grainy=plane.role == "floor")
    return found


def _without_islands(seen: Bool[np.ndarray, "h w"], width_px: float) -> Bool[np.ndarray, "h w"]:
    """What is left when narrow pieces between things that hide the plane, and small separate ones, are given up."""
    side = max(3, round(width_px) | 1)
    opened = cv2.morphologyEx(seen.astype(np.uint8), cv2.MORPH_OPEN, np.ones((side, side), np.uint8))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(opened)
    large = stats[:, cv2.CC_STAT_AREA] >= ISLAND_SHARE * max(int(opened.sum()), 1)
    large[0] = False
    return large[labels] if count > 1 else opened.astype(bool)


def _grown(hidden: Bool[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """A wider margin, and gaps between legs and leaves closed: what shows there is mostly shadow and rims."""
    rim = max(2, round(RIM * max(hidden.shape)))
    gap = 2 * rim
    wide = cv2.dilate(hidden.astype(np.uint8), np.ones((2 * (rim + gap) + 1,) * 2, np.uint8))
    return cv2.erode(wide, np.ones((2 * gap + 1,) * 2, np.uint8), borderValue=1).astype(bool)


def _boxes(shape: tuple[int, int], objects: list[DetectedObject]) -> Bool[np.ndarray, "h w"]:
    """Whole boxes of objects whose masks may have missed legs and arms, with a margin."""
    covered = np.zeros(shape, dtype=bool)
    margin = 0.012 * max(shape)
    for found in objects:
        x1, y1, x2, y2 = found.box
        rows = slice(max(0, int(y1 - margin)), int(y2 + margin) + 1)
        covered[rows, max(0, int(x1 - margin)) : int(x2 + margin) + 1] = True
    return covered


def _foreign(colours: Float32[np.ndarray, "h w 3"], seen: Bool[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """Texels far from what most of a floor looks like: things nobody pointed at, smeared over it."""
    lab = cv2.cvtColor(colours / 255.0, cv2.COLOR_RGB2LAB)
    if not seen.any():
        return np.zeros(seen.shape, dtype=bool)
    deviation = np.abs(lab - np.median(lab[seen], axis=0))
    typical = np.median(deviation[seen], axis=0)
    far = (deviation / np.maximum(FOREIGN_SPREADS * typical, FOREIGN_LEAST_LAB)).max(axis=-1) > 1.0
    compact = cv2.morphologyEx((far & seen).astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    return cv2.dilate(compact, np.ones((9, 9), np.uint8)).astype(bool)


def _texel_points(plane: Plane) -> tuple[Float[np.ndarray, "h w 3"], float]:
    """World points of the texels' centres, top row first, and a texel's size in metres."""
    origin, axes, extents = plane_rectangle(plane)
    pixel_m = max(1.0 / PIXELS_PER_M, float(extents.max()) / MAX_SIDE_PX)
    width, height = np.maximum(np.ceil(extents / pixel_m - 1e-6), 2).astype(int)
    across = (np.arange(width) + 0.5) / width * extents[0]
    up = (1.0 - (np.arange(height) + 0.5) / height) * extents[1]
    grid = np.stack(np.meshgrid(across, up), axis=-1)
    return origin + grid @ axes.T, pixel_m


def _seen_colours(
    rgb: UInt8[np.ndarray, "hp wp 3"],
    hidden: Bool[np.ndarray, "hp wp"],
    camera: Camera,
    planes: tuple[Plane, ...],
    plane: Plane,
    points: Float[np.ndarray, "h w 3"],
) -> tuple[Float32[np.ndarray, "h w 3"], Bool[np.ndarray, "h w"]]:
    """The photo's colour at each texel, and whether that is the plane: in view, unhidden and not too aslant."""
    pixels = camera.project(points).astype(np.float32)
    depth = camera.to_camera(points)[..., 2]
    k = camera.intrinsics
    frame = 1.0 + FRAME * max(k.width, k.height)
    seen = (depth > 0.05) & (pixels > frame).all(axis=-1) & (pixels < [k.width - frame, k.height - frame]).all(axis=-1)
    rays = points - camera.position
    distance = np.linalg.norm(rays, axis=-1)
    seen &= -(rays @ plane.normal) > MAX_GRAZING_COSINE * distance
    if seen.any():
        nearest = cast_planes(camera.position, rays[seen], tuple(p for p in planes if p.id != plane.id))[0]
        seen[seen] = nearest > 0.995
    columns, rows = np.moveaxis(np.where(seen[..., None], pixels, 0).astype(int), -1, 0)
    seen &= ~hidden[rows, columns]
    lookup = np.where(seen[..., None], pixels - 0.5, 0).astype(np.float32)
    colours = cv2.remap(rgb, lookup, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return colours.astype(np.float32), seen


def completed(
    colours: Float32[np.ndarray, "h w 3"],
    seen: Bool[np.ndarray, "h w"],
    plain: tuple[float, float, float],
    fade_px: float,
    *,
    grainy: bool = False,
) -> UInt8[np.ndarray, "h w 3"]:
    """Fills what is not seen smoothly from what is, fading to the plain colour away from it.

    Colours spread through an image pyramid (pull-push, Gortler et al. 1996), which leaves no streaks. With `grainy`
    the fine detail of the largest seen patch goes on over the rest, as carpets and boards do.
    """
    smooth = _pull_push(colours * seen[..., None], seen.astype(np.float32))
    distance = cv2.distanceTransform((~seen).astype(np.uint8), cv2.DIST_L2, 5)
    keep = np.exp(-distance / max(fade_px, 1.0))[..., None]
    filled = keep * smooth + (1.0 - keep) * (np.array(plain, np.float32) * 255.0)
    if grainy:
        filled = filled + _grain(colours, seen)
    # The first texels inside a mask's border still carry its rim; a soft seam hides the step.
    inner = cv2.erode(seen.astype(np.float32), np.ones((5, 5), np.uint8))
    weight = cv2.GaussianBlur(inner, (0, 0), 2.0)[..., None] * seen[..., None]
    return (weight * colours + (1.0 - weight) * filled).clip(0, 255).astype(np.uint8)


def _grain(colours: Float32[np.ndarray, "h w 3"], seen: Bool[np.ndarray, "h w"]) -> Float32[np.ndarray, "h w 3"]:
    """Detail of the largest wholly seen square, mirrored over the plane; zero when that is too small or uneven."""
    height, width = seen.shape
    ringed = cv2.copyMakeBorder(seen.astype(np.uint8), 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    reach = cv2.distanceTransform(ringed, cv2.DIST_C, 3)[1:-1, 1:-1]
    row, column = np.unravel_index(int(reach.argmax()), reach.shape)
    half = int(reach.max()) - 3
    if half < GRAIN_LEAST_PX:
        return np.zeros_like(colours)
    patch = colours[row - half : row + half, column - half : column + half]
    broad = cv2.GaussianBlur(patch, (0, 0), half / 8.0)
    detail = patch - broad
    if broad.std(axis=(0, 1)).max() > EVEN_LEVELS or np.abs(detail).max() > 6.0 * detail.std() + EVEN_LEVELS:
        return np.zeros_like(colours)
    mirrored = np.concatenate([detail, detail[::-1]])
    mirrored = np.concatenate([mirrored, mirrored[:, ::-1]], axis=1)
    period = 4 * half
    rows = (np.arange(height) - row + half) % period
    columns = (np.arange(width) - column + half) % period
    return mirrored[np.ix_(rows, columns)]


def _pull_push(
    weighted: Float32[np.ndarray, "h w 3"], weight: Float32[np.ndarray, "h w"]
) -> Float32[np.ndarray, "h w 3"]:
    """Average colours from ever coarser levels where finer ones know none."""
    height, width = weight.shape
    average = weighted / np.maximum(weight, 1e-6)[..., None]
    if min(height, width) <= 2:
        total = float(weight.sum())
        mean = weighted.reshape(-1, 3).sum(axis=0) / max(total, 1e-6)
        return np.where(weight[..., None] > 1e-3, average, mean).astype(np.float32)
    size = ((width + 1) // 2, (height + 1) // 2)
    coarse = _pull_push(
        cv2.resize(weighted, size, interpolation=cv2.INTER_AREA), cv2.resize(weight, size, interpolation=cv2.INTER_AREA)
    )
    above = cv2.resize(coarse, (width, height), interpolation=cv2.INTER_LINEAR)
    share = np.clip(weight, 0.0, 1.0)[..., None]
    return (share * average + (1.0 - share) * above).astype(np.float32)
