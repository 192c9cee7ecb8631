"""Reading files back: bounded before memory, one clear line for whatever is wrong, and every value of the type that the
code says it is.

A project folder, a scene or a texture may come from somebody else, and a disk may return anything. Every reader of the
program goes through these functions: they check the size before reading, the number of pixels before decoding and the
nesting before building values, and they raise the caller's kind of error and nothing else.
"""

from __future__ import annotations

import io
import json
import os
import re
import stat
import types
import warnings
from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import jaxtyping
import numpy as np
from jaxtyping import UInt8
from PIL import EpsImagePlugin, Image

from diorama_core.errors import DioramaError

EpsImagePlugin.gs_binary = False  # no picture starts a program, not even one that a library opens for us

Kind = type[DioramaError]

MAX_JSON_BYTES = 64_000_000
MAX_JSON_DEPTH = 64
MAX_PICTURE_BYTES = 64_000_000
MAX_PIXELS = 40_000_000
PICTURE_FORMATS = ("JPEG", "PNG", "WEBP")
"""What the program writes. Others are not opened: some (EPS) make the decoder start other programs."""

_STRINGS = re.compile(rb'"[^"\\]*+(?:\\.[^"\\]*+)*+(?:"|\Z|\\\Z)', re.DOTALL)
_OPEN, _CLOSED = np.frombuffer(b"[{", np.uint8), np.frombuffer(b"]}", np.uint8)
_LARGE = re.compile(rb"[0-9.][eE]\+?[0-9]{3}|[0-9]{300}")
_MAX_WORDS = 200
_WITHOUT_WAITING = getattr(os, "O_NONBLOCK", 0)


def read_bytes(path: Path, most: int, error: Kind, advice: str = "restore it from a copy") -> bytes:
    """The content of a regular file of at most `most` bytes.

    Args:
        path: of the file.
        most: bytes at most.
        error: class of what is raised.
        advice: what the reader of the message can do.

    Raises:
        error: missing, no regular file, unreadable or larger.
    """
    try:
        # Without waiting: a named pipe in a received folder would otherwise hold the reader for ever.
        handle = os.open(path, os.O_RDONLY | _WITHOUT_WAITING)
        with os.fdopen(handle, "rb") as stream:
            about = os.fstat(stream.fileno())
            if not stat.S_ISREG(about.st_mode):
                raise error(f"{path} is not a file; {advice}")
            if about.st_size > most:
                raise error(f"{path} has more than the {megabytes(most)} that are read; {advice}")
            return stream.read(min(most, about.st_size))  # Python takes as much memory as it is asked to read
    except OSError as reason:
        raise error(f"{path} cannot be read ({reason.strerror or reason}); {advice}") from reason
    except (ValueError, MemoryError) as reason:  # a null character in the name; a file larger than what is free
        raise error(f"{shorten(str(path))} cannot be read ({reason}); {advice}") from reason


def read_json(path: Path, error: Kind, *, most: int = MAX_JSON_BYTES, advice: str = "restore it from a copy") -> Any:
    """The value in a JSON file; see `parse_json`.

    Args:
        path: of the file.
        error: class of what is raised.
        most: bytes at most.
        advice: what the reader of the message can do.

    Raises:
        error: as `read_bytes` and `parse_json`.
    """
    return parse_json(read_bytes(path, most, error, advice), str(path), error, advice=advice)


def parse_json(
    data: bytes | str, name: str, error: Kind, *, advice: str = "restore it from a copy", finite: bool = True
) -> Any:
    """The value that JSON text describes: finite numbers (unless said otherwise), whole characters, few levels.

    Args:
        data: UTF-8.
        name: shown to the reader.
        error: class of what is raised.
        advice: what the reader of the message can do.
        finite: whether infinities are refused.

    Raises:
        error: not UTF-8, not JSON, nested too deeply, or with numbers or characters that cannot be written back.
    """
    try:
        raw = data.encode() if isinstance(data, str) else data
        if _is_too_deep(raw):
            raise error(f"{name} is nested more than {MAX_JSON_DEPTH} levels deep; {advice}")
        value = json.loads(raw.decode("utf-8-sig"), parse_constant=_refuse_constant if finite else float)
        if finite and _infinite(raw):
            raise ValueError("a number is too large")
        if rb"\u" in raw:
            json.dumps(value, ensure_ascii=False).encode()  # half of a character pair cannot be written
    except json.JSONDecodeError as reason:
        raise error(f"{name} is not valid JSON (line {reason.lineno}: {shorten(reason.msg)}); {advice}") from reason
    except UnicodeError as reason:
        raise error(f"{name} holds bytes that are no text (UTF-8); {advice}") from reason
    except (ValueError, RecursionError, MemoryError) as reason:
        raise error(f"{name} cannot be read ({shorten(str(reason)) or type(reason).__name__}); {advice}") from reason
    return value


