"""Which reading of a depth map is used, what is said about it, and when it is asked for instead."""

from __future__ import annotations

from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.kinds import BENT, CONTRADICTION, MIN_ORDER, DepthKind, DepthReading
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError, DepthAnswer

CONTRADICTING_PLANES = 0.08
"""Share of pixels by which inverse depth forms more planes, from which it would have to be what is given."""
MORE_PLANES = 0.015
"""Share of pixels by which planes must speak for another reading, whatever near and far say."""
BENT_PLANES = 0.05
"""Share of pixels by which the root or logarithm of depth must form more planes to be asked for: depth that networks
guessed bends planes by itself."""
WORDS = {
    "depth": "depth along the optical axis",
    "distance": "distances along the rays",
    "inverse": "inverse depth",
    "root": "the square root of depth",
    "logarithm": "the logarithm of depth",
    "shifted": "depth less a constant, as programs normalise it",
}
_INVERSE_ANSWERS = (
    DepthAnswer("inverse depth, fitted to the usual sizes of objects", kind="inverse"),
    DepthAnswer("depth along the optical axis after all", kind="depth"),
)


def chosen_reading(
    name: str, readings: tuple[DepthReading, ...], stated_kind: str | None, kind: DepthKind
) -> tuple[DepthReading, tuple[str, ...]]:
    """The reading that is used, and what to say about it.

    Args:
        name: of the file.
        readings: likeliest first; depth, inverse depth and the given kind are among them.
        stated_kind: "inverse" where the file says so.
        kind: what its user says.

    Raises:
        AmbiguousDepthError: the map is inverse depth, or the root or logarithm of depth.
        InputError: it contradicts the picture.
    """
    best, of_kind = readings[0], {r.kind: r for r in readings}
    if kind != "auto":
        note = f"{name} was read as {WORDS[kind]} as asked, but its planes look like {WORDS[best.kind]}"
        return of_kind[kind], (note,) if best.score - of_kind[kind].score > CONTRADICTION else ()
    depth, inverse = of_kind["depth"], of_kind["inverse"]
    if stated_kind == "inverse":
        best = inverse
    doubt = _bent(name, readings)
    if inverse.fit.explained - depth.fit.explained > CONTRADICTING_PLANES and inverse.order < MIN_ORDER:
        raise InputError(
            f"{name}: this contradicts the picture: walls and floor are not flat, near and far are not the photo's; "
            "give z in the camera, or say what it is by --depth-kind"
        )
    clearly = best.score - depth.score > CONTRADICTION / 2 and best.fit.explained > depth.fit.explained + MORE_PLANES
    if best.kind not in ("distance", "inverse") or not clearly:
        return depth, doubt
    if best.kind == "distance":
        remark = f"{name} holds distances along the rays, not along the optical axis: only so are walls and floor flat"
        return best, (remark + "; they were converted (--depth-kind depth keeps them)",)
    raise AmbiguousDepthError(
        f"{name}: this is inverse depth or disparity (larger is nearer), which has no unit; give metric depth, or add "
        "--depth-kind inverse to fit it to the objects' usual sizes",
        _INVERSE_ANSWERS,
    )


def _bent(name: str, readings: tuple[DepthReading, ...]) -> tuple[str, ...]:
    """A note where walls and floor are flatter under the root or logarithm of depth than under all other readings.

    Raises:
        AmbiguousDepthError: they are much flatter.
    """
    flattest = max(readings, key=lambda r: r.fit.explained)
    if flattest.kind not in BENT:
        return ()
    more = flattest.fit.explained - max(r.fit.explained for r in readings if r.kind not in BENT)
    looks = f"walls and floor are flat only if this is {WORDS[flattest.kind]}"
    if more > BENT_PLANES:
        raise AmbiguousDepthError(
            f"{name}: {looks}; give depth itself, or add --depth-kind {flattest.kind}, or --depth-kind depth if it is",
            (
                DepthAnswer(f"{WORDS[flattest.kind]}, fitted to the usual sizes of objects", kind=flattest.kind),
                DepthAnswer("depth along the optical axis after all", kind="depth"),
            ),
        )
    return (f"{name} may be {WORDS[flattest.kind]}: so walls and floor would be flatter",) if more > MORE_PLANES else ()
