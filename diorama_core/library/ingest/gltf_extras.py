"""Extras of glTF nodes that say what a part is: `role`, `joint` and `parameter`.

They hold for a node and what is below it, as far as no node between says otherwise. In Blender they are custom
properties of an object, and are exported with the option "Custom Properties".

- `role`: a word, "door" or "seat", which names the part.
- `joint`: "revolute AXIS LOWER UPPER" (degrees), "prismatic AXIS LOWER UPPER" (metres) or "continuous AXIS". The axis
  is x, y, z, -x, -y or -z of the node's own frame, through its origin; 0 is how the file shows the part.
- `parameter`: sides of the shape ("depth", "width", "height") along which the part is stretched with it, or "rigid".
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.io.contained import shown
from diorama_core.io.text import clean_text
from diorama_core.library.furniture.joints import Joint, JointKind
from diorama_core.library.part_notes import PartNotes

KINDS: dict[str, JointKind] = {"revolute": "hinge", "prismatic": "slide", "continuous": "swivel"}
SIDES = ("depth", "width", "height")
"""Of the canonical frame's x, y and z."""
MAX_ROLE = 40
"""Characters of a role that are used."""
MAX_TURN_DEG, MAX_SLIDE_M = 360.0, 10.0


def notes_of_node(scene: trimesh.Scene, node: str, warnings: list[str]) -> PartNotes | None:
    """The notes on a node of a file, its joint in the file's frame; None where nothing is said.

    Args:
        scene: as the file has it.
        node: one with a mesh.
        warnings: gets a line for each extra that cannot be read, which is then left out.
    """
    role, stretches, joint = "", None, None
    for holder, extras in _said(scene, node):
        if not role and "role" in extras:
            role = clean_text(str(extras["role"])).strip()[:MAX_ROLE]
        if stretches is None and "parameter" in extras:
            stretches = _stretches(str(extras["parameter"]), holder, warnings)
        if joint is None and "joint" in extras:
            T_file_node = np.asarray(scene.graph[holder][0], float)
            joint = _joint(str(extras["joint"]), str(extras.get("role") or holder), T_file_node, warnings)
    notes = PartNotes(role, joint, stretches)
    return None if notes == PartNotes() else notes


def _said(scene: trimesh.Scene, node: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """The extras of a node, of its parent, and so on up to the root."""
    tree = scene.graph.transforms
    while node in tree.parents:
        parent = tree.parents[node]
        extras = tree.edge_data[parent, node].get("metadata")
        if isinstance(extras, dict):
            yield str(node), extras
        node = parent


def _stretches(words: str, node: str, warnings: list[str]) -> tuple[bool, bool, bool] | None:
    sides = words.replace(",", " ").lower().split()
    if sides != ["rigid"] and (not sides or set(sides) - set(SIDES)):
        warnings.append(
            f'node {shown(node)}: parameter {shown(words)} is left out; write "rigid", or sides such as "width height"'
        )
        return None
    return SIDES[0] in sides, SIDES[1] in sides, SIDES[2] in sides


def _joint(words: str, name: str, T_file_node: Float[np.ndarray, "4 4"], warnings: list[str]) -> Joint | None:
    """The joint that a text describes; the mirror image of a turn goes the other way."""
    try:
        kind, axis, lower, upper = _parsed(words.lower())
    except ValueError:
        warnings.append(
            f'{shown(name)}: joint {shown(words)} is left out; write "revolute y 0 110" (degrees, from -360 to 360), '
            '"prismatic z 0 0.4" (metres) or "continuous y"; 0 is within the limits'
        )
        return None
    turn = T_file_node[:3, :3]
    direction = turn @ axis * (np.sign(np.linalg.det(turn)) if kind != "slide" else 1.0)
    if abs(lower) > upper:  # open is where the part is farthest from where it stands
        lower, upper, direction = -upper, -lower, -direction
    length = float(np.linalg.norm(direction))
    if not (np.isfinite(T_file_node).all() and length > 0):
        return None  # the part itself is left out, with a warning of its own
    dx, dy, dz = (float(v) for v in direction / length)
    x, y, z = (float(v) for v in T_file_node[:3, 3])
    return Joint(clean_text(name).strip()[:MAX_ROLE], kind, (x, y, z), (dx, dy, dz), lower, upper)


def _parsed(words: str) -> tuple[JointKind, Float[np.ndarray, "3"], float, float]:
    """Kind, axis and limits (radians or metres); raises `ValueError` for any other text."""
    kind, axis, *limits = words.replace(",", " ").split()
    if kind not in KINDS or axis.removeprefix("-") not in ("x", "y", "z"):
        raise ValueError(words)
    direction = np.eye(3)["xyz".index(axis[-1])] * (-1.0 if axis.startswith("-") else 1.0)
    if KINDS[kind] == "swivel" and not limits:
        return KINDS[kind], direction, 0.0, 0.0
    lower, upper = (float(limit) for limit in limits)
    most = MAX_TURN_DEG if kind == "revolute" else MAX_SLIDE_M
    if not (-most <= lower <= 0.0 <= upper <= most and lower < upper) or KINDS[kind] == "swivel":
        raise ValueError(words)
    unit = np.pi / 180.0 if kind == "revolute" else 1.0
    return KINDS[kind], direction, lower * unit, upper * unit
