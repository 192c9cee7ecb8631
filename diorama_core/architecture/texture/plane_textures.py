"""Plane textures: the photo rectified onto each plane, completed where occluded or out of view."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.architecture.texture.colours import object_pixels
from diorama_core.architecture.texture.continuation import complete_texture
from diorama_core.architecture.texture.continued_objects import cut_patches, find_continued_objects, object_colours
from diorama_core.architecture.texture.floor_material import contact_pixels, floor_texels, white_level
from diorama_core.architecture.texture.level_light import level_light
from diorama_core.artefacts import SURE_MASK, DetectedObject, Inputs
from diorama_core.geometry.casting import cast_planes
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.geometry.vectors import alike
from diorama_core.protocols import EmptyRoomFiller
from diorama_core.scene.types import Architecture, Camera, Plane

MAX_SIDE_PX = 1024
MAX_CEILING_PX = 512
"""Longest side of a ceiling's picture: little of it is in a photo, and what is there is plain."""
PIXELS_PER_M = 150.0
MIN_SEEN_SHARE = 0.06
"""Minimum visible share of a plane's area for a texture; below it the plane keeps its plain colour."""
MIN_SEEN_PX = 400
MIN_FLOOR_M2 = 0.08
"""Except a floor, of which so much is enough to continue its material from."""
MAX_GRAZING_COSINE = 0.06
"""Where the plane is seen more edge-on than this the photo is smeared and not used."""
FRAME = 0.014
"""Rim of the picture that is not used, as a share of its longer side: undistorted photos have pale frames there."""
ISLAND_M = 0.22
"""Pieces of a plane narrower than this are mostly rims, shadows and leaves of what stands before it."""
FLOOR_ISLAND_M = 0.1
"""For a floor, whose colours were looked at already."""
GRAIN_M = 0.01
"""Half the width of a floor's specks and lines that are its material's, though of another colour."""
ISLAND_SHARE = 0.04
"""Pieces apart from the rest with a smaller share of all that is seen are given up too."""
RIM = 0.008
"""Widening of what hides the room beyond its masks' own margin, as a share of the picture's longer side."""
PAINTED = 1e-3
"""How much what an inpainting network painted counts beside what another photo shows."""
SHARP, NEAREST = 0.25, 0.9
"""Texels that cover at least such a share of the photo beside the texel of this quantile are sharp."""
COLOUR_CELL_LAB = np.array([14.0, 8.0, 8.0])
"""Colours within about this much are one material in light and shade."""
EXPECTED_LAB = 8.0
"""Colours that differ by this from the expected one count less by a factor of e."""
FOREIGN_SPREADS = 2.5
FOREIGN_MIN_LAB = np.array([14.0, 9.0, 9.0])
"""A texel is foreign when it differs by more than this many typical deviations, and by this much at least."""
SMALL_M2, CUT_SHARE = 0.4, 0.1
"""A foreign piece smaller than this is given up where so much of its outline borders on what was not seen."""
STANDING_M2, FOOT_SHARE = 0.8, 0.25
"""Larger ones up to this only where so much of their width ends below at what was not seen, or on the floor."""
STRAY_SHARE = 0.25
"""None that is more of all that is seen: there may be two materials."""
STRAY_RIM_M = 0.03
"""So much around them is given up too."""
EDGE_M, SKIRTING = 0.18, 4.0
"""Except skirtings and mouldings: within so much of a wall's foot or top, so many times as long as high."""
MIN_TYPICAL = 0.06
"""Where less than this share of what is seen has about one colour, all of it is continued."""


@dataclass(frozen=True, eq=False)
class RoomPicture:
    """One photo of the room, with what hides the room in it."""

    rgb: UInt8[np.ndarray, "h w 3"]
    """In white light."""
    objects: tuple[DetectedObject, ...]
    """Their masks are left out."""
    camera: Camera
    standing: Collection[str] | None = None
    """Ids of the objects on the floor, at whose feet it is seen; all objects where it is None."""
    filler: EmptyRoomFiller | None = None
    """Paints what stands in the room out of the photo; without one every plane is continued by itself."""
    unmarked: Bool[np.ndarray, "h w"] | None = None
    """Where things hide the room that nobody marked in this photo."""


