"""Changes to an annotated photo under which its scene should stay as good: what a user's next photo differs in.

A perturbation is a pure function of the photo with its annotation and of a generator of random numbers. Boxes,
intrinsics, fronts and colours follow it, so that the annotation stays true.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.artefacts import Box, Inputs
from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.photo_annotations import AnnotatedObject, AnnotatedPhoto
from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear
from diorama_core.scene.types import Intrinsics

JITTER = 0.05
"""Standard deviation of a box's edges, as a share of the box: what people and detectors are off by."""
DROPPED = 0.25
"""Share of the boxes that nobody drew."""
EXPOSURE_STOPS = 0.7
WHITE_BALANCE = 1.15
"""Gain of red over blue, in linear light: about a lamp's light on a picture balanced for the day, or the reverse."""
ROLL_DEG = 3.0
CROPPED = 0.12
"""Most that is cut from each side, as a share of the picture."""
MIN_LEFT = 0.4
"""Share of a box that a crop must leave, else nobody would mark the object."""
BLUR = 0.002
"""Standard deviation of the blur as a share of the longer side: a photo slightly out of focus."""
CUT_CORNERS = 0.25
"""Share of a box's sides that its corners lack: furniture seen in perspective rarely fills them."""


@dataclass(frozen=True, eq=False)
class AnnotatedInputs:
    """What a build is given and what is true of it."""

    inputs: Inputs
    annotation: AnnotatedPhoto
    """In pixels of the inputs' photo."""
    indices: tuple[int, ...]
    """Places of the objects in the photo's own annotation, as it was before anything was left out."""


Perturbation = Callable[[AnnotatedInputs, np.random.Generator], AnnotatedInputs]


def perturb(case: AnnotatedInputs, name: str, seed: int = 0) -> AnnotatedInputs:
    """The case under a perturbation of `PERTURBATIONS`; the same for the same photo, name and seed."""
    key = zlib.crc32(f"{seed} {name} {case.inputs.photo.name}".encode())
    return PERTURBATIONS[name](case, np.random.default_rng(key))


def mirror(case: AnnotatedInputs, _: np.random.Generator) -> AnnotatedInputs:
    """Left and right exchanged."""
    width = case.inputs.photo.width
    rgb = np.ascontiguousarray(case.inputs.photo.rgb[:, ::-1])
    camera = case.inputs.intrinsics
    camera = None if camera is None else replace(camera, cx=width - camera.cx)
    case = _reframe(case, rgb, lambda box: (width - box[2], box[1], width - box[0], box[3]), camera)
    return _with_objects(case, [_turn(annotated) for annotated in case.annotation.objects])


def jitter(case: AnnotatedInputs, rng: np.random.Generator) -> AnnotatedInputs:
    """Given boxes whose edges are off; the annotation stays where it was."""
    photo = case.inputs.photo
    moved = (replace(b, box=jitter_box(b.box, (photo.width, photo.height), JITTER, rng)) for b in case.inputs.boxes)
    return replace(case, inputs=replace(case.inputs, boxes=tuple(moved)))


def jitter_box(box: Box, size: tuple[int, int], share: float, rng: np.random.Generator) -> Box:
    """A box whose edges are off, as what people and detectors draw is.

    Args:
        box: in pixels.
        size: width and height of the picture, which the box stays in.
        share: standard deviation of the edges, as a share of the box.
        rng: of the errors.
    """
    extent, (width, height) = np.tile([box[2] - box[0], box[3] - box[1]], 2), size
    x1, y1, x2, y2 = np.array(box) + share * extent * rng.standard_normal(4)
    x1, y1 = min(max(x1, 0.0), width - 2.0), min(max(y1, 0.0), height - 2.0)
    return float(x1), float(y1), float(min(max(x2, x1 + 2), width)), float(min(max(y2, y1 + 2), height))


