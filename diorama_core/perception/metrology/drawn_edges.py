"""Which way the edges run that are drawn in the picture of a thing, against the faces of a cuboid that may be it.

Boards, drawers and borders of upright faces are level or upright: on every face of the right cuboid they run to the
vanishing point of the face's level axis or to that of the vertical. A case that is seen from the front and a long one
that is seen along its length have the same box, but not the same edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int, UInt8

from diorama_core.perception.metrology.problem import Cuboids, View
from diorama_core.perception.metrology.settings import SETTINGS, BoxObservationSettings

_SIGMA_RAD = float(np.deg2rad(5.0))


@dataclass(frozen=True, eq=False)
class DrawnEdges:
    """Pixels with an edge that belong to one thing."""

    pixels: Float[np.ndarray, "n 2"]
    direction: Float[np.ndarray, "n 2"]
    """Unit vectors along the edges; either way."""
    settings: BoxObservationSettings

    @classmethod
    def of(
        cls,
        rgb: UInt8[np.ndarray, "h w 3"],
        mask: Bool[np.ndarray, "h w"],
        settings: BoxObservationSettings = SETTINGS.observed,
    ) -> DrawnEdges:
        """The strong edges of the picture inside a mask."""
        rows, columns = np.nonzero(mask)
        if not len(rows):
            return cls(np.zeros((0, 2)), np.zeros((0, 2)), settings)
        top, left = max(rows.min() - 2, 0), max(columns.min() - 2, 0)
        window = slice(top, rows.max() + 3), slice(left, columns.max() + 3)
        grey = cv2.GaussianBlur(cv2.cvtColor(rgb[window], cv2.COLOR_RGB2GRAY).astype(np.float64) / 255, (0, 0), 1.0)
        gx, gy = cv2.Sobel(grey, cv2.CV_64F, 1, 0, scale=0.125), cv2.Sobel(grey, cv2.CV_64F, 0, 1, scale=0.125)
        size = np.hypot(gx, gy)
        inside = cv2.erode(mask[window].astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
        v, u = np.nonzero(inside & (size > settings.min_gradient))
        step = max(len(v) // settings.most_px, 1)
        v, u = v[::step], u[::step]
        along = np.stack([-gy[v, u], gx[v, u]], axis=-1) / size[v, u, None]
        return cls(np.stack([u + left + 0.5, v + top + 0.5], axis=-1), along, settings)

    def costs(self, boxes: Cuboids, height_m: float, view: View) -> Float[np.ndarray, "k"]:
        """What the edges say against every cuboid, in squared sigmas, but for a common constant."""
        count = min(len(self.pixels) / self.settings.by_pixels, self.settings.most)
        if not len(self.pixels):
            return np.zeros(len(boxes.centre))
        return np.array([-2.0 * count * self._mean_log(boxes, k, height_m, view) for k in range(len(boxes.centre))])

    def _mean_log(self, boxes: Cuboids, row: int, height_m: float, view: View) -> float:
        k, R = view.intrinsics, view.R_world_camera
        rays = np.column_stack([(self.pixels - [k.cx, k.cy]) / [k.fx, k.fy], np.ones(len(self.pixels))]) @ R.T
        c, s = np.cos(boxes.yaw_rad[row]), np.sin(boxes.yaw_rad[row])
        axes = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        eye = axes @ (np.array([0.0, 0.0, height_m]) - boxes.centre[row])
        face = _faces(eye, rays @ axes.T, boxes.size_m[row] / 2)
        to = [self._alike(axes[axis], rays, view) for axis in range(3)]
        level = np.where(face == 0, to[1], np.where(face == 1, to[0], 0.5 * (to[0] + to[1])))
        upright = np.where(face == 2, 0.0, self.settings.share_upright)
        return float(
            np.log(
                self.settings.share_odd / np.pi + upright * to[2] + (1.0 - self.settings.share_odd - upright) * level
            ).mean()
        )

    def _alike(
        self, axis: Float[np.ndarray, "3"], rays: Float[np.ndarray, "n 3"], view: View
    ) -> Float[np.ndarray, "n"]:
        """Density of every edge's direction if it runs along an axis of the world."""
        k = view.intrinsics
        a, x = axis @ view.R_world_camera, rays @ view.R_world_camera
        drawn = np.column_stack([k.fx * (a[0] - a[2] * x[:, 0] / x[:, 2]), k.fy * (a[1] - a[2] * x[:, 1] / x[:, 2])])
        cross = drawn[:, 0] * self.direction[:, 1] - drawn[:, 1] * self.direction[:, 0]
        off = np.arcsin(np.clip(np.abs(cross) / np.maximum(np.linalg.norm(drawn, axis=1), 1e-9), 0.0, 1.0))
        return np.asarray(np.exp(-0.5 * (off / _SIGMA_RAD) ** 2) / (_SIGMA_RAD * np.sqrt(2 * np.pi)))


def _faces(
    eye: Float[np.ndarray, "3"], rays: Float[np.ndarray, "n 3"], half: Float[np.ndarray, "3"]
) -> Int[np.ndarray, "n"]:
    """For every ray the axis across the face of a cuboid about the origin that it meets first or comes nearest to."""
    with np.errstate(divide="ignore", invalid="ignore"):
        enters = (-np.sign(rays) * half - eye) / rays
    return np.where(np.isfinite(enters), enters, -np.inf).argmax(axis=1)
