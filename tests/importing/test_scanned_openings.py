from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from diorama_core.importing.measured_cloud import measure_cloud
from diorama_core.importing.measured_room import open_room
from diorama_core.importing.measured_types import MeasuredOpening, MeasuredWall
from diorama_core.importing.point_cloud import PointCloud
from diorama_core.importing.scanned_openings import find_openings
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import yaw_rotation
from tests.importing.scans import HEIGHT, TURN, room_points

WIDTH, DEPTH, TOP = 4.0, 3.0, 2.5
RING = np.array([[0.0, 0.0], [WIDTH, 0.0], [WIDTH, DEPTH], [0.0, DEPTH]])
Rectangle = tuple[float, float, float, float]
"""Along the wall from x = 0, and heights: left, bottom, right, top."""


def wall() -> MeasuredWall:
    """The wall at y = 0, seen from y > 0."""
    return MeasuredWall("wall_1", np.array([[0.0, 0, 0], [WIDTH, 0, 0], [WIDTH, 0, TOP], [0.0, 0, TOP]]))


def surface(
    holes: Sequence[Rectangle] = (), leaves: Sequence[tuple[Rectangle, float]] = (), spacing: float = 0.025
) -> np.ndarray:
    """Points of the wall without its holes; leaves stand out of it by so much."""
    rng = np.random.default_rng(5)
    x, z = (a.ravel() for a in np.meshgrid(np.arange(0.01, WIDTH, spacing), np.arange(0.01, TOP, spacing)))
    y = np.zeros(len(x))
    for rectangle, out in leaves:
        y[inside(x, z, rectangle)] = out
    through = np.zeros(len(x), bool)
    for rectangle in holes:
        through |= inside(x, z, rectangle)
    return np.column_stack([x, y, z])[~through] + rng.normal(0, 0.003, ((~through).sum(), 3))


def inside(x: np.ndarray, z: np.ndarray, r: Rectangle) -> np.ndarray:
    return (x > r[0]) & (x < r[2]) & (z > r[1]) & (z < r[3])


def found(points: np.ndarray) -> list[tuple[str, float, float, float, float]]:
    openings = find_openings(points, [wall()], RING)
    return [(o.kind, float(o.centre[0]), float(o.centre[2]), o.width_m, o.height_m) for o in openings]


def near(opening: tuple[str, float, float, float, float], kind: str, r: Rectangle, tolerance: float = 0.08) -> bool:
    expected = ((r[0] + r[2]) / 2, (r[1] + r[3]) / 2, r[2] - r[0], r[3] - r[1])
    return opening[0] == kind and opening[1:] == pytest.approx(expected, abs=tolerance)


DOORWAY, WINDOW = (0.5, 0.0, 1.4, 2.05), (2.2, 0.9, 3.4, 2.0)


def test_a_hole_that_reaches_the_floor_is_a_door_and_one_above_it_a_window() -> None:
    door, window = sorted(found(surface([DOORWAY, WINDOW])))
    assert near(door, "door", DOORWAY)
    assert near(window, "window", WINDOW)


GLAZED = (0.62, 0.3, 1.28, 1.9)
PANES = [(2.3, 1.0, 2.78, 1.9), (2.82, 1.0, 3.3, 1.9)]


@pytest.mark.parametrize(
    ("holes", "leaf", "out", "kind"),
    [(PANES, WINDOW, 0.03, "window"), ((), DOORWAY, 0.03, "door"), ((), DOORWAY, -0.04, "door"),
     ([GLAZED], DOORWAY, 0.03, "door")],
    ids=["a window with bars and a frame", "a shut door that stands out", "or is set in", "a glazed door"],
)  # fmt: skip
def test_a_leaf_or_frame_at_another_depth_than_the_wall_is_of_one_opening(holes, leaf, out: float, kind: str) -> None:
    (opening,) = found(surface(holes, [(leaf, out)]))
    assert near(opening, kind, leaf)


def test_a_picture_on_a_whole_wall_is_no_opening() -> None:
    assert found(surface(leaves=[((1.0, 1.2, 2.0, 1.9), 0.03)])) == []
    assert found(surface()) == []


def test_what_furniture_hides_is_no_hole() -> None:
    wardrobe = (1.0, 0.0, 2.2, 1.95)
    rng = np.random.default_rng(1)
    front = np.column_stack([rng.uniform(1.0, 2.2, 4000), np.full(4000, 0.6), rng.uniform(0, 1.95, 4000)])
    assert found(np.vstack([surface([wardrobe]), front])) == []


def test_what_was_never_scanned_up_to_the_walls_end_is_no_hole() -> None:
    assert found(surface([(3.0, 0.0, WIDTH, 2.2)])) == []
    assert found(surface([(1.0, 1.5, 2.0, TOP)])) == []


def test_a_wide_way_through_is_an_opening_without_a_door() -> None:
    (way,) = found(surface([(0.6, 0.0, 3.2, 2.2)]))
    assert way[0] == "opening"


def test_too_few_points_say_nothing() -> None:
    sparse = surface([DOORWAY], spacing=0.2)
    assert found(sparse) == []
    assert found(np.zeros((0, 3))) == []


def test_a_thinner_scan_still_shows_its_door() -> None:
    (door,) = found(surface([DOORWAY], spacing=0.05))
    assert near(door, "door", DOORWAY, 0.13)


def test_a_whole_scanned_room_opens_with_its_door_and_window_in_their_walls() -> None:
    points = room_points() @ yaw_rotation(TURN) - [0.0, 0.0, 12.0]
    x, y, z = points.T
    low = -3.4 / 2
    hole = inside(x, z, (0.2, 0.9, 1.2, 2.0)) | inside(x, z, (-1.6, -1.0, -0.7, 2.05))
    cut = points[~((np.abs(y - low) < 0.05) & hole)]
    measured = measure_cloud(PointCloud(cut @ yaw_rotation(0.2).T, np.array([0.0, 0.0, 1.0])))
    kinds: list[MeasuredOpening] = sorted(measured.openings, key=lambda o: o.kind)
    assert [o.kind for o in kinds] == ["door", "window"]
    assert kinds[0].height_m == pytest.approx(2.05, abs=0.08)
    scene = open_room(measured, built_in_library()).scene
    assert HEIGHT > 2.05
    for kind in ("door", "window"):
        (item,) = [o for o in scene.objects if o.category == kind]
        held = scene.plane(scene.support_of(item.id).parent)
        assert held.role == "wall"
        back = item.pose.position - held.normal * item.size_m[0] / 2
        assert held.normal @ back == pytest.approx(held.offset, abs=1e-6)
