"""The inputs for the next build: the photo with its boxes, depth and masks, until "Build scene"."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace

from diorama_core.artefacts import Box, Inputs, LabelledBox, Photo
from diorama_core.errors import InputError
from diorama_core.library.taxonomy import resolve
from diorama_core.models.manifest import NETWORKS
from diorama_core.models.store import ModelStore


@dataclass(frozen=True)
class Draft:
    """Immutable; every change is a new draft."""

    inputs: Inputs | None = None
    """Checked photo, depth, masks and intrinsics; its boxes are superseded by `boxes`."""
    boxes: tuple[LabelledBox, ...] = ()
    """In photo pixels."""
    highlighted: int | None = None
    """The box whose label is being chosen."""
    warnings: tuple[str, ...] = ()
    from_project: bool = False
    """Whether it is what the open project was built from."""
    files: dict[str, bytes] = field(default_factory=dict)
    """The uploads as they came ("photo", "depth", "masks", "boxes"), so that a later one can be read with them."""
    name: str = "photo"

    @property
    def photo(self) -> Photo | None:
        """The photo, if there is one yet."""
        return None if self.inputs is None else self.inputs.photo

    @property
    def ready(self) -> bool:
        """Whether a scene with objects can be built."""
        if self.inputs is None:
            return False
        return bool(self.boxes) or self.inputs.instances is not None or can_find_furniture()

    def with_box(self, box: Box, label: str) -> Draft:
        """A box more, highlighted."""
        made = LabelledBox(box, resolve(label).category.name, label)
        return replace(self, boxes=(*self.boxes, made), highlighted=len(self.boxes))

    def without_box(self, index: int) -> Draft:
        """One box fewer."""
        retained = tuple(b for i, b in enumerate(self.boxes) if i != index)
        return replace(self, boxes=retained, highlighted=None)

    def relabelled(self, index: int, label: str) -> Draft:
        """Another label for one box."""
        changed = replace(self.boxes[index], label=label, category=resolve(label).category.name)
        return replace(self, boxes=tuple(changed if i == index else b for i, b in enumerate(self.boxes)))

    def following(self, inputs: Inputs) -> Draft:
        """The draft after what is known of the project's photo has changed; what is not built yet stays in it."""
        before = () if self.inputs is None else self.inputs.boxes
        deleted = {b.box for b in before} - {b.box for b in self.boxes}
        known = {b.box for b in (*before[: len(inputs.boxes)], *inputs.boxes)}
        waiting = tuple(b for b in self.boxes if b.box not in known)
        retained = tuple(b for b in inputs.boxes if b.box not in deleted)
        return replace(self, inputs=inputs, boxes=(*retained, *waiting), highlighted=None)

    def to_build(self) -> Inputs:
        """The inputs of the pipeline; raises `InputError` when there is no photo."""
        if self.inputs is None:
            raise InputError("there is no photo yet; upload one first")
        if self.boxes == self.inputs.boxes:
            return self.inputs
        return replace(self.inputs, boxes=self.boxes, instance_boxes=self._matched())

    def _matched(self) -> tuple[tuple[int, LabelledBox], ...]:
        """Instance matches follow the relabelled boxes; those of deleted boxes keep their mask without a class."""
        assert self.inputs is not None
        by_box = {b.box: b for b in self.boxes}
        return tuple((i, by_box.get(b.box, b)) for i, b in self.inputs.instance_boxes)


def can_find_furniture() -> bool:
    """Whether a network that finds furniture is on this machine, so that nobody needs to draw boxes."""
    store = ModelStore.default()
    return any(store.has(n) for n in NETWORKS if n.role == "detection")


def boxes_json(boxes: tuple[LabelledBox, ...], photo: Photo) -> bytes:
    """Boxes as the documented file, in pixels of the upright original."""
    sx, sy = photo.original_size[0] / photo.width, photo.original_size[1] / photo.height
    rows = [{"bbox": [b.box[0] * sx, b.box[1] * sy, b.box[2] * sx, b.box[3] * sy], "class": b.label} for b in boxes]
    return json.dumps(rows).encode()
