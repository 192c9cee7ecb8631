"""Likely boxes of a photo, likely names of a box and its outline, while a person marks.

The recogniser that comes with Diorama works them out, with the network that finds everyday objects where it is here.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import Box, LabelledBox, Photo
from diorama_core.errors import UnavailableError
from diorama_core.io.assets import has_own_recogniser
from diorama_core.models.boxes import Detections, areas, overlaps
from diorama_core.models.store import ModelStore

log = logging.getLogger(__name__)

COUNT = 4
"""Names that are suggested for a box."""
UNKNOWN = "object"
"""Kind of what nothing recognises."""
SMALLER = 0.5
"""Share of a marked box's area below which another box is of something that lies on the object."""
SAME_IOU = 0.5
"""Intersection over union from which two boxes are one object's."""

_ASKED, _AHEAD = ThreadPoolExecutor(1, "suggestions"), ThreadPoolExecutor(1, "proposals")
"""Of all pages: networks that run beside one another only take each other's processor and memory. What somebody clicked
on waits for no photo that is looked at ahead."""


class Suggestions:
    """What one photo shows, worked out in the background.

    Args:
        photo: the photo.
        on_ready: called from a thread when something that was asked for is there.
        is_wanted: whether somebody still looks at it: what waits for its turn is left out otherwise.
    """

    def __init__(
        self, photo: Photo, on_ready: Callable[[], None], is_wanted: Callable[[], bool] = lambda: True
    ) -> None:
        self.photo = photo
        self._is_wanted = is_wanted
        self._on_ready = on_ready
        self._seen: dict[Box, Float[np.ndarray, k]] = {}
        """Probabilities of the namer's categories."""
        self._boxes: tuple[LabelledBox, ...] | None = None
        self._known: tuple[LabelledBox, ...] | None = None
        """What the network for everyday objects found."""
        self._clickable: Detections | None = None
        self._outline: tuple[Box, Bool[np.ndarray, "h w"]] | None = None
        """The last one that was worked out; they are as large as the photo."""
        self._wanted: Box | None = None
        """The box whose outline was asked for last: others that wait are worked out for nobody."""
        self._asked: set[object] = set()
        self._dismissed: set[Box] = set()

    def names(self, boxes: Sequence[Box], index: int) -> tuple[str, ...]:
        """The likeliest names of one of the marked boxes, best first; nothing yet where they are still worked out."""
        new = tuple(box for box in boxes if box not in self._seen)
        if new:
            self._ask(new, lambda: self._look_at(new))
        return () if any(box not in self._seen for box in new) else self._rank(boxes)[index]

    def boxes(self) -> tuple[LabelledBox, ...]:
        """Likely objects with their names, best first; nothing yet where they are still worked out."""
        if self._boxes is None:
            self._ask(None, self._propose)
        return tuple(b for b in self._boxes or () if b.box not in self._dismissed)

    def dismiss(self, box: Box) -> None:
        """Leave out a box that somebody turned down."""
        self._dismissed.add(box)

    def sure(self) -> tuple[LabelledBox, ...]:
        """Those of the likely objects that a build uses though nobody looked at them."""
        from diorama_core.perception.foundation.proposals import CONFIDENT

        known = {b.box for b in self._known or ()}
        return tuple(b for b in self.boxes() if b.score >= CONFIDENT or b.box in known)

    def outline(self, box: Box) -> Bool[np.ndarray, "h w"] | None:
        """The pixels of the photo that are the object's in a box; None while they are worked out."""
        last, self._wanted = self._outline, box
        if last is not None and last[0] == box:
            return last[1]
        self._ask(("outline", box), lambda: self._trace(box))
        return None

    def suggest(self, x: float, y: float, marked: Sequence[Box], then: Callable[[LabelledBox | None], None]) -> None:
        """Tell what somebody means who clicks on a pixel of the photo.

        Args:
            x: column of the pixel.
            y: row of the pixel.
            marked: boxes that are there already; in one of these, something smaller is meant.
            then: told the box, with its likeliest name, or None where nothing is recognised; called from a thread.
        """

        def tell() -> None:
            try:
                then(self._click(x, y, marked))
            except UnavailableError as error:
                log.warning("nothing is suggested: %s", error)
                then(None)

        self._submit(tell)

    def name(self, box: Box, marked: Sequence[Box], then: Callable[[LabelledBox], None]) -> None:
        """Tell the likeliest name of what a box holds that somebody drew.

        Args:
            box: in pixels of the photo.
            marked: boxes that are there already.
            then: told the box with its name, which is "object" where nothing is recognised; called from a thread.
        """

        def tell() -> None:
            try:
                name = self._likeliest(box, marked) if has_own_recogniser() else UNKNOWN
            except UnavailableError as error:
                log.warning("nothing is suggested: %s", error)
                name = UNKNOWN
            then(LabelledBox(box, name, name))

        self._submit(tell)

    def _submit(self, task: Callable[[], None], *, ahead: bool = False) -> None:
        (_AHEAD if ahead else _ASKED).submit(lambda: task() if self._is_wanted() else None)

    def _ask(self, key: object, work_out: Callable[[], object]) -> None:
        """Work something out once; what cannot be had is not tried again at every redraw."""
        if key in self._asked or not has_own_recogniser():
            return
        self._asked.add(key)

        def work() -> None:
            try:
                work_out()
            except UnavailableError as error:
                log.warning("nothing is suggested: %s", error)
                return
            self._on_ready()

        self._submit(work, ahead=key is None)

    def _look_at(self, boxes: Sequence[Box]) -> None:
        from diorama_core.models.recogniser import own_recogniser

        self._everyday()
        rows = own_recogniser().name(self.photo.rgb, np.array(boxes, dtype=float).reshape(-1, 4))
        self._seen.update(zip(boxes, rows, strict=True))

    def _rank(self, boxes: Sequence[Box]) -> list[tuple[str, ...]]:
        from diorama_core.models.recogniser import own_recogniser
        from diorama_core.perception.foundation.proposals import rank_names

        seen, corners = np.stack([self._seen[box] for box in boxes]), np.array(boxes, dtype=float)
        known = self._known or ()
        return [names[:COUNT] for names in rank_names(own_recogniser().categories, seen, corners, known)]

    def _everyday(self) -> tuple[LabelledBox, ...]:
        """What the network for everyday objects finds; nothing without it, or where it fails."""
        from diorama_core.pipeline.network_stages import everyday_detector
        from diorama_core.progress import Progress

        if self._known is None:
            try:
                detector = everyday_detector(ModelStore.default())
                self._known = () if detector is None else detector.detect(self.photo, (), Progress())
            except UnavailableError as error:
                log.warning("marking goes on without the network: %s", error)
                self._known = ()
        return self._known

    def _propose(self) -> None:
        from diorama_core.models.recogniser import own_recogniser
        from diorama_core.perception.foundation.proposals import LIKELY, MOST_SHOWN, OwnDetection, join_boxes
        from diorama_core.progress import Progress

        known = self._everyday()
        detected = OwnDetection(own_recogniser(), LIKELY, MOST_SHOWN).detect(self.photo, (), Progress())
        self._boxes = join_boxes(known, detected)

    def _trace(self, box: Box) -> None:
        from diorama_core.perception.masks import EmbeddedMasks

        if box == self._wanted:
            self._outline = box, EmbeddedMasks().segment_box(self.photo.rgb, box)[0]
        self._asked.discard(("outline", box))

    def _click(self, x: float, y: float, marked: Sequence[Box]) -> LabelledBox | None:
        from diorama_core.models.recogniser import own_recogniser
        from diorama_core.perception.foundation.proposals import clickable, find_clicked_box

        if not has_own_recogniser():
            return None
        if self._clickable is None:
            self._clickable = clickable(own_recogniser(), self.photo, self._everyday())
        box = find_clicked_box(drop_marked(self._clickable, x, y, marked), x, y)
        if box is None:
            return None
        name = self._likeliest(box, marked)
        return LabelledBox(box, name, name)

    def _likeliest(self, box: Box, marked: Sequence[Box]) -> str:
        boxes = (*marked, box)
        self._look_at(tuple(b for b in boxes if b not in self._seen))
        return self._rank(boxes)[-1][0]


def drop_marked(detections: Detections, x: float, y: float, marked: Sequence[Box]) -> Detections:
    """The boxes that a click at (x, y) may mean beside those that are marked there: of smaller objects on these.

    Args:
        detections: boxes that are likely.
        x: of the click, pixels of the photo.
        y: likewise.
        marked: boxes that are there.
    """
    boxes = np.array(marked, dtype=float).reshape(-1, 4)
    here = boxes[np.all((boxes[:, :2] <= (x, y)) & (boxes[:, 2:] >= (x, y)), axis=1)]
    if not len(here):
        return detections
    smaller = areas(detections.boxes) < SMALLER * areas(here).min()
    return detections.rows(np.flatnonzero(smaller & (overlaps(detections.boxes, boxes).max(axis=1) < SAME_IOU)))
