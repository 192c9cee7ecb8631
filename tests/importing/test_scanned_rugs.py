from __future__ import annotations

import numpy as np

from diorama_core.importing.scanned_rugs import scanned_rugs


def floor(noise_m: float = 0.002) -> np.ndarray:
    """Points of a floor of 4 x 4 m."""
    rng = np.random.default_rng(0)
    return np.column_stack([rng.uniform(-2, 2, (6000, 2)), rng.normal(0, noise_m, 6000)])


def with_rug(points: np.ndarray, half: tuple[float, float], height_m: float = 0.015) -> np.ndarray:
    """The floor, higher by the rug where that lies."""
    on_it = (np.abs(points[:, :2]) < half).all(axis=1)
    return points + np.where(on_it[:, None], [0.0, 0.0, height_m], 0.0)


def test_what_lies_level_and_a_little_higher_is_a_rug() -> None:
    (rug,) = scanned_rugs(with_rug(floor(), (0.7, 1.1)))
    assert np.ptp(rug[:, :2], axis=0).round(1).tolist() == [1.4, 2.2]


def test_furniture_on_it_hides_a_part_of_a_rug() -> None:
    points = with_rug(floor(), (0.7, 1.1))
    hidden = (points[:, 0] < 0.3) & (np.abs(points[:, 1]) < 0.7)
    (rug,) = scanned_rugs(points[~hidden])
    assert np.ptp(rug[:, :2], axis=0).round(1).tolist() == [1.4, 2.2]


def test_noise_slopes_borders_and_edges_are_no_rugs() -> None:
    assert not scanned_rugs(floor(0.01))
    assert not scanned_rugs(with_rug(floor(0.01), (0.7, 1.1)))  # lost in the noise
    points = floor()
    assert not scanned_rugs(points + points[:, :1] * [0.0, 0.0, 0.01])  # a floor that slopes
    frame = with_rug(points, (1.5, 1.5)) - with_rug(points, (1.2, 1.2)) * [0, 0, 1.0]
    assert not scanned_rugs(np.column_stack([points[:, :2], np.abs(frame[:, 2]) + points[:, 2]]))  # bare floor inside
    assert not scanned_rugs(with_rug(points, (0.1, 1.5)))  # a threshold


def test_without_a_floor_there_is_no_rug() -> None:
    assert scanned_rugs(np.empty((0, 3))) == []
