"""What a person puts right about the photo goes into the inputs, where the next build finds it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Bool

from diorama_core.artefacts import Box, Inputs, LabelledBox, Photo
from diorama_core.geometry.projection import box_iou
from diorama_core.library.labels import understand_label
from diorama_core.perception.inputs.boxes.agreement import rotate_box_180

SAME_BOX_IOU = 0.98
"""Boxes that overlap so much are the same one, written with fewer digits."""
SAME_OBJECT_IOU = 0.5
"""A detected box that overlaps so much with another one is of the same object."""


def with_correction(
    inputs: Inputs, before: Box | None, now: LabelledBox, mask: Bool[np.ndarray, "h w"] | None = None
) -> Inputs:
    """The inputs with one object in the photo corrected.

    Args:
        inputs: as they are.
        before: the box that the object had; None for an object that was missing.
        now: its box and what it is.
        mask: its outline, where a person drew it. A given outline stays with an unchanged box and goes with a new one.
    """
    index = None if before is None else box_index(inputs, before)
    if index is None and now.box in (b.box for b in inputs.boxes):
        index = box_index(inputs, now.box)
    if index is None:
        changed = replace(inputs, boxes=(*inputs.boxes, now))
    else:
        changed = with_box_at(inputs, index, now)
        changed = changed if mask is None else _without_outline(changed, inputs.boxes[index])
    return changed if mask is None else _with_outline(changed, now, mask)


def without_box(inputs: Inputs, index: int) -> Inputs:
    """The inputs without one box; an outline that was given for it stays as an outline without a class."""
    return replace(inputs, boxes=tuple(b for i, b in enumerate(inputs.boxes) if i != index))


def with_box_at(inputs: Inputs, index: int, now: LabelledBox) -> Inputs:
    """The inputs with another box, or another class, in the place of one; its outline goes with another box."""
    old = inputs.boxes[index]
    changed = replace(inputs, boxes=tuple(now if i == index else b for i, b in enumerate(inputs.boxes)))
    if old.box != now.box:
        return _without_outline(changed, old)
    renamed = tuple((i, now if b.box == now.box else b) for i, b in inputs.instance_boxes)
    return replace(changed, instance_boxes=renamed)


def with_boxes_added(inputs: Inputs, boxes: Sequence[LabelledBox]) -> Inputs:
    """The inputs with more boxes, except those that are there already with at least `SAME_OBJECT_IOU`."""
    new = tuple(b for b in boxes if same_object(inputs.boxes, b.box) is None)
    return replace(inputs, boxes=(*inputs.boxes, *new))


def same_object(boxes: Sequence[LabelledBox], box: Box, least_iou: float = SAME_OBJECT_IOU) -> int | None:
    """Which of the boxes is of the same object as another one, as far as overlap tells; None for none."""
    if not boxes:
        return None
    overlaps = box_iou(np.asarray([b.box for b in boxes]), np.asarray([box])).ravel()
    best = int(np.argmax(overlaps))
    return best if overlaps[best] >= least_iou else None


def label_box(box: Box, label: str) -> LabelledBox:
    """A box with a name as it was typed, and the category that it means."""
    return LabelledBox(box, understand_label(label).category.name, label)


def boxes_json(boxes: Sequence[LabelledBox], photo: Photo) -> bytes:
    """Boxes as a file of the documented form, in pixels of the upright original, whose size it states.

    Of a photo that was straightened or turned by 180 degrees, they lie as in its file.
    """
    if photo.straightened:
        from diorama_core.multiview.plumb_lines import box_before_straightening  # the editor opens without it

        boxes = [box_before_straightening(b, photo) for b in boxes]
    boxes = [rotate_box_180(b, photo) for b in boxes] if photo.half_turned else boxes
    sx, sy = photo.original_size[0] / photo.width, photo.original_size[1] / photo.height
    left, top = photo.offset or (0, 0)
    corners = [(b, left + sx * np.array(b.box[::2]), top + sy * np.array(b.box[1::2])) for b in boxes]
    rows = [{"bbox": [*map(float, (x[0], y[0], x[1], y[1]))], "class": b.label} for b, x, y in corners]
    size = {"width": photo.original_size[0], "height": photo.original_size[1]}
    return json.dumps({"image": size, "boxes": rows}).encode()


def find_outline(inputs: Inputs, box: Box) -> Bool[np.ndarray, "h w"] | None:
    """The outline that was given for a box; None where it is to be found."""
    known = [i for i, b in inputs.instance_boxes if b.box == box]
    if inputs.instances is None or not known:
        return None
    mask: Bool[np.ndarray, "h w"] = inputs.instances == known[0]
    return mask if mask.any() else None


def box_index(inputs: Inputs, box: Box) -> int | None:
    """Which of the given boxes this is; None when it is none of them."""
    return same_object(inputs.boxes, box, SAME_BOX_IOU)


def _without_outline(inputs: Inputs, box: LabelledBox) -> Inputs:
    gone = {i for i, b in inputs.instance_boxes if b.box == box.box}
    if not gone or inputs.instances is None:
        return inputs
    instances = np.where(np.isin(inputs.instances, list(gone)), 0, inputs.instances).astype(np.int32)
    instance_boxes = tuple((i, b) for i, b in inputs.instance_boxes if i not in gone)
    return replace(inputs, instances=instances if instance_boxes else None, instance_boxes=instance_boxes)


def _with_outline(inputs: Inputs, box: LabelledBox, mask: Bool[np.ndarray, "h w"]) -> Inputs:
    """With one outline more, in front of the others."""
    empty = np.zeros(mask.shape, dtype=np.int32)
    instances = empty if inputs.instances is None else inputs.instances.copy()
    new = max([0, int(instances.max()), *(i for i, _ in inputs.instance_boxes)]) + 1
    instances[mask] = new
    instances.setflags(write=False)
    return replace(inputs, instances=instances, instance_boxes=(*inputs.instance_boxes, (new, box)))
