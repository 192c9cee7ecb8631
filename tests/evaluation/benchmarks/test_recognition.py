"""What is found, what is named, and what counts once."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from PIL import Image

from diorama_core.artefacts import LabelledBox, Photo
from diorama_core.errors import InputError
from diorama_core.evaluation.benchmarks.recognition import run
from diorama_core.evaluation.reports.tables import Table
from diorama_core.io.assets import CARD, DETECTOR, NAMER
from diorama_core.models.recogniser import Recogniser, own_recogniser
from diorama_core.models.runtime import Session
from diorama_core.models.store import ModelStore
from diorama_core.perception.foundation.proposals import JoinedDetection, OwnDetection
from diorama_core.pipeline.network_stages import everyday_detector
from diorama_core.pipeline.presets import clickers, namers
from diorama_core.progress import Progress
from diorama_core.training.export import export_detector, export_namer, score, write_card
from diorama_core.training.networks import Detector, Namer

ANNOTATIONS = Path(__file__).parents[2] / "photo_annotations.json"
OBJECTS = [
    {"bbox": [10, 10, 50, 60], "class": "chair", "kind": "office chair"},
    {"bbox": [60, 20, 110, 70], "class": "table", "kind": "table"},
    {"bbox": [5, 70, 25, 78], "class": "thing", "kind": "object"},
]


@dataclass(frozen=True)
class Finder:
    """Always finds the same."""

    boxes: tuple[tuple[tuple[float, float, float, float], str], ...]

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """The boxes."""
        return tuple(LabelledBox(box, name, name, 0.9) for box, name in self.boxes)


@dataclass(frozen=True)
class Proposer:
    """The twenty best boxes without names."""

    recogniser: Recogniser

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """The boxes, best first."""
        found = self.recogniser.propose(photo.rgb, 0.01, 20)
        corners = [tuple(map(float, box)) for box in found.boxes]
        return tuple(
            LabelledBox((x1, y1, x2, y2), "object", "object", float(score))
            for (x1, y1, x2, y2), score in zip(corners, found.scores, strict=True)
        )


@pytest.fixture
def annotated(tmp_path: Path) -> Path:
    Image.fromarray(np.full((80, 120, 3), 130, np.uint8)).save(tmp_path / "made.png")
    file = tmp_path / "annotations.json"
    file.write_text(json.dumps({"made": {"size": [120, 80], "things": OBJECTS}}))
    return file


def test_each_object_is_found_once(annotated: Path) -> None:
    twice = ((10.0, 10.0, 50.0, 60.0), "office chair"), ((11.0, 11.0, 50.0, 60.0), "chair")
    near = ((60.0, 20.0, 110.0, 46.0), "desk")  # half of the table
    bench = run(annotated, annotated.parent, {"finder": Finder((*twice, near))}, {}, {})
    (found,) = bench.found["finder"].values()
    assert (found.objects, found.boxes) == (3, 3)
    assert found.hits == (2, 2)
    assert found.right == 2
    assert found.named == 1
    assert bench.tables()[0].row("finder")["precision"] == pytest.approx(2 / 3)


def test_names_are_compared_where_the_library_has_the_kind(annotated: Path) -> None:
    def namer(photo: Photo, boxes: np.ndarray) -> Sequence[Sequence[str]]:
        return [("chair", "office chair", "stool"), ("table",)][: len(boxes)]

    named = run(annotated, annotated.parent, {}, {"own": namer}, {}).named["own"]["made"]
    assert (named.objects, named.first, named.among_five) == (2, 1, 2)


def test_clicks_are_right_where_their_box_is_the_object_s(annotated: Path) -> None:
    def clicker(photo: Photo, pixels: np.ndarray) -> list[tuple[float, float, float, float] | None]:
        assert ((pixels >= 0) & (pixels <= (120, 80))).all()
        return [(10.0, 10.0, 50.0, 60.0), None, (5.0, 70.0, 11.0, 78.0)]

    clicked = run(annotated, annotated.parent, {}, {}, {"own": clicker})
    found = clicked.clicked["own"]["made"]
    assert (found.objects, found.hits, found.none) == (3, (1, 2), 1)
    assert clicked.tables()[2].row("own")["no box"] == pytest.approx(1 / 3)


def test_a_folder_without_the_photos_is_one_clear_line(annotated: Path, tmp_path: Path) -> None:
    (tmp_path / "made.png").unlink()
    with pytest.raises(InputError, match="none of the 1 annotated photos"):
        run(annotated, tmp_path, {}, {}, {})


def test_untrained_networks_can_be_scored(annotated: Path, tmp_path: Path) -> None:
    torch.manual_seed(0)
    export_detector(Detector(4, width=8), tmp_path / DETECTOR)
    export_namer(Namer(4, width=8), tmp_path / NAMER)
    write_card(tmp_path / CARD, ["office chair", "table", "bed", "sofa"])
    bench = score(annotated, annotated.parent, Recogniser.of(tmp_path))
    assert bench.named["own"]["made"].among_five == 2
    assert json.dumps(bench.to_json())


@pytest.fixture
def computed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Routes, namers and clickers show networks the same pictures: each is computed once, since the same comes out."""
    run_network, known = Session.run, {}

    def run_once(self: Session, feeds: Mapping[str, np.ndarray], *args: Any, **kwargs: Any) -> dict[str, np.ndarray]:
        key = (self.info.path, *((name, v.shape, sha256(v.tobytes()).digest()) for name, v in sorted(feeds.items())))
        if key not in known:
            known[key] = run_network(self, feeds, *args, **kwargs)
        return {name: v.copy() for name, v in known[key].items()}

    monkeypatch.setattr(Session, "run", run_once)


