"""Numbers as text, a million at a time: what the text formats spend their time on."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

ROWS_AT_ONCE = 100_000
_SPACE, _POINT, _MINUS, _NEWLINE, _ZERO = 32, 46, 45, 10, 48


def number_rows(prefix: str, values: Float[np.ndarray, "n k"], decimals: int) -> bytes:
    """Lines of a prefix and k numbers with a fixed count of decimals, columns padded with spaces.

    Args:
        prefix: Start of every line, such as `v`.
        values: Finite numbers.
        decimals: Digits behind the point, at least one.
    """
    if len(values) == 0:
        return b""
    scaled = np.rint(np.asarray(values, dtype=np.float64) * 10**decimals).astype(np.int64)
    size = np.abs(scaled)
    whole = max(1, len(str(int(size.max()) // 10**decimals)))
    width = whole + decimals + 3  # a space, a sign and the point
    text = np.full((*scaled.shape, width), _SPACE, dtype=np.uint8)
    text[..., width - 1 - decimals] = _POINT
    first = np.full(scaled.shape, width - decimals - 2)
    """Column of the foremost digit: at least one stands before the point."""
    for place in range(whole + decimals):
        size, digit = np.divmod(size, 10)
        column = width - 1 - place - (place >= decimals)
        text[..., column] = digit + _ZERO
        if place > decimals:
            leading = (digit == 0) & (size == 0)
            text[..., column][leading] = _SPACE
            first[~leading] = column
    negative = np.nonzero(scaled < 0)
    text[(*negative, first[negative] - 1)] = _MINUS
    rows = text.reshape(len(values), -1)
    head = np.broadcast_to(np.frombuffer(prefix.encode(), np.uint8), (len(values), len(prefix)))
    return np.concatenate([head, rows, np.full((len(values), 1), _NEWLINE, np.uint8)], axis=1).tobytes()


def index_rows(pattern: str, indices: Int[np.ndarray, "n k"]) -> bytes:
    """Lines made by a printf pattern with k places for integers."""
    parts = []
    for start in range(0, len(indices), ROWS_AT_ONCE):
        block = indices[start : start + ROWS_AT_ONCE]
        parts.append(((pattern + "\n") * len(block)) % tuple(block.reshape(-1).tolist()))
    return "".join(parts).encode()
