"""Review: one question about the scene after another, the most helpful first; an answer is an edit like any other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import viser
from jaxtyping import UInt8
from PIL import Image, ImageDraw

from diorama_app.commands import review
from diorama_app.commands.measure import start_measuring
from diorama_app.panels.fields import on_change, show_if, show_value
from diorama_app.projects.pictures import encode_picture, jpeg_uri
from diorama_app.reconstruction.object_correction import add_from_photo
from diorama_app.session.client import Client
from diorama_app.session.units import format_length, parse_length
from diorama_app.strings import _, plural
from diorama_app.viewport.thumbnails import SIDE_PX, Paint
from diorama_app.web.html import Action, LiveHtml, button, library_text, text
from diorama_core.artefacts import Box
from diorama_core.errors import EditRefused
from diorama_core.library.labels import understand_label
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.review.answers import apply_answer, candidate_of
from diorama_core.review.questions import LEAST_GAIN, TURNS, YES, Choice, Question, missing, questions
from diorama_core.scene.types import SceneObject

CROP_PX = 300
MARGIN = 0.5
"""How much of the photo is shown around an object, as a share of its box."""
SETTLED = 0.8
"""Share of what answers can bring that counts as most of it."""


@dataclass(frozen=True)
class Doubt:
    """How much of a scene is expected to be right, and what it takes to settle most of the rest."""

    right: float
    answers: int

    @classmethod
    def of(cls, items: tuple[SceneObject, ...], asked: tuple[Question, ...]) -> Doubt:
        """The doubt of a scene's objects, given its questions."""
        known = [o.belief.right for o in items if o.belief is not None]
        gains = np.cumsum([q.gain for q in asked])
        enough = int(np.searchsorted(gains, SETTLED * gains[-1])) + 1 if len(gains) else 0
        return cls(float(np.mean(known)) if known else 1.0, enough)


