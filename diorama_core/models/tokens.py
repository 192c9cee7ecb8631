"""Words as CLIP's byte-pair tokens."""

from __future__ import annotations

import html
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Int64

from diorama_core.models.runtime import NetworkError


def load_tokenizer(path: Path) -> Any:
    """The tokenizer of a `tokenizer.json`.

    Raises:
        NetworkError: when the file is absent or damaged.
    """
    from tokenizers import Tokenizer

    try:
        tokenizer = Tokenizer.from_file(str(path))
    except Exception as error:  # the tokenizer raises plain `Exception` on damaged files
        reason = " ".join(str(error).split())[:120]
        raise NetworkError(path, f"cannot be read ({reason}); run: diorama models verify") from error
    tokenizer.no_padding()
    tokenizer.no_truncation()
    return tokenizer


def clip_tokens(
    tokenizer: Any, texts: Sequence[str], length: int
) -> tuple[Int64[np.ndarray, "n length"], Int64[np.ndarray, "n length"]]:
    """Ids padded with 0 to a fixed length, and 1 where a word is; longer texts are cut but keep their end mark."""
    ids = np.zeros((len(texts), length), np.int64)
    mask = np.zeros((len(texts), length), np.int64)
    for row, text in enumerate(texts):
        tokens = tokenizer.encode(tidy(text)).ids
        if len(tokens) > length:
            tokens = [*tokens[: length - 1], tokens[-1]]
        ids[row, : len(tokens)] = tokens
        mask[row, : len(tokens)] = 1
    return ids, mask


def tidy(text: str) -> str:
    """Lower case, single spaces, entities resolved, as CLIP's texts were prepared."""
    return " ".join(html.unescape(html.unescape(text)).lower().split())
