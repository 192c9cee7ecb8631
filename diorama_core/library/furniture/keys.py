"""Keys to press: computer keyboards, keypads, and the keyboards of pianos."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Parts, Size, of
from diorama_core.library.furniture.solids import Solid, box

_OCTAVE_BLACKS = (0, 1, 3, 4, 5)
"""White keys of an octave that a black key follows, counted from the piano's lowest."""
_PIANO_WHITES = 52


def keypad(key: Solid, rows: Iterable[tuple[float, float]], across: Sequence[float]) -> list[Solid]:
    """A field of equal keys: at every (x, z) a row, in it one key at every y of `across`."""
    return [key.moved(x, y, z) for x, z in rows for y in across]


def spread(count: int, pitch: float, middle: float = 0.0) -> list[float]:
    """Places side by side, `pitch` apart, round a middle."""
    return [middle + (k - (count - 1) / 2) * pitch for k in range(count)]


def keys_of(d: float, w: float, rows: int, columns: int, z: float, height: float, material: Material) -> Parts:
    """The key caps of a computer's keyboard; the top row is toward -X, the space bar's toward +X."""
    pitch_x, pitch_y = d / rows, w / columns
    deep = pitch_x * 0.84
    xs = [d / 2 - pitch_x * (r + 0.5) for r in range(rows)]
    space = box((deep, pitch_y * 5.6, height), 0.0015).moved(xs[0], 0, z)
    beside = box((deep, pitch_y * 1.3, height), 0.0015)
    wide = [beside.moved(xs[0], s * (w / 2 - pitch_y * f), z) for s in (1, -1) for f in (0.75, 2.3)]
    cap = box((deep, pitch_y * 0.86, height), 0.0015)
    across = [-w / 2 + pitch_y * (c + 0.5) for c in range(columns)]
    return of(material, space, *wide, *keypad(cap, [(x, z) for x in xs[1:]], across))


def piano_keys(
    y: float,
    pitch: float,
    white: Size,
    white_at: tuple[float, float],
    black: Size,
    black_at: tuple[float, float],
    first: float = 0.5,
) -> Parts:
    """The 52 white keys of a piano and the black ones between them; the player is at +X.

    Args:
        y: Where the keyboard begins.
        pitch: From one white key to the next.
        white: Size of a white key.
        white_at: Its (x, z).
        black: Size of a black key.
        black_at: Its (x, z).
        first: Where the middle of the first white key is, in pitches from `y`.
    """
    whites = [y + pitch * (k + first) for k in range(_PIANO_WHITES)]
    blacks = [y + pitch * (k + first + 0.5) for k in range(_PIANO_WHITES - 1) if k % 7 in _OCTAVE_BLACKS]
    return of(m.WHITE, *keypad(box(white, 0.002), [white_at], whites)) + of(
        m.BLACK, *keypad(box(black, 0.002), [black_at], blacks)
    )
