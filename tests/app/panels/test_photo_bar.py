from __future__ import annotations

from dataclasses import replace

from diorama_app.panels.photo_bar import photo_bar
from diorama_core.artefacts import Inputs
from tests.app.small_room import plain_photo


def test_the_bar_counts_proposals_and_boxes(session, client) -> None:
    inputs = session.inputs
    bar = photo_bar(client, inputs, 10)
    assert "10 proposals" in bar
    assert f"Build scene ({len(inputs.boxes)})" in bar
    assert "Add selected box" not in bar
    client.selected_box = 0
    assert "Add selected box" in photo_bar(client, inputs, 0)


def test_nothing_is_built_before_anything_is_marked(client, monkeypatch) -> None:
    monkeypatch.setattr("diorama_app.reconstruction.build_job.can_find_furniture", lambda: False)
    bar = photo_bar(client, replace(Inputs(plain_photo()), boxes=()), 0)
    assert "Mark furniture" in bar
    assert "disabled>Build scene<" in bar
