"""Reading measured depth: what the file is, what its numbers mean, how long their unit is; missing is 0 afterwards."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float, Float32, Shaped, UInt8

from diorama_core.artefacts import Box, LabelledBox
from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.confidence import without_unsure
from diorama_core.perception.inputs.depth.containers import DEPTH_FORMS
from diorama_core.perception.inputs.depth.kinds import (
    BENT,
    CONTRADICTION,
    MIN_ORDER,
    DepthKind,
    DepthReading,
    Known,
    depth_readings,
    rays_of,
)
from diorama_core.perception.inputs.depth.numpy_files import DepthContent, RawDepth
from diorama_core.perception.inputs.depth.scale import (
    AmbiguousDepthError,
    DepthAnswer,
    focal_of_planes,
    metric_depth,
    metric_of_bent,
    scale_evidence,
    unit_of,
)
from diorama_core.perception.inputs.depth.voids import find_measured_pixels
from diorama_core.perception.inputs.photos.reading import DecodedPhoto
from diorama_core.perception.inputs.source import Source, form_of
from diorama_core.scene.types import Intrinsics

DepthEncoding = Literal["linear", "sunrgbd"]
"""How a PNG's 16 bits mean distance: as they are, or rotated by three bits as in SUN RGB-D."""
FARTHEST_M = 80.0
"""Larger values mean that the sensor measured nothing."""
ROOM_MEDIAN_M = (0.15, 20.0)
"""Median depth of a photo of a room; outside, the unit is wrong."""
MIN_COVERAGE = 0.01
LOW_COVERAGE = 0.2
MIN_PIXELS = 1500
"""Measured, from which a map is looked at: fewer do not show what planes are."""
MILLIMETRES = 1000.0
MOSTLY = 0.5
"""Share of the pixels that must be negative, for a map of a camera that looks along -z."""
Z_BUFFER = (0.6, 1.0)
"""Within which all values of a graphics card's depth buffer lie where nothing is close to the camera."""
WORKING_SIDE_PX = 192
MARGIN = 0.1
"""By which the edges of a turned map must agree better with the photo's, as correlations."""
MIN_AGREEMENT = 0.25
"""Correlation of a turned map with the photo: measured maps that lie right have 0.28 to 0.4, turned ones up to 0.24."""
_TURNS = {
    "mirrored": np.s_[:, ::-1],
    "upside down": np.s_[::-1, ::-1],
    "upside down and mirrored": np.s_[::-1, :],
}
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


@dataclass(frozen=True)
class DepthOptions:
    """What a person says of a depth map."""

    per_metre: float | None = None
    """Units per metre; None for millimetres of whole numbers and metres of others, unless the picture contradicts."""
    encoding: DepthEncoding = "linear"
    kind: DepthKind = "auto"


def read_depth(
    source: Source,
    options: DepthOptions,
    photo: DecodedPhoto,
    boxes: tuple[LabelledBox, ...] = (),
    intrinsics: Intrinsics | None = None,
) -> tuple[Float32[np.ndarray, "h w"], tuple[str, ...]]:
    """Depth in metres at the photo's size, 0 where missing, and what was understood.

    Args:
        source: the file.
        options: what its user says of it.
        photo: over which it lies.
        boxes: named things, whose sizes tell the unit.
        intrinsics: of the photo, where they are known.

    Raises:
        InputError: when it is no depth, contradicts the picture, or its proportions are not the photo's.
    """
    scale = options.per_metre
    if scale is not None and (not np.isfinite(scale) or scale <= 0):
        raise InputError(f"--depth-scale {scale:g}: give a positive number of units per metre, 1000 for millimetres")
    size = (photo.photo.width, photo.photo.height)
    raw = _raw(source, photo)
    trusted, unsure = without_unsure(source, raw.values)
    trusted, upended = _positive(trusted)
    values, laid = photo.frame.align_map(source.name, "depth", trusted)
    if options.encoding == "sunrgbd" and not raw.is_float:
        values = _unrotate_bits(values)
    valid, voids = find_measured_pixels(values)
    if valid.sum() <= MIN_COVERAGE * valid.size:
        raise InputError(f"{source.name}: the depth is empty or nearly so; leave it out or choose another file")
    with np.errstate(invalid="ignore", over="ignore"):
        numbers = np.where(valid, values, 0).astype(np.float32)
    over = None if options.kind != "auto" or valid.sum() < MIN_PIXELS else find_turn(numbers, photo.photo.rgb)
    if over is not None:
        numbers = apply_turn(numbers, over)
        laid = (*laid, f"the depth lies {over} over the photo, by the edges of both; it was turned")
    depth, understood = _convert_to_metres(source.name, numbers, raw, options, _surroundings(photo, boxes, intrinsics))
    coverage = _check_plausible(source.name, depth, values, raw, options)
    resized, coarse = _resize_to_photo(depth, size)
    resized.setflags(write=False)
    return resized, (*raw.notes, *unsure, *upended, *laid, *voids, *understood, *coverage, *coarse)