@dataclass(frozen=True, eq=False)
class PlaneView:
    """What one photo shows of a plane, on the texels of its picture."""

    colours: Float32[np.ndarray, "h w 3"]
    """0 to 255, meaningful where seen."""
    seen: Bool[np.ndarray, "h w"]
    own: Bool[np.ndarray, "h w"]
    """Those seen that show the plane's own material."""
    shown: Bool[np.ndarray, "h w"]
    """Those seen, and those before which something was seen that nobody marked."""
    share: Float[np.ndarray, "h w"]
    """How much of the photo a texel covers, up to a factor; hardly any where it was painted."""

    @property
    def sharp(self) -> Bool[np.ndarray, "h w"]:
        """The own texels that are seen from about as near as the nearest ones: farther ones are blurred."""
        if not self.own.any():
            return self.own
        return np.asarray(self.own & (self.share >= SHARP * np.quantile(self.share[self.own], NEAREST)))


def plane_textures(
    inputs: Inputs,
    objects: tuple[DetectedObject, ...],
    camera: Camera,
    architecture: Architecture,
    filler: EmptyRoomFiller | None = None,
    standing: Collection[str] | None = None,
    only: Collection[str] | None = None,
) -> dict[str, UInt8[np.ndarray, "_ _ 3"]]:
    """RGB pictures of the planes that are seen well enough, by plane id.

    Texture coordinates are `geometry.planes.plane_uv`: row 0 is v = 1. At most `MAX_SIDE_PX` a side.

    Args:
        inputs: The photo.
        objects: What hides the room; their masks are painted out.
        camera: The photo's camera.
        architecture: The room, with its plain colours.
        filler: Paints what stands in the room out of the photo; without one every plane is continued by itself.
        standing: Ids of the objects on the floor, at whose feet it is seen; all objects by default.
        only: Ids of the planes to make pictures of; all by default.
    """
    planes = [plane for plane in architecture.planes if only is None or plane.id in only]
    if not planes:
        return {}  # the room need not be painted empty for that
    view = PhotoView(RoomPicture(inputs.photo.rgb, objects, camera, standing, filler))
    textures: dict[str, np.ndarray] = {}
    for plane in planes:
        points, pixel_m = texel_points(plane)
        seen = view.plane_view(plane, architecture.planes, points, pixel_m)
        if seen is not None and is_enough(seen.shown, pixel_m, plane):
            textures[plane.id] = plane_picture(plane, seen.colours, seen.seen, pixel_m, seen.own, seen.sharp)
    return textures


def plane_picture(
    plane: Plane,
    colours: Float32[np.ndarray, "h w 3"],
    seen: Bool[np.ndarray, "h w"],
    pixel_m: float,
    is_plane: Bool[np.ndarray, "h w"],
    sharp: Bool[np.ndarray, "h w"],
) -> UInt8[np.ndarray, "h w 3"]:
    """The picture of a plane, completed; a floor's without the photo's light.

    Args:
        plane: One of the room's.
        colours, seen, pixel_m, is_plane, sharp: As for `continuation.complete_texture`.
    """
    ground = plane.role == "floor"
    colours = level_light(colours, is_plane, pixel_m) if ground else colours
    return complete_texture(colours, seen, plane.colour, pixel_m, is_plane, ground=ground, sharp=sharp)