class Review:
    """A card that tells how sure the scene is, and the open question."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._open = False
        self._later: frozenset[str] = frozenset()
        """Questions that were put off; all are asked again when the review is opened anew."""
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._act(action), key=_key(action)))
        self._other = gui.add_text(
            _("It is another kind"), "", visible=False, hint=_("Type what it is: armchair, wardrobe, …")
        )
        self._length = gui.add_text(
            _("Another height"), "", visible=False, hint=_("Type what it measures: 2.03 m, 6 ft 8 in")
        )
        on_change(self._length, lambda words: client.post(lambda: self._measure(str(words)), key="length"))
        on_change(self._other, lambda words: client.post(lambda: self._name(str(words)), key="other kind"))

    def refresh(self) -> None:
        """Draw the card for the scene as it is."""
        scene, asked = self._client.session.scene, self._all()
        left = tuple(q for q in asked if q.id not in self._later)
        self._open = self._open and bool(left)
        show_if(self._open and left[0].subject == "kind", self._other)
        show_if(self._open and left[0].subject == "scale", self._length)
        if not asked:
            self._html.show("")
            return
        doubt = Doubt.of(scene.objects, asked)
        self._html.show(self._asking(left[0], len(left)) if self._open else _summary(doubt))

    def _all(self) -> tuple[Question, ...]:
        """What is asked of the scene and of what it may lack, the most helpful question first."""
        scene, proposals = self._client.session.scene, self._client.proposals()
        if not scene.objects or not proposals or self._client.further_photo is not None:
            return questions(scene)
        from diorama_core.pipeline.beliefs import presence_of  # the pipeline; the page opens without it

        more = (missing(scene, box, presence_of(box.score)) for box in proposals)
        everything = (*questions(scene), *(q for q in more if q.gain >= LEAST_GAIN))
        return tuple(sorted(everything, key=lambda question: -question.gain))

    def _asking(self, question: Question, left: int) -> str:
        known = self._client.session.scene
        item = known.object(question.object_id) if known.has_object(question.object_id) else None
        tiles = "".join(self._tile(item, question, choice, k) for k, choice in enumerate(question.choices, 1))
        after = button(_("Later"), "later", question.id, title=_("Show the next question"))
        after += button(_("Close"), "close", title=_("Continue another time; answers are kept"))
        if question.subject == "scale":
            hint = _("Click two points, then type their distance")
            after = button(_("Measure something else"), "measure", title=hint) + after
        count = text(plural("{count} question left", "{count} questions left", left))
        return (
            f'<div class="card review" role="group" aria-label="{text(_("Review"))}"><h4>{count}</h4>'
            f"{self._crop(item, question)}<p><b>{library_text(question.sentence)}</b></p>"
            f'<div class="grid two">{tiles}</div><div class="bar tight">{after}</div></div>'
        )

    def _tile(self, item: SceneObject | None, question: Question, choice: Choice, number: int) -> str:
        picture = ""
        if item is not None and question.subject == "kind":
            shape = candidate_of(self._client.session.library, item, choice.value).shape_id
            picture = self._client.session.thumbnails.html(shape, (item.colour, item.finish))
        elif item is not None and question.subject == "front":
            picture = self._preview(item, choice.value)
        label = library_text(choice.label)
        if question.subject == "scale":
            length = format_length(float(choice.value), self._client.preferences.unit)
            label = text(_("About {length}").format(length=length))
        key = text(f"{question.id}={choice.value}")
        hint = _("Hover to preview it in the room; key {number} chooses it").format(number=number)
        return (
            f'<button type="button" class="tile" data-do="answer" data-arg="{key}" data-peek="{key}" '
            f'data-digit="{number}" title="{text(hint)}">'
            f"{picture}<b>{number} · {label}</b><small>{100 * choice.probability:.0f} %</small></button>"
        )

    def _preview(self, item: SceneObject, turn: str) -> str:
        """The object as the photo's camera would see it after a turn; nothing without a camera."""
        session, camera = self._client.session, self._client.session.scene.camera
        if camera is None:
            return ""
        from diorama_core.render.views import StudioView, render_shape  # OpenCV: only once such a question is open

        x, y, z = camera.position - item.pose.position
        yaw = float(np.arctan2(y, x)) - item.pose.yaw_rad - TURNS.index(turn) * np.pi / 2
        view = StudioView(yaw, float(np.arctan2(z, np.hypot(x, y))))
        paint: Paint = (item.colour, item.finish)

        def draw() -> bytes:
            rgba = render_shape(session.library, item.shape_id, (SIDE_PX, SIDE_PX), view, paint=paint)
            return encode_picture(rgba, "PNG")

        return session.thumbnails.picture_html(f"{item.shape_id} {view} {paint}", draw)

    def _crop(self, item: SceneObject | None, question: Question) -> str:
        """The object in the photo, as an image of the page."""
        inputs = self._client.session.inputs
        box = _box_of(question) if item is None else item.box_px
        if inputs is None or box is None:
            return ""
        uri = jpeg_uri(encode_picture(crop_around(inputs.photo.rgb, box), "JPEG", quality=85))
        return f'<img class="crop" alt="{text(_(question.sentence))}" src="{uri}">'

    def _act(self, action: Action) -> None:
        client = self._client
        if action.do == "review":
            self._open, self._later = True, frozenset()
        elif action.do == "close":
            self._open = False
        elif action.do == "measure":
            start_measuring(client)
            return
        elif action.do == "later":
            self._later |= {action.arg}
        elif action.do in ("answer", "peek"):
            question, value = action.arg.partition("=")[::2]
            if action.do == "peek":
                self._peek(question, value)
                return
            if question.startswith("missing:"):
                self._answer_missing(question, value)
            else:
                review.answer(client.session, question, value, by=client)
        self._show_object()

    def _answer_missing(self, question_id: str, value: str) -> None:
        """Add what the scene lacks, from the photo; or never ask again."""
        scene = self._client.session.scene
        box = next((b for b in self._client.proposals() if missing(scene, b, 0.5).id == question_id), None)
        if box is None:
            return
        self._later |= {question_id}  # what is being added is not asked again meanwhile
        if value == YES:
            add_from_photo(self._client, box.box, box.label)
        else:
            self._client.dismiss(box)

    def _name(self, words: str) -> None:
        """Answer the open question with a kind in words."""
        question = self._question()
        if question is None or question.subject != "kind" or not words.strip():
            return
        kind = understand_label(words).category
        if kind.name == UNKNOWN.name:
            message = _("the library has no kind of object called “{words}”; try another word").format(words=words)
            raise EditRefused(message)
        show_value(self._other, "")
        review.answer(self._client.session, question.id, kind.name, by=self._client)
        self._show_object()

    def _measure(self, words: str) -> None:
        """Answer the open question with a length."""
        question = self._question()
        if question is None or question.subject != "scale" or not words.strip():
            return
        length_m = parse_length(words, self._client.preferences.unit)
        show_value(self._length, "")
        review.answer(self._client.session, question.id, str(length_m), by=self._client)
        self._show_object()

    def _question(self) -> Question | None:
        """The question that is open now."""
        left = (q for q in self._all() if q.id not in self._later)
        return next(left, None) if self._open else None

    def _show_object(self) -> None:
        """Select what is asked about, so that it is marked in the view and in the list."""
        question = self._question()
        if question is not None and question.subject != "missing":
            self._client.select((question.object_id,))
        self._client.refresh()

    def _peek(self, question: str, value: str) -> None:
        """Show what an answer would do, without giving it; nothing for no answer."""
        session = self._client.session
        subject, object_id = question.partition(":")[::2]
        if subject == "scale" or not session.scene.has_object(object_id) or session.jobs.status is not None:
            session.refresh()
            return
        shown = apply_answer(session.scene, session.library, question, value)
        if shown.has_object(object_id):
            session.viewport.preview_item(shown.object(object_id))


