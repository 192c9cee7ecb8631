"""Building rows of the batch: one object, one assumption about what holds it, and where to start."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.priors import SizeMode
from diorama_core.perception.metrology.problem import UNKNOWNS, UNTOLD, Problems, View
from diorama_core.perception.metrology.settings import SETTINGS, CuboidFitSettings


def row(
    observations: BoxObservations,
    index: int,
    mode: SizeMode,
    *,
    camera_height_m: float,
    yaw_rad: float,
    parent: int | None = None,
    **more: object,
) -> Problems:
    """A batch of one row: by default a thing on the floor; `more` replaces columns.

    Args:
        observations: What the picture says.
        index: The object.
        mode: The assumed size.
        camera_height_m: The camera's height above the floor.
        yaw_rad: The assumed heading of the front.
        parent: The object it rests on, if any.
        more: Columns of `Problems` that differ from a thing on the floor, without the row axis.
    """
    # What lies on another is where that is; of small things a network sees what is behind them.
    log_depth, depth_sigma = observations.log_depth(index, camera_height_m) if parent is None else (0.0, UNTOLD)
    columns: dict[str, object] = {
        "item": float(index),
        "camera_height_m": camera_height_m,
        "yaw_rad": yaw_rad,
        "box_px": observations.box_px[index],
        "edge_sigma_px": observations.edge_sigma_px[index],
        "hidden_px": observations.hidden_px(index, parent),
        "hidden_odds": observations.hidden_odds(index, parent),
        "log_size": mode.log_size,
        "log_size_sigma": mode.sigma,
        "whitening": mode.whitening,
        "base_m": 0.0,
        "base_sigma_m": 0.0,
        "top_m": 0.0,
        "top_sigma_m": UNTOLD,
        "footprint": np.zeros(5),
        "footprint_sigma_m": UNTOLD,
        "wall_m": 1.0,
        "wall_sigma": UNTOLD,
        "cut_sigma": observations.settings.fit.cut_log_sigma,
        "log_depth": log_depth,
        "depth_sigma": depth_sigma,
        "outline": mode.outline,
        "extra": mode.cost,
    }
    columns.update(more)
    return Problems(**{name: np.asarray(value)[None] for name, value in columns.items()})


def contact_start(
    problems: Problems, view: View, settings: CuboidFitSettings = SETTINGS.fit
) -> Float[np.ndarray, "n 6"]:
    """Start where the box's bottom meets the base's height; where it does not, as `size_start`."""
    box = problems.box_px
    rays = _rays(np.column_stack([(box[:, 0] + box[:, 2]) / 2, box[:, 3]]), view)
    drop = problems.base_m - problems.camera_height_m
    meets = rays[:, 2] * np.sign(drop) > 0.02
    reach = drop / np.where(meets, rays[:, 2], 1.0)
    ground = np.linalg.norm(rays[:, :2], axis=1)
    reach = reach + 0.35 * np.exp(problems.log_size[:, :2].min(axis=1)) / np.maximum(ground, 0.2)
    plan = reach[:, None] * rays[:, :2]
    return np.where(
        meets[:, None], _start(plan, problems, view, settings), size_start(problems, view, settings=settings)
    )


def size_start(
    problems: Problems, view: View, farther: float = 1.0, settings: CuboidFitSettings = SETTINGS.fit
) -> Float[np.ndarray, "n 6"]:
    """Start at the distance (times `farther`) at which a thing of the expected size fills the box.

    Args:
        problems: n rows.
        view: intrinsics, and rotation from camera to world.
        farther: factor of the distance.
        settings: of the fit.
    """
    box, k = problems.box_px, view.intrinsics
    rays = _rays((box[:, :2] + box[:, 2:]) / 2, view)
    size = np.exp(problems.log_size)
    by_height = k.fy * size[:, 2] / (box[:, 3] - box[:, 1])
    by_width = k.fx * np.sqrt(size[:, 0] * size[:, 1]) / (box[:, 2] - box[:, 0])
    return _start((farther * np.sqrt(by_height * by_width))[:, None] * rays[:, :2], problems, view, settings)


def other_start(
    problems: Problems, view: View, farther: float = 1.0, settings: CuboidFitSettings = SETTINGS.fit
) -> Float[np.ndarray, "n 6"]:
    """Start as `size_start`; where the lower end may be hidden, with a usual height and the top where the box has it.

    The visible part alone would be taken for a thing far away.

    Args:
        problems: n rows.
        view: intrinsics, and rotation from camera to world.
        farther: factor of the distance.
        settings: of the fit.
    """
    box = problems.box_px
    rays = _rays(np.column_stack([(box[:, 0] + box[:, 2]) / 2, box[:, 1]]), view)
    rise = problems.base_m + np.exp(problems.log_size[:, 2]) - problems.camera_height_m
    meets = (rays[:, 2] * np.sign(rise) > 0.02) & (np.abs(rise) > settings.min_rise_m)
    plan = (rise / np.where(meets, rays[:, 2], 1.0))[:, None] * rays[:, :2]
    hidden = problems.hidden_odds[:, 3:] > settings.maybe_hidden
    return np.where(
        meets[:, None] & hidden, _start(plan, problems, view, settings), size_start(problems, view, farther, settings)
    )


def _rays(pixels: Float[np.ndarray, "n 2"], view: View) -> Float[np.ndarray, "n 3"]:
    """World directions of unit depth."""
    k = view.intrinsics
    camera = np.column_stack([(pixels[:, 0] - k.cx) / k.fx, (pixels[:, 1] - k.cy) / k.fy, np.ones(len(pixels))])
    return camera @ view.R_world_camera.T


def _start(
    plan: Float[np.ndarray, "n 2"], problems: Problems, view: View, settings: CuboidFitSettings
) -> Float[np.ndarray, "n 6"]:
    """Unknowns at a place of the floor plan, with the expected size and base."""
    ahead, right = view.heading, np.array([view.heading[1], -view.heading[0]])
    forward = np.clip(plan @ ahead, settings.nearest_m, settings.farthest_m)
    start = np.zeros((len(problems), UNKNOWNS))
    start[:, 0] = np.clip(plan @ right / forward, -3.0, 3.0)
    start[:, 1] = np.log(forward)
    start[:, 2:5] = problems.log_size
    return start
