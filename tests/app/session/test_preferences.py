"""What a browser keeps of how somebody works."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest

from diorama_app.session.preferences import Preferences, preferences_text, read_preferences, recall, remember
from tests.app.people import LocalClient


class Shut:
    """A browser that keeps nothing for any page."""

    def get_item(self, key: str, timeout: float | None = None) -> str | None:
        raise RuntimeError("localStorage is blocked")


CHANGED = Preferences(
    unit="ft-in",
    snap=True,
    slide=False,
    names=True,
    badges=False,
    planes=True,
    dark=True,
    gizmo="size",
    physics=True,
    build_at_once=False,
    recipe="paper",
    size_mode="catalogue",
    keep_colour=False,
    all_alike=True,
    favourites=("chair_a",),
    recent=("lamp_a", "chair_a"),
    numbers=True,
)


def viser_client(drawer: object = None) -> LocalClient:
    class Server:
        scene = gui = None

    made = LocalClient(Server(), 1)
    if drawer is not None:
        made.local_storage = drawer
    return made


def test_every_setting_is_retained_except_that_outlines_are_shown() -> None:
    same = [f.name for f in fields(Preferences) if getattr(CHANGED, f.name) == getattr(Preferences(), f.name)]
    assert same == ["masks"], "this test forgot a setting"
    one = viser_client()
    remember(one, replace(CHANGED, masks=True))
    assert recall(one) == CHANGED


@pytest.mark.parametrize("retained", [None, "", "{", "[]", '{"unit": "parsec"}', '{"snap": "perhaps"}'])
def test_what_is_not_understood_counts_as_somebody_new(retained: str | None) -> None:
    assert read_preferences(retained) == Preferences()


def test_settings_of_another_version_keep_what_is_known() -> None:
    assert read_preferences('{"dark": true, "colour_of_the_sky": "blue"}') == Preferences(dark=True)
    assert read_preferences(preferences_text(CHANGED)) == CHANGED


def test_a_browser_that_keeps_nothing_is_somebody_new() -> None:
    assert recall(viser_client(Shut())) == Preferences()
