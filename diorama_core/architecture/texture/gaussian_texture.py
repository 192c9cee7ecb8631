"""Textures without lines or figures, made anew over any area: stationary Gaussian fields that have the covariance of a
sample of any outline (texton noise; Desolneux, Moisan and Ronsin 2012, Galerne, Gousseau and Morel 2011).

Grain, carpet, plaster and stone are such textures. Copied from a small sample they show as a weave; made anew they
repeat nothing.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Float32
from scipy import fft

from diorama_core.architecture.texture.quilting import broad_shading

REACH_PX = 45
"""Covariance is taken up to this distance."""
NORMAL_KURTOSIS, KURTOSIS_SPAN = 3.0, 1.5
"""A normal distribution has the one; lines have far more, two colours side by side far less."""
LINE_PX, LINE_SKEWNESS = 5.0, 0.75
"""Gaps between boards are about so wide, and skew the distribution of what is so fine by more than that."""


def is_gaussian(detail: Float32[np.ndarray, "h w 3"], sample: Bool[np.ndarray, "h w"]) -> bool:
    """Whether a texture's detail is distributed about normally, so that its covariance says how it looks.

    Args:
        detail: Colours without their broad shading.
        sample: The texels that show the texture.
    """
    grey = detail[sample].mean(axis=-1, dtype=np.float64)
    if len(grey) < 2 or not grey.var() > 0.0:
        return False
    kurtosis = float(np.mean((grey - grey.mean()) ** 4) / grey.var() ** 2)
    return abs(kurtosis - NORMAL_KURTOSIS) < KURTOSIS_SPAN


def has_lines(detail: Float32[np.ndarray, "h w 3"], sample: Bool[np.ndarray, "h w"]) -> bool:
    """Whether a texture has gaps between boards or tiles: thin lines that are darker, or lighter, than all the rest.

    Args:
        detail: Colours without their broad shading.
        sample: The texels that show the texture.
    """
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
