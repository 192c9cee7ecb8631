"""Whether the photo shows a surface plainer than the library's own weave or grain would make it.

A slot that shows no pattern of its own keeps the library's texture in the photo's colour. That suits what is too far
away to tell; but smooth leather is no bouclé, and where the photo would show the weave and does not, there is none.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float32, UInt8

from diorama_core.appearance.surface_view import SurfaceView


@dataclass(frozen=True)
class PlainnessSettings:
    """When a surface counts as plain."""

    fine: float = 2.0
    """Detail is what a blur of so many cells takes away."""
    visible: float = 0.025
    """Contrast, as a share of the brightness, from which on a texture would be seen."""
    much_less: float = 0.5
    min_cells: int = 400
    """Cells of the surface, away from its edges."""
    min_texels: int = 8
    """Texels of a texture at the photo's resolution: a smaller one averages out."""


SETTINGS = PlainnessSettings()


def shows_plain(
    view: SurfaceView,
    near: Bool[np.ndarray, "gh gw"],
    rgb: UInt8[np.ndarray, "h w 3"],
    texture: UInt8[np.ndarray, "th tw 3"],
    tile_m: float,
) -> bool:
    """Whether a surface is much plainer in the photo than this texture would be at the photo's resolution.

    Args:
        view: The shape in its pose.
        near: Where the slot shows its main colour.
        rgb: The photo.
        texture: The library's.
        tile_m: What one of it covers, in metres of the shape at scale 1.
    """
    inside = cv2.erode(near.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(bool)
    cell_m = _cell_size_m(view, inside)
    if inside.sum() < SETTINGS.min_cells or cell_m is None:
        return False
    side = round(tile_m / cell_m)
    if side < SETTINGS.min_texels:
        return False
    whole = cv2.cvtColor(texture, cv2.COLOR_RGB2GRAY).astype(np.float32)
    small = cv2.resize(whole, (side, side), interpolation=cv2.INTER_AREA) if side < min(whole.shape) else whole
    expected = contrast(small, np.ones(small.shape, dtype=bool))
    seen = contrast(cv2.cvtColor(np.ascontiguousarray(view.crop(rgb)), cv2.COLOR_RGB2GRAY).astype(np.float32), inside)
    return expected >= SETTINGS.visible and seen < SETTINGS.much_less * expected


def contrast(grey: Float32[np.ndarray, "h w"], where: Bool[np.ndarray, "h w"]) -> float:
    """Deviation of the fine detail in some places, as a share of their brightness."""
    weight = cv2.GaussianBlur(where.astype(np.float32), (0, 0), SETTINGS.fine)
    broad = cv2.GaussianBlur(grey * where, (0, 0), SETTINGS.fine) / np.maximum(weight, 1e-6)
    return float((grey - broad)[where].std() / max(float(grey[where].mean()), 1.0))


def _cell_size_m(view: SurfaceView, inside: Bool[np.ndarray, "gh gw"]) -> float | None:
    """Typical size on the surface of a cell of the view; None where no two neighbours are seen."""
    both = inside[:-1, :-1] & inside[:-1, 1:] & inside[1:, :-1]
    if not both.any():
        return None
    uv = view.uv_m.astype(np.float64)
    along, down = (uv[:-1, 1:] - uv[:-1, :-1])[both], (uv[1:, :-1] - uv[:-1, :-1])[both]
    return float(np.median(np.abs(along[:, 0] * down[:, 1] - along[:, 1] * down[:, 0]))) ** 0.5 or None
