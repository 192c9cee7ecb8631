"""Contact sheets: many shapes on one page, to be looked at."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PIL import Image, ImageDraw

from diorama_core.library.record import Shape

CAPTION_PX = 18
PAGE = (246, 245, 243)
INK = (60, 60, 60)


def contact_sheet(
    shapes: Sequence[Shape], picture: Callable[[Shape], Image.Image], size_px: int = 240, columns: int = 6
) -> Image.Image:
    """A page with every shape's picture over its id and size.

    Args:
        shapes: What to show, in order.
        picture: Renders one shape; the library itself renders nothing.
        size_px: Side of one picture.
        columns: Pictures side by side.

    """
    rows = max(-(-len(shapes) // columns), 1)
    page = Image.new("RGB", (columns * size_px, rows * (size_px + CAPTION_PX)), PAGE)
    draw = ImageDraw.Draw(page)
    for number, shape in enumerate(shapes):
        left, top = (number % columns) * size_px, (number // columns) * (size_px + CAPTION_PX)
        image = picture(shape).convert("RGBA").resize((size_px, size_px))
        page.paste(image, (left, top), image)
        x, y, z = shape.size_m
        words = f"{shape.id}  {x:.2f} x {y:.2f} x {z:.2f}"
        draw.text((left + 4, top + size_px + 2), _fitted(draw, words, size_px - 8), fill=INK)
    return page


def _fitted(draw: ImageDraw.ImageDraw, words: str, width_px: int) -> str:
    """The words, or as many of their letters as fit."""
    while words and draw.textlength(words) > width_px:
        words = words[:-1]
    return words.rstrip()
