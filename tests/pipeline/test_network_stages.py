from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, Photo
from diorama_core.models.manifest import network
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.network_stages import published_embeddings, with_joint_retrieval
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.stages import Stages
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.retrieval.joint import JointSimilarity
from tests.primitives import PrimitiveLibrary


class Store(ModelStore):
    """A store that says that some networks are there, without their bytes."""

    present: frozenset[str] = frozenset()

    def has(self, wanted) -> bool:
        return wanted.id in self.present

    def path(self, wanted, file: str) -> Path:
        return self.folder_of(wanted) / file

    def identity(self, wanted) -> str:
        return f"{wanted.id}-1"


class AllHere(Store):
    present = frozenset({"openclip-b32", "duoduoclip"})


class PicturesHere(Store):
    present = frozenset({"openclip-b32"})


class ShapesHere(Store):
    present = frozenset({"duoduoclip"})


@pytest.fixture
def base() -> Stages:
    photo = Photo(np.zeros((48, 64, 3), np.uint8), "x", (64, 48))
    return stages_for("embedded", Inputs(photo), PrimitiveLibrary())


def stages(base: Stages, store: ModelStore) -> Stages:
    return with_joint_retrieval(base, PrimitiveLibrary(), store)


def test_without_the_networks_nothing_changes(base, tmp_path: Path) -> None:
    assert stages(base, Store(tmp_path)) is base
    assert stages(base, ShapesHere(tmp_path)) is base


@pytest.mark.parametrize("tower", [False, True])
def test_pictures_and_shapes_are_compared_in_one_space(base, tmp_path: Path, tower: bool) -> None:
    made = stages(base, (AllHere if tower else PicturesHere)(tmp_path))
    assert made.retrieval != base.retrieval
    assert isinstance(made.retrieval, HierarchicalRetrieval)
    similarity = made.retrieval.similarity
    assert isinstance(similarity, JointSimilarity)
    embedding = similarity.embedding
    assert embedding.clip.weights == "openclip-b32-1"
    clip = network("openclip-b32")
    assert embedding.clip.text_graph == AllHere(tmp_path).path(clip, clip.files[0].path)
    assert (embedding.tower is not None) is tower
    changed = {n for n in vars(base) if getattr(base, n) is not getattr(made, n)}
    assert changed == {"retrieval"}


@pytest.mark.parametrize(
    ("present", "names"),
    [
        ({"openclip-b32"}, []),
        ({"openclip-b32", "duoduoclip"}, ["DD"]),
        ({"openclip-bigg14"}, ["CLIP"]),
        ({"openshape"}, []),
        ({"openclip-b32", "duoduoclip", "openclip-bigg14", "openshape"}, ["CLIP", "OS", "DD"]),
    ],
)
def test_the_publications_embeddings_are_those_whose_networks_are_here(
    tmp_path: Path, present: set[str], names: list[str]
) -> None:
    store = type("Some", (Store,), {"present": frozenset(present)})(tmp_path)
    found = published_embeddings(store)
    assert list(found) == names
    assert len({e.weights for e in found.values()}) == len(names)
