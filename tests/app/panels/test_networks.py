from __future__ import annotations

import pytest

from diorama_app.panels import networks
from diorama_app.panels.networks import Networks
from diorama_core.models.manifest import networks_of
from tests.app.page import Page

GET, ACCEPT = "Download networks", "I accept these licences"


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch, tmp_path) -> list:
    """What would be fetched; this machine has no networks."""
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    calls: list = []
    monkeypatch.setattr(networks, "get_networks", lambda client, chosen, accepted: calls.append((chosen, accepted)))
    return calls


@pytest.fixture
def panel(page: Page, client, asked) -> Networks:
    return page.put(Networks)


def test_licences_are_accepted_before_anything_is_fetched(page, panel, asked) -> None:
    page.write("Set", "tiny: a photo alone")
    assert "to download" in page.html
    for network in networks_of("tiny"):
        assert network.title in page.html
    assert page.field(GET).disabled
    page.write(ACCEPT, True)
    page.press(GET)
    ((chosen, accepted),) = asked
    assert chosen == networks_of("tiny")
    assert accepted == frozenset(n.id for n in networks_of("tiny"))


def test_another_set_has_other_licences(page, panel) -> None:
    page.write(ACCEPT, True)
    page.write("Set", "paper: as published")
    assert page.field(ACCEPT).value is False
    assert page.field(GET).disabled


def test_every_stage_says_what_it_uses(page, panel) -> None:
    assert "What each stage uses now" in page.html
    assert "no network on this machine" in page.html.lower()


def test_the_disk_is_not_read_at_every_edit(page, panel, monkeypatch) -> None:
    looked: list[int] = []
    monkeypatch.setattr(networks, "profile_status", lambda: looked.append(1) or [])
    for _ in range(5):
        panel.refresh()
    assert looked == []
    page.write(ACCEPT, True)
    assert looked == [1]
