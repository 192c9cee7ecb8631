"""What is said of the photo in a session is undone, redone and found by the next one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_app.reconstruction.camera_correction import set_camera_height
from diorama_app.session.client import Client
from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.editing.input_corrections import with_correction
from diorama_core.project.storage import Project
from diorama_core.scene import edits

TABLE = LabelledBox((240.0, 200.0, 440.0, 420.0), "table", "dining table")


def retained(client: Client) -> Inputs:
    """What a later session finds."""
    assert client.session.project is not None
    client.session.autosave.flush()
    found = Project.open(client.session.project.folder).load_inputs()
    assert found is not None
    return found


def test_corrections_are_undone_redone_and_found_by_the_next_session(client: Client) -> None:
    session = client.session
    before = session.document.inputs
    assert before is not None
    outline = np.zeros((before.photo.height, before.photo.width), dtype=bool)
    outline[230:400, 260:420] = True
    bench = replace(TABLE, category="bench", label="bench")
    said = with_correction(before, TABLE.box, bench, outline)
    session.edit("outline", lambda s: edits.rename(s, "table_1", "bench"), by=client, inputs=said)
    assert retained(client) == said
    session.undo(client)
    assert retained(client) == before
    session.redo(client)
    assert retained(client) == said
    project = session.project
    assert project is not None
    session.open_project(Project.open(project.folder))
    assert session.document.inputs == said


def test_a_known_length_is_retained_as_the_height_of_the_camera(client: Client) -> None:
    set_camera_height(client, 1.9)
    assert retained(client).camera_height_m == pytest.approx(1.9)
    client.session.undo(client)
    assert retained(client).camera_height_m is None