def _box_of(question: Question) -> Box | None:
    if question.subject != "missing":
        return None
    x1, y1, x2, y2 = (float(v) for v in question.object_id.split(","))
    return x1, y1, x2, y2


def _key(action: Action) -> str | None:
    return "peek" if action.do == "peek" else None


def _summary(doubt: Doubt) -> str:
    """How sure the scene is, and what a few answers would do."""
    share = round(100 * doubt.right)
    words = plural(
        "{count} answer would resolve most doubts", "{count} answers would resolve most doubts", doubt.answers
    )
    hint = _("Answer questions about uncertain results, the most helpful one first")
    start = button(_("Review"), "review", title=hint)
    sure = text(_("{percent} % sure").format(percent=share))
    return (
        f'<div class="job card"><span class="words"><b>{sure}</b> · {text(words)}</span>{start}'
        f'<meter min="0" max="100" value="{share}" aria-label="{text(_("Confidence in the scene"))}"></meter></div>'
    )


def crop_around(rgb: UInt8[np.ndarray, "h w 3"], box: Box) -> Image.Image:
    """A part of a photo around a box, with a frame that tells the box from its surroundings."""
    x1, y1, x2, y2 = box
    side, (x, y) = max(x2 - x1, y2 - y1) * (0.5 + MARGIN), ((x1 + x2) / 2, (y1 + y2) / 2)
    left, top = max(0, round(x - side)), max(0, round(y - side))
    right, bottom = min(rgb.shape[1], round(x + side)), min(rgb.shape[0], round(y + side))
    picture = Image.fromarray(rgb[top:bottom, left:right])
    scale = CROP_PX / max(picture.size)
    picture = picture.resize((max(1, round(picture.width * scale)), max(1, round(picture.height * scale))))
    frame = [(x1 - left) * scale, (y1 - top) * scale, (x2 - left) * scale, (y2 - top) * scale]
    for colour, width in (("#ffffff", 5), ("#2f6fd6", 3)):
        ImageDraw.Draw(picture).rectangle(frame, outline=colour, width=width)
    return picture