class PhotoView:
    """A photo ready to be looked at plane by plane."""

    def __init__(self, picture: RoomPicture) -> None:
        shape = picture.rgb.shape[:2]
        unsure = [o for o in picture.objects if o.mask_confidence < SURE_MASK]
        masked = object_pixels(shape, picture.objects) | cut_patches(picture.rgb, unsure)
        masked = _grow_mask(masked if picture.unmarked is None else masked | picture.unmarked)
        hidden = masked | _boxes(shape, unsure)
        rgb, painted = picture.rgb, np.zeros(shape, dtype=bool)
        if picture.filler is not None and hidden.any():
            rgb, painted = picture.filler.fill(rgb, hidden), hidden
            masked = hidden = np.zeros(shape, dtype=bool)
        standing = picture.standing
        on_floor = [o for o in picture.objects if standing is None or o.id in standing]
        self._rgb, self._camera = rgb, picture.camera
        self._masked, self._hidden, self._painted = masked, hidden, painted
        self._contact = contact_pixels(shape, on_floor) & ~masked
        self._white = white_level(rgb)
        self._of_objects = () if picture.filler is not None else object_colours(rgb, unsure)

    def plane_view(
        self, plane: Plane, planes: tuple[Plane, ...], points: Float[np.ndarray, "h w 3"], pixel_m: float
    ) -> PlaneView | None:
        """View of a plane in the photo; None where too little of it is seen to tell its material.

        Args:
            plane: One of the room's.
            planes: All of them.
            points: The texels' centres (`texel_points`).
            pixel_m: Their size.
        """
        ground = plane.role == "floor"
        # Boxes of objects hide nearly all of a floor; there, what an unsure mask left over is told by its colour.
        hidden = self._masked if ground else self._hidden
        colours, seen = _sample_visible_colours(self._rgb, hidden, self._camera, planes, plane, points)
        share = _photo_share(points, plane, self._camera)
        if ground:
            contact = _sample_at_texels(self._contact, self._camera, points) & seen
            floor = floor_texels(colours, seen, share, contact, pixel_m, self._white)
            seen = _without_islands(_with_grain(floor, pixel_m) & seen, FLOOR_ISLAND_M / pixel_m)
        else:
            seen = _without_islands(seen, ISLAND_M / pixel_m)
        if seen.sum() < MIN_SEEN_PX:
            return None
        is_plane = shown = seen
        if not ground:
            is_plane = _own(colours, seen, share, plane.colour)
            wall = plane.role == "wall"
            stray = strays(seen, is_plane, pixel_m, wall=wall)
            if wall:
                foreign = seen & ~is_plane
                where = self._camera.project(points[foreign])
                longest = max(self._rgb.shape[:2])
                stray |= find_continued_objects(colours, is_plane, foreign, where, self._of_objects, pixel_m, longest)
            seen = _without_islands(seen & ~stray, ISLAND_M / pixel_m)
        if self._painted.any():
            share = np.where(_sample_at_texels(self._painted, self._camera, points), PAINTED * share, share)
        return PlaneView(colours, seen, is_plane & seen, shown, share)


def is_enough(seen: Bool[np.ndarray, "h w"], pixel_m: float, plane: Plane) -> bool:
    """Whether so much of a plane is seen that it gets a picture."""
    enough_m2 = MIN_FLOOR_M2 if plane.role == "floor" else np.inf
    return bool(seen.sum() >= MIN_SEEN_PX and (seen.mean() >= MIN_SEEN_SHARE or seen.sum() * pixel_m**2 >= enough_m2))


def _without_islands(seen: Bool[np.ndarray, "h w"], width_px: float) -> Bool[np.ndarray, "h w"]:
    """What is left when narrow pieces between objects that hide the plane, and small separate ones, are given up."""
    side = max(3, round(width_px) | 1)
    opened = cv2.morphologyEx(seen.astype(np.uint8), cv2.MORPH_OPEN, np.ones((side, side), np.uint8))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(opened)
    large = stats[:, cv2.CC_STAT_AREA] >= ISLAND_SHARE * max(int(opened.sum()), 1)
    large[0] = False
    return large[labels] if count > 1 else opened.astype(bool)


def _with_grain(floor: Bool[np.ndarray, "h w"], pixel_m: float) -> Bool[np.ndarray, "h w"]:
    """A floor with its grain: gaps between boards, knots and threads are its material's and cut no piece in two."""
    side = 2 * max(1, round(GRAIN_M / pixel_m)) + 1
    around = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    return cv2.morphologyEx(floor.astype(np.uint8), cv2.MORPH_CLOSE, around).astype(bool)


