"""Depth in files of numpy: an array, or an archive of several with their names."""

from __future__ import annotations

import io
import math
import re
import zipfile
from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped

from diorama_core.errors import InputError
from diorama_core.perception.inputs.arrays import array_header
from diorama_core.perception.inputs.depth.channels import one_channel
from diorama_core.perception.inputs.depth.voids import only_sure
from diorama_core.perception.inputs.source import Source

MAX_DEPTH_MEGAPIXELS = 40
_DEPTH_NAMES = ("depth", "depth_m", "depths", "metric_depth", "depth_map", "pred_depth", "pred", "z", "dpt", "arr_0")
_BESIDE_DEPTH = re.compile(r"conf|mask|valid|rgb|image|img|colou?r|normal|label|segm|intrinsic|camera|pose|uncert")
"""In the names of arrays that lie beside depth."""
_RELATIVE_NAMES = ("inverse_depth", "inv_depth", "disparity", "disp")


@dataclass(frozen=True)
class DepthContent:
    """A file, and the photo's size, whose proportions a bare dump must have."""

    source: Source
    photo_size: tuple[int, int]


@dataclass(frozen=True, eq=False)
class RawDepth:
    """The numbers of a depth map as they are stored."""

    values: Shaped[np.ndarray, "h w"]
    notes: tuple[str, ...] = ()
    stated_kind: str | None = None
    """"inverse" where the array's name says so."""

    @property
    def is_float(self) -> bool:
        """Whether they are metres by themselves; whole numbers have a unit of their own."""
        return self.values.dtype.kind == "f"


def read_npy(content: DepthContent) -> RawDepth:
    """An array, after its header was found to promise no more than the file holds."""
    array = _array(content.source.data, content.source.name)
    return RawDepth(*one_channel(array, content.source.name))


def is_npz(content: DepthContent) -> bool:
    """Whether it is an archive of numpy's arrays."""
    data = content.source.data
    return data.startswith(b"PK\x03\x04") and b".npy" in data[:300]


def read_npz(content: DepthContent) -> RawDepth:
    """The array called `depth`, or the only one that can be a map."""
    name = content.source.name
    try:
        with zipfile.ZipFile(io.BytesIO(content.source.data)) as archive:
            if sum(m.file_size for m in archive.infolist()) > MAX_DEPTH_MEGAPIXELS * 24_000_000:
                raise InputError(f"{name}: its arrays are too large for a depth map; save depth alone")
            arrays = {m.filename.removesuffix(".npy"): archive.read(m) for m in archive.infolist()}
    except InputError:
        raise
    except Exception as error:  # a damaged archive raises almost anything
        raise InputError(f"{name}: the .npz file is truncated or damaged; write it again with numpy.savez") from error
    read = {k: _array(v, f"{name}: {k}") for k, v in arrays.items() if v.startswith(b"\x93NUMPY")}
    maps = {k: v for k, v in read.items() if v.dtype.kind in "fiu" and np.squeeze(v).ndim in (2, 3)}
    known = next((k for k in (*_DEPTH_NAMES, *_RELATIVE_NAMES) if k in maps), None)
    if known is None and len(maps) > 1:
        maps = {k: v for k, v in maps.items() if min(np.squeeze(v).shape[:2]) > 4 and not _BESIDE_DEPTH.search(k)}
    if known is None and len(maps) != 1:
        listed = ", ".join(read)[:120] or "nothing"
        raise InputError(f"{name}: which of its arrays is the depth ({listed})? call it 'depth', or save it as .npy")
    key = known or next(iter(maps))
    values, notes = one_channel(maps[key], name)
    kind = "inverse" if key in _RELATIVE_NAMES else None
    values, more = _apply_masks(values, read, key)
    return RawDepth(values, (*notes, *more), kind)


def _array(data: bytes, name: str) -> np.ndarray:
    """An array of numbers; the header is not trusted to allocate more than the file holds."""
    stream = io.BytesIO(data)
    try:
        shape, dtype = array_header(stream)
        if dtype.kind not in "fiub":
            raise InputError(f"{name}: depth in .npy must be floats in metres or whole numbers, this holds {dtype}")
        count = math.prod(shape)
        if count > MAX_DEPTH_MEGAPIXELS * 1_000_000 * 3:
            raise InputError(f"{name}: {count / 1e6:.0f} megapixels of depth are too many; save the photo's size")
        if count * dtype.itemsize > len(data):
            raise ValueError("fewer numbers than the header states")
        return np.asarray(np.load(stream, allow_pickle=False))
    except InputError:
        raise
    except Exception as error:  # a damaged header raises almost anything
        raise InputError(f"{name}: the .npy depth is truncated or damaged; write it again with numpy.save") from error


def _apply_masks(
    values: Shaped[np.ndarray, "h w"], arrays: dict[str, np.ndarray], key: str
) -> tuple[Shaped[np.ndarray, "h w"], tuple[str, ...]]:
    """The map without the pixels that a mask of the same file excludes."""
    for name in ("confidence", "conf", "depth_conf", "confidence_map"):
        level = np.squeeze(arrays[name]) if name in arrays else None
        if level is not None and level.shape == values.shape and level.dtype.kind in "bu":
            return only_sure(values, level, f"its {name}")
        if level is not None:
            return values, (f"its {name} is no map of whole numbers as large as the depth; it was not used",)
    for name in ("mask", "valid", "valid_mask"):
        mask = np.squeeze(arrays[name]) if name in arrays and name != key else None
        if mask is not None and mask.shape == values.shape and 0 < np.count_nonzero(mask) < mask.size:
            return np.where(mask != 0, values, 0), (f"{np.mean(mask == 0):.0%} of the depth is excluded by its {name}",)
    return values, ()
