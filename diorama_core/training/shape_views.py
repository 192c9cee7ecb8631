"""Single shapes from many sides, set before parts of rendered rooms: every kind and form is met equally often.

Rooms show what usually stands beside what, but few of the rare kinds; here each shape is drawn with the same chance.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Bool, Float32, Int8, UInt8

from diorama_core.errors import InputError
from diorama_core.library.form import MEASURED, VALUES, form_at, value_indices
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.models.images import CROP_SIDE, FILL, MARGIN
from diorama_core.progress import SILENT, Progress
from diorama_core.render.views import StudioView, render_shape
from diorama_core.scene.values import ArrayValue
from diorama_core.training.pictures import category_names, make_files
from diorama_core.training.rooms import any_colour

SIDE = 112
VIEWS = 12
TURN_RAD, ANY_SIDE = 0.7, 0.15
"""Standard deviation of a view's turn from the front, and the share of views from any side: people picture fronts."""
ELEVATION_RAD = (0.0, 0.65)
RECOLOURED = 0.5
SOLID = 240
"""Opacity above which a pixel is the shape's own and not its shadow's."""
HIDDEN, CUT = 0.4, 0.2
"""Shares of the crops in which another shape stands before it, and in which the picture's border cuts it."""
MAX_HIDDEN, MAX_CUT = 0.45, 0.4
"""Shares of its width or height."""


@dataclass(frozen=True, eq=False)
class ShapeViews(ArrayValue):
    """One shape on nothing."""

    rgba: UInt8[np.ndarray, "n s s 4"]
    category: int
    """Index into `category_names`."""
    form: Int8[np.ndarray, "7"]
    """`library.form.value_indices` at its own size."""


def make_shape_views(folder: Path, library: ShapeLibrary, progress: Progress = SILENT) -> int:
    """Render the shapes that are not in the folder yet.

    Args:
        folder: One file a shape goes there.
        library: Where shapes come from.
        progress: Reported after each shape; honours cancelling, and the next call goes on.

    Returns:
        The number of shapes rendered now.
    """
    index = {name: k for k, name in enumerate(category_names(library))}
    return make_files(
        folder,
        library.shapes(),
        lambda shape: f"shape_{shape.content_hash[:16]}.npz",
        lambda shape: _pack(_views(shape, library, index[shape.category])),
        progress,
    )


@dataclass(frozen=True, eq=False)
class FormStatistics(ArrayValue):
    """Which attributes of form tell shapes of a kind apart, and how common their values are."""

    asked: Bool[np.ndarray, "k 7"]
    """Whether an attribute varies among the shapes of a kind."""
    weights: tuple[Float32[np.ndarray, "_"], ...]
    """For every attribute, those of its values: rare ones count more."""


@dataclass(frozen=True)
class ShapeViewFiles:
    """The files of a folder of shape views, those of one kind together."""

    of_kind: tuple[tuple[Path, ...], ...]

    @classmethod
    def of(cls, folder: Path) -> ShapeViewFiles:
        """All shapes of a folder.

        Raises:
            InputError: where there is none.
        """
        kinds: dict[int, list[Path]] = {}
        for path in sorted(folder.glob("shape_*.npz")):
            kinds.setdefault(read_shape(path).category, []).append(path)
        if not kinds:
            raise InputError(
                f"{folder}: no shapes are there; make some: python -m diorama_core.training shapes {folder}"
            )
        return cls(tuple(tuple(kinds[k]) for k in sorted(kinds)))

    def form_statistics(self, kinds: int) -> FormStatistics:
        """Statistics of all shapes; of kinds that have none, nothing is asked."""
        asked = np.zeros((kinds, len(MEASURED)), bool)
        counts = [np.zeros(len(VALUES[name])) for name in MEASURED]
        for paths in self.of_kind:
            views = [read_shape(path) for path in paths]
            forms = np.stack([v.form for v in views])
            varies = (forms.min(axis=0) >= 0) & (forms.min(axis=0) < forms.max(axis=0))
            asked[views[0].category] = varies
            for k in np.flatnonzero(varies):
                counts[k] += np.bincount(forms[:, k], minlength=len(counts[k]))
        return FormStatistics(asked, tuple(_rare_count_more(c) for c in counts))

    def draw(self, rng: np.random.Generator) -> ShapeViews:
        """A shape of a kind of chance; kinds with many shapes are drawn a little more often."""
        weight = np.sqrt([len(paths) for paths in self.of_kind])
        paths = self.of_kind[int(rng.choice(len(weight), p=weight / weight.sum()))]
        return read_shape(paths[int(rng.integers(len(paths)))])


