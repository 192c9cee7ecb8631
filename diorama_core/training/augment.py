"""Pictures made harder than rendered ones: cropped, enlarged, mirrored, badly lit, blurred, noisy and compressed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from diorama_core.training.pictures import LabelledPicture

MIN_VISIBLE = 0.3
"""An object of which a crop leaves less than this share of its box is no longer asked for."""
MIN_SIDE_PX = 6
MOSAIC_SHARE = 0.25
FILL = 114


def training_picture(
    pictures: Sequence[LabelledPicture], size: tuple[int, int], rng: np.random.Generator
) -> LabelledPicture:
    """One picture of the given width and height for a step of training.

    Args:
        pictures: one, or four that are laid out as a mosaic.
        size: width and height of the result.
        rng: the source of chance.
    """
    if len(pictures) == 1:
        return _relight(_crop(pictures[0], size, rng), rng)
    half = (size[0] // 2, size[1] // 2)
    canvas = np.zeros((size[1], size[0], 3), np.uint8)
    boxes, categories, pixels, forms = [], [], [], []
    for k, picture in enumerate(pictures):
        part = _relight(_crop(picture, half, rng), rng)
        x, y = (k % 2) * half[0], (k // 2) * half[1]
        canvas[y : y + half[1], x : x + half[0]] = part.rgb
        boxes.append(part.boxes + np.array([x, y, x, y], np.float32))
        categories.append(part.categories)
        pixels.append(part.pixels)
        forms.append(part.forms)
    joined = (np.concatenate(rows) for rows in (boxes, categories, pixels, forms))
    return LabelledPicture(canvas, *joined)


def _crop(picture: LabelledPicture, size: tuple[int, int], rng: np.random.Generator) -> LabelledPicture:
    """A random part, enlarged or reduced, with a little change of its proportions; mirrored every other time."""
    h, w = picture.rgb.shape[:2]
    fit = min(size[0] / w, size[1] / h)
    scale = fit * np.exp(rng.uniform(np.log(0.75), np.log(2.2)))
    stretch = np.exp(rng.normal(0.0, 0.08))
    sx, sy = scale * stretch, scale / stretch
    # Where the scaled picture is larger than the window, any part of it; else anywhere within the window.
    tx = rng.uniform(min(0.0, size[0] - w * sx), max(0.0, size[0] - w * sx))
    ty = rng.uniform(min(0.0, size[1] - h * sy), max(0.0, size[1] - h * sy))
    M = np.array([[sx, 0, tx], [0, sy, ty]], np.float32)
    boxes = picture.boxes * np.array([sx, sy, sx, sy], np.float32) + np.array([tx, ty, tx, ty], np.float32)
    if rng.random() < 0.5:
        M = np.array([[-sx, 0, size[0] - tx], [0, sy, ty]], np.float32)
        boxes[:, [0, 2]] = size[0] - boxes[:, [2, 0]]
    how = cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR
    rgb = cv2.warpAffine(picture.rgb, M, size, flags=how, borderValue=(FILL, FILL, FILL))
    inside = np.clip(boxes, 0, np.array([*size, *size], np.float32))
    area = np.prod(boxes[:, 2:] - boxes[:, :2], axis=1)
    left = np.prod(inside[:, 2:] - inside[:, :2], axis=1)
    large = (inside[:, 2:] - inside[:, :2]).min(axis=1, initial=np.inf) >= MIN_SIDE_PX
    keep = large & (left >= MIN_VISIBLE * area)
    left_in = (picture.categories[keep], picture.pixels[keep], picture.forms[keep])
    return LabelledPicture(rgb, inside[keep].astype(np.float32), *left_in)


def _relight(picture: LabelledPicture, rng: np.random.Generator) -> LabelledPicture:
    return replace(picture, rgb=photograph(picture.rgb, rng))


def photograph(rgb: UInt8[np.ndarray, "h w 3"], rng: np.random.Generator) -> UInt8[np.ndarray, "h w 3"]:
    """Other light, exposure, white balance, lens, sensor and compression."""
    values: Float32[np.ndarray, "h w 3"] = (rgb.astype(np.float32) / 255.0) ** np.float32(np.exp(rng.normal(0, 0.3)))
    values *= np.exp(rng.normal(0.0, [0.14, 0.05, 0.14])).astype(np.float32) * np.float32(np.exp(rng.normal(0, 0.2)))
    values = (values - 0.5) * np.float32(np.exp(rng.normal(0.0, 0.2))) + 0.5
    if rng.random() < 0.3:
        grey = values.mean(axis=2, keepdims=True)
        values = grey + (values - grey) * np.float32(rng.uniform(0.0, 1.6))
    if rng.random() < 0.5:
        values = _uneven(values, rng)
    if rng.random() < 0.4:
        values = cv2.GaussianBlur(values, (0, 0), float(rng.uniform(0.3, 1.4)))
    values += rng.normal(0.0, float(rng.uniform(0.0, 0.035)), values.shape).astype(np.float32)
    out = (np.clip(values, 0, 1) * 255).astype(np.uint8)
    if rng.random() < 0.4:
        _, data = cv2.imencode(".jpg", out, [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(30, 90))])
        out = cv2.imdecode(data, cv2.IMREAD_COLOR)
    return out


def _uneven(values: Float32[np.ndarray, "h w 3"], rng: np.random.Generator) -> Float32[np.ndarray, "h w 3"]:
    """Light that falls off across the picture, as of a lamp or a window at one side."""
    coarse = np.exp(rng.normal(0.0, 0.35, (3, 4))).astype(np.float32)
    light = cv2.resize(coarse, (values.shape[1], values.shape[0]), interpolation=cv2.INTER_CUBIC)
    return values * np.clip(light, 0.3, 2.5)[..., None]
