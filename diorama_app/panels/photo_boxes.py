"""Marking what is in the photo: boxes that are drawn, clicked for, proposed, named and deleted."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from diorama_app.reconstruction.build_job import stop_unasked
from diorama_app.reconstruction.networks import can_find_furniture
from diorama_app.reconstruction.suggestions import Suggestions
from diorama_app.session.client import Client
from diorama_app.strings import _, plural
from diorama_app.viewport.annotation_canvas import (
    Accepted,
    Clicked,
    Deleted,
    Dismissed,
    Drawn,
    Event,
    Finished,
    Named,
    Reshaped,
    Selected,
)
from diorama_app.web.html import button, text
from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.editing.box_checks import merge_boxes, too_tall
from diorama_core.editing.input_corrections import label_box, same_object, with_box_at, without_box
from diorama_core.errors import InputError
from diorama_core.library.taxonomy import CATEGORIES, column, is_furniture

COMMON = tuple(sorted(filter(is_furniture, column("frequency")), key=lambda kind: -column("frequency")[kind])[:10])
"""Furniture that rooms have most of."""
NAMES = (*COMMON, *sorted({c.name for c in CATEGORIES} - {*COMMON, "object"}))


class PhotoBoxes:
    """Boxes of the open photo, on the canvas and in the panel, which `refresh` draws anew."""

    def __init__(self, client: Client, refresh: Callable[[], None]) -> None:
        self._client, self._refresh = client, refresh
        self._suggestions: list[Suggestions] = []
        """One for each photo that was looked at."""

    def show(self, inputs: Inputs) -> None:
        """Draw boxes and proposals on the canvas."""
        index, canvas = self._client.selected_box, self._client.view.canvas
        if canvas.shows_another(inputs.photo.rgb):
            self._put(inputs)  # it was turned, or straightened
        likely = () if index is None else self._likely(inputs, index)
        canvas.show_boxes(inputs.boxes, index, likely)
        if canvas.is_open:
            canvas.show_proposals(self._proposals(inputs))
            canvas.show_mask(None if index is None else self._suggest(inputs).outline(inputs.boxes[index].box))

    def _suggest(self, inputs: Inputs) -> Suggestions:
        for known in self._suggestions:
            if known.photo is inputs.photo:
                return known
        session = self._client.session
        photos = [p.inputs.photo for p in session.further_photos]
        photos += [] if session.photo is None else [session.photo]
        new = Suggestions(
            inputs.photo,
            lambda: self._client.post(self._refresh, key="suggestions"),
            lambda: not self._client.has_left,
        )
        self._suggestions = [*(s for s in self._suggestions if any(s.photo is p for p in photos)), new]
        return new

    def _likely(self, inputs: Inputs, index: int) -> tuple[str, ...]:
        return self._suggest(inputs).names([b.box for b in inputs.boxes], index)

    def _proposals(self, inputs: Inputs) -> tuple[LabelledBox, ...]:
        """Likely objects that nobody marked or turned down yet."""
        return tuple(b for b in self._suggest(inputs).boxes() if same_object(inputs.boxes, b.box) is None)

    def proposals(self) -> tuple[LabelledBox, ...]:
        """Likely objects of the scene's own photo that nobody marked or turned down yet."""
        inputs = self._client.session.inputs
        return self._proposals(inputs) if inputs is not None and self._suggestions else ()

    def dismiss(self, proposal: LabelledBox) -> None:
        """Turn a proposal down."""
        for known in self._suggestions:
            known.dismiss(proposal.box)
        self._client.refresh()

    def proposal_count(self, inputs: Inputs) -> int:
        """Number of proposals that are shown."""
        return len(self._proposals(inputs)) if self._client.view.canvas.is_open else 0

    def accept_all(self) -> None:
        """Make boxes of all proposals; their names stay guesses until somebody names them."""
        inputs = self._client.inputs
        if inputs is None:
            return
        proposed = tuple(replace(label_box(b.box, b.label), guessed=True) for b in self._proposals(inputs))
        accepted = merge_boxes((*inputs.boxes, *proposed))[len(merge_boxes(inputs.boxes)) :]
        if accepted:
            boxes = (*inputs.boxes, *accepted)
            doubtful = too_tall(boxes)
            self._client.selected_box = doubtful[0][0] if doubtful else None
            label = plural("mark {count} object", "mark {count} objects", len(accepted))
            self._annotate(label, replace(inputs, boxes=boxes))
            self._client.refresh()
            self._client.notice(" ".join(_outcome(boxes, len(proposed) - len(accepted), doubtful)))

    def sure(self, inputs: Inputs) -> tuple[LabelledBox, ...]:
        """Those of the proposals that a build uses though nobody looked at them."""
        sure = {b.box for b in self._suggest(inputs).sure()}
        return tuple(replace(b, guessed=True) for b in self._proposals(inputs) if b.box in sure)

    def open(self) -> None:
        """Put the photo on the canvas, to be marked; raises `InputError` where there is none."""
        inputs = self._client.inputs
        if inputs is None:
            raise InputError("there is no photo yet; upload one first")
        self._put(inputs)
        self._client.refresh()

    def _put(self, inputs: Inputs) -> None:
        client = self._client
        client.view.canvas.open(
            inputs.photo.rgb,
            lambda event: client.post(lambda: self.handle(event)),
            names=NAMES,
        )

    def handle(self, event: Event) -> None:
        """Something was done on the photo."""
        inputs, client = self._client.inputs, self._client
        if inputs is None:
            return
        index = getattr(event, "index", None)
        rows = self._proposals(inputs) if isinstance(event, Accepted | Dismissed) else inputs.boxes
        if index is not None and not 0 <= index < len(rows):
            return  # somebody else deleted it just now
        match event:
            case Drawn(box):
                photo = inputs.photo
                marked = [b.box for b in inputs.boxes]
                self._suggest(inputs).name(box, marked, lambda row: client.post(lambda: self._name_box(photo, row)))
            case Reshaped(i, box):
                now = replace(inputs.boxes[i], box=box)
                self._annotate(_("change the box of {label}").format(label=now.label), with_box_at(inputs, i, now))
            case Named(i, label):
                self._rename(i, label)
            case Deleted(i):
                client.selected_box = None
                self._annotate(
                    _("delete the box of {label}").format(label=inputs.boxes[i].label), without_box(inputs, i)
                )
            case Clicked(x, y):
                client.selected_box = None
                client.refresh()
                photo = inputs.photo
                marked = [b.box for b in inputs.boxes]
                self._suggest(inputs).suggest(x, y, marked, lambda box: client.post(lambda: self._take_box(photo, box)))
            case Accepted(i, label):
                self._mark(inputs, label_box(rows[i].box, label or rows[i].label))
            case Dismissed(i):
                self.dismiss(rows[i])
            case Selected(i):
                client.selected_box = i
                client.refresh()
            case Finished():
                client.view.canvas.close()
                client.refresh()

    def _take_box(self, photo: Photo, box: LabelledBox | None) -> None:
        """What was clicked on is known: it becomes a box, or the one that is there already is selected."""
        inputs = self._client.inputs
        if inputs is None or inputs.photo is not photo:
            return  # another project was opened meanwhile
        known = None if box is None else same_object(inputs.boxes, box.box)
        if box is None:
            self._client.notice(_("Nothing was recognised there; drag a box around the object."))
        elif known is None:
            self._mark(inputs, label_box(box.box, box.label))
        else:
            self._client.selected_box = known
            self._client.refresh()

    def _name_box(self, photo: Photo, box: LabelledBox) -> None:
        """The likeliest name of a box that was drawn is known."""
        inputs = self._client.inputs
        if inputs is not None and inputs.photo is photo:
            self._mark(inputs, label_box(box.box, box.label))

    def _mark(self, inputs: Inputs, box: LabelledBox) -> None:
        """Add a box and select it, so that it can be named and changed at once."""
        self._annotate(_("mark: {label}").format(label=box.label), replace(inputs, boxes=(*inputs.boxes, box)))
        self._client.selected_box = len(inputs.boxes)
        self._client.refresh()

    def _annotate(self, label: str, inputs: Inputs) -> None:
        stop_unasked(self._client.session)
        self._client.annotate(label, inputs)

    def _rename(self, index: int, name: str) -> None:
        inputs, words = self._client.inputs, " ".join(name.split())
        if inputs is None or not words or inputs.boxes[index].label == words:
            return
        now = label_box(inputs.boxes[index].box, words)
        label = _("change {label} to {words}").format(label=inputs.boxes[index].label, words=words)
        self._annotate(label, with_box_at(inputs, index, now))

    def name(self, word: str) -> None:
        """A name was chosen for the selected box."""
        if self._client.selected_box is not None:
            self._rename(self._client.selected_box, word)

    def name_field(self, inputs: Inputs) -> str:
        """The name of the selected box, with likely and frequent names to choose."""
        index = self._client.selected_box
        if index is None:
            return ""
        value, likely = inputs.boxes[index].label, self._likely(inputs, index)
        names = (*likely, *(name for name in COMMON if name not in likely))[: len(COMMON)]
        chips = "".join(button(text(_(name)), "name", name, on=name == value) for name in names)
        options = "".join(f'<option value="{text(name)}">' for name in NAMES)
        return (
            f'<h4><label for="dio-box-name">{text(_("Name of the selected box"))}</label></h4>'
            f'<input id="dio-box-name" list="dio-box-names" data-change="named" value="{text(value)}">'
            f'<datalist id="dio-box-names">{options}</datalist>'
            f'<div class="bar tight" style="margin-top:6px">{chips}</div>'
        )


