"""Values as the XML formats of simulators write them."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.io.srgb import linear_to_srgb
from diorama_core.render.appearance import Material

_TERMS = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}


def numbers(values: Float[np.ndarray, " n"], digits: int = 9) -> str:
    """Numbers side by side, with this many significant digits."""
    return " ".join([f"{value:.{digits}g}" for value in np.asarray(values, dtype=float).tolist()])


def inertia_terms(tensor: Float[np.ndarray, "3 3"]) -> dict[str, str]:
    """The six different entries of an inertia tensor, by the names that URDF and SDF give them."""
    return {name: f"{float(tensor[at]):.8g}" for name, at in _TERMS.items()}


def srgb_rgba(material: Material) -> Float[np.ndarray, "4"]:
    """A material's colour as programs without linear light expect it."""
    return np.append(linear_to_srgb(np.asarray(material.colour)), material.alpha)
