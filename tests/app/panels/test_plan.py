from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diorama_app.panels.plan import Plan, ShapeOutlines
from diorama_app.session.client import Client
from diorama_app.session.units import format_length
from diorama_core.editing.plan_edits import corners, wall_feet
from tests.app.page import Page
from tests.waiting import until


@pytest.fixture
def plan(client, page: Page) -> Plan:
    return page.put(Plan)


def refresh(client: Client, plan: Plan, page: Page) -> None:
    """As the program does it: on the UI thread, where the outlines that were looked for ask for it, too."""
    client.post(plan.refresh)
    page.settle()


def told(page: Page) -> dict[str, Any] | None:
    """What the page was told last."""
    import html

    said = html.unescape(next(h.content for kind, _, h in reversed(page.made) if kind == "html"))
    news: dict[str, Any] | None = json.loads(said[said.index("told(") + 5 : said.rindex(")")])
    return news


def do(page: Page, what: str, arg: object) -> None:
    """As the page does it."""
    hidden = next(h for kind, label, h in page.made if label == "·")
    page.send(hidden, what, json.dumps(arg))


def test_nothing_is_told_while_it_is_not_looked_at(client, page: Page, plan: Plan) -> None:
    refresh(client, plan, page)
    assert told(page) is None
    client.plan = True
    refresh(client, plan, page)
    assert told(page) is not None


def test_what_is_told_is_what_the_scene_says(session, client, page: Page, plan: Plan) -> None:
    client.plan = True
    client.select(["table_1"])
    refresh(client, plan, page)
    news = told(page)
    assert news is not None
    assert {w["id"]: w["length"] for w in news["walls"]} == {
        f.id: format_length(f.length_m, "m") for f in wall_feet(session.scene)
    }
    assert len(news["corners"]) == len(corners(session.scene))
    assert {p["id"] for p in news["pieces"]} == {o.id for o in session.scene.objects}
    assert [p["id"] for p in news["pieces"] if p["on"]] == ["table_1"]


def test_it_selects_moves_and_sets_lengths_with_undo(session, client, page: Page, plan: Plan) -> None:
    client.plan = True
    refresh(client, plan, page)
    do(page, "select", ["chair_1", False])
    assert client.selection == ("chair_1",)
    before = session.scene.object("chair_1").pose.position
    do(page, "move", ["chair_1", 0.1, -0.2])
    np.testing.assert_allclose(session.scene.object("chair_1").pose.position - before, (0.1, -0.2, 0.0), atol=1e-9)
    corner = corners(session.scene)[0]
    do(page, "length", [corner.first, "3.3"])
    assert next(f for f in wall_feet(session.scene) if f.id == corner.first).length_m == pytest.approx(3.3)
    session.undo(client)
    session.undo(client)
    np.testing.assert_allclose(session.scene.object("chair_1").pose.position, before)


@pytest.mark.parametrize(
    ("what", "arg"),
    [
        ("move", ["gone", 1, 1]),
        ("move", None),
        ("wall", ["wall_1"]),
        ("corner", [1]),
        ("length", ["wall_1", "long"]),
        ("split", ["wall_1"]),
        ("split", ["gone", 0, 0]),
        ("door", ["wall_1", 0, 0]),
        ("window", ["gone", 0, 0]),
        ("room", [[0, 0], [1, 0]]),
        ("room", "all"),
    ],
)
def test_what_is_no_edit_is_refused_and_changes_nothing(
    session, client, page: Page, plan: Plan, what: str, arg: object
) -> None:
    client.plan = True
    refresh(client, plan, page)
    before = session.scene
    do(page, what, arg)
    assert session.scene is before


def test_outlines_are_boxes_until_the_shapes_are_known(session) -> None:
    outlines, found = ShapeOutlines(session.library), []
    table = session.scene.object("table_1")
    (box,) = outlines.object_outlines(table)
    low, high = table.corners_world.min(axis=0)[:2], table.corners_world.max(axis=0)[:2]
    np.testing.assert_allclose(np.stack([box.min(axis=0), box.max(axis=0)]), [low, high], atol=1e-6)
    outlines.look_for(session.scene, lambda: found.append(True))
    until(lambda: bool(found))
    shape = np.concatenate(outlines.object_outlines(table))
    np.testing.assert_allclose(np.stack([shape.min(axis=0), shape.max(axis=0)]), [low, high], atol=0.01)


def test_a_shape_that_is_lost_stays_a_box_and_the_others_are_drawn(session) -> None:
    first, *others = session.scene.objects
    scene = replace(session.scene, objects=(replace(first, shape_id="gone"), *others))
    outlines, found = ShapeOutlines(session.library), []
    outlines.look_for(scene, lambda: found.append(True))
    until(lambda: bool(found))
    assert len(outlines.object_outlines(scene.objects[0])) == 1
    outlines.look_for(scene, lambda: found.append(True))
    assert len(found) == 1, "it is not looked for again"
