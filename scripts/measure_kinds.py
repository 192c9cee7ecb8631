"""Writes what the built-in library's shapes tell of every kind: usual sizes and outlines, for single-view metrology.

    python scripts/measure_kinds.py

Only shapes of the training and validation splits are read; the benchmark's rooms are furnished from the others.
"""

from __future__ import annotations

import json
from collections import defaultdict
from pathlib import Path

import numpy as np
import trimesh
from scipy.cluster.hierarchy import fcluster, linkage

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.kinds import OUTLINE_DIRECTIONS, PATH, STEPS
from diorama_core.synthesis.splits import split_library

APART_SIZE, APART_OUTLINE = 0.6, 0.15
"""Things of one mode differ by no more than this: in the logarithm of any extent, and in how far they reach in any
direction (in sides of their unit box; what is round and what is square differ by 0.2)."""
MIN_SIGMA = 0.07
"""Of a mode's sizes: what is made next year is a little different."""
USUAL_SIGMA, USUAL_COUNT = 0.14, 3
"""Spread of a mode before any of its shapes is seen, and how many shapes that belief is worth."""


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


def modes(log_sizes: np.ndarray, outlines: np.ndarray) -> list[dict[str, object]]:
    """Groups of shapes alike in size and outline, most common first, each with its share, size, covariance, outline."""
    group = np.ones(len(log_sizes), dtype=int)
    if len(log_sizes) > 1:
        size_apart = np.abs(log_sizes[:, None] - log_sizes[None]).max(axis=-1) / APART_SIZE
        reach = (outlines * OUTLINE_DIRECTIONS).sum(axis=-1)
        reach_apart = np.abs(reach[:, None] - reach[None]).max(axis=-1) / APART_OUTLINE
        apart = np.maximum(size_apart, reach_apart)
        group = fcluster(linkage(apart[np.triu_indices(len(apart), 1)], "complete"), 1.0, "distance")
    found = []
    for number in sorted(set(group), key=lambda g: -np.sum(group == g)):
        mine = group == number
        count = int(mine.sum())
        off = log_sizes[mine] - log_sizes[mine].mean(axis=0)
        spread = USUAL_COUNT * USUAL_SIGMA**2 / (count + USUAL_COUNT) + MIN_SIGMA**2 * (1 + 1 / count)
        covariance = off.T @ off / (count + USUAL_COUNT) + spread * np.eye(3)
        found.append(
            {
                "share": round(count / len(log_sizes), 3),
                "size_m": np.exp(log_sizes[mine].mean(axis=0)).round(3).tolist(),
                "covariance": covariance[np.triu_indices(3)].round(4).tolist(),
                "outline": np.rint(STEPS * outlines[mine].mean(axis=0)).astype(int).tolist(),
            }
        )
    return found


def outline(mesh: trimesh.Trimesh) -> np.ndarray:
    """Mean support points in `OUTLINE_DIRECTIONS` of a shape in its unit box and its mirror images."""
    points = (mesh.vertices - mesh.bounds.mean(axis=0)) / np.maximum(np.ptp(mesh.bounds, axis=0), 1e-6)
    flips = [np.array([x, y, 1.0]) for x in (1.0, -1.0) for y in (1.0, -1.0)]
    ends = [(points * flip)[np.argmax((points * flip) @ OUTLINE_DIRECTIONS.T, axis=0)] for flip in flips]
    return np.mean(ends, axis=0)


if __name__ == "__main__":
    main()