def _surroundings(photo: DecodedPhoto, boxes: tuple[LabelledBox, ...], intrinsics: Intrinsics | None) -> Known:
    """The boxes and the focal length, the given one or that of the header, in shares of the photo's longer side."""
    side = max(photo.photo.width, photo.photo.height)
    focal = photo.photo.exif_focal_px if intrinsics is None else intrinsics.fx
    return Known(tuple(replace(b, box=_shares(b.box, side)) for b in boxes), None if focal is None else focal / side)


def _shares(box: Box, side: int) -> Box:
    x1, y1, x2, y2 = box
    return x1 / side, y1 / side, x2 / side, y2 / side


def _raw(source: Source, photo: DecodedPhoto) -> RawDepth:
    content = DepthContent(source, photo.frame.inner_size)
    form = form_of(DEPTH_FORMS, content)
    if form is None:
        raise InputError(f"{source.name}: {_what_it_is(source)}; save depth as 16-bit PNG, .npy in metres, or EXR")
    return form.read(content)


def _what_it_is(source: Source) -> str:
    data = source.data
    if data.startswith(b"\x89HDF"):
        return "this is an HDF5 file"
    if data.startswith(b"MATLAB"):
        return "this is a MATLAB file"
    if data.startswith(b"PK\x03\x04"):
        return "this is an archive, not a depth map"
    if source.suffix in (".raw", ".bin", ".dat"):
        return f"a dump of {len(data)} bytes has not the photo's proportions, or is of numbers that are not read"
    return "this is not a picture or array of depth"


def _convert_to_metres(
    name: str, numbers: Float32[np.ndarray, "h w"], raw: RawDepth, options: DepthOptions, known: Known
) -> tuple[Float32[np.ndarray, "h w"], tuple[str, ...]]:
    """The numbers as metres along the optical axis."""
    stated = 1.0 if raw.is_float else MILLIMETRES
    is_metric = options.kind == "depth" and options.per_metre is not None
    if is_metric or (options.kind == "auto" and np.count_nonzero(numbers) < MIN_PIXELS):
        return _to_metres(numbers, options.per_metre or stated), ()
    readings = depth_readings(numbers, known, options.kind)
    reading, notes = choose_reading(name, readings, raw.stated_kind, options.kind)
    if reading.kind == "inverse":
        depth, more = metric_depth(name, numbers, reading.fit, known)
        return depth.astype(np.float32), (*notes, *more)
    if reading.kind in BENT:
        depth, more = metric_of_bent(name, numbers, reading, known, options.per_metre)
        return depth.astype(np.float32), (*notes, *more)
    along = numbers
    if reading.kind == "distance" and reading.focal is not None:
        along = (numbers / rays_of(numbers.shape[0], numbers.shape[1], reading.focal)).astype(np.float32)
    focal = known.focal or reading.focal or focal_of_planes(reading.fit)
    evidence = scale_evidence(along, reading.fit, focal, known.boxes)
    unit = unit_of(evidence, options.per_metre or stated)
    if options.per_metre is not None:
        doubt = f"{unit.note or unit.question}".split("; ")[0]
        notes += (f"{doubt}: check --depth-scale",) if unit.note or unit.question else ()
        return _to_metres(along, options.per_metre), notes
    if unit.question:
        answers = tuple(DepthAnswer(words, per_metre) for per_metre, words in unit.choices)
        raise AmbiguousDepthError(f"{name}: {unit.question}", answers)
    if evidence is None and not raw.is_float:
        notes += (
            "the depth was taken for millimetres, which neither a floor nor named objects confirm: --depth-scale",
        )
    return _to_metres(along, unit.per_metre), (*notes, *([unit.note] if unit.note else []))


def _to_metres(numbers: Float32[np.ndarray, "h w"], per_metre: float) -> Float32[np.ndarray, "h w"]:
    return numbers if per_metre == 1.0 else (numbers / np.float64(per_metre)).astype(np.float32)


def _positive(values: Shaped[np.ndarray, "h w"]) -> tuple[Shaped[np.ndarray, "h w"], tuple[str, ...]]:
    """Depth of cameras that look along -z (OpenGL, Blender) as distance before them."""
    if values.dtype.kind != "f" or np.mean(values < 0) < MOSTLY or np.mean(values > 0) > 1.0 - MOSTLY:
        return values, ()
    return -values, ("the depth is negative, as of a camera that looks along -z; its sign was changed",)


def _unrotate_bits(values: Shaped[np.ndarray, "*n"]) -> Shaped[np.ndarray, "*n"]:
    """SUN RGB-D's storage undone: the 16 bits were rotated left by three."""
    v = values.astype(np.uint32)
    return (((v >> 3) | (v << 13)) & 0xFFFF).astype(np.uint16)


