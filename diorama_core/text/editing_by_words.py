"""Commands in words become the editor's own edits, to be looked at before they are done.

A language model translates them where one is set up (DIORAMA_LMM_BASE_URL), else a small grammar, into the same list of
typed edits. The grammar also steps in where the model is slow, unreachable or answers what cannot be done.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from diorama_core.editing.positioning import Positioner
from diorama_core.errors import EditRefused, UnavailableError
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.language.client import LmmClient, LmmSettings
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.schema import check_limits
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Scene
from diorama_core.text.edit_apply import EditApplier
from diorama_core.text.edit_grammar import edits_of
from diorama_core.text.edit_plan import Edit, EditPlan, Rename
from diorama_core.text.edit_wording import clauses_of
from diorama_core.text.language import SYSTEM, edit_prompt

MAX_OBJECTS_ASKED = 300
"""A language model is told of no more objects."""


@dataclass(frozen=True, eq=False)
class ProposedEdits:
    """What a command would do."""

    command: str
    scene: Scene
    """With all edits done."""
    edits: tuple[Edit, ...]
    lines: tuple[str, ...]
    """What is done, one line each."""
    notes: tuple[str, ...] = ()
    """What is done otherwise than asked."""
    translator: str = "grammar"
    """Who translated: "grammar" or the language model's name."""
    changed: tuple[str, ...] = ()
    """Ids of the objects in the new scene that differ or are new."""


def propose_edits(
    command: str,
    scene: Scene,
    library: ShapeLibrary,
    *,
    selected: Sequence[str] = (),
    language_model: LmmSettings | None = None,
    progress: Progress = SILENT,
) -> ProposedEdits:
    """What a command in words would do to a scene, which stays as it is.

    Args:
        command: in plain English, such as "make all chairs wooden and remove the rug".
        scene: what is edited.
        library: of its shapes, and of new ones.
        selected: ids of selected objects, which "it" and a noun that several objects share mean first.
        language_model: translates; None leaves it to the grammar.
        progress: reports and cancellation of a question to the language model.

    Raises:
        EditRefused: something is not understood, not there, or does not fit: one line that says what. Nothing is done.
    """
    clauses_of(command)  # an empty or endless command is nothing to ask about
    if language_model is None:
        return _propose_by_grammar(command, scene, library, selected)
    try:
        return _propose_by_model(command, scene, library, language_model, selected, progress)
    except (UnavailableError, EditRefused) as trouble:
        try:
            plain = _propose_by_grammar(command, scene, library, selected)
        except EditRefused as refused:
            raise trouble if isinstance(trouble, EditRefused) else refused from trouble
        note = f"understood without the language model ({trouble})"
        return replace(plain, notes=(note, *plain.notes))


def apply_edits(
    edits: Sequence[Edit],
    scene: Scene,
    library: ShapeLibrary,
    *,
    command: str = "",
    translator: str = "",
    progress: Progress = SILENT,
) -> ProposedEdits:
    """What typed edits would do to a scene, one after the other; the scene stays as it is.

    Args:
        edits: in order; later ones may use the names that earlier ones gave to new objects.
        scene: what is edited.
        library: of its shapes, and of new ones.
        command: the words that they stand for, if any.
        translator: who made them of words.
        progress: where a cancellation is noticed.

    Raises:
        EditRefused: one of them cannot be done: one line that says which and why. Nothing is done.
    """
    applier, after = EditApplier(Positioner(library)), scene
    lines: list[str] = []
    notes: list[str] = []
    for number, edit in enumerate(edits, 1):
        progress.check()
        try:
            done = applier.apply(after, edit)
        except EditRefused as error:
            which = f"edit {number} of {len(edits)} ({edit.do}): " if len(edits) > 1 else ""
            raise EditRefused(f"{which}{error}") from error
        after = done.scene
        lines += done.lines
        notes += done.notes
    return _proposal(command, scene, after, edits, lines, notes, translator)


def _propose_by_grammar(command: str, scene: Scene, library: ShapeLibrary, selected: Sequence[str]) -> ProposedEdits:
    applier = EditApplier(Positioner(library))
    after, last = scene, tuple(selected)
    edits: list[Edit] = []
    lines: list[str] = []
    notes: list[str] = []
    for clause in clauses_of(command):
        for proposal in edits_of(clause, after, library, last, selected):
            edit = _restore_case(proposal, command)
            done = applier.apply(after, edit)
            after, last = done.scene, done.touched or last
            edits.append(edit)
            lines += done.lines
            notes += done.notes
    return _proposal(command, scene, after, edits, lines, notes, "grammar")


def _restore_case(edit: Edit, command: str) -> Edit:
    """An edit whose name is spelt as the command spells it; clauses are lower case."""
    if not isinstance(edit, Rename):
        return edit
    at = command.lower().find(edit.to)
    return edit if at < 0 else edit.model_copy(update={"to": command[at : at + len(edit.to)]})


def _propose_by_model(
    command: str,
    scene: Scene,
    library: ShapeLibrary,
    settings: LmmSettings,
    selected: Sequence[str],
    progress: Progress,
) -> ProposedEdits:
    if len(scene.objects) > MAX_OBJECTS_ASKED:
        raise UnavailableError(f"a scene of more than {MAX_OBJECTS_ASKED} objects is too large to be told")
    progress.report(0.0, f"Asking {settings.model} what is meant")
    client = LmmClient(settings, system=SYSTEM)
    plan = client.ask(edit_prompt(command, scene, selected), [], EditPlan, progress).value
    if plan.not_understood or not plan.edits:
        remainder = "; ".join(plan.not_understood) or command
        raise EditRefused(f"not understood: “{remainder[:120]}”; nothing was done")
    return apply_edits(plan.edits, scene, library, command=command, translator=settings.model, progress=progress)


def _proposal(
    command: str,
    before: Scene,
    after: Scene,
    edits: Sequence[Edit],
    lines: Sequence[str],
    notes: Sequence[str],
    translator: str,
) -> ProposedEdits:
    check_scene(after)
    check_limits(after, before)
    changed = tuple(o.id for o in after.objects if not before.has_object(o.id) or before.object(o.id) != o)
    return ProposedEdits(command, after, tuple(edits), tuple(lines), tuple(dict.fromkeys(notes)), translator, changed)
