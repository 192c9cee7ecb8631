"""Depth and normals of every pixel: rendered from the cuboids and the room, or measured with its holes filled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32

from diorama_core.artefacts import (
    ArchitectureEstimate,
    Cuboid,
    DepthMap,
    DetectedObject,
    Inputs,
    ObjectGeometry,
)
from diorama_core.geometry.casting import camera_rays, cast_box, cast_planes
from diorama_core.geometry.depth_grid import smooth_normals_camera
from diorama_core.progress import Progress
from diorama_core.provenance import DepthSource
from diorama_core.scene.types import Architecture, Camera


@dataclass(frozen=True)
class RenderedDepth:
    """Depth from the geometry that was reasoned out: within a mask its object's cuboid, elsewhere the room."""

    def depth(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        architecture: ArchitectureEstimate,
        progress: Progress,
    ) -> DepthMap:
        """Depth and normals of every pixel; zero where neither the room nor an object is.

        Args:
            inputs, objects, geometry, architecture, progress: as documented in `protocols.DepthStage`.
        """
        progress.report(0.0, "Rendering depth from room and objects")
        depth, normals = render_geometry(geometry, objects, architecture.architecture)
        progress.report(1.0, "Depth is rendered")
        return DepthMap(depth, normals, DepthSource.RENDERED)


@dataclass(frozen=True)
class MeasuredDepth:
    """The measured map; its holes are filled from the room and the cuboids."""

    def depth(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        architecture: ArchitectureEstimate,
        progress: Progress,
    ) -> DepthMap:
        """Measured depth where there is some, rendered elsewhere; normals from the grid where they can be told.

        Args:
            inputs, objects, geometry, architecture, progress: as documented in `protocols.DepthStage`.

        Raises:
            ValueError: when the inputs hold no measured depth.
        """
        if inputs.depth_m is None:
            raise ValueError("MeasuredDepth needs measured depth; use RenderedDepth for a photo alone")
        progress.report(0.0, "Filling holes of the measured depth")
        normals_camera = smooth_normals_camera(inputs.depth_m, geometry.camera.intrinsics)
        rendered = render_geometry(geometry, objects, architecture.architecture)
        filled = fill_depth(inputs.depth_m, normals_camera, geometry.camera, rendered, DepthSource.MEASURED)
        progress.report(1.0, "Depth is complete")
        return filled


def fill_depth(
    depth_m: Float32[np.ndarray, "h w"],
    normals_camera: Float[np.ndarray, "h w 3"],
    camera: Camera,
    rendered: tuple[Float32[np.ndarray, "h w"], Float32[np.ndarray, "h w 3"]],
    source: DepthSource,
) -> DepthMap:
    """A depth map and its normals; where either is zero, the rendered depth or world normal stands instead.

    Args:
        depth_m: z in camera in metres; 0 where missing.
        normals_camera: unit, toward the camera; zero where missing.
        camera: in the world.
        rendered: depth in metres and world normals that fill the gaps.
        source: of the result.
    """
    depth, normals = rendered
    known = np.any(normals_camera != 0, axis=-1, keepdims=True)
    return DepthMap(
        np.where(depth_m > 0, depth_m, depth).astype(np.float32),
        np.where(known, normals_camera @ camera.T_world_camera[:3, :3].T, normals).astype(np.float32),
        source,
    )


def render_geometry(
    geometry: ObjectGeometry, objects: tuple[DetectedObject, ...], architecture: Architecture
) -> tuple[Float32[np.ndarray, "h w"], Float32[np.ndarray, "h w 3"]]:
    """Depth and world normals of every pixel from planes and, within the objects' masks, cuboids."""
    origin, rays = camera_rays(geometry.camera)
    planes = architecture.planes
    depth, which = cast_planes(origin, rays, planes)
    plane_normals = np.array([p.normal for p in planes] + [np.zeros(3)])[which]
    facing = np.sign((plane_normals * rays).sum(axis=-1, keepdims=True))
    normals = np.where(facing > 0, -plane_normals, plane_normals)
    depth = np.where(np.isfinite(depth), depth, 0.0)
    nearest = np.full(depth.shape, np.inf)
    cuboids = {c.object_id: c for c in geometry.cuboids}
    for detected in objects:
        if detected.id not in cuboids or not detected.mask.any():
            continue
        rows, columns = np.nonzero(detected.mask)
        t, n = _cuboid_surface(origin, rays[rows, columns], cuboids[detected.id], geometry.camera)
        closer = t < nearest[rows, columns]
        rows, columns = rows[closer], columns[closer]
        nearest[rows, columns] = depth[rows, columns] = t[closer]
        normals[rows, columns] = n[closer]
    return depth.astype(np.float32), normals.astype(np.float32)


def _cuboid_surface(
    origin: Float[np.ndarray, "3"], rays: Float[np.ndarray, "n 3"], cuboid: Cuboid, camera: Camera
) -> tuple[Float[np.ndarray, "n"], Float[np.ndarray, "n 3"]]:
    """Depth and normal of a mask's pixels on the cuboid; rays that pass it by get its centre's depth, facing back."""
    t, normals = cast_box(origin, rays, cuboid.R_world_object, cuboid.centre, cuboid.size_m)
    missed = ~np.isfinite(t)
    back = -rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    centre_depth = max(float(camera.to_camera(cuboid.centre)[2]), 0.05)
    return np.where(missed, centre_depth, t), np.where(missed[:, None], back, normals)