def picture_of(
    data: bytes,
    name: str,
    error: Kind,
    *,
    most_pixels: int = MAX_PIXELS,
    formats: Sequence[str] = PICTURE_FORMATS,
    within: tuple[int, int] | None = None,
) -> UInt8[np.ndarray, "h w 3"]:
    """A picture's pixels, decoded.

    Args:
        data: the file's bytes.
        name: what to call it in messages.
        error: the kind of error raised.
        most_pixels: more are refused before they are decoded.
        formats: which formats are opened.
        within: a JPEG may be decoded at a fraction of its size that still covers this (width, height).

    Raises:
        error: no picture of these formats, damaged, or of too many pixels.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            image = Image.open(io.BytesIO(data), formats=tuple(formats))
        if image.width * image.height > most_pixels:
            raise error(
                f"{name}: {image.width} x {image.height} pixels are more than the {most_pixels / 1e6:.0f} megapixels "
                "that are read; reduce it"
            )
        if within is not None:
            image.draft("RGB", within)
        return np.asarray(image.convert("RGB"))
    except DioramaError:
        raise
    except Image.DecompressionBombError as reason:
        raise error(f"{name}: more pixels than are read; reduce it") from reason
    except Exception as reason:  # decoders of untrusted bytes raise almost anything
        raise error(f"{name} is not a whole picture ({' or '.join(formats)}); replace it") from reason


def read_picture(
    path: Path, error: Kind, *, most_pixels: int = MAX_PIXELS, within: tuple[int, int] | None = None
) -> UInt8[np.ndarray, "h w 3"]:
    """A picture that the program wrote.

    Args:
        path: of the file.
        error: class of what is raised.
        most_pixels: pixels at most.
        within: width and height at most; None for any.

    Raises:
        error: as `read_bytes` and `picture_of`.
    """
    data = read_bytes(path, MAX_PICTURE_BYTES, error, "replace it")
    return picture_of(data, str(path), error, most_pixels=most_pixels, within=within)


def shorten(words: str, most: int = _MAX_WORDS) -> str:
    """One line of at most `most` characters, without control characters and half characters."""
    line = " ".join(words.encode("utf-8", "replace").decode().split())
    line = "".join(c for c in line if c.isprintable())
    return line if len(line) <= most else f"{line[: most - 1]}…"


def megabytes(count: int) -> str:
    """A number of bytes, in words."""
    return f"{count / 1e6:.3g} MB" if count >= 100_000 else f"{count / 1e3:.3g} kB"


def _is_too_deep(data: bytes) -> bool:
    """True where brackets are nested too deeply outside strings."""
    marks = np.frombuffer(_STRINGS.sub(b"", data), np.uint8)
    steps = np.isin(marks, _OPEN).astype(np.int8) - np.isin(marks, _CLOSED)
    return bool((np.cumsum(steps[steps != 0], dtype=np.int32) > MAX_JSON_DEPTH).any())


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is no number")


def _infinite(raw: bytes) -> bool:
    """Whether a number is too large, as 1e999 or 400 digits. Only an exponent or very many digits make one."""
    if not _LARGE.search(raw):
        return False
    try:
        json.dumps(json.loads(raw.decode("utf-8-sig"), parse_int=float), allow_nan=False)
    except ValueError:
        return True
    return False


def fits(value: Any, annotation: Any) -> bool:
    """Whether a value is of an annotated type, its parts included.

    Understands classes, `None`, unions, `Literal`, `tuple`, `dict`, jaxtyping's arrays (number type and dimensions, not
    named sizes) and dataclasses of these. Whole numbers pass as `float`; numbers must be finite.
    """
    origin, arguments = get_origin(annotation), get_args(annotation)
    if annotation is Any or isinstance(annotation, TypeVar):
        return True
    if annotation is None or annotation is type(None):
        return value is None
    if origin in (Union, types.UnionType):
        return any(fits(value, one) for one in arguments)
    if origin is Literal:
        return value in arguments
    if origin is tuple or annotation is tuple:
        return isinstance(value, tuple) and _tuple_fits(value, arguments)
    if origin is dict:
        return isinstance(value, dict) and all(
            fits(k, arguments[0]) and fits(v, arguments[1]) for k, v in value.items()
        )
    return isinstance(annotation, type) and _instance_fits(value, annotation)


def _tuple_fits(value: tuple, arguments: tuple) -> bool:
    if not arguments:
        return True
    if len(arguments) == 2 and arguments[1] is Ellipsis:
        return all(fits(one, arguments[0]) for one in value)
    return len(value) == len(arguments) and all(map(fits, value, arguments))


def _instance_fits(value: Any, annotation: type) -> bool:
    if annotation in (int, float):
        kinds = (int,) if annotation is int else (int, float)
        return isinstance(value, kinds) and not isinstance(value, bool) and abs(value) < float("inf")
    with jaxtyping.jaxtyped("context"):  # a caller's named sizes are those of other arrays
        if not isinstance(value, annotation):
            return False
    if is_dataclass(value):
        return all(fits(getattr(value, name), hint) for name, hint in field_types(value.__class__).items())
    return not isinstance(value, np.ndarray) or value.dtype.kind != "f" or bool(np.isfinite(value).all())


@cache
def field_types(kind: type) -> dict[str, Any]:
    """The annotated types of a dataclass's fields by name."""
    hints = get_type_hints(kind)
    return {f.name: hints[f.name] for f in fields(kind)}


def as_member(value: Any, annotation: Any) -> Any:
    """A string as the member of the `StrEnum` that is asked for; any other value as it is.

    Raises:
        ValueError: when the enum has no such member.
    """
    named = isinstance(annotation, type) and issubclass(annotation, StrEnum) and isinstance(value, str)
    return annotation(value) if named else value
