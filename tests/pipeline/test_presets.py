"""Profiles: the same artefacts whoever made them, mixed per stage, and only what changes runs again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
import torch

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import InputError, UnavailableError
from diorama_core.io import assets
from diorama_core.models.fast_depth import FastDepth
from diorama_core.models.manifest import network
from diorama_core.models.store import ModelStore
from diorama_core.perception.foundation.proposals import OwnDetection
from diorama_core.perception.language.client import LmmSettings
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.pipeline.choices import NetworkChoice, profile_status
from diorama_core.pipeline.findings import camera_sentence
from diorama_core.pipeline.presets import propose_boxes, stages_for
from diorama_core.pipeline.run import Built, build_scene
from diorama_core.pipeline.stages import Stages
from diorama_core.pose import MadeToMeasure
from diorama_core.progress import Progress
from diorama_core.provenance import DepthSource, FocalSource, GraphMethod
from diorama_core.synthesis.layout_rooms import box_library
from tests.made_once import made_once
from tests.models import tiny_networks, tiny_sams
from tests.models.test_depth import HEIGHT, WIDTH, _Moge
from tests.models.tiny_networks import install
from tests.perception.language.stub_lmm import StubLmm, answering

BOX = (40.0, 45.0, 90.0, 85.0)


class _Yolox(torch.nn.Module):
    """Sees one chair, in the same place of every picture."""

    def __init__(self) -> None:
        super().__init__()
        scale = 416 / WIDTH
        x1, y1, x2, y2 = (v * scale for v in BOX)
        raw = torch.full((1, 3549, 85), 0.0)
        # The first cell of the coarsest grid: stride 32, cell (0, 0).
        row = raw[0, 52 * 52 + 26 * 26]
        row[:2] = torch.tensor([(x1 + x2) / 64, (y1 + y2) / 64])
        row[2:4] = torch.log(torch.tensor([(x2 - x1) / 32, (y2 - y1) / 32]))
        row[4] = row[5 + 56] = 1.0
        self.register_buffer("raw", raw)

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        return self.raw + 0.0 * images.mean()


@dataclass(frozen=True)
class _Nothing:
    """Stands for retrieval and pose, which these tests are not about."""

    def retrieve(self, *artefacts: object) -> tuple[()]:
        return ()

    def pose(self, *artefacts: object) -> tuple[()]:
        return ()


def _exported(folder: Path) -> dict[str, list[Path]]:
    _, encoder, decoder = tiny_sams.slimsam(folder)
    moge = (torch.zeros(1, 3, HEIGHT, WIDTH), torch.tensor(1800))
    names = ["points", "normal", "mask", "metric_scale"]
    yolox = (torch.zeros(1, 3, 416, 416),)
    return {
        "yolox-nano": [tiny_networks.export(_Yolox(), yolox, folder / "y.onnx", ["images"], ["output"])],
        "slimsam": [encoder, decoder],
        "migan": [tiny_networks.migan(folder / "p.onnx")],
        "moge-2-vits": [tiny_networks.export(_Moge(), moge, folder / "m.onnx", ["image", "num_tokens"], names)],
    }


@cache
def _graphs_made_once() -> dict[str, list[bytes]]:
    """To export them takes longer than what is done with them."""

    def make() -> dict[str, list[bytes]]:
        with TemporaryDirectory() as folder:
            return {name: [p.read_bytes() for p in paths] for name, paths in _exported(Path(folder)).items()}

    return made_once("tiny networks", make)


@pytest.fixture(scope="module")
def graphs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Path]]:
    """Graphs of tiny networks, by id."""
    folder, paths = tmp_path_factory.mktemp("graphs"), dict[str, list[Path]]()
    for name, files in _graphs_made_once().items():
        paths[name] = [folder / f"{name}-{k}.onnx" for k in range(len(files))]
        for path, data in zip(paths[name], files, strict=True):
            path.write_bytes(data)
    return paths


@pytest.fixture
def store(tmp_path: Path) -> ModelStore:
    return ModelStore(tmp_path / "models")


@pytest.fixture
def photo(rng: np.random.Generator) -> Photo:
    rgb = rng.integers(115, 125, (HEIGHT, WIDTH, 3)).astype(np.uint8)
    rgb[48:82, 44:88] = (200, 60, 40)
    return Photo(rgb, "room.png", (WIDTH, HEIGHT))


def _build(stages: Stages, inputs: Inputs, cache: Path | None = None, *, plane_pictures: bool = False) -> Built:
    quiet = replace(stages, retrieval=_Nothing(), pose=_Nothing())
    return build_scene(inputs, box_library(), stages=quiet, cache=cache, plane_pictures=plane_pictures)


def _types(built: Built) -> dict[str, type]:
    parts = {"camera": built.camera, "geometry": built.geometry, "room": built.architecture, "depth": built.depth}
    return {name: type(value) for name, value in parts.items()} | {"object": type(built.objects[0])}


def test_both_profiles_make_the_same_kinds_of_artefacts(
    photo: Photo, store: ModelStore, graphs: dict[str, list[Path]]
) -> None:
    drawn = Inputs(photo, (LabelledBox(BOX, "chair", "chair"),))
    embedded = _build(stages_for("embedded", drawn, box_library(), store=store), drawn)
    for network_id, files in graphs.items():
        install(store, network_id, files)
    alone = Inputs(photo)
    foundation = _build(stages_for("foundation", alone, box_library(), store=store), alone, plane_pictures=True)
    assert _types(embedded) == _types(foundation)
    assert [o.category for o in foundation.objects] == ["chair"]
    np.testing.assert_allclose(foundation.objects[0].box, BOX, atol=1.0)
    assert foundation.depth.source is DepthSource.NETWORK
    assert foundation.inputs.depth_source is DepthSource.NETWORK
    assert foundation.inputs.intrinsics is not None
    assert foundation.inputs.intrinsics.fx == pytest.approx(110.0, rel=1e-2)
    assert foundation.camera.source.focal is FocalSource.NETWORK
    assert foundation.notes[0] == f"camera: {camera_sentence(foundation.camera, DepthSource.NETWORK)}"
    assert foundation.objects[0].mask.shape == embedded.objects[0].mask.shape


def test_stages_mix_one_by_one_and_a_pull_reruns_only_what_it_touches(
    photo: Photo, store: ModelStore, graphs: dict[str, list[Path]], tmp_path: Path
) -> None:
    inputs, cache = Inputs(photo, (LabelledBox(BOX, "chair", "chair"),)), tmp_path / "stages"

    def ran() -> set[str]:
        built = _build(stages_for("auto", inputs, box_library(), store=store), inputs, cache)
        return {r.stage for r in built.runs if not r.cached}

    assert ran() >= {"camera", "objects", "geometry", "depth"}
    assert ran() == set()
    install(store, "slimsam", graphs["slimsam"])
    again = ran()
    assert "objects" in again
    assert "camera" not in again
    assert ran() == set()
    install(store, "moge-2-vits", graphs["moge-2-vits"])
    assert ran() >= {"depth_prediction", "camera", "geometry", "depth"}
    install(store, "migan", graphs["migan"])
    emptied = ran()
    assert "architecture" in emptied
    assert not emptied & {"depth_prediction", "camera", "objects", "geometry", "graph"}
    store.forget(network("migan"))
    assert ran() == set()
    store.forget(network("moge-2-vits"))
    assert ran() == set()
    store.forget(network("slimsam"))
    assert ran() == set()


def test_every_network_of_the_paper_takes_its_stage(photo: Photo, store: ModelStore, tmp_path: Path) -> None:
    """Which stage uses which network; nothing is loaded before it runs."""
    file = tmp_path / "some.onnx"
    file.write_bytes(b"not looked at")

    def put(*ids: str) -> None:
        for network_id in ids:
            install(store, network_id, [file] * len(network(network_id).files))

    inputs = Inputs(photo)
    put("owlv2-large", "sam2.1-large", "metric3d-large")
    bare = stages_for("foundation", inputs, box_library(), store=store)
    assert isinstance(bare.architecture, PlanarRoom)
    assert isinstance(bare.pose, MadeToMeasure)
    put("lama", "birefnet", "birefnet-lite", "mvanet", "dinov2-large", "gigapose-scale")
    stages = stages_for("foundation", inputs, box_library(), store=store)
    used = {
        "detection": "owlv2-large",
        "objects": "sam2.1-large",
        "depth_prediction": "metric3d-large",
        "architecture": "lama metric3d-large birefnet: mvanet",
        "filler": "lama",
        "pose": "dinov2-large gigapose-scale block=17",
    }
    for stage, ids in used.items():
        assert all(network_id in repr(getattr(stages, stage)) for network_id in ids.split()), stage
    assert "birefnet-lite" not in repr(stages.architecture)
    assert isinstance(stages_for("auto", inputs, box_library(), store=store).pose, MadeToMeasure)
    assert stages_for("embedded", inputs, box_library(), store=store).filler is None


def test_what_the_user_gave_is_never_replaced(photo: Photo, store: ModelStore, graphs: dict[str, list[Path]]) -> None:
    for network_id, files in graphs.items():
        install(store, network_id, files)
    depth = np.full((HEIGHT, WIDTH), 2.0, np.float32)
    given = Inputs(photo, (LabelledBox(BOX, "sofa", "sofa"),), depth_m=depth)
    stages = stages_for("auto", given, box_library(), store=store)
    assert stages.detection is None
    assert stages.depth_prediction is None
    assert [s.implementation for s in profile_status(store=store)][:2] == [
        "YOLOX nano (80 everyday classes)",
        "SlimSAM (points and boxes)",
    ]


def test_the_foundation_profile_says_what_is_missing(photo: Photo, store: ModelStore) -> None:
    with pytest.raises(UnavailableError, match="diorama models pull tiny"):
        stages_for("foundation", Inputs(photo), box_library(), store=store)
    for status in profile_status(store=store)[:3]:
        assert not status.present
        assert status.size_mb > 0
        assert status.licence
        assert "pull default" in status.advice


def test_without_networks_the_recogniser_of_our_own_proposes_and_builds_use_what_is_sure(
    photo: Photo, store: ModelStore, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    own = stages_for("embedded", Inputs(photo), box_library(), store=store).detection
    assert isinstance(own, OwnDetection)
    assert own == stages_for("auto", Inputs(photo), box_library(), store=store).detection
    sure, likely = own.detect(photo, (), Progress()), propose_boxes(photo, store=store)
    assert likely is not None
    assert {b.box for b in sure} <= {b.box for b in likely}
    marked = Inputs(photo, (LabelledBox(BOX, "sofa", "sofa"),))
    assert stages_for("embedded", marked, box_library(), store=store).detection is None
    monkeypatch.setattr(assets, "FOLDER", tmp_path)
    assert stages_for("embedded", Inputs(photo), box_library(), store=store).detection is None
    assert propose_boxes(photo, store=store) is None


def test_a_network_can_be_named_instead_of_the_best(
    photo: Photo, store: ModelStore, graphs: dict[str, list[Path]]
) -> None:
    install(store, "yolox-nano", graphs["yolox-nano"])
    named = [
        stages_for("auto", Inputs(photo), box_library(), store=store, choice=NetworkChoice(detector)).detection
        for detector in (None, "yolox-nano", "own")
    ]
    assert [type(stage).__name__ for stage in named] == ["JoinedDetection", "EverydayDetection", "OwnDetection"]
    with pytest.raises(UnavailableError, match="models pull owlv2-base"):
        stages_for("auto", Inputs(photo), box_library(), store=store, choice=NetworkChoice("owlv2-base"))
    with pytest.raises(InputError, match="no depth network"):
        stages_for("auto", Inputs(photo), box_library(), store=store, choice=NetworkChoice(depth="lama"))


def test_a_damaged_network_is_one_clear_line(photo: Photo, store: ModelStore, tmp_path: Path) -> None:
    broken = tmp_path / "broken.onnx"
    broken.write_bytes(b"half a file")
    install(store, "yolox-nano", [broken])
    with pytest.raises(UnavailableError, match="diorama models verify"):
        propose_boxes(photo, store=store)


def test_a_language_model_takes_the_graph_and_is_asked_again_after_a_failure(
    photo: Photo, store: ModelStore, tmp_path: Path
) -> None:
    inputs, cache = Inputs(photo, (LabelledBox(BOX, "chair", "chair"),)), tmp_path / "stages"
    reply = '{"objects": [], "support_relation": [{"subject_id": 1, "type": "placed on", "target_id": 2}]}'
    with answering(StubLmm([500])) as stub:
        lmm = LmmSettings(stub.address, "stub", votes=1)
        stages = stages_for("auto", inputs, box_library(), store=store, lmm=lmm)
        without = _build(stages, inputs, cache)
        assert without.graph is not None
        assert without.graph.source.method is GraphMethod.GEOMETRY
        stub.answers = [reply]
        built = _build(stages, inputs, cache)
    cached = {r.stage: r.cached for r in built.runs}
    assert cached["camera"]
    assert cached["geometry"]
    assert not cached["graph"]
    assert built.graph is not None
    assert built.graph.source.method is GraphMethod.LANGUAGE_MODEL


def test_progress_reaches_the_proposals(photo: Photo, store: ModelStore, graphs: dict[str, list[Path]]) -> None:
    install(store, "yolox-nano", graphs["yolox-nano"])
    heard: list[float] = []
    boxes = propose_boxes(photo, store=store, progress=Progress(lambda e: heard.append(e.fraction)))
    assert boxes is not None
    assert [b.category for b in boxes] == ["chair"]
    assert heard == sorted(heard)


def test_rough_depth_is_evidence_and_not_what_the_foundation_profile_needs(
    photo: Photo, shared: Path, store: ModelStore
) -> None:
    store.add_folder(shared / "models")
    given = Inputs(photo, (LabelledBox(BOX, "chair", "chair"),))
    stages = stages_for("auto", given, box_library(), store=store)
    assert isinstance(stages.geometry, SingleViewMetrology)
    assert isinstance(stages.geometry.depth, FastDepth)
    assert stages.depth_prediction is None
    named = stages_for("auto", given, box_library(), store=store, choice=NetworkChoice(depth="fast-depth"))
    assert named.geometry == stages.geometry
    measured = replace(given, depth_m=np.ones((photo.height, photo.width), np.float32))
    assert not isinstance(stages_for("auto", measured, box_library(), store=store).geometry, SingleViewMetrology)
    with pytest.raises(UnavailableError, match="the foundation profile needs"):
        stages_for("foundation", given, box_library(), store=store)
