"""Which of an object's boxes one cuboid explains: what photos disagree about does not spoil what one photo shows.

A box that something hides, or that is another object's, pulls a joint cuboid away from all others. As in fits by
consensus (Fischler and Bolles 1981), a sighting that costs more than it may is left out of the fit; the object keeps
it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diorama_core.multiview.joining import RoomPhoto, Track, fitted_track, shown
from diorama_core.multiview.settings import SETTINGS, JoiningSettings


def with_agreeing_boxes(track: Track, photos: Sequence[RoomPhoto], settings: JoiningSettings = SETTINGS) -> Track:
    """The object with the cuboid of those boxes that agree.

    One photo by itself says what it says at no cost. Of two that disagree the one that shows the object better counts,
    of more those that are left when the one goes without which the others agree best.
    """
    fitted = track
    while len(fitted.boxes) > 1 and fitted.cuboid.cost > settings.left_out_cost:
        fewer = [fitted_track(tuple(b for b in fitted.boxes if b != out), photos, settings) for out in fitted.boxes]
        best = min(fewer, key=lambda t: (t.cuboid.cost, -max(shown(photos[p], box, settings) for p, box in t.boxes)))
        if best.cuboid.cost + settings.left_out_cost >= fitted.cuboid.cost:
            break
        fitted = best
    left_out = tuple(b for b in track.boxes if b not in fitted.boxes)
    return replace(track, cuboid=fitted.cuboid, left_out=left_out)