@pytest.mark.slow
@pytest.mark.usefixtures("computed_once")
def test_the_shipped_networks_reach_what_is_promised_on_real_photos(shared: Path, tmp_path: Path) -> None:
    """Shares of 97 objects in every third of 21 photos on which nothing was trained; `assets/models/README.md` has the
    figures of all.
    """
    photos = list(json.loads(ANNOTATIONS.read_text()).items())[::3]
    third = tmp_path / "third.json"
    third.write_text(json.dumps(dict(photos)))
    store = ModelStore(tmp_path / "models")
    store.add_folder(shared / "models")
    everyday = everyday_detector(store)
    assert everyday is not None
    routes = {
        "twenty best": Proposer(own_recogniser()),
        "everyday objects": everyday,
        "used": JoinedDetection(everyday, OwnDetection(own_recogniser())),
    }
    bench = run(third, shared / "photos", routes, namers(store), clickers(store))
    found, named, clicked = bench.tables()
    assert found.row("twenty best")["objects"] == 97
    least: list[tuple[Table, str, str, float]] = [
        (found, "twenty best", "found at IoU 0.5", 0.50),
        (found, "twenty best", "found at IoU 0.3", 0.70),
        (found, "everyday objects", "found at IoU 0.5", 0.20),
        (found, "everyday objects", "precision", 0.85),
        (found, "used", "found at IoU 0.5", 0.40),
        (found, "used", "found at IoU 0.3", 0.49),
        (found, "used", "precision", 0.58),
        (named, "own", "first", 0.41),
        (named, "own", "among five", 0.70),
        (named, "own, everyday objects known", "first", 0.47),
        (named, "own, everyday objects known", "among five", 0.68),
        (clicked, "own", "right at IoU 0.5", 0.65),
        (clicked, "own", "right at IoU 0.3", 0.77),
        (clicked, "own, everyday objects known", "right at IoU 0.5", 0.65),
        (clicked, "own, everyday objects known", "right at IoU 0.3", 0.75),
    ]
    missed = [
        (row, column, table.row(row)[column]) for table, row, column, share in least if table.row(row)[column] < share
    ]
    assert not missed
