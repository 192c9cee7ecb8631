"""Distortion of photos whose cameras were calibrated, and the photos without it: straight lines become straight.

Coefficients as OpenCV has them (Brown's model, and Kannala and Brandt's for fisheye lenses), which COLMAP's and
nerfstudio's models are cases of.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.errors import InputError
from diorama_core.scene.types import Intrinsics

MIN_BENT_PX = 0.5
"""A lens that moves no pixel of the border farther is taken for straight."""


@dataclass(frozen=True)
class Lens:
    """How a lens bends what it shows."""

    k: tuple[float, ...] = ()
    """Radial coefficients: k1, k2, k3 to k6; of a fisheye k1 to k4."""
    p: tuple[float, float] = (0.0, 0.0)
    """Tangential ones."""
    fisheye: bool = False

    @property
    def bends(self) -> bool:
        """Whether there is any distortion."""
        return any(self.k) or any(self.p)

    @property
    def coefficients(self) -> Float[np.ndarray, "n"]:
        """In OpenCV's order."""
        if self.fisheye:
            return np.array([*self.k, *([0.0] * (4 - len(self.k)))])
        k = [*self.k, *([0.0] * (6 - len(self.k)))]
        return np.array([*k[:2], *self.p, *k[2:]])

    def rotate(self, quarters: int) -> Lens:
        """The lens of a picture after clockwise quarter turns."""
        p1, p2 = self.p
        for _ in range(quarters % 4):
            p1, p2 = p2, -p1
        return replace(self, p=(p1, p2))


def lens_of(numbers: Sequence[float]) -> Lens:
    """The lens with OpenCV's coefficients: k1, or k1, k2, or k1, k2, p1, p2, k3 to k6 as far as they are given.

    Raises:
        InputError: there are other numbers than these.
    """
    if len(numbers) not in (1, 2, 4, 5, 8) or not np.isfinite(numbers).all():
        shown = ",".join(f"{v:g}" for v in numbers)
        raise InputError(f"--distortion {shown}: give OpenCV's k1 or k1,k2 or k1,k2,p1,p2 or k1,k2,p1,p2,k3")
    p1, p2 = (numbers[2], numbers[3]) if len(numbers) > 2 else (0.0, 0.0)
    return Lens((*numbers[:2], *numbers[4:]), (p1, p2))


def without_distortion(inputs: Inputs, lens: Lens) -> Inputs:
    """One photo with everything that lies on it, straightened around its camera, which must be known.

    Raises:
        InputError: neither the user nor the photo's header says the focal length.
    """
    photo, k = inputs.photo, inputs.intrinsics
    if k is None and photo.exif_focal_px is not None:
        focal = photo.exif_focal_px
        k = Intrinsics(photo.width, photo.height, focal, focal, photo.width / 2, photo.height / 2)
    if k is None:
        raise InputError(
            "--distortion needs the focal length, which the photo's header does not say: add --fov or --intrinsics"
        )
    return replace(undistort(inputs, k, lens), intrinsics=k)


STRAIGHT = Lens()
"""Bends nothing."""


def undistort(inputs: Inputs, k: Intrinsics, lens: Lens) -> Inputs:
    """A photo with everything that lies on it, without what its lens bends; the camera stays.

    Args:
        inputs: As given; boxes are those around the moved outlines of the given ones.
        k: Of the photo, in its pixels.
        lens: Its distortion.
    """
    if not lens.bends or _farthest_px(k, lens) < MIN_BENT_PX:
        return inputs
    import cv2  # only when photos are straightened; the editor starts without it

    K = k.matrix
    size = (k.width, k.height)
    if lens.fisheye:
        maps = cv2.fisheye.initUndistortRectifyMap(K, lens.coefficients, np.eye(3), K, size, cv2.CV_32FC1)
    else:
        maps = cv2.initUndistortRectifyMap(K, lens.coefficients, np.eye(3), K, size, cv2.CV_32FC1)

    def exactly(values: np.ndarray) -> np.ndarray:
        return np.asarray(cv2.remap(values, *maps, cv2.INTER_NEAREST, borderMode=cv2.BORDER_CONSTANT))

    rgb = np.asarray(cv2.remap(inputs.photo.rgb, *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE))
    return replace(
        inputs,
        photo=replace(inputs.photo, rgb=rgb),
        boxes=tuple(_undistort_box(b, k, lens) for b in inputs.boxes),
        instance_boxes=tuple((n, _undistort_box(b, k, lens)) for n, b in inputs.instance_boxes),
        instances=None if inputs.instances is None else exactly(inputs.instances.astype(np.float32)).astype(np.int32),
        depth_m=None if inputs.depth_m is None else exactly(inputs.depth_m),
        normals_camera=None if inputs.normals_camera is None else exactly(inputs.normals_camera),
    )


def straight_points(points: Float[np.ndarray, "n 2"], k: Intrinsics, lens: Lens) -> Float[np.ndarray, "n 2"]:
    """Where pixels of a bent photo are in the straight one."""
    import cv2

    undistort = cv2.fisheye.undistortPoints if lens.fisheye else cv2.undistortPoints
    K = k.matrix
    return np.asarray(undistort(points.reshape(-1, 1, 2).astype(np.float64), K, lens.coefficients, P=K)).reshape(-1, 2)


def distort_box(marked: LabelledBox, k: Intrinsics, lens: Lens) -> LabelledBox:
    """The box of a bent photo that straightening moves to a given one; up to the photo's side where that one is."""
    goal = bent = np.array(marked.box, dtype=float)
    for _ in range(12):
        straight = _undistort_box(replace(marked, box=(*bent.tolist(),)), k, lens).box
        bent = np.clip(bent + goal - straight, 0.0, [k.width, k.height] * 2)
    return replace(marked, box=(*bent.tolist(),))


def _farthest_px(k: Intrinsics, lens: Lens) -> float:
    border = _border(0.0, 0.0, float(k.width), float(k.height))
    return float(np.linalg.norm(straight_points(border, k, lens) - border, axis=1).max())


def _undistort_box(marked: LabelledBox, k: Intrinsics, lens: Lens) -> LabelledBox:
    points = straight_points(_border(*(float(v) for v in marked.box)), k, lens)
    low = np.clip(points.min(axis=0), 0.0, [k.width, k.height])
    high = np.clip(points.max(axis=0), 0.0, [k.width, k.height])
    if (high - low < 1.0).any():
        return marked
    return replace(marked, box=(float(low[0]), float(low[1]), float(high[0]), float(high[1])))


def _border(x0: float, y0: float, x1: float, y1: float) -> Float[np.ndarray, "n 2"]:
    along = 9  # points on each side tell where a box goes
    x, y = np.linspace(x0, x1, along), np.linspace(y0, y1, along)
    sides = [np.column_stack([x, np.full(along, v)]) for v in (y0, y1)]
    return np.vstack([*sides, *(np.column_stack([np.full(along, v), y]) for v in (x0, x1))])
