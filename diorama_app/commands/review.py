"""Answers to questions about the scene, each one undo step."""

from __future__ import annotations

from diorama_app.commands.glide import glide
from diorama_app.reconstruction.camera_correction import rescale_inputs
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.strings import N_, _
from diorama_core.artefacts import Inputs
from diorama_core.review.answers import apply_answer, lengths
from diorama_core.review.questions import NO
from diorama_core.scene.types import Scene

STEPS = {
    "presence": N_("confirm {label}"),
    "kind": N_("name {label}"),
    "front": N_("turn {label}"),
    "supporter": N_("place {label}"),
    "missing": N_("insert what was missing"),
}
"""What undo steps of answers are called."""


def answer(session: EditorSession, question_id: str, value: str, *, by: Client | None = None, author: str = "") -> None:
    """Answer a question about the scene.

    Args:
        session: of the project.
        question_id: of the question.
        value: of the answer.
        by: who answers in a browser.
        author: who does so elsewhere.

    Raises:
        EditRefused: it is no answer, or the object is gone or locked.
    """
    subject, object_id = question_id.partition(":")[::2]
    name = session.scene.object(object_id).label if session.scene.has_object(object_id) else ""
    label = _(N_("delete {label}") if value == NO else STEPS.get(subject, subject)).format(label=name).strip()

    rescaled: Inputs | None = None
    if subject == "scale" and session.scene.has_object(object_id):
        now_m, true_m = lengths(session.scene, object_id, value)
        label = _("{label} is {metres:g} m high").format(label=name, metres=true_m)
        rescaled = rescale_inputs(session, true_m / now_m)

    def change(scene: Scene) -> Scene:
        return apply_answer(scene, session.library, question_id, value)

    before = session.scene
    session.edit(label, change, by=by, author=author, by_hand=subject in ("front", "supporter"), inputs=rescaled)
    glide(session, before)
