"""Things of a set share what the photo shows of them: legs that are seen of one chair are known of all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import cv2
import numpy as np

from diorama_core.scene.types import PhotoMaterial

_AGREE = 18.0
"""Colours of a set this near each other (CIELAB, lightness at half weight) are one colour in other light."""
_OWN_VOICE = 0.4
"""A member sees well enough to differ from its set when it is seen this well beside the one that is seen best."""

Colour = tuple[float, float, float]


def leaders(
    members: Sequence[str], colours: Mapping[str, Colour], sure: Mapping[str, tuple[float, str]]
) -> dict[str, str]:
    """For every member of a set the one whose colour it takes: itself, or the surest one of about its colour.

    Args:
        members: ids of the things.
        colours: main colours of those that have one, sRGB 0 to 1.
        sure: how well each is seen, with its id, so that no two are equal.

    Returns:
        The member that speaks for each; members that are hardly seen, or have no colour, follow the surest. Empty
        where none has a colour.
    """
    order = sorted((m for m in members if m in colours), key=sure.__getitem__, reverse=True)
    leading, follows = order[:1], {m: m for m in order[:1]}
    for member in order[1:]:
        alike = [leader for leader in leading if _agree(colours[member], colours[leader])]
        if not alike and sure[member][0] >= _OWN_VOICE * sure[leading[0]][0]:
            leading.append(member)
            follows[member] = member
        else:
            follows[member] = (alike or leading)[0]
    return {**dict.fromkeys(members, leading[0]), **follows} if leading else {}


def share_materials(
    materials: Mapping[str, tuple[PhotoMaterial, ...]],
    sets: Sequence[Sequence[str]],
    seen: Mapping[tuple[str, str], float],
) -> dict[str, tuple[PhotoMaterial, ...]]:
    """The materials by object, each slot of things of a set as the member shows it that sees it best.

    Args:
        materials: of every object, by its id.
        sets: ids of things of one shape.
        seen: pixels that show an object's slot, by the object's id and the slot's name.
    """
    shared = dict(materials)
    for members in sets:
        mains = {i: m.colour for i in members for m in materials.get(i, ()) if m.main}
        sure = {
            i: (max((v for (unshared, _), v in seen.items() if unshared == i), default=0.0) ** 0.5, i) for i in members
        }
        speaks_for = leaders(members, mains, sure)
        for leader in sorted(set(speaks_for.values())):
            group = [i for i in members if speaks_for[i] == leader]
            slots = {
                slot: max((i for i in group if (i, slot) in seen), key=lambda i: (seen[i, slot], i))
                for i in group
                for slot in (m.slot for m in materials.get(i, ()) if (i, m.slot) in seen)
            }
            common = tuple(next(m for m in materials[i] if m.slot == slot) for slot, i in sorted(slots.items()))
            for i in group:
                unshared = tuple(m for m in materials.get(i, ()) if m.slot not in slots)
                shared[i] = (*unshared, *common)
    return shared


def _agree(one: Colour, other: Colour) -> bool:
    lab = cv2.cvtColor(np.array([[one, other]], np.float32), cv2.COLOR_RGB2Lab)[0]
    return float(np.linalg.norm((lab[0] - lab[1]) / (2.0, 1.0, 1.0))) < _AGREE