@lru_cache(maxsize=4000)
def read_shape(path: Path) -> ShapeViews:
    """The views of one shape's file."""
    with np.load(path, allow_pickle=False) as saved:
        return ShapeViews(saved["rgba"], int(saved["category"]), saved["form"])


def crop_before(
    background: UInt8[np.ndarray, "h w 3"], files: ShapeViewFiles, rng: np.random.Generator
) -> tuple[UInt8[np.ndarray, "s s 3"], tuple[float, float], ShapeViews]:
    """A crop of a shape in its box, as `models.images.box_crop` cuts it, before a part of a picture.

    Args:
        background: any picture of a room.
        files: where the shape, and what may hide a part of it, come from.
        rng: the source of chance.

    Returns:
        The crop, width and height of its box as shares of the longer of both, and what it shows.
    """
    views = files.draw(rng)
    rgba = _crop_to_solid(views.rgba[int(rng.integers(len(views.rgba)))], rng)
    height, width = rgba.shape[:2]
    mirrored = rng.random() < 0.5
    rgba = rgba[:, ::-1] if mirrored else rgba
    canvas = _part(background, rng)
    cut = _Cut.draw(rng) if rng.random() < CUT else None
    if cut is not None:
        rgba = cut.apply(rgba)
        height, width = rgba.shape[:2]
    scale = CROP_SIDE / (max(width, height) * (1 + 2 * MARGIN)) * float(np.exp(rng.normal(0.0, 0.05)))
    centre = CROP_SIDE / 2 + rng.normal(0.0, 0.02 * CROP_SIDE, 2)
    x0, y0 = _lay(canvas, rgba, scale, centre)
    if rng.random() < HIDDEN:
        _hide(canvas, files, rng, np.array([x0, y0, x0 + width * scale, y0 + height * scale]))
    if cut is not None:
        cut.blank(canvas, x0, y0, width * scale, height * scale)
    longer = max(width, height)
    return canvas, (width / longer, height / longer), views


@dataclass(frozen=True)
class _Cut:
    """The picture's border through the shape."""

    side: int
    """0 left, 1 right, 2 bottom."""
    share: float

    @classmethod
    def draw(cls, rng: np.random.Generator) -> _Cut:
        return cls(int(rng.integers(3)), float(rng.uniform(0.05, MAX_CUT)))

    def apply(self, rgba: UInt8[np.ndarray, "h w 4"]) -> UInt8[np.ndarray, "h2 w2 4"]:
        """Cut a picture to what the border leaves."""
        height, width = rgba.shape[:2]
        if self.side == 2:
            return rgba[: max(2, round(height * (1 - self.share)))]
        left = round(width * self.share) if self.side == 0 else 0
        return rgba[:, left : max(left + 2, width - (round(width * self.share) if self.side == 1 else 0))]

    def blank(self, canvas: UInt8[np.ndarray, "s s 3"], x: float, y: float, width: float, height: float) -> None:
        """Nothing is seen beyond the border.

        Args:
            canvas: changed in place.
            x: of the window.
            y: likewise.
            width: of the window.
            height: likewise.
        """
        if self.side == 0:
            canvas[:, : max(0, round(x))] = FILL
        elif self.side == 1:
            canvas[:, max(0, round(x + width)) :] = FILL
        else:
            canvas[max(0, round(y + height)) :] = FILL


def _rare_count_more(counts: np.ndarray) -> Float32[np.ndarray, "_"]:
    """Weights that fall with the square root of how often a value is met, 1 on average over what is met."""
    weights = 1.0 / np.sqrt(np.maximum(counts, 1.0))
    return np.asarray(weights * counts.sum() / max(float(weights @ counts), 1e-9), np.float32)