def drop(case: AnnotatedInputs, rng: np.random.Generator) -> AnnotatedInputs:
    """A quarter of the boxes not given; what such an object carries has an unknown supporter."""
    count = len(case.annotation.objects)
    out = rng.permutation(count)[: round(DROPPED * count)]
    return with_only(case, [k for k in range(count) if k not in set(out.tolist())])


def expose(case: AnnotatedInputs, rng: np.random.Generator) -> AnnotatedInputs:
    """Lighter or darker, and warmer or cooler."""
    warm = float(np.sqrt(WHITE_BALANCE)) ** rng.choice([-1, 1])
    gain = 2.0 ** (EXPOSURE_STOPS * rng.choice([-1, 1])) * np.array([warm, 1.0, 1.0 / warm])
    table = np.stack([_light(np.arange(256) / 255.0, channel) for channel in gain], axis=-1)
    shown = np.rint(255 * table).astype(np.uint8)
    rgb = np.stack([shown[case.inputs.photo.rgb[..., c], c] for c in range(3)], axis=-1)
    case = _reframe(case, rgb, lambda box: box, case.inputs.intrinsics)
    return _with_objects(case, [_recolour(annotated, gain) for annotated in case.annotation.objects])


def roll(case: AnnotatedInputs, rng: np.random.Generator) -> AnnotatedInputs:
    """The camera turned about its axis; the picture's edges are continued by reflection."""
    photo, camera = case.inputs.photo, case.inputs.intrinsics
    centre = (photo.width / 2, photo.height / 2) if camera is None else (camera.cx, camera.cy)
    angle_rad = float(np.deg2rad(ROLL_DEG)) * rng.choice([-1, 1])
    A = cv2.getRotationMatrix2D(centre, float(np.rad2deg(angle_rad)), 1.0)
    size = (photo.width, photo.height)
    rgb = cv2.warpAffine(photo.rgb, A, size, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT_101)

    def move(box: Box) -> Box:
        points = _octagon(box) @ A[:, :2].T + A[:, 2]
        (x1, y1), (x2, y2) = points.min(axis=0), points.max(axis=0)
        return float(x1), float(y1), float(x2), float(y2)

    return _reframe(case, rgb, move, camera)


def crop(case: AnnotatedInputs, rng: np.random.Generator) -> AnnotatedInputs:
    """Every side cut by up to an eighth; objects of which too little is left are not marked."""
    photo, camera = case.inputs.photo, case.inputs.intrinsics
    left, top, right, bottom = rng.uniform(0, CROPPED, 4) * np.tile([photo.width, photo.height], 2)
    x, y, width, height = round(left), round(top), round(photo.width - left - right), round(photo.height - top - bottom)
    rgb = np.ascontiguousarray(photo.rgb[y : y + height, x : x + width])
    if camera is not None:
        camera = Intrinsics(rgb.shape[1], rgb.shape[0], camera.fx, camera.fy, camera.cx - x, camera.cy - y)
    return _reframe(case, rgb, lambda box: (box[0] - x, box[1] - y, box[2] - x, box[3] - y), camera)


def blur(case: AnnotatedInputs, _: np.random.Generator) -> AnnotatedInputs:
    """Slightly out of focus."""
    photo = case.inputs.photo
    rgb = cv2.GaussianBlur(photo.rgb, (0, 0), BLUR * max(photo.width, photo.height))
    return _reframe(case, rgb, lambda box: box, case.inputs.intrinsics)


PERTURBATIONS: Mapping[str, Perturbation] = {
    "mirrored": mirror,
    "jittered": jitter,
    "dropped": drop,
    "exposed": expose,
    "rolled": roll,
    "cropped": crop,
    "blurred": blur,
}


def perturbations_named(names: Sequence[str]) -> tuple[str, ...]:
    """The names, each checked; all there are where none is given.

    Raises:
        InputError: for a name that is not in `PERTURBATIONS`.
    """
    for name in names:
        if name not in PERTURBATIONS:
            raise InputError(f"--perturbed {name}: give one or more of {', '.join(PERTURBATIONS)}")
    return tuple(names) or tuple(PERTURBATIONS)