def _grow_mask(hidden: Bool[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """A wider margin, and gaps between legs and leaves closed: what shows there is mostly shadow and rims."""
    rim = max(2, round(RIM * max(hidden.shape)))
    gap = 2 * rim
    wide = cv2.dilate(hidden.astype(np.uint8), np.ones((2 * (rim + gap) + 1,) * 2, np.uint8))
    return cv2.erode(wide, np.ones((2 * gap + 1,) * 2, np.uint8), borderValue=1).astype(bool)


def _boxes(shape: tuple[int, int], objects: list[DetectedObject]) -> Bool[np.ndarray, "h w"]:
    """Whole boxes of objects whose masks may have missed legs and arms, with a margin."""
    covered = np.zeros(shape, dtype=bool)
    margin = 0.012 * max(shape)
    for detected in objects:
        x1, y1, x2, y2 = detected.box
        rows = slice(max(0, int(y1 - margin)), int(y2 + margin) + 1)
        covered[rows, max(0, int(x1 - margin)) : int(x2 + margin) + 1] = True
    return covered


def _foreign(
    colours: Float32[np.ndarray, "h w 3"],
    seen: Bool[np.ndarray, "h w"],
    weight: Float[np.ndarray, "h w"],
    expected: tuple[float, float, float],
) -> Bool[np.ndarray, "h w"]:
    """Texels unlike the wall's own colour: objects nobody pointed at, posters.

    Its own colour is the one that covers much of the photo and is about what was expected.
    """
    if not seen.any():
        return np.zeros(seen.shape, dtype=bool)
    rows, columns = np.nonzero(seen)
    lab = cv2.cvtColor(colours[rows, columns][:, None] / 255.0, cv2.COLOR_RGB2LAB)[:, 0]
    every = max(1, len(rows) // 4000)
    sample = lab[::every]
    hoped = cv2.cvtColor(np.array([[expected]], np.float32), cv2.COLOR_RGB2LAB)[0, 0]
    share = weight[rows[::every], columns[::every]]
    cells, index = np.unique(np.round(sample / COLOUR_CELL_LAB), axis=0, return_inverse=True)
    covered = np.bincount(index.ravel(), weights=share)
    best, median = -1.0, np.median(sample, axis=0)
    for cell in cells[np.argsort(-covered, kind="stable")][:8]:
        near = alike(sample, cell * COLOUR_CELL_LAB, COLOUR_CELL_LAB)
        likely = float(np.exp(-np.linalg.norm(cell * COLOUR_CELL_LAB - hoped) / EXPECTED_LAB))
        score = float(share[near].sum()) * likely
        if score > best:
            best, median = score, np.median(sample[near], axis=0)
    deviation = np.abs(lab - median)
    near = alike(lab, median, 2.0 * COLOUR_CELL_LAB)
    typical = np.median(deviation[near] if near.any() else deviation, axis=0)
    far = np.zeros(seen.shape, np.uint8)
    far[rows, columns] = (deviation > np.maximum(FOREIGN_SPREADS * typical, FOREIGN_MIN_LAB)).any(axis=-1)
    compact = cv2.morphologyEx(far, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    return cv2.dilate(compact, np.ones((9, 9), np.uint8)).astype(bool)


def _photo_share(points: Float[np.ndarray, "h w 3"], plane: Plane, camera: Camera) -> Float[np.ndarray, "h w"]:
    """How much of the photo each texel covers, up to one factor: it shrinks with distance and with slant."""
    rays = points - camera.position
    distance = np.maximum(np.sqrt(np.einsum("hwk,hwk->hw", rays, rays)), 0.1)
    return np.asarray(np.maximum(-(rays @ plane.normal), 0.0) / distance**3)


def _sample_at_texels(
    photo: Bool[np.ndarray, "hp wp"], camera: Camera, points: Float[np.ndarray, "h w 3"]
) -> Bool[np.ndarray, "h w"]:
    """Value of a map of the photo's pixels at each texel; meaningless behind the camera."""
    pixels = np.nan_to_num(camera.project(points))
    rows = np.clip(pixels[..., 1], 0, photo.shape[0] - 1).astype(int)
    return np.asarray(photo[rows, np.clip(pixels[..., 0], 0, photo.shape[1] - 1).astype(int)])


def texel_points(plane: Plane) -> tuple[Float[np.ndarray, "h w 3"], float]:
    """World points of the texels' centres, top row first, and a texel's size in metres."""
    origin, axes, extents = plane_rectangle(plane)
    most = MAX_CEILING_PX if plane.role == "ceiling" else MAX_SIDE_PX
    pixel_m = max(1.0 / PIXELS_PER_M, float(extents.max()) / most)
    width, height = np.maximum(np.ceil(extents / pixel_m - 1e-6), 2).astype(int)
    across = (np.arange(width) + 0.5) / width * extents[0]
    up = (1.0 - (np.arange(height) + 0.5) / height) * extents[1]
    grid = np.stack(np.meshgrid(across, up), axis=-1)
    return origin + grid @ axes.T, pixel_m


def _sample_visible_colours(
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
    x, y = pixels[..., 0], pixels[..., 1]
    seen = (depth > 0.05) & (x > frame) & (y > frame) & (x < k.width - frame) & (y < k.height - frame)
    rays = points[seen] - camera.position
    seen[seen] = -(rays @ plane.normal) > MAX_GRAZING_COSINE * np.linalg.norm(rays, axis=-1)
    if seen.any():
        rays = points[seen] - camera.position
        nearest = cast_planes(camera.position, rays, tuple(p for p in planes if p.id != plane.id))[0]
        seen[seen] = nearest > 0.995
    columns, rows = np.moveaxis(np.where(seen[..., None], pixels, 0).astype(int), -1, 0)
    seen &= ~hidden[rows, columns]
    lookup = np.where(seen[..., None], pixels - 0.5, 0).astype(np.float32)
    colours = cv2.remap(rgb, lookup, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return colours.astype(np.float32), seen


def _own(
    colours: Float32[np.ndarray, "h w 3"],
    seen: Bool[np.ndarray, "h w"],
    weight: Float[np.ndarray, "h w"],
    expected: tuple[float, float, float],
) -> Bool[np.ndarray, "h w"]:
    """What is seen of the plane's own material; all of it where hardly anything has one colour."""
    is_plane = seen & ~_foreign(colours, seen, weight, expected)
    return is_plane if is_plane.sum() >= MIN_TYPICAL * seen.sum() else seen


def strays(
    seen: Bool[np.ndarray, "h w"], is_plane: Bool[np.ndarray, "h w"], pixel_m: float, *, wall: bool
) -> Bool[np.ndarray, "h w"]:
    """Foreign pieces that are cut off by what was not seen: objects before the plane, their rims, shadows and glow.

    A poster or a socket has the plane's own material all around; a plant nobody pointed at goes on below the rim of a
    mask or stands on the floor, the glow around a lamp and the shadow at a table's foot go on behind the mask.

    Args:
        seen: texels of the plane that the photo shows.
        is_plane: of those, the ones that show the plane's own material.
        pixel_m: side of a texel (m).
        wall: whether the plane is a wall.
    """
    pieces = (seen & ~is_plane).astype(np.uint8)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(pieces, connectivity=8)
    _, top, width, height, area = (stats[:, k] for k in range(5))
    unseen = cv2.dilate((~seen).astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool)
    outline = (pieces > 0) & (cv2.erode(pieces, np.ones((3, 3), np.uint8), borderValue=1) == 0)
    cut = np.bincount(labels[unseen & outline], minlength=count)
    below = np.full_like(seen, wall)
    below[:-1] = ~seen[1:]
    foot = np.bincount(labels[below & (pieces > 0)], minlength=count)
    small = (area < SMALL_M2 / pixel_m**2) & (cut > CUT_SHARE * np.bincount(labels[outline], minlength=count))
    standing = (area < STANDING_M2 / pixel_m**2) & (foot > FOOT_SHARE * width)
    stray = (small | standing) & (area < STRAY_SHARE * float(seen.sum()))
    if wall:
        edge = EDGE_M / pixel_m
        at_edge = (top + height < edge) | (top > len(pieces) - edge)
        stray &= ~(at_edge & (width > SKIRTING * height))
    stray[0] = False
    rim = round(STRAY_RIM_M / pixel_m)
    return cv2.dilate(stray[labels].astype(np.uint8), np.ones((2 * rim + 1,) * 2, np.uint8)).astype(bool)
