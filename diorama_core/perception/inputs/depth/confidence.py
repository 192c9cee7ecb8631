"""Confidence beside one photo's depth, as phones and scanner apps write it: what is unsure counts as not measured."""

from __future__ import annotations

import glob
import re
from pathlib import Path

import numpy as np
from jaxtyping import Shaped

from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.containers import DEPTH_FORMS
from diorama_core.perception.inputs.depth.numpy_files import DepthContent
from diorama_core.perception.inputs.depth.voids import only_sure
from diorama_core.perception.inputs.source import Source, form_of

_NAMED = re.compile(r"confidence|(?:^|[_.\- ])conf(?![a-z])")
_NO_MAPS = (".json", ".txt", ".csv", ".xml", ".yaml", ".yml", ".md", ".ini")


def is_confidence(name: str) -> bool:
    """Whether a file's name, or its folder's, says that it is a confidence map."""
    path = Path(name.lower())
    return path.suffix not in _NO_MAPS and any(_NAMED.search(part) for part in (path.name, path.parent.name))


def is_map(companion: Source) -> bool:
    """Whether a file that came with a depth map is its confidence, and no list of names."""
    return companion.suffix not in _NO_MAPS


def without_unsure(
    source: Source, values: Shaped[np.ndarray, "h w"]
) -> tuple[Shaped[np.ndarray, "h w"], tuple[str, ...]]:
    """A map with 0 where the confidence that lies beside its file is low, and what was done; the map itself without."""
    for beside in tuple(c for c in source.companions if is_map(c)) or _confidence_files(source):
        confidence = _read(beside, values.shape)
        if confidence is None:
            return values, (
                f"{beside.name} is no confidence map of the depth (whole numbers, as large); it was not used",
            )
        return only_sure(values, confidence, beside.name)
    return values, ()


def _confidence_files(source: Source) -> tuple[Source, ...]:
    """Files that may be the confidence of a depth map, likeliest first."""
    stem, name = glob.escape(Path(source.name).stem), glob.escape(Path(source.name).name)
    named = [f"{stem}{joint}conf*.*" for joint in "_.-"]
    if "depth" in stem.lower():
        named += [f"{part}.*" for word in ("confidence", "conf") if (part := _replace_word(stem, word)) != stem]
    files = source.sibling_files(*named)
    if not files and source.path is not None and source.path.parent.name.lower().startswith("depth"):
        files = Source(b"", "", source.path.parent).sibling_files(f"confidence/{name}", f"confidence_map/{name}")
    return files


def _replace_word(stem: str, word: str) -> str:
    """A name with another word for depth, as in depth_0001 and confidence_0001."""
    at = stem.lower().index("depth")
    return stem[:at] + word + stem[at + len("depth") :]


def _read(source: Source, shape: tuple[int, ...]) -> Shaped[np.ndarray, "h w"] | None:
    """Whole numbers as large as the depth; None where the file holds none."""
    if len(source.data) == shape[0] * shape[1]:
        return np.frombuffer(source.data, np.uint8).reshape(shape)  # ARKit's buffer as it is
    content = DepthContent(source, (shape[1], shape[0]))
    form = form_of(DEPTH_FORMS, content)
    try:
        values = None if form is None else form.read(content).values
    except InputError:
        return None
    return values if values is not None and values.shape == shape and values.dtype.kind in "bu" else None
