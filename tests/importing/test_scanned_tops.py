from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.importing.scanned_tops import apart_from_tops


def block(low: tuple[float, float, float], high: tuple[float, float, float]) -> np.ndarray:
    """Points of a box's surface."""
    size, middle = np.subtract(high, low), np.add(low, high) / 2
    mesh = trimesh.creation.box(size, trimesh.transformations.translation_matrix(middle))
    return np.asarray(trimesh.sample.sample_surface(mesh, int(mesh.area * 3000) + 200, seed=2)[0])


CABINET = block((0, 0, 0), (1.4, 0.45, 0.8))


def test_things_on_a_cabinet_are_things_of_their_own() -> None:
    vase, box = block((0.2, 0.1, 0.8), (0.4, 0.3, 1.1)), block((0.8, 0.1, 0.8), (1.2, 0.4, 1.0))
    cabinet, *tops = apart_from_tops(np.vstack([CABINET, vase, box]))
    assert np.ptp(cabinet[:, 2]) < 0.95
    assert len(tops) == 2
    assert sorted(round(float(t[:, 2].max()), 1) for t in tops) == [1.0, 1.1]


def test_backs_and_heads_belong_to_what_they_are_of() -> None:
    seat, back = block((0, 0, 0), (0.9, 2.0, 0.45)), block((0, 0, 0.45), (0.25, 2.0, 0.9))
    assert len(apart_from_tops(np.vstack([seat, back]))) == 1


def test_a_whole_thing_stays_whole() -> None:
    assert len(apart_from_tops(CABINET)) == 1
    shelves = np.vstack([block((0, 0, z), (1.0, 0.3, z + 0.02)) for z in (0.0, 0.4, 0.8, 1.2, 1.6)])
    assert len(apart_from_tops(shelves)) == 1


def test_no_point_is_lost_or_doubled() -> None:
    whole = np.vstack([CABINET, block((0.2, 0.1, 0.8), (0.5, 0.3, 1.2))])
    parts = apart_from_tops(whole)
    assert len(parts) == 2
    assert sum(map(len, parts)) == len(whole)
