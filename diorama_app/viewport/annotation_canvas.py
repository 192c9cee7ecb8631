"""The photo over the 3D view in one browser: boxes are drawn, selected, changed and deleted on it, points are clicked.

The page draws it (`static/canvas.js`): a box follows the hand at once, and the server hears when it is let go of.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import viser
from jaxtyping import Bool, UInt8

from diorama_app.projects.pictures import picture_uri
from diorama_app.strings import N_, _
from diorama_app.viewport.mesh_assets import reduce
from diorama_app.web.html import Action, LiveHtml, run_once
from diorama_core.artefacts import Box, LabelledBox
from diorama_core.progress import Segments

MAX_SIDE_PX, MAX_MASK_PX = 1600, 800
JPEG_QUALITY = 85
MASK_COLOUR = (255, 90, 20, 110)
MIN_BOX_PX = 3
MAX_LABEL = 40

Mode = Literal["boxes", "one box", "points"]
HINTS: dict[Mode, str] = {
    "boxes": N_(
        "Click each piece of furniture, or drag a box around it. Shift-click marks what lies on a marked object. "
        "Keys 1 to 4 choose a name; Delete deletes."
    ),
    "one box": N_("Drag a new box around the object."),
    "points": N_("Click the object. Shift-click what does not belong to it."),
}


@dataclass(frozen=True)
class Drawn:
    """A rectangle was drawn, in photo pixels."""

    box: Box


@dataclass(frozen=True)
class Reshaped:
    """A box was moved or resized."""

    index: int
    box: Box


@dataclass(frozen=True)
class Selected:
    """A box was clicked; None for a click beside all boxes."""

    index: int | None


@dataclass(frozen=True)
class Named:
    """A name was written on a box."""

    index: int
    label: str


@dataclass(frozen=True)
class Deleted:
    """A box is to go."""

    index: int


@dataclass(frozen=True)
class Pointed:
    """A pixel was clicked."""

    x: float
    y: float
    is_part: bool
    """Without Shift: the pixel is part of the object."""


@dataclass(frozen=True)
class Clicked:
    """A pixel was clicked beside all boxes, or in one with Shift: what else is there?"""

    x: float
    y: float


@dataclass(frozen=True)
class Accepted:
    """A proposal becomes a box, under another name where one is given."""

    index: int
    label: str


@dataclass(frozen=True)
class Dismissed:
    """A proposal is to go."""

    index: int


@dataclass(frozen=True)
class Finished:
    """The person is done."""


Event = Drawn | Reshaped | Selected | Named | Deleted | Pointed | Clicked | Accepted | Dismissed | Finished
OnEvent = Callable[[Event], None]


class AnnotationCanvas:
    """Shows the photo and reports what is done on it. Used from the UI thread only."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._on_event: OnEvent | None = None
        self._size = (1, 1)
        self._shown: tuple[UInt8[np.ndarray, "h w 3"], Mode] | None = None
        sender = LiveHtml(gui, self._receive)
        sender.show('<button type="button" id="dio-canvas-send" style="display:none" tabindex="-1"></button>')
        self._photo, self._boxes, self._proposals, self._mask, self._lines = (_Told(gui) for _ in range(5))
        self._outline: Bool[np.ndarray, "h w"] | None = None
        """The one that is shown."""
        self._photo.tell({"photo": None})

    @property
    def is_open(self) -> bool:
        """Whether this browser shows the canvas."""
        return self._on_event is not None

    def shows_another(self, photo: UInt8[np.ndarray, "h w 3"]) -> bool:
        """Whether boxes are drawn on another picture than this."""
        return self.is_open and self._shown is not None and self._shown[1] == "boxes" and self._shown[0] is not photo

    def open(
        self,
        photo: UInt8[np.ndarray, "h w 3"],
        on_event: OnEvent,
        mode: Mode = "boxes",
        *,
        names: Sequence[str] = (),
    ) -> None:
        """Show the photo to draw on or to click on.

        Args:
            photo: the picture.
            on_event: told what is done on it, from viser's event loop.
            mode: what can be done.
            names: suggested when a box is named.
        """
        self.close()
        self._on_event, self._shown = on_event, (photo, mode)
        height, width = photo.shape[:2]
        self._size = width, height
        about = {
            "url": picture_uri(reduce(photo, MAX_SIDE_PX), "JPEG", quality=JPEG_QUALITY),
            "size": [width, height],
            "mode": mode,
            "hint": _(HINTS[mode]),
            "names": list(names),
        }
        self._photo.tell({"photo": about})

    def show_boxes(self, boxes: Sequence[LabelledBox], selected: int | None, likely: Sequence[str] = ()) -> None:
        """Draw the boxes over the photo; the selected one offers its likely names.

        Args:
            boxes: of the photo.
            selected: number of a box; None for none.
            likely: names for the selected one.
        """
        if self.is_open:
            self._boxes.tell(
                {"boxes": _rows(boxes), "selected": selected, "likely": [(name, _(name)) for name in likely]}
            )

    def show_proposals(self, boxes: Sequence[LabelledBox]) -> None:
        """Draw boxes that nobody accepted yet."""
        if self.is_open:
            self._proposals.tell({"proposals": _rows(boxes)})

    def show_lines(self, lines: Segments) -> None:
        """Draw what a build found so far over the photo."""
        if self.is_open:
            self._lines.tell({"lines": lines})

    def show_mask(self, mask: Bool[np.ndarray, "h w"] | None) -> None:
        """Lay an outline over the photo; none takes the last one away."""
        if not self.is_open or mask is self._outline:
            return
        self._outline = mask
        if mask is None:
            self._mask.tell({"mask": None})
            return
        tint = np.zeros((*mask.shape, 4), dtype=np.uint8)
        tint[mask] = MASK_COLOUR
        step = max(1, max(mask.shape) // MAX_MASK_PX)
        self._mask.tell({"mask": picture_uri(np.ascontiguousarray(tint[::step, ::step]), "PNG")})

    def close(self) -> None:
        """Put the photo away."""
        if not self.is_open:
            return
        self._on_event = None
        self._photo.tell({"photo": None})
        self._boxes.tell({"boxes": [], "selected": None, "likely": []})
        self._proposals.tell({"proposals": []})
        self._mask.tell({"mask": None})
        self._lines.tell({"lines": []})
        self._outline = None

    def _receive(self, action: Action) -> None:
        on_event = self._on_event
        event = _event(action, self._size)
        if on_event is not None and event is not None:
            on_event(event)


class _Told:
    """One part of what the page knows; a newer message replaces an older one that was not sent yet."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._html = gui.add_html("")
        self._last = ""

    def tell(self, news: dict[str, Any]) -> None:
        message = json.dumps(news, separators=(",", ":"))
        if message != self._last:
            self._last = message
            self._html.content = run_once(f"window.__dioCanvas.told({message})")


def _event(action: Action, size: tuple[int, int]) -> Event | None:
    """What a page says was done; None for what is no event."""
    try:
        arg = action.value
        match action.do:
            case "draw":
                return Drawn(_box(arg, size))
            case "change":
                return Reshaped(int(arg[0]), _box(arg[1], size))
            case "select":
                return Selected(None if arg is None else int(arg))
            case "name":
                return Named(int(arg[0]), str(arg[1])[:MAX_LABEL])
            case "delete":
                return Deleted(int(arg))
            case "point":
                return Pointed(float(arg[0]), float(arg[1]), bool(arg[2]))
            case "click":
                return Clicked(float(arg[0]), float(arg[1]))
            case "accept":
                return Accepted(int(arg[0]), str(arg[1])[:MAX_LABEL])
            case "dismiss":
                return Dismissed(int(arg))
            case "done":
                return Finished()
    except (ValueError, TypeError, LookupError):
        return None  # from a page that is not ours, or less than `MIN_BOX_PX`
    return None


def _rows(boxes: Sequence[LabelledBox]) -> list[dict[str, Any]]:
    return [{"box": list(b.box), "label": b.label[:MAX_LABEL]} for b in boxes]


def _box(corners: Any, size: tuple[int, int]) -> Box:
    """The box between two corners, cut at the photo's edges; raises `ValueError` where too little is left."""
    x1, y1, x2, y2 = (float(v) for v in corners)
    (x1, x2), (y1, y2) = sorted((x1, x2)), sorted((y1, y2))
    x1, x2 = (min(max(x, 0.0), float(size[0])) for x in (x1, x2))
    y1, y2 = (min(max(y, 0.0), float(size[1])) for y in (y1, y2))
    if not (x2 - x1 >= MIN_BOX_PX and y2 - y1 >= MIN_BOX_PX):
        raise ValueError("too small")
    return x1, y1, x2, y2
