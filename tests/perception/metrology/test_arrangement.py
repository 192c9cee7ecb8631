from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from diorama_core.library.taxonomy import category
from diorama_core.perception.metrology.arrangement import arrange, distinct
from diorama_core.perception.metrology.problem import Cuboids


def boxes(*rows: tuple[float, float, float, float, float]) -> Cuboids:
    """x, y, yaw, depth, width; all 0.8 m high."""
    table = np.array(rows, dtype=float)
    heights = np.full(len(rows), 0.8)
    return Cuboids(np.column_stack([table[:, :2], heights / 2]), table[:, 2], np.column_stack([table[:, 3:], heights]))


def test_readings_that_are_alike_count_once_and_dear_ones_are_dropped() -> None:
    found = boxes(
        (0, 2, 0, 1, 2), (0.05, 2, 0, 1, 2), (0, 2, np.pi / 2, 2, 1), (0, 2, np.pi / 2, 1, 2), (1, 3, 0, 1, 2)
    )
    costs = np.array([3.0, 2.0, 4.0, 5.0, 14.5])
    # Row 2 is row 1 turned by a quarter with its sides exchanged; row 3 is really turned; row 4 costs too much.
    assert distinct(found, costs) == [1, 3]
    assert distinct(found, costs - [0, 0, 0, 0, 2.0]) == [1, 3, 4]


def test_at_most_five_readings_are_retained() -> None:
    many = boxes(*[(float(x), 2.0, 0.0, 1.0, 1.0) for x in range(9)])
    assert distinct(many, np.linspace(1.0, 0.0, 9)) == [8, 7, 6, 5, 4]


def test_two_objects_do_not_stand_in_each_other() -> None:
    sofa = boxes((0, 3, 0, 1, 2), (0, 5, 0, 1, 2))
    bed = boxes((0, 3, 0, 2, 1.6))
    kinds = [category("sofa"), category("bed")]
    assert arrange([sofa, bed], [np.array([1.0, 3.0]), np.array([1.0])], kinds) == [1, 0]
    assert arrange([sofa, bed], [np.array([1.0, 30.0]), np.array([1.0])], kinds) == [0, 0]


def test_chairs_may_be_tucked_under_tables() -> None:
    chair = boxes((0, 3, 0, 0.5, 0.5), (2, 3, 0, 0.5, 0.5))
    table = boxes((0, 3, 0, 0.9, 1.6))
    costs = [np.array([0.0, 8.0]), np.array([0.0])]
    assert arrange([chair, table], costs, [category("chair"), category("table")]) == [0, 0]
    assert arrange([chair, table], costs, [category("chair"), category("sofa")]) == [1, 0]


def test_flat_objects_are_in_nobodys_way() -> None:
    rug = boxes((0, 3, 0, 2, 2), (4, 3, 0, 2, 2))
    flat = Cuboids(rug.centre, rug.yaw_rad, rug.size_m * [1, 1, 0.01])
    sofa = boxes((0, 3, 0, 1, 2))
    kinds = [category("rug"), category("sofa")]
    assert arrange([flat, sofa], [np.array([0.0, 1.0]), np.array([0.0])], kinds) == [0, 0]
    assert arrange([rug, sofa], [np.array([0.0, 1.0]), np.array([0.0])], kinds) == [1, 0]


@pytest.mark.parametrize("seed", range(5))
def test_no_single_change_makes_the_whole_cheaper(seed: int) -> None:
    rng = np.random.default_rng(seed)
    readings = [boxes(*[(*rng.uniform(-1, 1, 2), rng.uniform(-3, 3), 1.0, 1.0) for _ in range(3)]) for _ in range(4)]
    costs = [rng.uniform(0, 6, 3) for _ in range(4)]
    kinds = [category("bed")] * 4

    def total(choice) -> float:
        """The whole's cost, from pairs that leave no choice."""
        found = sum(float(c[k]) for c, k in zip(costs, choice, strict=True))
        for i, j in product(range(4), repeat=2):
            if i < j:
                found += overlap(readings[i], choice[i], readings[j], choice[j])
        return found

    chosen = arrange(readings, costs, kinds)
    best = total(chosen)
    for i, k in product(range(4), range(3)):
        assert total([*chosen[:i], k, *chosen[i + 1 :]]) >= best - 1e-9


def overlap(a: Cuboids, i: int, b: Cuboids, j: int) -> float:
    """What `arrange` pays for a pair, by independent sampling of the shrunken footprints."""

    def share(p: Cuboids, m: int, q: Cuboids, n: int) -> float:
        steps = np.linspace(-0.45, 0.45, 7)
        found = 0
        for u, v in product(steps, steps):
            c, s = np.cos(p.yaw_rad[m]), np.sin(p.yaw_rad[m])
            x = p.centre[m, 0] + c * u * p.size_m[m, 0] - s * v * p.size_m[m, 1] - q.centre[n, 0]
            y = p.centre[m, 1] + s * u * p.size_m[m, 0] + c * v * p.size_m[m, 1] - q.centre[n, 1]
            c, s = np.cos(q.yaw_rad[n]), np.sin(q.yaw_rad[n])
            found += abs(c * x + s * y) <= q.size_m[n, 0] / 2 and abs(-s * x + c * y) <= q.size_m[n, 1] / 2
        return found / 49

    return 14.0 * max(share(a, i, b, j), share(b, j, a, i))
