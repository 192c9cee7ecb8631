"""The room behind the furniture (PlainRecon, Diorama section 3.1 and supplement).

What stands in it is found and painted out, depth is read from the emptied picture, and the room is reconstructed from
that.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Bool, Float32, UInt8

from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.models.foreground import ForegroundNetwork
from diorama_core.models.inpainting import Filler
from diorama_core.models.seen_depth import GeometryNetwork, SeenDepth
from diorama_core.progress import Progress
from diorama_core.protocols import ArchitectureStage

DILATION_PX = 10
"""Margin of what is painted out, at a picture of `USUAL_SIDE_PX`: shadows and rims go too."""
USUAL_SIDE_PX = 1008
MAX_FOREGROUND = 0.9
"""A foreground larger than this share of the photo is rejected as a false detection of the room."""
MIN_SHARED_PX = 200
"""Pixels of the room that both depths must have before one is scaled to the other."""


@dataclass(frozen=True)
class EmptyRoomArchitecture:
    """An architecture stage that shows another one the emptied room."""

    room: ArchitectureStage
    filler: Filler
    depth_prediction: GeometryNetwork
    foregrounds: tuple[ForegroundNetwork, ...] = ()
    """Find what no mask covers; without any, the objects' masks are all that is painted out."""

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """The room from what is seen of it and, behind objects, from the depth of the emptied picture.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.ArchitectureStage`.

        Raises:
            ValueError: when the inputs hold no depth.
        """
        if inputs.depth_m is None:
            raise ValueError("EmptiedRoom needs the depth that a network read; use PhotoRoom without one")
        rgb = inputs.photo.rgb
        progress.report(0.0, "Looking for what stands in the room")
        hole = self.hole(rgb, objects)
        if not hole.any():
            return self.room.reconstruct(inputs, objects, geometry, progress)
        progress.report(0.3, "Painting the furniture out")
        empty = self.filler.fill(rgb, hole)
        progress.report(0.5, "Reading the depth of the empty room")
        seen = self.depth_prediction.predict(empty, inputs.intrinsics)
        depth, normals = _complete_depth(inputs, seen, hole)
        cleared = replace(
            inputs,
            photo=replace(inputs.photo, rgb=empty),
            instances=None,
            instance_boxes=(),
            depth_m=depth,
            normals_camera=normals,
        )
        estimate = self.room.reconstruct(cleared, (), geometry, progress.part(0.7, 1.0))
        return replace(estimate, source=replace(estimate.source, furniture_inpainted=True))

    def hole(self, rgb: UInt8[np.ndarray, "h w 3"], objects: tuple[DetectedObject, ...]) -> Bool[np.ndarray, "h w"]:
        """Pixels of objects and their margin: masks, and what the foreground networks see beyond them."""
        items = np.zeros(rgb.shape[:2], dtype=bool)
        for detected in objects:
            items |= detected.mask
        for network in self.foregrounds:
            more = network.mask(rgb)
            if more.mean() <= MAX_FOREGROUND:
                items |= more
        reach = max(1, round(DILATION_PX * max(rgb.shape[:2]) / USUAL_SIDE_PX))
        return cv2.dilate(items.astype(np.uint8), np.ones((2 * reach + 1,) * 2, np.uint8)).astype(bool)


def _complete_depth(
    inputs: Inputs, seen: SeenDepth, hole: Bool[np.ndarray, "h w"]
) -> tuple[Float32[np.ndarray, "h w"], Float32[np.ndarray, "h w 3"]]:
    """The photo's depth where the room itself is seen; in the hole the emptied picture's, scaled to agree around it."""
    before = inputs.depth_m
    assert before is not None
    shared = ~hole & (before > 0) & (seen.depth_m > 0)
    enough = int(shared.sum()) >= MIN_SHARED_PX
    factor = float(np.median(before[shared] / seen.depth_m[shared])) if enough else 1.0
    depth = np.where(hole, seen.depth_m * np.float32(factor), before).astype(np.float32)
    old = seen.normals_camera if inputs.normals_camera is None else inputs.normals_camera
    return depth, np.where(hole[..., None], seen.normals_camera, old).astype(np.float32)
