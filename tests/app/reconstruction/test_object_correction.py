from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_app.commands import edit as editing
from diorama_app.reconstruction.object_correction import (
    add_from_photo,
    redraw_box,
    rename_class,
    start_outline,
    use_outline,
)
from diorama_core.errors import EditRefused
from diorama_core.pipeline import reconstruct_object as pipeline
from diorama_core.pipeline.reconstruct_object import Found
from diorama_core.scene.types import Candidate, Pose, SceneObject, Support
from tests.app.people import settle
from tests.app.small_room import PlainLibrary

BOX = (240.0, 200.0, 440.0, 420.0)
"""Of the table, the only one that was drawn."""


@pytest.fixture(autouse=True)
def seen_table(session):
    """The table knows its box in the photo, as after a build."""
    table = replace(session.scene.object("table_1"), box_px=BOX)
    scene = replace(session.scene, objects=tuple(table if o.id == "table_1" else o for o in session.scene.objects))
    session.document.open(scene, session.document.inputs)
    session.refresh()


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[dict]:
    """What was looked for in the photo; a red chair of the library is found in its place."""
    calls: list[dict] = []
    shape = PlainLibrary().shape("chair_c")

    def look(scene, inputs, library, box, object_id, *, mask, cache, progress) -> Found:
        calls.append({"box": box, "id": object_id, "mask": mask, "cache": cache})
        pose = Pose.upright((0.5, 1.0, 0.475))
        candidate = Candidate(shape.id, shape.size_m, 0.9, pose)
        item = SceneObject(
            object_id,
            box.label,
            box.category,
            shape.id,
            shape.size_m,
            pose,
            (candidate,),
            box_px=box.box,
            confidence=0.6,
        )
        return Found(item, Support(object_id, "floor"), {}, as_built=False)

    monkeypatch.setattr(pipeline, "reconstruct_object", look)
    return calls


def test_what_was_missed_is_added_and_selected(session, client, asked) -> None:
    count = len(session.scene.objects)
    add_from_photo(client, (10.0, 300.0, 80.0, 400.0), "armchair")
    settle(session)
    assert len(session.scene.objects) == count + 1
    new = session.scene.object(client.selection[0])
    assert (new.label, new.category, new.shape_id) == ("armchair", "armchair", "chair_c")
    assert asked[0]["mask"] is None
    assert asked[0]["cache"] == session.project.stages_folder
    # The next build starts from that box too.
    assert [b.label for b in session.document.inputs.boxes] == ["dining table", "armchair"]
    session.undo(client)
    assert len(session.document.inputs.boxes) == 1


def test_another_class_stands_where_the_object_stood(session, client, asked) -> None:
    before = session.scene.object("table_1")
    rename_class(client, "table_1", " chair ")
    settle(session)
    after = session.scene.object("table_1")
    assert (after.label, after.category, after.shape_id) == ("chair", "chair", "chair_c")
    np.testing.assert_allclose(after.pose.position[:2], before.pose.position[:2], atol=1e-6)
    assert after.colour == before.colour
    assert session.document.history.current.label == "change dining table to chair"
    assert [b.label for b in session.document.inputs.boxes] == ["chair"]


def test_a_new_box_poses_it_again(session, client, asked) -> None:
    box = (100.0, 150.0, 300.0, 400.0)
    redraw_box(client, "table_1", box)
    settle(session)
    assert asked[0]["box"].box == box
    assert session.scene.object("table_1").box_px == box
    np.testing.assert_allclose(session.scene.object("table_1").pose.position[:2], [0.5, 1.0], atol=1e-6)


def test_a_drawn_outline_is_what_is_looked_at(session, client, asked) -> None:
    outline = start_outline(client, "table_1")
    assert outline.box == BOX
    assert outline.mask.any()
    use_outline(client, "table_1", outline)
    settle(session)
    np.testing.assert_array_equal(asked[0]["mask"], outline.mask)
    assert start_outline(client, "table_1").mask.sum() == outline.mask.sum(), "it is remembered"
    with pytest.raises(EditRefused, match="outline is empty"):
        use_outline(client, "table_1", replace(outline, mask=np.zeros_like(outline.mask)))


def test_what_cannot_be_corrected_says_why(session, client, asked) -> None:
    with pytest.raises(EditRefused, match="was not found in the photo"):
        rename_class(client, "chair_1", "sofa")
    with pytest.raises(EditRefused, match="type a category"):
        rename_class(client, "table_1", "  ")
    editing.set_locked(client, ["table_1"], True)
    with pytest.raises(EditRefused, match="is locked"):
        rename_class(client, "table_1", "sofa")
    session.document.open(session.scene)
    with pytest.raises(EditRefused, match="no photo"):
        add_from_photo(client, BOX, "chair")
    assert asked == []