def with_only(case: AnnotatedInputs, places: Sequence[int]) -> AnnotatedInputs:
    """Only the objects at some places of the annotation; supporters that are left out are no longer stated."""
    new = {old: k for k, old in enumerate(places)}
    objects = [case.annotation.objects[k] for k in places]
    objects = [o.model_copy(update={"on": new.get(o.on) if isinstance(o.on, int) else o.on}) for o in objects]
    inputs = replace(case.inputs, boxes=tuple(case.inputs.boxes[k] for k in places))
    case = replace(case, inputs=inputs, indices=tuple(case.indices[k] for k in places))
    return _with_objects(case, objects)


def _with_objects(case: AnnotatedInputs, objects: Sequence[AnnotatedObject]) -> AnnotatedInputs:
    return replace(case, annotation=case.annotation.model_copy(update={"objects": tuple(objects)}))


def _reframe(
    case: AnnotatedInputs,
    rgb: UInt8[np.ndarray, "h w 3"],
    moved: Callable[[Box], Box],
    intrinsics: Intrinsics | None,
) -> AnnotatedInputs:
    """Another picture in which boxes lie elsewhere: they are clipped, and what is mostly outside is left out."""
    height, width = rgb.shape[:2]
    before = [moved(annotated.bbox) for annotated in case.annotation.objects]
    after = [_clip(box, width, height) for box in before]
    photo = replace(case.inputs.photo, rgb=rgb, original_size=(width, height))
    boxes = tuple(replace(b, box=_clip(moved(b.box), width, height)) for b in case.inputs.boxes)
    inputs = replace(case.inputs, photo=photo, boxes=boxes, intrinsics=intrinsics)
    objects = [o.model_copy(update={"bbox": box}) for o, box in zip(case.annotation.objects, after, strict=True)]
    case = replace(case, inputs=inputs, annotation=case.annotation.model_copy(update={"size": (width, height)}))
    left = [
        k for k, (whole, part) in enumerate(zip(before, after, strict=True)) if _area(part) > MIN_LEFT * _area(whole)
    ]
    return with_only(_with_objects(case, objects), left)


def _clip(box: Box, width: int, height: int) -> Box:
    x1, x2 = np.clip([box[0], box[2]], 0.0, width)
    y1, y2 = np.clip([box[1], box[3]], 0.0, height)
    return float(x1), float(y1), float(x2), float(y2)


def _area(box: Box) -> float:
    return (box[2] - box[0]) * (box[3] - box[1])


def _octagon(box: Box) -> Float[np.ndarray, "8 2"]:
    """A box without its corners."""
    x, y = np.array([box[0], box[2]]), np.array([box[1], box[3]])
    inner_x, inner_y = (v + CUT_CORNERS * (v[::-1] - v) for v in (x, y))
    return np.array([*((a, b) for a in x for b in inner_y), *((a, b) for a in inner_x for b in y)])


def _turn(annotated: AnnotatedObject) -> AnnotatedObject:
    front = None if annotated.front is None else -annotated.front % 360.0
    return annotated.model_copy(update={"front": front})


def _recolour(annotated: AnnotatedObject, gain: Float[np.ndarray, "3"]) -> AnnotatedObject:
    if annotated.colour is None:
        return annotated
    channels = (_light(np.array([value / 255.0]), g)[0] for value, g in zip(annotated.colour, gain, strict=True))
    return annotated.model_copy(update={"colour": tuple(float(255.0 * c) for c in channels)})


def _light(display: Float[np.ndarray, "n"], gain: float) -> Float[np.ndarray, "n"]:
    """Display values, 0 to 1, in more or less light, clipped as cameras do."""
    return np.asarray(linear_to_srgb(np.clip(gain * srgb_to_linear(display), 0.0, 1.0)))
