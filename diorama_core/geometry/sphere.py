"""Pictures of all directions: equirectangular pixels, directions, and perspective views.

The sphere's frame has +Z up. The picture's middle column looks along -Y, and columns go on to the right as one turns
to the right (+X is at a quarter of the width), as OpenEXR defines latitude-longitude maps.
"""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.geometry.casting import pixel_centres
from diorama_core.scene.types import Camera, Intrinsics


def directions(width: int) -> Float[np.ndarray, "h w 3"]:
    """Directions of all pixels of a map, unit vectors in the sphere's frame; the map is half as high as wide."""
    return directions_at(pixel_centres(width, width // 2), (width, width // 2))


def directions_at(pixels: Float[np.ndarray, "*n 2"], size: tuple[int, int]) -> Float[np.ndarray, "*n 3"]:
    """Unit vectors through places of a map of some width and height; x may go on beyond its sides."""
    longitude = np.pi * (1.0 - 2.0 * pixels[..., 0] / size[0])
    latitude = np.pi * (0.5 - pixels[..., 1] / size[1])
    across = np.cos(latitude)
    return np.stack([across * np.sin(longitude), -across * np.cos(longitude), np.sin(latitude)], axis=-1)


def sphere_pixels(towards: Float[np.ndarray, "*n 3"], width: int) -> Float[np.ndarray, "*n 2"]:
    """Pixels at which a map shows directions of any length: x in [0, width), y in [0, width / 2]."""
    x, y, z = towards[..., 0], towards[..., 1], towards[..., 2]
    longitude, latitude = np.arctan2(x, -y), np.arctan2(z, np.hypot(x, y))
    return np.stack(
        [np.mod(0.5 - longitude / (2 * np.pi), 1.0) * width, (0.5 - latitude / np.pi) * (width / 2)], axis=-1
    )


def sample(picture: UInt8[np.ndarray, "h w 3"], towards: Float[np.ndarray, "a b 3"]) -> UInt8[np.ndarray, "a b 3"]:
    """Colours of an equirectangular picture in some directions, also across its seam."""
    height, width = picture.shape[:2]
    at = (sphere_pixels(towards, width) * [1.0, height / (width / 2)] - 0.5).astype(np.float32)
    wrapped = np.concatenate([picture[:, -1:], picture, picture[:, :1]], axis=1)
    return cv2.remap(wrapped, at[..., 0] + 1.0, at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def perspective(
    picture: UInt8[np.ndarray, "h w 3"], R_sphere_camera: Float[np.ndarray, "3 3"], intrinsics: Intrinsics
) -> UInt8[np.ndarray, "a b 3"]:
    """The picture that a perspective camera takes from the sphere's middle.

    Args:
        picture: equirectangular.
        R_sphere_camera: the camera's axes (x right, y down, z ahead) in the sphere's frame.
        intrinsics: of the camera.
    """
    k, T = intrinsics, np.eye(4)
    T[:3, :3] = R_sphere_camera
    # Averaged from a finer grid: a wide map is shown smaller.
    finer = max(1, round(picture.shape[1] / (2 * np.pi * k.fx)))
    if finer > 1:
        picture = cv2.resize(picture, None, fx=1 / finer, fy=1 / finer, interpolation=cv2.INTER_AREA)
    return sample(picture, Camera(k, T).rays(pixel_centres(k.width, k.height)))


def level_axes(azimuth_rad: float, elevation_rad: float = 0.0) -> Float[np.ndarray, "3 3"]:
    """Axes of a camera without roll that looks in a direction; azimuth is from +X toward +Y.

    Args:
        azimuth_rad: of its optical axis.
        elevation_rad: of that axis above the horizon.
    """
    ca, sa, ce, se = np.cos(azimuth_rad), np.sin(azimuth_rad), np.cos(elevation_rad), np.sin(elevation_rad)
    ahead = np.array([ca * ce, sa * ce, se])
    right = np.array([sa, -ca, 0.0])
    return np.column_stack([right, np.cross(ahead, right), ahead])
