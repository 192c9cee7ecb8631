"""Pictures as networks want them: resized, normalised, channels first; boxes cut out and described."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8
from PIL import Image
from scipy import ndimage

IMAGENET_MEAN, IMAGENET_STD = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)
CLIP_MEAN, CLIP_STD = (0.48145466, 0.4578275, 0.40821073), (0.26862954, 0.26130258, 0.27577711)


def resize(
    rgb: UInt8[np.ndarray, "h w 3"], size: tuple[int, int], how: Image.Resampling = Image.Resampling.BILINEAR
) -> UInt8[np.ndarray, "h2 w2 3"]:
    """Pillow's resampling to (height, width), which the networks were trained with; OpenCV's differs."""
    if rgb.shape[:2] == size:
        return np.ascontiguousarray(rgb)
    return np.asarray(Image.fromarray(rgb).resize((size[1], size[0]), how))


def normalise(
    rgb: UInt8[np.ndarray, "h w 3"] | Float[np.ndarray, "h w 3"],
    mean: tuple[float, float, float],
    std: tuple[float, float, float],
) -> Float32[np.ndarray, "1 3 h w"]:
    """A batch of one; eight-bit values are taken to 0..1 first."""
    values = rgb.astype(np.float32) / np.float32(255.0) if rgb.dtype == np.uint8 else rgb.astype(np.float32)
    centred = (values - np.array(mean, np.float32)) / np.array(std, np.float32)
    return np.ascontiguousarray(centred.transpose(2, 0, 1)[None])


def pad_square(rgb: UInt8[np.ndarray, "h w 3"]) -> Float32[np.ndarray, "s s 3"]:
    """0..1, padded with black at the right and the bottom."""
    height, width = rgb.shape[:2]
    side = max(height, width)
    square = np.zeros((side, side, 3), np.float32)
    square[:height, :width] = rgb.astype(np.float32) / np.float32(255.0)
    return square


def antialias(picture: Float32[np.ndarray, "h w 3"], side: int) -> Float32[np.ndarray, "side side 3"]:
    """Gaussian blur that suits the reduction, then linear interpolation on pixel areas (scikit-image's resize)."""
    factors = np.array([picture.shape[0] / side, picture.shape[1] / side, 1.0])
    blurred: np.ndarray = ndimage.gaussian_filter(picture, np.maximum(0.0, (factors - 1) / 2), mode="mirror", cval=0)
    out = ndimage.zoom(blurred, 1 / factors, order=1, mode="mirror", cval=0, grid_mode=True)
    return np.clip(out, picture.min(), picture.max())


def enlarge(values: Float32[np.ndarray, "h w"], size: tuple[int, int]) -> Float32[np.ndarray, "h2 w2"]:
    """Linear interpolation by pixel centres to (height, width), as networks' masks are brought to the photo."""
    return cv2.resize(np.ascontiguousarray(values, np.float32), (size[1], size[0]), interpolation=cv2.INTER_LINEAR)


CROP_SIDE = 96
MARGIN = 0.12
"""Share of the box's size on every side of a crop: what a thing stands on tells what it is."""
FILL = 114


def box_crop(
    rgb: UInt8[np.ndarray, "h w 3"],
    box: Float[np.ndarray, "4"],
    margin: float = MARGIN,
    side: int = CROP_SIDE,
    squeeze: float = 0.0,
) -> UInt8[np.ndarray, "side side 3"]:
    """The box with a margin as a square picture, grey outside the photo.

    Args:
        rgb: the photo.
        box: x1, y1, x2, y2 in its pixels; may reach beyond it.
        margin: of the box's size, on every side.
        side: of the square, pixels.
        squeeze: how far the shorter side may be stretched to fill the square: 0 keeps proportions, 1 fills it.
    """
    x1, y1, x2, y2 = (float(v) for v in box)
    longer = max(x2 - x1, y2 - y1)
    spans = [max(v, longer * (1 - squeeze)) * (1 + 2 * margin) for v in (x2 - x1, y2 - y1)]
    sx, sy = (side / max(span, 1e-3) for span in spans)
    cx, cy = (x1 + x2) / 2, (y1 + y2) / 2
    left, top = (max(0, int(c - 0.5 * side / s - 2)) for c, s in ((cx, sx), (cy, sy)))
    right, bottom = (int(c + 0.5 * side / s + 2) + 1 for c, s in ((cx, sx), (cy, sy)))
    part = rgb[top:bottom, left:right]
    if min(sx, sy) < 0.5:  # linear interpolation alone would skip pixels
        part = cv2.GaussianBlur(part, (0, 0), 0.4 / min(sx, sy))
    M = np.array([[sx, 0, side / 2 - sx * (cx - left)], [0, sy, side / 2 - sy * (cy - top)]], np.float32)
    return cv2.warpAffine(part, M, (side, side), flags=cv2.INTER_LINEAR, borderValue=(FILL, FILL, FILL))


def box_geometry(box: Float[np.ndarray, "4"], width: int, height: int) -> Float32[np.ndarray, "6"]:
    """Where a box is and how large: middle, lower edge, logarithms of size and proportions; the picture has width 1."""
    x1, y1, x2, y2 = np.asarray(box, dtype=np.float64) / width
    w, h = max(x2 - x1, 1e-3), max(y2 - y1, 1e-3)
    tall = height / width
    return np.array(
        [(x1 + x2) / 2 - 0.5, (y1 + y2) / (2 * tall) - 0.5, y2 / tall - 0.5, np.log(w), np.log(h), np.log(w / h)],
        np.float32,
    )
