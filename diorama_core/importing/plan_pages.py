"""A picture of a floor plan: a scan, a photo of paper, or the first page of a PDF.

PDF pages are rendered by PDFium (extra `plan`).
"""

from __future__ import annotations

import io

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.errors import InputError, UnavailableError
from diorama_core.io.bounded import picture_of, shorten

LARGEST_PX = 2400
"""Thin lines of a page stay readable."""
MAX_PAGE_POINTS = 20_000


def plan_page(content: bytes, name: str) -> UInt8[np.ndarray, "h w 3"]:
    """The picture in a file, or the first page of a PDF, at most `LARGEST_PX` long.

    Raises:
        InputError: it is neither, or damaged.
        UnavailableError: a PDF, and pypdfium2 is not installed.
    """
    if content[:1024].lstrip().startswith(b"%PDF"):
        return _page(content, name)
    rgb = picture_of(content, name, InputError)
    scale = LARGEST_PX / max(rgb.shape[:2])
    if scale >= 1.0:
        return rgb
    size = (max(1, round(rgb.shape[1] * scale)), max(1, round(rgb.shape[0] * scale)))
    return np.asarray(Image.fromarray(rgb).resize(size, Image.Resampling.LANCZOS))


def _page(content: bytes, name: str) -> UInt8[np.ndarray, "h w 3"]:
    try:
        import pypdfium2
    except ImportError as error:
        raise UnavailableError("PDF pages need pypdfium2: pip install 'diorama[plan]'") from error
    try:
        document = pypdfium2.PdfDocument(io.BytesIO(content))
        try:
            page = document[0]
            width, height = page.get_size()
            if not 1.0 <= max(width, height) <= MAX_PAGE_POINTS:
                raise InputError(f"{name}: its first page is {width:.0f} x {height:.0f} points large; export one page")
            bitmap = page.render(scale=LARGEST_PX / max(width, height))
            return np.ascontiguousarray(np.asarray(bitmap.to_pil().convert("RGB")))
        finally:
            document.close()
    except (pypdfium2.PdfiumError, IndexError, ValueError) as error:
        reason = shorten(str(error), 100)
        raise InputError(f"{name}: the page cannot be read ({reason}); export the plan again") from error
