"""Networks fetched from the editor, furniture found with one, and rooms made from words."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
import torch

from diorama_app.reconstruction import networks
from diorama_app.reconstruction.networks import NO_DETECTOR, detect_with_networks, find_furniture, get_networks
from diorama_app.reconstruction.text_to_scene import NO_ENDPOINT, describe_room, how_pictures_come
from diorama_app.session.client import Client
from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.errors import EditRefused, InputError, UnavailableError
from diorama_core.io import assets
from diorama_core.models.network import ModelFile, Network
from diorama_core.models.store import ModelStore
from diorama_core.project.storage import Project
from tests.app.people import LocalClient, settle
from tests.app.small_room import plain_photo
from tests.models import tiny_networks
from tests.models.stub_hub import SHA, Hub, serving, try_again_at_once
from tests.pipeline.test_presets import BOX, HEIGHT, WIDTH, _Yolox, install

GRAPH = bytes(range(256)) * 2000
SMALL = Network(
    id="small",
    role="detection",
    title="Small net",
    licence="MIT",
    repo="owner/name",
    revision=SHA,
    files=(ModelFile("model.onnx", len(GRAPH), hashlib.sha256(GRAPH).hexdigest()),),
)


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModelStore:
    for name in ("DIORAMA_LMM_BASE_URL", "DIORAMA_IMAGE_BASE_URL", "HF_HUB_OFFLINE"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    try_again_at_once(monkeypatch)
    return ModelStore.default()


@pytest.fixture
def hub(monkeypatch: pytest.MonkeyPatch) -> Iterator[Hub]:
    with serving(Hub({"owner/name/model.onnx": GRAPH})) as running:
        monkeypatch.setenv("HF_ENDPOINT", running.address)
        yield running


def _told(client: Client) -> list[str]:
    """What was shown as an error, once the job and the desk are done."""
    settle(client.session)
    viser_client = client.viser_client
    assert isinstance(viser_client, LocalClient)
    return viser_client.told


def test_networks_are_fetched_once_their_licences_are_accepted(hub: Hub, store: ModelStore, client: Client) -> None:
    with pytest.raises(InputError, match="accept the licences"):
        get_networks(client, (SMALL,), frozenset())
    assert not store.has(SMALL)
    get_networks(client, (SMALL,), frozenset({"small"}))
    assert _told(client) == []
    assert store.path(SMALL, "model.onnx").read_bytes() == GRAPH
    with pytest.raises(EditRefused, match="already"):
        get_networks(client, (SMALL,), frozenset())
    store.forget(SMALL)
    get_networks(client, (SMALL,), frozenset())  # what was accepted once is not asked again
    assert _told(client) == []
    assert store.has(SMALL)


@pytest.mark.parametrize("case", ["refused", "wrong content", "no hub"])
def test_a_failed_pull_is_one_line_and_nothing_is_used(
    case: str, hub: Hub, store: ModelStore, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    hub.status = 403 if case == "refused" else 200
    hub.corrupt = case == "wrong content"
    if case == "no hub":
        monkeypatch.setenv("HF_ENDPOINT", "http://127.0.0.1:9")
    before = client.session.scene
    get_networks(client, (SMALL,), frozenset({"small"}))
    (message,) = _told(client)
    assert "Small net" in message
    assert "\n" not in message
    assert "unexpectedly" not in message
    assert not store.has(SMALL)
    assert client.session.scene is before


def test_a_pull_can_be_stopped(hub: Hub, store: ModelStore, client: Client) -> None:
    hub.pause_s = 0.02
    get_networks(client, (SMALL,), frozenset({"small"}))
    with pytest.raises(EditRefused, match="still running"):
        get_networks(client, (SMALL,), frozenset({"small"}))
    client.session.jobs.cancel()
    assert _told(client) == []
    assert not store.has(SMALL)


def begun(folder: Path, inputs: Inputs) -> Project:
    """A project with a photo and no scene yet."""
    project = Project.create(folder)
    project.save_inputs(inputs)
    return project


def test_networks_are_downloaded_and_detect_at_once(
    store: ModelStore, client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    photo = plain_photo(WIDTH, HEIGHT)
    client.session.open_project(begun(tmp_path / "projects" / "tiny", Inputs(photo)))
    example = (torch.zeros(1, 3, 416, 416),)
    graph = tiny_networks.export(_Yolox(), example, tmp_path / "y.onnx", ["images"], ["output"])
    accepted: list[str] = []

    def pulled(into: ModelStore, missing: tuple[Network, ...], *, accept, progress) -> tuple[str, ...]:
        assert accept(missing), "the licences shown beside the button are accepted"
        accepted.extend(n.id for n in missing)
        install(into, "yolox-nano", [graph])
        return ("yolox-nano",)

    monkeypatch.setattr(networks, "pull", pulled)
    detect_with_networks(client)
    assert _told(client) == []
    assert "yolox-nano" in accepted
    assert client.session.inputs is not None
    assert "chair" in [b.label for b in client.session.inputs.boxes]


def test_found_furniture_joins_the_boxes_drawn_by_hand(
    store: ModelStore, client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(assets, "FOLDER", tmp_path / "left out")
    photo = plain_photo(WIDTH, HEIGHT)
    client.session.open_project(begun(tmp_path / "projects" / "tiny", Inputs(photo)))
    find_furniture(client)
    assert _told(client) == [NO_DETECTOR]
    example = (torch.zeros(1, 3, 416, 416),)
    graph = tiny_networks.export(_Yolox(), example, tmp_path / "y.onnx", ["images"], ["output"])
    install(store, "yolox-nano", [graph])
    drawn = LabelledBox((2.0, 2.0, 20.0, 20.0), "lamp", "lamp")
    client.annotate("draw", replace(client.session.inputs, boxes=(drawn,)))
    boards: list[int] = []
    client.open_board = lambda: boards.append(1)
    find_furniture(client)
    assert _told(client) == [NO_DETECTOR]
    retained, found = client.session.inputs.boxes
    assert retained == drawn
    assert found.label == "chair"
    assert found.box == pytest.approx(BOX, abs=1.0)
    assert boards == [1]
    find_furniture(client)
    _told(client)
    assert len(client.session.inputs.boxes) == 2, "what is marked already is not marked again"


def test_a_room_needs_words_and_a_whole_setting(
    store: ModelStore, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(InputError, match="describe the room"):
        describe_room(client, "  ")
    assert how_pictures_come() == NO_ENDPOINT
    monkeypatch.setenv("DIORAMA_IMAGE_BASE_URL", "http://127.0.0.1:9/v1")
    assert "DIORAMA_IMAGE_MODEL" in how_pictures_come()
    with pytest.raises(UnavailableError, match="DIORAMA_IMAGE_MODEL"):
        describe_room(client, "a kitchen")
    monkeypatch.setenv("DIORAMA_IMAGE_MODEL", "painter")
    assert how_pictures_come() == "painter generates the picture."
    before = client.session.scene
    describe_room(client, "a kitchen")
    (message,) = _told(client)
    assert "127.0.0.1:9" in message
    assert client.session.scene is before
    assert [p.name for p in client.session.projects_dir.iterdir()] == ["demo"]


def test_a_described_room_can_be_stopped(store: ModelStore, client: Client) -> None:
    before = client.session.scene
    describe_room(client, "two chairs and a table")
    client.session.jobs.cancel()
    assert _told(client) == []
    assert client.session.scene is before