def _crop_to_solid(rgba: UInt8[np.ndarray, "s s 4"], rng: np.random.Generator) -> UInt8[np.ndarray, "h w 4"]:
    """The rectangle around the shape itself, a little stretched; shadows beside it are left out."""
    solid = rgba[..., 3] >= SOLID
    rows, columns = np.flatnonzero(solid.any(axis=1)), np.flatnonzero(solid.any(axis=0))
    if len(rows) and len(columns):
        rgba = rgba[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    stretch = np.exp(rng.normal(0.0, 0.1))
    size = (max(2, round(rgba.shape[1] * stretch)), max(2, round(rgba.shape[0] / stretch)))
    return np.asarray(cv2.resize(rgba, size, interpolation=cv2.INTER_LINEAR))


def _part(background: UInt8[np.ndarray, "h w 3"], rng: np.random.Generator) -> UInt8[np.ndarray, "s s 3"]:
    """A square part of a picture as the ground of a crop."""
    h, w = background.shape[:2]
    side = int(rng.uniform(0.15, 0.9) * min(h, w))
    x, y = int(rng.integers(w - side + 1)), int(rng.integers(h - side + 1))
    return np.array(
        cv2.resize(background[y : y + side, x : x + side], (CROP_SIDE, CROP_SIDE), interpolation=cv2.INTER_AREA)
    )


def _lay(
    canvas: UInt8[np.ndarray, "s s 3"], rgba: UInt8[np.ndarray, "h w 4"], scale: float, centre: np.ndarray
) -> tuple[float, float]:
    """Draw a shape over the canvas; returns its upper left corner."""
    height, width = rgba.shape[:2]
    x0, y0 = float(centre[0] - width * scale / 2), float(centre[1] - height * scale / 2)
    source = cv2.GaussianBlur(rgba, (0, 0), 0.4 / scale) if scale < 0.5 else rgba
    M = np.array([[scale, 0, x0], [0, scale, y0]], np.float32)
    premultiplied: Float32[np.ndarray, "h w 4"] = source.astype(np.float32)
    premultiplied[..., :3] *= premultiplied[..., 3:] / 255
    laid = cv2.warpAffine(premultiplied, M, (canvas.shape[1], canvas.shape[0]), flags=cv2.INTER_LINEAR)
    canvas[:] = np.clip(laid[..., :3] + canvas * (1 - laid[..., 3:] / 255), 0, 255).astype(np.uint8)
    return x0, y0


def _hide(canvas: UInt8[np.ndarray, "s s 3"], files: ShapeViewFiles, rng: np.random.Generator, box: np.ndarray) -> None:
    """Set another shape before a part of the box, from the left, the right or below."""
    views = files.draw(rng)
    rgba = _crop_to_solid(views.rgba[int(rng.integers(len(views.rgba)))], rng)
    size, share, side = box[2:] - box[:2], float(rng.uniform(0.08, MAX_HIDDEN)), int(rng.integers(3))
    scale = float(rng.uniform(0.4, 1.1) * max(size) / max(rgba.shape[:2]))
    size_px = np.array([rgba.shape[1], rgba.shape[0]]) * scale
    middle = (box[:2] + box[2:]) / 2 + rng.uniform(-0.3, 0.3, 2) * size
    if side == 2:
        middle[1] = box[3] - share * size[1] + size_px[1] / 2
    else:
        inner = box[0] + share * size[0] - size_px[0] / 2 if side == 0 else box[2] - share * size[0] + size_px[0] / 2
        middle = np.array([inner, max(middle[1], box[3] - size_px[1] / 2)])
    _lay(canvas, rgba, scale, middle)


def _views(shape: Shape, library: ShapeLibrary, kind: int) -> ShapeViews:
    rng = np.random.default_rng(int(shape.content_hash[:12], 16))
    pictures = []
    for _ in range(VIEWS):
        turn = rng.uniform(-np.pi, np.pi) if rng.random() < ANY_SIDE else rng.normal(0.0, TURN_RAD)
        view = StudioView(float(turn), float(rng.uniform(*ELEVATION_RAD)))
        colour = any_colour(rng) if rng.random() < RECOLOURED else None
        pictures.append(render_shape(library, shape.id, (SIDE, SIDE), view, paint=(colour, None)))
    form = form_at(library, shape, np.asarray(shape.size_m))
    return ShapeViews(np.stack(pictures), kind, value_indices(form))


def _pack(views: ShapeViews) -> bytes:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, rgba=views.rgba, category=np.array(views.category), form=views.form)
    return buffer.getvalue()
