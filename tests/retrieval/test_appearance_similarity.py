"""Looks of things and shapes: rendered views, colours, and tiny networks with the signatures of the real ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from diorama_core.models.clip import DuoduoClip, OpenClip
from diorama_core.models.runtime import SessionPool
from diorama_core.progress import Progress
from diorama_core.render.views import StudioView, render_shape
from diorama_core.retrieval import joint
from diorama_core.retrieval.appearance_similarity import NEUTRAL, EmbeddedSimilarity, ObjectCrop
from diorama_core.retrieval.hierarchical import HierarchicalRetrieval
from diorama_core.retrieval.joint import ClipEmbedding, JointSimilarity
from tests.models import tiny_networks
from tests.pose.rooms import LIBRARY, Room, camera_at, standing

CHAIRS = [LIBRARY.shape(s) for s in ("chair", "low chair", "sofa", "desk", "table")]


@cache
def pictured(shape_id: str) -> ObjectCrop:
    rgba = render_shape(LIBRARY, shape_id, (160, 160), StudioView(0.5, 0.3))
    mask = rgba[..., 3] > 250
    return ObjectCrop(np.where(mask[..., None], rgba[..., :3], 90).astype(np.uint8), mask, "chair")


def test_the_crop_is_the_object_alone_on_neutral_ground() -> None:
    rgb = np.full((60, 80, 3), 40, np.uint8)
    mask = np.zeros((60, 80), bool)
    mask[10:30, 20:25] = True
    crop = ObjectCrop(rgb, mask, "lamp").crop
    assert crop.shape[0] == crop.shape[1] >= 20
    assert (crop == 40).all(axis=-1).sum() == 100
    assert ((crop == 40) | (crop == NEUTRAL)).all()
    assert (ObjectCrop(rgb, mask & False, "lamp").crop == NEUTRAL).all()


@pytest.mark.parametrize("index", range(len(CHAIRS)))
def test_a_picture_of_a_shape_is_most_like_that_shape(index: int, tmp_path: Path) -> None:
    alike = EmbeddedSimilarity(LIBRARY, tmp_path).similarities(pictured(CHAIRS[index].id), CHAIRS)
    assert int(alike.argmax()) == index
    assert ((alike >= 0) & (alike <= 1)).all()


def test_of_what_is_not_seen_only_colours_speak(tmp_path: Path) -> None:
    hidden = replace(pictured("chair"), visible=0.0)
    alike = EmbeddedSimilarity(LIBRARY, tmp_path).similarities(hidden, CHAIRS)
    assert np.ptp(alike) == 0  # all of one wood
    nothing = replace(hidden, mask=np.zeros_like(hidden.mask))
    assert (EmbeddedSimilarity(LIBRARY, tmp_path).similarities(nothing, CHAIRS) == 0.5).all()


def test_forms_of_shapes_agree_whatever_their_size_and_colours(tmp_path: Path) -> None:
    similarity = EmbeddedSimilarity(LIBRARY, tmp_path)
    chair, low, sofa, *_ = CHAIRS
    assert similarity.form_agreement(chair, chair) == pytest.approx(1.0)
    assert similarity.form_agreement(chair, sofa) < similarity.form_agreement(low, sofa) < 0.99
    assert similarity.form_agreement(low, sofa) == pytest.approx(similarity.form_agreement(sofa, low))


@pytest.fixture(scope="module", autouse=True)
def _views_rendered_once() -> Iterator[None]:
    """The studio's pictures of a shape are the same in every test here."""
    render = joint.studio_views
    rendered = cache(lambda shape_id: render(LIBRARY, LIBRARY.shape(shape_id)))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(joint, "studio_views", lambda library, shape: rendered(shape.id))
        yield


@pytest.fixture(scope="module")
def embedding(tmp_path_factory: pytest.TempPathFactory) -> ClipEmbedding:
    folder = tmp_path_factory.mktemp("clip")
    _, text, image, views = tiny_networks.clip(folder)
    tokenizer, pool = tiny_networks.clip_tokenizer(folder / "tokenizer.json"), SessionPool()
    return ClipEmbedding(OpenClip(text, image, tokenizer, pool=pool), DuoduoClip(views, pool=pool))


@pytest.mark.parametrize("tower", [True, False], ids=["with DuoduoCLIP", "OpenCLIP alone"])
def test_a_joint_embedding_orders_shapes_and_reads_each_once(
    embedding: ClipEmbedding, tower: bool, tmp_path: Path
) -> None:
    embedding = embedding if tower else replace(embedding, tower=None)
    similarity = JointSimilarity(LIBRARY, embedding, tmp_path)
    alike = similarity.similarities(pictured("sofa"), CHAIRS)
    assert alike.max() == pytest.approx(1.0)
    assert len(np.unique(alike)) == len(CHAIRS)
    # What is kept is what the network says of the shape's pictures on neutral ground.
    retained = sorted(tmp_path.rglob("*.npy"))
    assert len(retained) == len(CHAIRS)
    stamps = [k.stat().st_mtime_ns for k in retained]
    assert (JointSimilarity(LIBRARY, embedding, tmp_path).similarities(pictured("sofa"), CHAIRS) == alike).all()
    assert [k.stat().st_mtime_ns for k in retained] == stamps
    own = np.load(next(k for k in retained if CHAIRS[2].content_hash in k.name))[0].astype(float)
    assert np.linalg.norm(own) == pytest.approx(1.0, abs=1e-2)
    assert len(similarity.similarities(pictured("sofa"), [])) == 0


def test_words_and_picture_count_the_same(embedding: ClipEmbedding, tmp_path: Path) -> None:
    similarity, item = JointSimilarity(LIBRARY, embedding, tmp_path), pictured("chair")
    blind = similarity.similarities(replace(item, mask=item.mask & False), CHAIRS)
    known = np.stack([np.load(next(tmp_path.rglob(f"{s.content_hash}.npy")))[0] for s in CHAIRS]).astype(np.float32)
    words, picture = known @ embedding.text("a photo of chair"), known @ embedding.picture(item.crop)
    assert np.allclose(blind, np.exp((words - words.max()) / 0.08), atol=1e-4)
    both = 0.5 * (words + picture)
    assert np.allclose(similarity.similarities(item, CHAIRS), np.exp((both - both.max()) / 0.08), atol=1e-4)


def test_retrieval_ranks_by_the_likeness_it_is_given(embedding: ClipEmbedding, tmp_path: Path) -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 3.0, 20.0),), (0,))
    stages = [
        HierarchicalRetrieval(LIBRARY),
        HierarchicalRetrieval(
            LIBRARY, similarity=JointSimilarity(LIBRARY, embedding, tmp_path), similarity_weight=50.0
        ),
    ]
    plain, learned = (s.retrieve(room.inputs, room.objects, room.geometry, Progress())[0].ranked for s in stages)
    assert {s for s, _ in plain} == {s for s, _ in learned}
    assert [v for _, v in plain] != [v for _, v in learned]
    assert repr(stages[0]) != repr(stages[1])
    assert embedding.weights in repr(stages[1]) or "openclip-b32" in repr(stages[1])