def _check_plausible(
    name: str,
    depth_m: Float32[np.ndarray, "h w"],
    raw: Shaped[np.ndarray, "h w"],
    about: RawDepth,
    options: DepthOptions,
) -> tuple[str, ...]:
    """A note about little coverage; what is too far is dropped in place."""
    valid = depth_m[depth_m > 0]
    median = float(np.median(valid))
    if not ROOM_MEDIAN_M[0] <= median <= ROOM_MEDIAN_M[1]:
        raise InputError(f"{name}: {_unit_advice(median, raw, about, options)}")
    depth_m[depth_m > FARTHEST_M] = 0.0
    notes = []
    low, high = (float(v) for v in np.percentile(valid, [2, 98]))
    if Z_BUFFER[0] < low < high <= Z_BUFFER[1]:
        notes.append(f"nearly all depth is {low:.3g} to {high:.3g} m: if it is a renderer's z-buffer, give metres")
    if valid.size < LOW_COVERAGE * depth_m.size:
        notes.append(f"only {100 * valid.size / depth_m.size:.0f} % of the depth is measured")
    return tuple(notes)


def _unit_advice(median: float, raw: Shaped[np.ndarray, "h w"], about: RawDepth, options: DepthOptions) -> str:
    read_as = f"read this way the middle depth is {median:.3g} m, which is no room"
    if about.is_float and options.per_metre is None:
        return f"{read_as}; the numbers must be metres, or give their units per metre by --depth-scale"
    scale = options.per_metre or MILLIMETRES
    if options.encoding == "linear" and not about.is_float:
        turned = _unrotate_bits(raw[raw > 0]) / scale
        if ROOM_MEDIAN_M[0] <= float(np.median(turned)) <= ROOM_MEDIAN_M[1] and median > ROOM_MEDIAN_M[1]:
            return f"{read_as}; it looks like SUN RGB-D's rotated bits: add --depth-encoding sunrgbd"
    return f"{read_as}; set --depth-scale (units per metre, now {scale:g}) or --depth-encoding"


def _resize_to_photo(
    depth_m: Float32[np.ndarray, "h w"], photo_size: tuple[int, int]
) -> tuple[Float32[np.ndarray, "_ _"], tuple[str, ...]]:
    """Resize by nearest neighbour, so that no depth is invented between a chair's edge and the wall behind it."""
    height, width = depth_m.shape
    if (width, height) == photo_size:
        return depth_m, ()
    import cv2  # the editor opens without it

    resized = cv2.resize(np.ascontiguousarray(depth_m), photo_size, interpolation=cv2.INTER_NEAREST_EXACT)
    if width * 2 < photo_size[0]:
        return resized, (f"the depth ({width} x {height}) is much coarser than the photo",)
    return resized, ()


def find_turn(values: Float[np.ndarray, "h w"], rgb: UInt8[np.ndarray, "h2 w2 3"]) -> str | None:
    """How a map, 0 where nothing was measured, lies over its photo of the same proportions, where that is clearly not
    as the photo; None otherwise.
    """
    import cv2  # the editor opens without it

    scale = WORKING_SIDE_PX / max(rgb.shape[:2])
    size = max(8, round(rgb.shape[1] * scale)), max(8, round(rgb.shape[0] * scale))
    grey = cv2.cvtColor(cv2.resize(rgb, size, interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2GRAY).astype(np.float32)
    valid = values > 0
    low, high = np.percentile(values[::4, ::4][valid[::4, ::4]], [2, 98])
    even = np.clip((np.where(valid, values, low) - low) / max(float(high - low), 1e-12), 0, 1).astype(np.float32)
    steps = cv2.resize(even, size, interpolation=cv2.INTER_AREA)
    seen = cv2.resize(valid.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0.99
    sure = cv2.erode(seen.astype(np.uint8), np.ones((5, 5))) > 0  # not where measured meets missing
    photo, depth = _edges(grey), _edges(steps)
    as_is = _agreement(photo, depth, sure)
    agreements = {name: _agreement(photo, depth[turn], sure[turn]) for name, turn in _TURNS.items()}
    best = max(agreements, key=lambda name: agreements[name])
    return best if agreements[best] > max(as_is + MARGIN, MIN_AGREEMENT) else None


def apply_turn(values: Float[np.ndarray, "h w"], how: str) -> Float[np.ndarray, "h w"]:
    """A map as it lies over its photo, `how` being what `find_turn` said of it."""
    return np.ascontiguousarray(values[_TURNS[how]])


def _edges(picture: Float[np.ndarray, "h w"]) -> Float[np.ndarray, "h w"]:
    import cv2  # as above

    strength = np.hypot(*(cv2.Sobel(picture, cv2.CV_32F, dx, 1 - dx) for dx in (0, 1)))
    return np.asarray(cv2.GaussianBlur(np.sqrt(strength), (5, 5), 0))


def _agreement(one: Float[np.ndarray, "h w"], other: Float[np.ndarray, "h w"], sure: Bool[np.ndarray, "h w"]) -> float:
    """The correlation of two pictures of edges where the second one is sure."""
    if np.count_nonzero(sure) < 0.2 * sure.size:
        return 0.0
    a, b = one[sure] - one[sure].mean(), other[sure] - other[sure].mean()
    return float((a * b).sum() / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-12))


def choose_reading(
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
    doubt = _check_bent_reading(name, readings)
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


def _check_bent_reading(name: str, readings: tuple[DepthReading, ...]) -> tuple[str, ...]:
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
