"""A surface's picture continued where nobody saw it: shading spreads smoothly, fine detail is quilted or made anew.

Textures without lines or figures, made anew over any area: stationary Gaussian fields that have the covariance of a
sample of any outline (texton noise; Desolneux, Moisan and Ronsin 2012, Galerne, Gousseau and Morel 2011).

Grain, carpet, plaster and stone are such textures. Copied from a small sample they show as a weave; made anew they
repeat nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8
from scipy import fft

from diorama_core.architecture.texture.quilting import (
    LARGEST_BLOCK_PX,
    block_size,
    broad_shading,
    detail_continued,
    plain_texels,
)

REACH_PX = 45
"""Covariance is taken up to this distance."""
NORMAL_KURTOSIS, KURTOSIS_SPAN = 3.0, 1.5
"""A normal distribution has the one; lines have far more, two colours side by side far less."""
LINE_PX, LINE_SKEWNESS = 5.0, 0.75
"""Gaps between boards are about so wide, and skew the distribution of what is so fine by more than that."""


@dataclass(frozen=True)
class ContinuationSettings:
    """How a surface's picture is continued where it was not seen."""

    fade_m: float = 1.2
    """Far from what is seen, shading fades to the plane's plain colour over this length."""
    floor_shading_m: float = 0.25
    wall_shading_m: float = 0.08
    """Variation broader than this is light and shade, finer is the material's own."""
    seam_m: float = 0.25
    """Over about this length beside what is seen, what is made up has its light and shade."""
    seam_levels: float = 40.0
    """Not that of what differs by more levels of 255 from the plane's own."""
    calm_levels: float = 20.0
    """A floor's light and shade within so many levels of its main colour is carried on."""
    sample_broadest: float = 0.2
    """Detail broader than this share of the width of what it is taken from is not made anew."""
    lined_block_px: int = 48
    """Smaller copies of lines are a weave rather than lines."""
    broadest_px: float = 10.0
    """What is broader than this is not made anew either: the shadows of window bars are as broad."""
    floor_detail: float = 45.0
    wall_detail: float = 14.0
    """Detail that deviates by more levels of 255 is no part of the material."""


SETTINGS = ContinuationSettings()


def complete_texture(
    colours: Float32[np.ndarray, "h w 3"],
    seen: Bool[np.ndarray, "h w"],
    plain: tuple[float, float, float],
    pixel_m: float,
    is_plane: Bool[np.ndarray, "h w"],
    *,
    ground: bool = False,
    sharp: Bool[np.ndarray, "h w"] | None = None,
) -> UInt8[np.ndarray, "h w 3"]:
    """The plane's picture: as seen, and where it was not seen, its shading spread smoothly and its detail continued.

    Shading spreads through an image pyramid (pull-push, Gortler et al. 1996), which leaves no streaks, and fades to
    the plain colour; detail is quilted where enough was seen to copy from, or, where that is little and without
    figures, made with the same covariance.

    Args:
        colours: 0 to 255, meaningful where seen.
        seen: Which texels are.
        plain: The plane's colour, 0 to 1.
        pixel_m: Size of a texel.
        is_plane: Which of the seen texels show the plane's material: what may be continued.
        ground: Whether it is a floor: boards and rugs vary more, and more broadly, than walls.
        sharp: Which of the plane's own texels are seen from near enough to copy detail from; all by default.
    """
    breadth_m, strongest = (
        (SETTINGS.floor_shading_m, SETTINGS.floor_detail) if ground else (SETTINGS.wall_shading_m, SETTINGS.wall_detail)
    )
    if ground:
        red, green, blue = (float(c) / 255.0 for c in np.median(colours[is_plane], axis=0))
        plain = (red, green, blue)
    shading = broad_shading(colours, is_plane, breadth_m / pixel_m)
    even = is_plane
    if ground:
        # Shadows and glow at the feet of things are not carried on over the floor.
        calm = is_plane & (np.abs(shading - np.array(plain, np.float32) * 255.0).max(axis=-1) < SETTINGS.calm_levels)
        even = calm if calm.any() else is_plane
    smooth = _pull_push(shading * even[..., None], even.astype(np.float32))
    distance = cv2.distanceTransform((~seen).astype(np.uint8), cv2.DIST_L2, 5)
    keep = np.exp(-distance * pixel_m / SETTINGS.fade_m)[..., None]
    filled = keep * smooth + (1.0 - keep) * (np.array(plain, np.float32) * 255.0)
    near = np.exp(-distance * pixel_m / SETTINGS.seam_m)[..., None]
    beside = broad_shading(colours, seen, breadth_m / pixel_m)
    alike = seen & (np.abs(beside - smooth).max(axis=-1) < (SETTINGS.calm_levels if ground else SETTINGS.seam_levels))
    filled = near * _pull_push(beside * alike[..., None], alike.astype(np.float32)) + (1.0 - near) * filled
    detail = _detail(colours - shading, is_plane, strongest, sharp)
    if detail is not None:
        filled = filled + detail
    # The first texels inside a mask's border still carry its rim; a soft seam hides the step.
    inner = cv2.erode(seen.astype(np.float32), np.ones((5, 5), np.uint8))
    mixed = cv2.GaussianBlur(inner, (0, 0), 2.0)[..., None] * seen[..., None]
    return (mixed * colours + (1.0 - mixed) * filled).clip(0, 255).astype(np.uint8)


