from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_app.commands import edit as editing
from diorama_app.panels.object_card import ObjectCard
from diorama_app.panels.properties import Properties
from diorama_core.scene.types import PhotoMaterial, Scene
from tests.app.page import Page


@pytest.fixture
def panel(page: Page, client, commands) -> Properties:
    made = Properties(page, client)
    client.panels = [ObjectCard(page, client, commands), made]
    client.change_preferences(numbers=True)
    return made


def chair(session):
    return session.scene.object("chair_1")


def test_without_a_selection_the_panel_says_what_to_do(session, client, page, panel) -> None:
    assert "Click an object" in page.html
    assert not page.field("Name").visible
    session.document.open(Scene())
    session.refresh()
    assert "The room is empty" in page.html


def test_numbers_are_folded_until_somebody_wants_them(client, page, panel) -> None:
    client.select(["chair_1"])
    page.act("numbers")
    assert not page.field("Name").visible
    assert "Size: Width" not in page.html
    page.act("numbers")
    assert "Size: Width" in page.html


def test_fields_show_the_selected_object(session, client, page, panel) -> None:
    client.select(["chair_2"])
    item = session.scene.object("chair_2")
    assert page.field("Name").value == item.label
    for name, value in {"Size: Width": 0.52, "Size: Depth": 0.55, "Position: x": 1.2, "Position: Height": 0}.items():
        assert f'aria-label="{name}" value="{value:g}"' in page.html
    assert f'value="{np.degrees(2.6):.4g}" aria-label="Direction' in page.html
    assert "chair &lt;b&gt;by the window&lt;/b&gt;" in page.html


def test_what_is_written_becomes_an_edit(session, client, page, panel) -> None:
    client.select(["chair_1"])
    page.write("Name", "throne")
    page.change("turn", "90")
    for axis, size in enumerate(("0.6", "70 cm", "1")):
        page.change("size", size, str(axis))
    for axis, place in enumerate(("-1", "1", "0")):
        page.change("place", place, str(axis))
    page.write("Colour", (255, 0, 51))
    item = chair(session)
    assert item.label == "throne"
    assert np.degrees(item.pose.yaw_rad) == pytest.approx(90.0)
    np.testing.assert_allclose(item.size_m, [0.7, 0.6, 1.0])
    np.testing.assert_allclose(editing.base_position(item), [-1.0, 1.0, 0.0], atol=1e-9)
    assert item.colour == pytest.approx((1.0, 0.0, 0.2))
    page.act("own")
    assert chair(session).colour is None


def test_lengths_are_written_in_the_persons_unit(session, client, page, panel) -> None:
    client.select(["chair_1"])
    page.change("unit", "cm")
    assert 'aria-label="Size: Width" value="46"' in page.html
    page.change("size", "50", "0")
    assert chair(session).size_m[1] == pytest.approx(0.5)
    page.change("unit", "ft-in")
    page.change("size", "2'", "1")
    assert chair(session).size_m[0] == pytest.approx(0.6096)
    before = session.scene
    page.change("size", "two feet", "0")
    assert session.scene is before
    assert any("is not a length" in told for told in client.viser_client.told)


def test_the_colour_field_shows_the_colour_of_what_is_selected(session, client, page, panel) -> None:
    client.select(["chair_1"])
    assert page.field("Colour").value == (205, 173, 139), "sRGB of what glTF says in linear light"
    client.select(["table_1"])
    assert page.field("Colour").value == (224, 208, 182)
    cloth = PhotoMaterial("fabric", (0.6, 0.2, 0.4), main=True)
    scene = session.scene
    worn = tuple(replace(o, photo_materials=(cloth,)) if o.id == "table_1" else o for o in scene.objects)
    session.commit("build", replace(scene, objects=worn), by=client)
    session.ui_thread.wait()
    assert page.field("Colour").value == (153, 51, 102), "what the photo shows of it"
    page.act("materials", "library")
    assert page.field("Colour").value == (224, 208, 182)


def test_a_zero_has_no_minus(session, client, page, panel) -> None:
    client.select(["chair_1"])
    page.change("turn", "-0.0")
    page.change("place", "-0", "0")
    assert 'value="-0"' not in page.html


def test_finishes_are_put_on_and_taken_off(session, client, page, panel) -> None:
    client.select(["chair_1", "chair_2"])
    page.act("finish", "gloss")
    assert {o.finish for o in session.scene.objects if o.category == "chair"} == {"gloss"}
    page.act("finish", "")
    assert chair(session).finish is None


def test_materials_of_the_photo_are_put_on_and_taken_off(session, client, page, panel) -> None:
    client.select(["chair_1"])
    assert not page.shows("materials", "photo"), "the photo gave it none"
    cloth = PhotoMaterial("fabric", (0.5, 0.2, 0.1), main=True)
    scene = session.scene
    worn = tuple(replace(o, photo_materials=(cloth,)) if o.id == "chair_1" else o for o in scene.objects)
    session.commit("build", replace(scene, objects=worn), by=client)
    page.act("materials", "library")
    assert chair(session).visible_materials == ()
    page.act("materials", "photo")
    assert chair(session).visible_materials == (cloth,)
    page.write("Colour", (255, 0, 51))
    assert chair(session).material_source == "library", "paint shows"
    session.undo(client)
    assert chair(session).visible_materials == (cloth,)


def test_several_objects_are_aligned_and_three_distributed(session, client, page, panel) -> None:
    client.select(["chair_1", "chair_2"])
    assert "and 1 more" in page.html
    assert page.shows("run", "align_left")
    assert not page.shows("run", "distribute")
    client.select(["chair_1", "chair_2", "table_1"])
    assert page.shows("run", "distribute")
    page.act("run", "align_front")
    near = [session.scene.object(i).corners_world[:, 1].min() for i in client.selection]
    np.testing.assert_allclose(near, near[0], atol=1e-9)


def test_a_refused_value_is_said_and_the_field_goes_back(session, client, page, panel) -> None:
    client.select(["chair_1"])
    editing.set_locked(client, ["chair_1"], True)
    before = session.scene
    page.change("turn", "10")
    assert session.scene is before
    assert any("locked" in told for told in client.viser_client.told)
    assert f'value="{np.degrees(0.4):.3g}" aria-label="Direction' in page.html
    assert "locked</span>" in page.html


@pytest.mark.parametrize(("category", "word"), [("laptop", "Close"), ("door", "Open")])
def test_moving_parts_have_a_slider_that_says_what_it_does(
    session, client, page, panel, monkeypatch: pytest.MonkeyPatch, category: str, word: str
) -> None:
    monkeypatch.setattr(session.shapes, "can_open", lambda shape_id: True)
    item = replace(chair(session), category=category)
    others = tuple(o for o in session.scene.objects if o.id != item.id)
    session.document.open(replace(session.scene, objects=(*others, item)))
    client.select([item.id])
    assert f'aria-label="{word}"' in page.html


def test_distances_are_never_negative_and_overlaps_are_told(session, client, page, panel) -> None:
    client.select(["chair_1"])
    editing.set_base_position(client, "chair_1", np.array([1.25, 1.45, 0.0]))  # into the other chair
    client.refresh()
    page.settle()
    assert 'title="Overlaps chair &lt;b&gt;by the window&lt;/b&gt; by ' in page.html
    assert 'value="-' not in page.html.split("Distances")[1].split("</div>")[0]
