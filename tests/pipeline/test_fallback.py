"""Builds go on without networks that cannot be used, and say so; profiles that insist stop with one line."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import UnavailableError
from diorama_core.models.manifest import network
from diorama_core.models.runtime import NetworkError
from diorama_core.models.store import ModelStore
from diorama_core.perception.language.client import LmmSettings
from diorama_core.perception.language.stages import LanguageRecognition
from diorama_core.pipeline.fallback import with_usable_networks
from diorama_core.pipeline.presets import Profile, stages_for
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import Progress
from diorama_core.project.build import build_project
from diorama_core.project.storage import Project
from diorama_core.synthesis.layout_rooms import box_library
from tests.models.test_broken_networks import BROKEN, CASES
from tests.perception.language.stub_lmm import StubLmm, answering
from tests.pipeline.test_presets import BOX, _Nothing, graphs, install, photo, store

__all__ = ["graphs", "photo", "store"]  # fixtures

IN_STORE = {"yolox-nano": "yolox", "slimsam": "sam encoder", "migan": "migan", "moge-2-vits": "moge"}
"""What breaks which network."""


def _choose(profile: Profile, inputs: Inputs):
    def choose(store: ModelStore) -> Stages:
        stages = stages_for(profile, inputs, box_library(), store=store)
        return replace(stages, retrieval=_Nothing(), pose=_Nothing())

    return choose


def _build(
    profile: Profile, inputs: Inputs, store: ModelStore, cache: Path | None = None, *, plane_pictures: bool = False
) -> tuple[Built, tuple[str, ...]]:
    def build(stages: Stages) -> Built:
        return build_scene(inputs, box_library(), stages=stages, cache=cache, plane_pictures=plane_pictures)

    return with_usable_networks(_choose(profile, inputs), build, store=store)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where stages are kept for all tests: what whole networks make of the photo is the same beside any broken one."""
    return tmp_path_factory.mktemp("stages")


@pytest.mark.parametrize(
    ("network_id", "how"),
    [("yolox-nano", "noise"), ("slimsam", "other outputs"), ("migan", "answers that are no numbers"),
     ("moge-2-vits", "out of memory")],
)  # fmt: skip
def test_a_network_that_fails_is_left_out_and_named(
    network_id: str,
    how: str,
    photo: Photo,
    store: ModelStore,
    graphs: dict[str, list[Path]],
    finished: Path,
    tmp_path: Path,
) -> None:
    for other, files in graphs.items():
        install(store, other, files)
    broken = tmp_path / "broken.onnx"
    BROKEN[how](CASES[IN_STORE[network_id]], broken)
    install(store, network_id, [broken, *graphs[network_id][1:]])
    filled = network_id == "migan"  # it works on pictures of floor and walls only
    built, left_out = _build("auto", Inputs(photo), store, finished, plane_pictures=filled)
    assert [line.split(" was left out: ")[0] for line in left_out] == [network(network_id).title]
    assert all("\n" not in line and len(line) < 600 for line in left_out)
    assert built.scene.architecture.planes
    used = " ".join(run.used for run in built.runs)
    assert network_id not in used
    assert all(other in used for other in {"slimsam", "moge-2-vits"} - {network_id})


def test_all_networks_may_fail_and_the_project_says_so(
    photo: Photo, store: ModelStore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    noise = tmp_path / "noise.onnx"
    noise.write_bytes(np.random.default_rng(0).bytes(3000))
    for network_id in ("slimsam", "sam2.1-large", "migan", "moge-2-vits"):
        install(store, network_id, [noise] * len(network(network_id).files))
    monkeypatch.setenv("DIORAMA_MODELS", str(store.folder))
    inputs = Inputs(photo, (LabelledBox(BOX, "chair", "chair"),))
    project = Project.create(tmp_path / "room")
    build_project(project, inputs, box_library(), choose=_choose("auto", inputs))
    notes = "\n".join(Project.open(project.folder).info()["notes"])
    for network_id in ("slimsam", "sam2.1-large", "migan", "moge-2-vits"):
        assert f"{network(network_id).title} was left out: " in notes


def test_a_profile_that_insists_stops_with_the_reason(
    photo: Photo, store: ModelStore, graphs: dict[str, list[Path]], tmp_path: Path
) -> None:
    for other, files in graphs.items():
        install(store, other, files)
    noise = tmp_path / "noise.onnx"
    noise.write_bytes(b"half a file")
    install(store, "moge-2-vits", [noise])
    with pytest.raises(NetworkError, match="cannot be loaded"):
        _build("foundation", Inputs(photo), store)


def test_a_file_that_was_changed_since_it_was_checked_is_not_used(
    photo: Photo, store: ModelStore, graphs: dict[str, list[Path]]
) -> None:
    install(store, "slimsam", graphs["slimsam"])
    slimsam = network("slimsam")
    path = store.path(slimsam, slimsam.files[0].path)
    data = bytearray(path.read_bytes())
    inputs = Inputs(photo, (LabelledBox(BOX, "chair", "chair"),))
    path.write_bytes(data)  # the same content, written later: it may be used
    assert _build("auto", inputs, store)[1] == ()
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(data)
    with pytest.raises(NetworkError, match="changed since it was fetched"):
        store.path(slimsam, slimsam.files[0].path)
    assert "changed since it was fetched" in _build("auto", inputs, store)[1][0]


def test_other_errors_end_the_work(store: ModelStore, photo: Photo, tmp_path: Path) -> None:
    def fails(stages: Stages) -> None:
        raise UnavailableError("something else is missing")

    with pytest.raises(UnavailableError, match="something else"):
        with_usable_networks(_choose("auto", Inputs(photo)), fails, store=store)

    def foreign(stages: Stages) -> None:
        raise NetworkError(tmp_path / "elsewhere.onnx", "fails")

    with pytest.raises(NetworkError, match="elsewhere"):
        with_usable_networks(_choose("auto", Inputs(photo)), foreign, store=store)


@dataclass(frozen=True)
class _SeesNothing:
    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        return ()


def test_a_language_model_that_names_nothing_is_left_out_and_named(photo: Photo, store: ModelStore) -> None:
    inputs = Inputs(photo)
    with answering(StubLmm(["no idea"])) as stub:
        recognition = LanguageRecognition(LmmSettings(stub.address, "stub", votes=1, re_asks=0))
        stages = replace(_choose("auto", inputs)(store), recognition=recognition, detection=_SeesNothing())
        built = build_scene(inputs, box_library(), stages=stages)
    assert any(note.startswith("recognition: left out (stub gave no usable answer") for note in built.notes)
