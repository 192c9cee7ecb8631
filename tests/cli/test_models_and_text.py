from __future__ import annotations

import json
from pathlib import Path

import onnxruntime
import pytest

from diorama_app.cli import main
from diorama_core.models.manifest import network
from diorama_core.models.network import Network
from diorama_core.models.store import ModelStore
from diorama_core.project.storage import Project
from tests.cli.room_photo import write_room
from tests.cli.running import refused, told
from tests.few_shapes import stored_seats


@pytest.fixture(autouse=True)
def _own_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    for name in ("DIORAMA_IMAGE_BASE_URL", "DIORAMA_LMM_BASE_URL"):
        monkeypatch.delenv(name, raising=False)


def test_networks_are_listed_with_size_and_licence(capsys: pytest.CaptureFixture[str]) -> None:
    rows = {r["id"]: r for r in json.loads(told(capsys, ["models", "list", "--json"]))}
    assert rows["yolox-nano"]["licence"] == "Apache-2.0"
    assert rows["sam2.1-large"]["size_mb"] > 900
    assert not any(r["here"] for r in rows.values())


def test_a_set_is_pulled_in_half_precision_where_a_card_calculates_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    pulled: list[str] = []

    def pull(store: ModelStore, networks: tuple[Network, ...], **_: object) -> tuple[str, ...]:
        pulled[:] = [n.id for n in networks]
        return ()

    monkeypatch.setattr("diorama_core.models.pull.pull", pull)
    for cuda, expected in ((True, "owlv2-base-fp16"), (False, "owlv2-base")):
        offered = ["CUDAExecutionProvider"] * cuda + ["CPUExecutionProvider"]
        monkeypatch.setattr(onnxruntime, "get_available_providers", lambda offered=offered: offered)
        assert main(["models", "pull", "default", "--yes"]) == 0
        assert [i for i in pulled if i.startswith("owlv2")] == [expected]
    assert main(["models", "pull", "owlv2-base-fp16", "--yes"]) == 0
    assert pulled == ["owlv2-base-fp16"], "what is named is what is pulled"


def test_path_and_verify_without_networks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert told(capsys, ["models", "path"]).strip() == str(tmp_path / "models")
    assert "pull" in told(capsys, ["models", "verify"])


def test_files_fetched_elsewhere_and_damage_found(
    shared: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["models", "pull", "--from", str(shared / "models")]) == 0
    assert main(["models", "verify"]) == 0
    graph = tmp_path / "models" / "yolox-nano" / "yolox_nano.onnx"
    data = bytearray(graph.read_bytes())
    data[1000] ^= 1
    graph.write_bytes(bytes(data))
    assert main(["models", "verify"]) == 1
    assert "yolox-nano" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        ["models", "pull", "everything"],
        ["models", "pull", "duoduoclip", "--yes"],
        ["models", "pull", "tiny"],
        ["models", "pull", "--from", "nowhere"],
        ["text", "", "-o", "p"],
    ],
    ids=["unknown", "own copy", "licence not accepted", "no folder", "no text"],
)
def test_failures_are_one_clear_line(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert refused(capsys, arguments)


def test_failing_networks_and_language_models_leave_the_project_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*more: str) -> str:
        """The one line that is said; the scene is what it was."""
        said = refused(capsys, [*arguments, *more])
        assert (tmp_path / "room" / "scene.json").read_bytes() == before
        return said

    photo, boxes = write_room(tmp_path, marked=1)
    arguments = ["build", str(photo), "--boxes", str(boxes), "-o", str(tmp_path / "room"), "--library", stored_seats()]
    assert main(arguments) == 0
    before = (tmp_path / "room" / "scene.json").read_bytes()
    monkeypatch.setenv("DIORAMA_LMM_BASE_URL", "http://127.0.0.1:9/v1")
    monkeypatch.setenv("DIORAMA_LMM_MODEL", "m")
    assert main(arguments) == 0
    notes = Project.open(tmp_path / "room").info()["notes"]
    assert any("geometry (" in note and "cannot be reached" in note for note in notes), notes
    monkeypatch.delenv("DIORAMA_LMM_BASE_URL")
    assert "diorama models pull tiny" in fails("--profile", "foundation")
    damaged, store = network("slimsam"), ModelStore.default()
    for file in damaged.files:
        arrived = tmp_path / "arrived"
        arrived.write_bytes(b"half a graph")
        store.adopt(damaged, file, arrived, "local")
    assert main(arguments) == 0
    notes = Project.open(tmp_path / "room").info()["notes"]
    assert any("SlimSAM" in note and "left out" in note and "diorama models verify" in note for note in notes), notes
    capsys.readouterr()
    assert main([*arguments, "--profile", "embedded"]) == 0
    assert (tmp_path / "room" / "scene.json").read_bytes() == before
