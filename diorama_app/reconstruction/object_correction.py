"""Corrections from the photo: add a missed object, or change the category, box or outline of one."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool

from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.artefacts import Box, Inputs, LabelledBox
from diorama_core.editing.input_corrections import find_outline, with_correction
from diorama_core.editing.reconstructed import insert, rename, replace_object
from diorama_core.errors import EditRefused
from diorama_core.library.labels import understand_label
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.types import Scene, SceneObject

if TYPE_CHECKING:
    from diorama_core.editing.outline import MaskDraft
    from diorama_core.pipeline.reconstruct_object import Found  # the whole pipeline; opening a project does without it


def add_from_photo(client: Client, box: Box, label: str) -> None:
    """Segment, retrieve, pose and place the object in a box of the photo; nothing else changes."""
    session = client.session
    new_id = edits.fresh_id(session.scene, understand_label(label).category.name)

    def put(scene: Scene, result: Found) -> Scene:
        return insert(scene, result, session.library)

    step = _("insert {label} from the photo").format(label=label)
    _reconstruct(client, None, _label(box, label), new_id, step, put, select_new=True)


def rename_class(client: Client, object_id: str, label: str) -> None:
    """Change an object's category: retrieves matching shapes for its box and uses the best at the same place."""
    item = _find(client, object_id)
    words = label.strip()
    if not words:
        raise EditRefused("type a category, for example armchair")

    def put(scene: Scene, result: Found) -> Scene:
        return rename(scene, object_id, result)

    assert item.box_px is not None
    step = _("change {label} to {words}").format(label=item.label, words=words)
    _reconstruct(client, item.box_px, _label(item.box_px, words), object_id, step, put)


def redraw_box(client: Client, object_id: str, box: Box) -> None:
    """Change an object's box in the photo: segments, retrieves and poses it again."""
    item = client.session.scene.object(object_id)
    now, label = _label(box, item.label), _("reconstruct {label}").format(label=item.label)
    _reconstruct(client, item.box_px, now, object_id, label, _replace(client, object_id))


def use_outline(client: Client, object_id: str, outline: MaskDraft) -> None:
    """Change an object's mask: retrieves and poses it again."""
    item = client.session.scene.object(object_id)
    if not outline.mask.any():
        raise EditRefused("the outline is empty; click the object first")
    box = _label(outline.bounds, item.label)
    label = _("change the outline of {label}").format(label=item.label)
    _reconstruct(client, item.box_px, box, object_id, label, _replace(client, object_id), drawn=outline.mask)


def start_outline(client: Client, object_id: str) -> MaskDraft:
    """The present outline of an object: as it was given, or as far as its box tells."""
    item, inputs = _find(client, object_id), _inputs(client)
    from diorama_core.editing.outline import MaskDraft
    from diorama_core.perception.masks import EmbeddedMasks

    assert item.box_px is not None
    mask = find_outline(inputs, item.box_px)
    if mask is None:
        mask = EmbeddedMasks().segment_box(inputs.photo.rgb, item.box_px)[0]
    return MaskDraft(inputs.photo.rgb, item.box_px, mask)


def _reconstruct(
    client: Client,
    before: Box | None,
    box: LabelledBox,
    object_id: str,
    label: str,
    put: Callable[[Scene, Found], Scene],
    *,
    drawn: Bool[np.ndarray, "h w"] | None = None,
    select_new: bool = False,
) -> None:
    """Reconstruct one box of the photo, update the scene, and store the correction for the next build."""
    session = client.session
    inputs, scene, project = _inputs(client), session.scene, session.project

    def work(progress: Progress) -> None:
        from diorama_core.pipeline.reconstruct_object import reconstruct_object

        result = reconstruct_object(
            scene,
            inputs,
            session.offer,
            box,
            object_id,
            mask=find_outline(inputs, box.box) if drawn is None else drawn,
            cache=None if project is None else project.stages_folder,
            progress=progress,
        )

        def show() -> None:
            ids_before = {o.id for o in session.scene.objects}
            session.add_textures(result.pictures)
            corrected = with_correction(_inputs(client), before, box, drawn)
            session.edit(label, lambda s: put(s, result), by=client, inputs=corrected)
            new = [o.id for o in session.scene.objects if o.id not in ids_before]
            if select_new and new:
                client.view.canvas.close()
                client.select(new)

        client.post(show)

    session.jobs.start("outline", _("Reconstructing {label}").format(label=box.label), work)


def _replace(client: Client, object_id: str) -> Callable[[Scene, Found], Scene]:
    return lambda scene, result: replace_object(scene, object_id, result, client.session.library)


def _label(box: Box, label: str) -> LabelledBox:
    return LabelledBox(box, understand_label(label).category.name, label)


def _inputs(client: Client) -> Inputs:
    inputs = client.session.document.inputs
    if inputs is None:
        raise EditRefused("this project has no photo; upload one in the Photo tab")
    return inputs


def _find(client: Client, object_id: str) -> SceneObject:
    item = client.session.scene.object(object_id)
    if item.box_px is None:
        message = _("{label} was not found in the photo; draw a box around it in the Photo tab instead")
        raise EditRefused(message.format(label=item.label))
    if item.locked:
        raise EditRefused(_("{label} is locked; unlock it first").format(label=item.label))
    return item