MERGED = (
    "{count} proposal was left out because another box shows the same object.",
    "{count} proposals were left out because other boxes show the same objects.",
)


def box_list(inputs: Inputs, selected: int | None) -> str:
    """All boxes, to be selected and deleted; how to make the first one."""
    if not inputs.boxes:
        message = _("Click each piece of furniture in the photo, or drag a box around it.")
        if can_find_furniture():
            message = _("Build the scene: furniture is detected automatically.") + " " + message
        return f'<p class="dim">{text(message)}</p>'
    rows = []
    for index, box in enumerate(inputs.boxes):
        unknown = f' <span class="dim">{text(_("unknown kind"))}</span>' if box.category == "object" else ""
        rows.append(
            f'<div class="row {"on" if index == selected else ""}" data-do="mark" data-arg="{index}" role="treeitem" '
            f'tabindex="0" aria-selected="{"true" if index == selected else "false"}">'
            f'<span class="name">{text(box.label)}{unknown}</span>'
            + button("✕", "drop", index, title=_("Delete the box of {label}").format(label=box.label))
            + "</div>"
        )
    return f'<h4>{text(_("Boxes"))}</h4><div role="tree" aria-label="{text(_("Boxes"))}">{"".join(rows)}</div>'


def _outcome(boxes: Sequence[LabelledBox], merged: int, doubtful: Sequence[tuple[int, float]]) -> Iterator[str]:
    """What became of all proposals, in sentences."""
    yield _("All proposals are accepted.")
    if merged:
        yield plural(*MERGED, merged)
    if doubtful:
        index, height_m = doubtful[0]
        yield _("{label} would be at least {height_m:.1f} m high; check its name and its box.").format(
            label=boxes[index].label.capitalize(), height_m=height_m
        )
        if len(doubtful) > 1:
            yield plural("{count} more box is doubtful.", "{count} more boxes are doubtful.", len(doubtful) - 1)
