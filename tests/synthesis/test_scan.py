from __future__ import annotations

from pathlib import Path

import numpy as np

from diorama_core.importing.point_files import read_points
from diorama_core.synthesis.scan import NOISE_M, write_scan
from tests.importing.furnished_scans import living_room


def test_a_written_scan_is_read_back_as_points_of_the_room(tmp_path: Path) -> None:
    scene, frames = living_room()
    folder = write_scan(tmp_path / "scan", frames)
    cloud = read_points(folder)
    assert len(cloud.photos) == len(frames)
    points = cloud.points[:, [0, 2, 1]] * [1.0, -1.0, 1.0]  # from +Y up
    walls = scene.architecture.by_role("wall")
    beyond = np.max([w.offset - points @ w.normal for w in walls], axis=0)
    assert np.quantile(beyond, 0.99) < 5 * NOISE_M  # unsure pixels are left out, glass reflects nothing
    on_floor = np.abs(points[:, 2]) < 3 * NOISE_M
    assert on_floor.mean() > 0.05


def test_panes_reflect_nothing_and_their_frames_do(tmp_path: Path) -> None:
    scene, frames = living_room()
    (window,) = [o for o in scene.objects if o.category == "window"]
    points = read_points(write_scan(tmp_path / "scan", frames)).points[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
    local = np.abs((points - window.pose.position) @ window.pose.R_world_object)
    half = window.size_m / 2
    near = (local[:, 0] < 0.12) & (local[:, 1:] < half[1:]).all(axis=1)
    pane = near & (local[:, 1:] < half[1:] - 0.2).all(axis=1)
    pane_area, area = float(np.prod(2 * (half[1:] - 0.2))), float(np.prod(2 * half[1:]))
    frame_density = (near & ~pane).sum() / (area - pane_area)
    assert frame_density > 200
    assert pane.sum() / pane_area < 0.15 * frame_density
