"""What a build leaves in its project's folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.project.build import save_artefacts, with_found_boxes
from diorama_core.project.storage import Project
from diorama_core.scene.types import Scene
from tests.app.small_room import plain_photo
from tests.built import built_scene

GUESSED = LabelledBox((1.0, 1.0, 4.0, 5.0), "chair", "chair", guessed=True)
WITHOUT_WORD = replace(GUESSED, category="object", label="object", guessed=False)
FOUND = LabelledBox((2.0, 2.0, 6.0, 5.0), "table", "table", score=0.7)


def test_boxes_keep_their_guessed_names_where_a_build_found_no_others(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room")
    given = Inputs(plain_photo(), (GUESSED,))
    project.save_inputs(given)
    built = built_scene(Scene())
    built = replace(built, inputs=replace(built.inputs, boxes=(WITHOUT_WORD,)))
    assert with_found_boxes(given, built) is given
    save_artefacts(project, built, given)
    saved = project.load_inputs()
    assert saved is not None
    assert saved.boxes == (GUESSED,)


def test_boxes_that_a_network_found_are_saved_with_what_was_given(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room")
    given = Inputs(plain_photo())
    project.save_inputs(given)
    built = built_scene(Scene())
    save_artefacts(project, replace(built, inputs=replace(built.inputs, boxes=(FOUND,))), given, ("blurred",))
    assert project.load_inputs() == replace(given, boxes=(FOUND,))
    assert project.info()["notes"] == ["blurred"]
