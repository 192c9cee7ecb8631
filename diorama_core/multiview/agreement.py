"""Which of an object's boxes one cuboid explains: what photos disagree about does not spoil what one photo shows.

A box that something hides, or that is another object's, pulls a joint cuboid away from all others. As in fits by
consensus (Fischler and Bolles 1981), a sighting that costs more than it may is left out of the fit; the object keeps
it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diorama_core.multiview.joining import RoomPhoto, Track, fitted_track, shown

LEFT_OUT_COST = 12.0
"""Of a sighting that is left out: four edges that are independent and of one sigma each cost more once in sixty."""


def with_agreeing_boxes(track: Track, photos: Sequence[RoomPhoto]) -> Track:
    """The object with the cuboid of those boxes that agree.

    One photo by itself says what it says at no cost. Of two that disagree the one that shows the object better counts,
    of more those that are left when the one goes without which the others agree best.
    """
    fitted = track
    while len(fitted.boxes) > 1 and fitted.cuboid.cost > LEFT_OUT_COST:
        fewer = [fitted_track(tuple(b for b in fitted.boxes if b != out), photos) for out in fitted.boxes]
        best = min(fewer, key=lambda t: (t.cuboid.cost, -max(shown(photos[p], box) for p, box in t.boxes)))
        if best.cuboid.cost + LEFT_OUT_COST >= fitted.cuboid.cost:
            break
        fitted = best
    left_out = tuple(b for b in track.boxes if b not in fitted.boxes)
    return replace(track, cuboid=fitted.cuboid, left_out=left_out)
