"""Writes what the built-in library's shapes tell of every kind: usual sizes and outlines, for single-view metrology.

    python scripts/measure_kinds.py

Sizes are a kernel density over a kind's shapes, reduced to a few Gaussians by the least loss of information (Runnalls,
"Kullback-Leibler approach to Gaussian mixture reduction", 2007): most tables are 0.75 m high within centimetres, which
one Gaussian over all of them, low and high ones too, does not say. The kernels are those that make the scale of shapes
left out likeliest where their proportions are known, as a picture tells them. Only shapes of the training and
validation splits are read; the benchmark's rooms are furnished from the others.
"""

from __future__ import annotations

import json
from collections import defaultdict
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
import trimesh

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.kinds import OUTLINE_DIRECTIONS, PATH, STEPS
from diorama_core.synthesis.splits import split_library

MAX_MODES, MIN_LOSS = 6, 2.5
"""Of a kind: no more than so many; two are merged where that loses less than so much (nats, over all shapes)."""
USUAL_SIGMA, USUAL_COUNT = 0.14, 3
"""Spread of a kind's extents before any of its shapes is seen, and how many shapes that belief is worth."""
KERNEL, MIN_SIGMA = 1.4, 0.05
"""Width of one shape's kernel against the spread of its kind's (for one shape; it falls with their number, as Scott's
rule has it), and at least: what is made next year is a little different."""
OUTLINE_SIGMA = 0.075
"""How much outlines of one mode differ, in sides of their unit box (round and square things differ by 0.2)."""
_MEDIAN_TO_SIGMA = 1.4826


def main() -> None:
    library = split_library(built_in_library(), "train", "validation")
    members = defaultdict(list)
    for shape in library.shapes():
        members[shape.category].append(shape)
    kinds = {}
    for name in sorted(members):
        outlines = np.array([outline(library.mesh(s.id)) for s in members[name]])
        kinds[name] = modes(np.log([s.size_m for s in members[name]]), outlines)
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(kind, separators=(',', ':'))}" for name, kind in kinds.items())
    Path(PATH).write_text("{\n" + lines + "\n}\n")
    print(f"{PATH}: {len(kinds)} kinds, {sum(map(len, kinds.values()))} modes")


@dataclass(frozen=True, eq=False)
class Component:
    """A Gaussian of a mixture, with the mean outline of the shapes that it stands for."""

    count: int
    mean: np.ndarray
    covariance: np.ndarray
    outline: np.ndarray


def modes(log_sizes: np.ndarray, outlines: np.ndarray) -> list[dict[str, object]]:
    """Groups of shapes alike in size and outline, most common first, each with its count, size, covariance, outline."""
    kernel = np.diag(kernel_sigma(log_sizes) ** 2)
    parts = [Component(1, mean, kernel, around) for mean, around in zip(log_sizes, outlines, strict=True)]
    while len(parts) > 1:
        a, b = min(combinations(parts, 2), key=lambda pair: loss(*pair))
        if len(parts) <= MAX_MODES and loss(a, b) > MIN_LOSS:
            break
        parts = [p for p in parts if p is not a and p is not b] + [merged(a, b)]
    return [
        {
            "count": p.count,
            "size_m": np.exp(p.mean).round(3).tolist(),
            "covariance": p.covariance[np.triu_indices(3)].round(4).tolist(),
            "outline": np.rint(STEPS * p.outline).astype(int).tolist(),
        }
        for p in sorted(parts, key=lambda p: -p.count)
    ]


def kernel_sigma(log_sizes: np.ndarray) -> np.ndarray:
    """Width of the kernels along every axis: a share of the robust spread, drawn to the usual one."""
    count = len(log_sizes)
    spread = _MEDIAN_TO_SIGMA * np.median(np.abs(log_sizes - np.median(log_sizes, axis=0)), axis=0)
    variance = (count * spread**2 + USUAL_COUNT * USUAL_SIGMA**2) / (count + USUAL_COUNT)
    return np.maximum(KERNEL * np.sqrt(variance) * count ** (-1 / 7), MIN_SIGMA)


def merged(a: Component, b: Component) -> Component:
    """One Gaussian with the mean and covariance of two."""
    count = a.count + b.count
    share, off = a.count / count, a.mean - b.mean
    return Component(
        count,
        share * a.mean + (1 - share) * b.mean,
        share * a.covariance + (1 - share) * b.covariance + share * (1 - share) * np.outer(off, off),
        share * a.outline + (1 - share) * b.outline,
    )


def loss(a: Component, b: Component) -> float:
    """Bound of the information that merging loses; outlines count as one more coordinate, along their difference."""
    both = merged(a, b)
    logdets = [p.count * float(np.linalg.slogdet(p.covariance)[1]) for p in (both, a, b)]
    apart = float(np.abs(((a.outline - b.outline) * OUTLINE_DIRECTIONS).sum(axis=-1)).max())
    blurred = a.count * b.count / both.count**2 * (apart / OUTLINE_SIGMA) ** 2
    return 0.5 * (logdets[0] - logdets[1] - logdets[2] + both.count * float(np.log1p(blurred)))


def outline(mesh: trimesh.Trimesh) -> np.ndarray:
    """Mean support points in `OUTLINE_DIRECTIONS` of a shape in its unit box and its mirror images."""
    points = (mesh.vertices - mesh.bounds.mean(axis=0)) / np.maximum(np.ptp(mesh.bounds, axis=0), 1e-6)
    flips = [np.array([x, y, 1.0]) for x in (1.0, -1.0) for y in (1.0, -1.0)]
    ends = [(points * flip)[np.argmax((points * flip) @ OUTLINE_DIRECTIONS.T, axis=0)] for flip in flips]
    return np.mean(ends, axis=0)


if __name__ == "__main__":
    main()
