"""The ground that a room stands on: its soft shadow, so that it does not hang in the air."""

from __future__ import annotations

import numpy as np
import trimesh
from PIL import Image, ImageDraw, ImageFilter
from trimesh.visual.material import PBRMaterial

from diorama_core.scene.types import Plane

PIXELS = 192
MARGIN_M = 1.2
BELOW_M = 0.08
"""So far below the floor."""
BLUR_M = 0.32
DARKEST = 110
"""Opacity of the shadow beside the room, of 255."""


def ground_glb(floor: Plane) -> bytes:
    """A rectangle below a floor with its blurred outline in black, as GLB bytes; seen from above only."""
    low, high = floor.polygon[:, :2].min(axis=0) - MARGIN_M, floor.polygon[:, :2].max(axis=0) + MARGIN_M
    size = high - low
    shape = np.maximum((PIXELS * size / size.max()).astype(int), 2)
    outline = Image.new("L", (int(shape[0]), int(shape[1])))
    corners = (floor.polygon[:, :2] - low) / size * shape
    ImageDraw.Draw(outline).polygon([(float(x), float(y)) for x, y in corners], fill=DARKEST)
    mask = np.asarray(outline.filter(ImageFilter.GaussianBlur(BLUR_M * float(shape[0] / size[0]))))[::-1]
    picture = np.zeros((*mask.shape, 4), np.uint8)
    picture[..., 3] = mask
    z = float(floor.polygon[:, 2].min()) - BELOW_M
    vertices = np.array([[low[0], low[1], z], [high[0], low[1], z], [high[0], high[1], z], [low[0], high[1], z]])
    material = PBRMaterial(
        baseColorTexture=Image.fromarray(picture), alphaMode="BLEND", metallicFactor=0.0, roughnessFactor=1.0
    )
    mesh = trimesh.Trimesh(
        vertices=vertices,
        faces=[[0, 1, 2], [0, 2, 3]],
        visual=trimesh.visual.TextureVisuals(uv=[[0, 0], [1, 0], [1, 1], [0, 1]], material=material),
        process=False,
    )
    return bytes(trimesh.Scene(mesh).export(file_type="glb"))
