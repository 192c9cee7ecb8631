"""Run lengths of COCO (pixels out of and in the mask by turns, column by column, plain or packed) and Label Studio."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.errors import InputError
from diorama_core.perception.inputs.json_values import whole_numbers
from diorama_core.perception.inputs.masks.pictures import MAX_MASK_MEGAPIXELS


def decoded_runs(segment: Mapping[str, Any], name: str) -> Bool[np.ndarray, "h w"]:
    """The mask of an object with `size` (height, width) and `counts`.

    Raises:
        InputError: the counts do not make up the size.
    """
    size, counts = segment.get("size"), segment.get("counts")
    try:
        height, width = whole_numbers(size)
        runs = _unpacked(counts) if isinstance(counts, str) else whole_numbers(counts)
    except (ValueError, OverflowError):
        raise InputError(f"{name}: its run lengths are damaged; export the masks again") from None
    if height <= 0 or width <= 0 or height * width > MAX_MASK_MEGAPIXELS * 1_000_000:
        raise InputError(f"{name}: masks of {width} x {height} pixels are no usable size; give those of the photo")
    if min(runs, default=0) < 0 or sum(runs) != height * width:
        raise InputError(f"{name}: run lengths of {sum(runs)} pixels are not those of {width} x {height}; export again")
    inside = np.arange(len(runs)) % 2 == 1
    return np.repeat(inside, runs).reshape(width, height).T


def decoded_brush(segment: Mapping[str, Any], name: str) -> Bool[np.ndarray, "h w"]:
    """The mask of Label Studio's brush: bytes of a packed picture of four channels, of which the last is the mask.

    Args:
        segment: `rle`, a list of bytes, and `size` (height, width).
        name: of the file.

    Raises:
        InputError: the bytes do not make up the size.
    """
    try:
        height, width = whole_numbers(segment.get("size"))
        packed = bytes(whole_numbers(segment.get("rle")))
        if (
            not 0 < height * width <= MAX_MASK_MEGAPIXELS * 1_000_000
            or int.from_bytes(packed[:4]) != 4 * height * width
        ):
            raise ValueError(segment.get("size"))
        values = np.concatenate(list(_words(packed, 4 * height * width)))
        return np.asarray(values[3::4].reshape(height, width) > 127)
    except (ValueError, OverflowError, TypeError):
        raise InputError(f"{name}: the run lengths of a brush are damaged; export the masks again") from None


def _words(packed: bytes, count: int) -> Iterator[UInt8[np.ndarray, "_"]]:
    """The words of thi.ng's run lengths: 32 bits of count, the words' and four lengths' bits, then runs."""
    bits = "".join(format(byte, "08b") for byte in packed)
    at, done = 32, 0

    def number(width: int) -> int:
        nonlocal at
        at += width
        return int(bits[at - width : at], 2)

    word = number(5) + 1
    if word != 8:
        raise ValueError(word)
    widths = [number(4) + 1 for _ in range(4)]
    while done < count:
        same = number(1)
        length = number(widths[number(2)]) + 1
        done += length
        if same:
            yield np.full(length, number(word), np.uint8)
        else:
            yield np.array([number(word) for _ in range(length)], np.uint8)
    if done != count:
        raise ValueError(done)


def _unpacked(text: str) -> list[int]:
    """The counts of COCO's text: five bits a character, lowest first, from the third count on as differences."""
    runs: list[int] = []
    value, shift = 0, 0
    for letter in text:
        bits = ord(letter) - 48
        if not 0 <= bits < 64 or shift > 40:
            raise ValueError(text)
        value |= (bits & 0x1F) << shift
        shift += 5
        if bits & 0x20:
            continue
        if bits & 0x10:
            value -= 1 << shift
        runs.append(value + runs[-2] if len(runs) > 2 else value)
        value, shift = 0, 0
    return runs
