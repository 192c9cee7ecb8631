"""True scenes and pictures of them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from diorama_core.artefacts import Inputs, Photo
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Scene
from diorama_core.synthesis import furnish_room, render_truth, sample_cameras
from diorama_core.synthesis.artefacts import true_supports
from diorama_core.synthesis.layout_rooms import box_library, generate_room
from diorama_core.synthesis.truth import TruthView


def without_unasked(view: TruthView) -> Scene:
    """The true scene of the objects asked for only: what a perfect system would return."""
    retained = tuple(view.scene.objects[k] for k in view.indices)
    return replace(view.scene, objects=retained, supports=true_supports(view))


def blank_view(scene: Scene, size: tuple[int, int] = (4, 4), grey: int = 0) -> TruthView:
    """A picture of one grey that shows nothing of a scene whose objects are all asked for."""
    rgb = np.full((size[1], size[0], 3), grey, np.uint8)
    ids = np.full(rgb.shape[:2], -1, np.int32)
    inputs, depth = Inputs(Photo(rgb, "grey.png", size)), np.zeros(ids.shape, np.float32)
    count = len(scene.objects)
    return TruthView(
        inputs, scene, np.zeros(rgb.shape, np.float32), ids, ids, depth, ids, rgb, (None,) * count, np.ones(count)
    )


@cache
def view_of_boxes() -> TruthView:
    """A picture of a generated room of boxes."""
    room, library, size = generate_room(3, 8).truth, box_library(), (160, 120)
    return render_truth(room, sample_cameras(room, library, 1, 1, size)[0], library, size)


@cache
def view_of_room(seed: int, kind: str, size: tuple[int, int], clutter: int = 0) -> TruthView:
    """A picture of a furnished room."""
    library = built_in_library()
    room = furnish_room(seed, kind, library, clutter=clutter)
    camera = sample_cameras(room, library, 1, 1, size)[0]
    return render_truth(room, camera, library, size, with_empty_room=False)
