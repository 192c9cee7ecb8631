"""The picture of a plan that lies below a project's plan: `plan.jpg`, and where it lies in `project.json`."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
from jaxtyping import UInt8

from diorama_core.errors import InputError, ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_bytes
from diorama_core.project.storage import Project, jpeg

MAX_BYTES = 40_000_000
ENTRY = "plan_picture"
MIN_METRES, MAX_METRES = 1e-5, 10.0
"""Side of a pixel (m)."""
REACH_M = 10_000.0


@dataclass(frozen=True)
class PlanPicture:
    """Where the picture lies."""

    size: tuple[int, int]
    """Width and height in pixels."""
    at: tuple[float, float]
    """Its middle, x and y in the world (m)."""
    metres: float
    """Side of a pixel (m)."""

    def __post_init__(self) -> None:
        """Raises `InputError` for a place or a scale that no plan has."""
        good = all(abs(v) < REACH_M for v in self.at) and MIN_METRES < self.metres < MAX_METRES
        if not good or min(self.size) < 1:
            raise InputError("the picture of the plan cannot lie there; scale it by a length that you know")


def save_plan_picture(project: Project, rgb: UInt8[np.ndarray, "h w 3"], picture: PlanPicture) -> None:
    """Keep a picture and where it lies.

    Raises:
        ProjectError: the folder cannot be written.
    """
    write_atomically(project.folder / "plan.jpg", jpeg(rgb), error=ProjectError)
    place_plan_picture(project, picture)


def place_plan_picture(project: Project, picture: PlanPicture | None) -> None:
    """Keep where the picture lies; None takes it away."""
    project.update_info(**{ENTRY: None if picture is None else asdict(picture)})


def load_plan_picture(project: Project) -> tuple[bytes, PlanPicture] | None:
    """The picture as a JPEG file and where it lies; None without one, or where it is damaged."""
    row = project.info().get(ENTRY)
    path = project.folder / "plan.jpg"
    if not isinstance(row, dict) or not path.is_file():
        return None
    try:
        (width, height), (x, y) = row["size"], row["at"]
        picture = PlanPicture((int(width), int(height)), (float(x), float(y)), float(row["metres"]))
        return read_bytes(path, MAX_BYTES, ProjectError), picture
    except (LookupError, TypeError, ValueError, InputError, ProjectError):
        return None
