"""Validation of all user inputs: photo, depth, intrinsics, boxes, masks.

Files and uploads are read only here. Whatever cannot be used ends in one `InputError` line that says what was
wrong, where, and what to do; what can be used with a remark comes back with a warning to show.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.errors import InputError
from diorama_core.perception.inputs.boxes.agreement import is_upside_down, rotate_box_180
from diorama_core.perception.inputs.boxes.reading import read_boxes
from diorama_core.perception.inputs.depth.kinds import DepthKind
from diorama_core.perception.inputs.depth.reading import DepthEncoding, DepthOptions, read_depth
from diorama_core.perception.inputs.masks.reading import read_masks
from diorama_core.perception.inputs.photos.reading import DecodedPhoto, half_turned, read_photo
from diorama_core.perception.inputs.source import Source, read_folder, read_source
from diorama_core.scene.types import Intrinsics

MAX_SIDE_PX, MAX_SPHERE_PX = 1600, 4096
"""Longer side to which photos are reduced, and 360 degree photos: a view of a quarter turn is then as sharp."""
FOV_RANGE_DEG = (15.0, 150.0)
"""Horizontal fields of view that a photo of a room can have."""


@dataclass(frozen=True)
class ReadInputs:
    """Checked inputs and what to tell the user about them."""

    inputs: Inputs
    warnings: tuple[str, ...] = ()


def read_inputs(
    image: Path | bytes,
    *,
    name: str | None = None,
    depth: Path | bytes | Source | None = None,
    depth_scale: float | None = None,
    depth_encoding: DepthEncoding = "linear",
    depth_kind: DepthKind = "auto",
    intrinsics: tuple[float, float, float, float] | None = None,
    fov_deg: float | None = None,
    boxes: Path | bytes | Source | None = None,
    masks: Path | bytes | Source | None = None,
    half_turn: bool = False,
    flat: bool = False,
    max_side: int | None = None,
    sphere: bool = False,
) -> ReadInputs:
    """Read and check what the user gave.

    Args:
        image: The photo, a path or the bytes of an upload.
        name: What to call the photo; by default its file name.
        depth: Measured depth in any container of `DEPTH_FORMS`.
        depth_scale: Units of depth per metre; by default whole numbers are millimetres and others metres, unless the
            picture contradicts it.
        depth_encoding: "sunrgbd" where a PNG's bits are rotated as in SUN RGB-D.
        depth_kind: What the numbers are: depth along the optical axis, distance along the rays, inverse depth, or
            the root or logarithm of depth; by default what the picture says.
        intrinsics: fx, fy, cx, cy in pixels of the upright original photo.
        fov_deg: Horizontal field of view of the upright photo in degrees, instead of `intrinsics`.
        boxes: In any form of `BOX_FORMS`, by default in pixels of the upright original photo.
        masks: In any form of `MASK_FORMS`: a picture with one colour or one id per instance, a folder, an array.
        half_turn: Whether the photo and all that belongs to it are upside down, and are turned by 180 degrees.
        flat: Whether the photo shows one direction although it looks like a panorama.
        max_side: Larger photos are reduced so that the longer side has this many pixels; by default `MAX_SIDE_PX`, or
            `MAX_SPHERE_PX` of a 360 degree photo.
        sphere: Whether the photo is to be a 360 degree photo (equirectangular).

    Returns:
        The inputs in photo pixels, and warnings in words for the user.

    Raises:
        SphericalPhotoError: it is a 360 degree photo and none was to be read.
        InputError: one line saying what cannot be used, where, and what to do.
    """
    side = max_side or (MAX_SPHERE_PX if sphere else MAX_SIDE_PX)
    decoded = read_photo(read_source(image, "photo", name), side, sphere=sphere, flat=flat)
    photo, warnings = decoded.photo, list(decoded.notes)
    unturned, camera = decoded, _read_intrinsics(decoded, intrinsics, fov_deg)
    if half_turn:
        decoded, camera = half_turned(decoded), camera and _half_turned_camera(camera)
    depth_m, instances = None, None
    options = DepthOptions(depth_scale, depth_encoding, depth_kind)
    labelled: tuple[LabelledBox, ...] = ()
    matched: tuple[tuple[int, LabelledBox], ...] = ()
    if boxes is not None:
        labelled, notes = read_boxes(read_source(boxes, "boxes"), unturned)
        labelled = tuple(rotate_box_180(b, photo) for b in labelled) if half_turn else labelled
        warnings += notes
        if is_upside_down(labelled, photo.height):
            warnings.append("the photo seems to be upside down: turn it with its boxes (Turn photo, or --half-turn)")
    if depth is not None:
        depth_m, notes = read_depth(read_source(depth, "depth"), options, decoded, labelled, camera)
        warnings += notes
    if masks is not None:
        instances, matched, notes = read_masks(read_folder(masks, "masks"), labelled, decoded)
        warnings += notes
    return ReadInputs(Inputs(decoded.photo, labelled, instances, matched, depth_m, camera), tuple(warnings))


def _half_turned_camera(camera: Intrinsics) -> Intrinsics:
    return replace(camera, cx=camera.width - camera.cx, cy=camera.height - camera.cy)


def _read_intrinsics(
    decoded: DecodedPhoto, given: tuple[float, float, float, float] | None, fov_deg: float | None
) -> Intrinsics | None:
    """The user's intrinsics, carried over to the photo's pixels."""
    photo, (left, top, _, _) = decoded.photo, decoded.frame.margins
    width, height = decoded.frame.full_size
    if given is not None and fov_deg is not None:
        raise InputError("--intrinsics and --fov mean the same; give one of them")
    if fov_deg is not None:
        low, high = FOV_RANGE_DEG
        if not low <= fov_deg <= high:
            raise InputError(f"--fov {fov_deg:g}: give a horizontal field of view of {low:g} to {high:g} degrees")
        inner = Intrinsics.from_fov(*photo.original_size, float(np.deg2rad(fov_deg)))
        return inner.resize(photo.width, photo.height)
    if given is None:
        return None
    shown = ",".join(f"{v:g}" for v in given)
    if len(given) != 4 or not np.isfinite(given).all() or given[0] <= 0 or given[1] <= 0:
        raise InputError(f"--intrinsics {shown}: give fx,fy,cx,cy in pixels, both focal lengths positive")
    fx, fy, cx, cy = (float(v) for v in given)
    if not (0 < cx < width and 0 < cy < height):
        raise InputError(
            f"--intrinsics {shown}: the centre lies outside the photo ({width} x {height}); give pixels of this photo"
        )
    camera = Intrinsics(*photo.original_size, fx, fy, cx - left, cy - top)
    if not FOV_RANGE_DEG[0] <= np.rad2deg(camera.horizontal_fov_rad) <= FOV_RANGE_DEG[1]:
        raise InputError(
            f"--intrinsics {shown}: the focal length does not fit {width} pixels of width; give pixels of this photo"
        )
    return camera.resize(photo.width, photo.height)
