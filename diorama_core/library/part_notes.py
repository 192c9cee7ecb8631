"""Notes on one part of a model that is not built in: its role, its joint, and along which sides it stretches.

An author writes them as extras of glTF nodes (`ingest.repair`). A library's own GLB files carry them as extras of
meshes, in the shape's canonical frame.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.errors import LibraryError
from diorama_core.io.bounded import fits
from diorama_core.library.furniture.joints import Joint

KEY = "part"
"""Of a mesh's metadata."""


@dataclass(frozen=True)
class PartNotes:
    """Notes on one part; those on parts that move together have equal joints."""

    role: str = ""
    """"door", "seat"; empty where nobody says."""
    joint: Joint | None = None
    """In the frame of the mesh; None for a part that stays."""
    stretches: tuple[bool, bool, bool] | None = None
    """Along the shape's depth, width and height; None where its thickness decides (`stretch`)."""

    def transform(self, T: Float[np.ndarray, "4 4"]) -> PartNotes:
        """The notes in another frame, whose axes may have another unit but are not mirrored."""
        if self.joint is None:
            return self
        axis = T[:3, :3] @ self.joint.axis
        scale = float(np.linalg.norm(axis))
        travel = scale if self.joint.kind == "slide" else 1.0
        origin = T[:3, :3] @ self.joint.origin + T[:3, 3]
        joint = Joint(
            self.joint.name,
            self.joint.kind,
            (float(origin[0]), float(origin[1]), float(origin[2])),
            (float(axis[0] / scale), float(axis[1] / scale), float(axis[2] / scale)),
            self.joint.lower * travel,
            self.joint.upper * travel,
        )
        return replace(self, joint=joint)

    def as_json(self) -> dict[str, Any]:
        """A JSON object, which `notes_of` reads back."""
        return asdict(self)


def notes_of(mesh: trimesh.Trimesh) -> PartNotes | None:
    """The notes on a mesh of a library; None where there are none.

    Raises:
        LibraryError: when they are not what `PartNotes.as_json` writes.
    """
    row = mesh.metadata.get(KEY)
    if row is None:
        return None
    try:
        joint, stretches = row["joint"], row["stretches"]
        if joint is not None:
            joint = Joint(**joint | {name: tuple(joint[name]) for name in ("origin", "axis")})
        notes = PartNotes(row["role"], joint, None if stretches is None else tuple(stretches))
    except (TypeError, KeyError, ValueError) as error:
        raise LibraryError("the notes on a part are damaged; add the shape to its library again") from error
    if not fits(notes, PartNotes):
        raise LibraryError("the notes on a part are damaged; add the shape to its library again")
    return notes


def transform(mesh: trimesh.Trimesh, T: Float[np.ndarray, "4 4"]) -> trimesh.Trimesh:
    """A copy of a mesh in another frame, with its notes."""
    made = mesh.copy().apply_transform(T)
    if (notes := notes_of(mesh)) is not None:
        made.metadata[KEY] = notes.transform(T).as_json()
    return made