def _detail(
    detail: Float32[np.ndarray, "h w 3"],
    is_plane: Bool[np.ndarray, "h w"],
    strongest: float,
    sharp: Bool[np.ndarray, "h w"] | None,
) -> Float32[np.ndarray, "h w 3"] | None:
    """Detail everywhere: copied in blocks where large ones were seen or it has lines and figures, else made anew."""
    sample = plain_texels(detail, is_plane, strongest, sharp)
    size = block_size(sample)
    copied = size is None or size == LARGEST_BLOCK_PX or not is_gaussian(detail, sample)
    if copied or (size is not None and size >= SETTINGS.lined_block_px and has_lines(detail, sample)):
        return detail_continued(detail, is_plane, strongest, source=sharp)
    # What is nearly as broad as the sample is rather light and shade.
    width = 2.0 * float(cv2.distanceTransform(np.pad(sample, 1).astype(np.uint8), cv2.DIST_L2, 5).max())
    finer = detail - broad_shading(detail, sample, min(SETTINGS.sample_broadest * width, SETTINGS.broadest_px))
    made = gaussian_texture(finer, sample)
    return np.asarray(np.where(is_plane[..., None], detail, made), dtype=np.float32)


def _pull_push(
    weighted: Float32[np.ndarray, "h w 3"], weight: Float32[np.ndarray, "h w"]
) -> Float32[np.ndarray, "h w 3"]:
    """Average colours from ever coarser levels where finer ones know none."""
    height, width = weight.shape
    average = weighted / np.maximum(weight, 1e-6)[..., None]
    if min(height, width) <= 2:
        total = float(weight.sum())
        mean = weighted.reshape(-1, 3).sum(axis=0) / max(total, 1e-6)
        return np.where(weight[..., None] > 1e-3, average, mean).astype(np.float32)
    size = ((width + 1) // 2, (height + 1) // 2)
    share = cv2.resize(weight, size, interpolation=cv2.INTER_AREA)
    # One known texel of four makes a coarser one known: what is near the seam must not be thinned by what is far.
    sure = np.minimum(4.0 * share, 1.0)
    total_colour = cv2.resize(weighted, size, interpolation=cv2.INTER_AREA)
    coarse = _pull_push(total_colour * (sure / np.maximum(share, 1e-6))[..., None], sure)
    above = cv2.resize(coarse, (width, height), interpolation=cv2.INTER_LINEAR)
    known = np.clip(weight, 0.0, 1.0)[..., None]
    return (known * average + (1.0 - known) * above).astype(np.float32)


def is_gaussian(detail: Float32[np.ndarray, "h w 3"], sample: Bool[np.ndarray, "h w"]) -> bool:
    """Whether a texture's detail is distributed about normally, so that its covariance says how it looks."""
    grey = detail[sample].mean(axis=-1, dtype=np.float64)
    if len(grey) < 2 or not grey.var() > 0.0:
        return False
    kurtosis = float(np.mean((grey - grey.mean()) ** 4) / grey.var() ** 2)
    return abs(kurtosis - NORMAL_KURTOSIS) < KURTOSIS_SPAN


def has_lines(detail: Float32[np.ndarray, "h w 3"], sample: Bool[np.ndarray, "h w"]) -> bool:
    """Whether a texture has gaps between boards or tiles: thin lines that are darker, or lighter, than all the rest."""
    grey = (detail - broad_shading(detail, sample, LINE_PX))[sample].mean(axis=-1, dtype=np.float64)
    if len(grey) < 2 or not grey.var() > 0.0:
        return False
    return bool(abs(np.mean((grey - grey.mean()) ** 3)) >= LINE_SKEWNESS * grey.std() ** 3)


def gaussian_texture(
    detail: Float32[np.ndarray, "h w 3"], sample: Bool[np.ndarray, "h w"], seed: int = 0
) -> Float32[np.ndarray, "h w 3"]:
    """Detail of the picture's whole area with the mean 0 and the covariance that it has within a sample.

    Args:
        detail: Colours without their broad shading, meaningful within the sample.
        sample: At least one texel.
        seed: Of the noise.
    """
    known = np.where(sample[..., None], detail, 0.0).astype(np.float64)
    known = np.where(sample[..., None], known - known.sum(axis=(0, 1)) / sample.sum(), 0.0)
    # Colours' principal components vary independently of each other.
    axes = np.linalg.eigh(np.einsum("hwi,hwj->ij", known, known) / sample.sum())[1]
    rows, columns = np.flatnonzero(sample.any(axis=1)), np.flatnonzero(sample.any(axis=0))
    part = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
    components = known[part] @ axes
    rng = np.random.default_rng(seed)
    made = [_field(_kernel(components[..., k], sample[part]), sample.shape, rng) for k in range(3)]
    return np.asarray(np.stack(made, axis=-1) @ axes.T, dtype=np.float32)


def _kernel(values: Float[np.ndarray, "h w"], sample: Bool[np.ndarray, "h w"]) -> Float[np.ndarray, "k k"]:
    """What turns white noise into a field of the values' covariance: its spectrum is the root of their spectrum.

    Sums over pairs are divided by all texels, not by the pairs: what is nearly as broad as the sample counts less.
    """
    size = [fft.next_fast_len(n + REACH_PX + 1, real=True) for n in sample.shape]
    lags = np.arange(-REACH_PX, REACH_PX + 1)
    sums = fft.irfft2(np.abs(fft.rfft2(values, size)) ** 2, size)
    window = np.cos(0.5 * np.pi * lags / (REACH_PX + 1)) ** 2
    covariance = sums[np.ix_(lags % size[0], lags % size[1])] / sample.sum() * window[:, None] * window
    spectrum = fft.fft2(fft.ifftshift(covariance)).real
    return np.asarray(fft.fftshift(fft.ifft2(np.sqrt(np.maximum(spectrum, 0.0))).real))


def _field(
    kernel: Float[np.ndarray, "k k"], shape: tuple[int, ...], rng: np.random.Generator
) -> Float[np.ndarray, "h w"]:
    size = [fft.next_fast_len(n + len(kernel), real=True) for n in shape]
    noise = rng.standard_normal(size)
    field = fft.irfft2(fft.rfft2(noise) * fft.rfft2(kernel, size), size)
    return np.asarray(field[: shape[0], : shape[1]])
