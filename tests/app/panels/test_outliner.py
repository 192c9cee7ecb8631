from __future__ import annotations

from dataclasses import replace

from diorama_app.panels.outliner import Outliner, to_check
from tests.app.page import Page


def test_the_list_counts_objects_and_selects_those_to_check(session, client, page: Page) -> None:
    page.put(Outliner)
    sure = tuple(replace(o, confidence=1.0) for o in session.scene.objects)
    session.document.open(replace(session.scene, objects=sure))
    client.refresh()
    assert f"{len(sure)} objects</p>" in page.html
    assert not page.shows("check")
    lamp, chair = (session.scene.object(i) for i in ("lamp_1", "chair_1"))
    unsure = replace(chair, confidence=0.1, box_px=(1.0, 2.0, 30.0, 40.0))
    session.document.open(replace(session.scene, objects=tuple(unsure if o is chair else o for o in sure)))
    session.badges = {lamp.id: ("floats",)}
    client.refresh()
    assert "· 2 to check" in page.html
    page.act("check")
    assert set(client.selection) == {lamp.id, chair.id} == set(to_check(session.scene, session.badges))
