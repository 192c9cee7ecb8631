"""Every facade beside the `transformers` processor and model it stands for, pre- and post-processing included."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
import transformers
from PIL import Image
from scipy import ndimage

from diorama_core.errors import UnavailableError
from diorama_core.models.clip import DuoduoClip, OpenClip, clip_pixels
from diorama_core.models.features import Dinov2
from diorama_core.models.foreground import Foreground
from diorama_core.models.inpainting import Lama, Migan
from diorama_core.models.owlv2 import Owlv2
from diorama_core.models.runtime import SessionPool
from diorama_core.models.segment_anything import HqSam, Sam2, SlimSam, sam3_tracker
from tests.models import tiny_networks, tiny_sams


def _photo(height: int, width: int, seed: int = 0) -> np.ndarray:
    """Soft blobs with sharp edges, so that resampling matters."""
    rng = np.random.default_rng(seed)
    base = ndimage.gaussian_filter(rng.uniform(0, 255, (height, width, 3)), (6, 6, 0))
    base = (base - base.min()) / np.ptp(base) * 255
    base[height // 3 : height // 2, width // 4 : width // 2] = (220, 40, 60)
    return base.astype(np.uint8)


@pytest.fixture(params=[(120, 200), (333, 190)], ids=["wide", "tall"])
def photo(request: pytest.FixtureRequest) -> np.ndarray:
    return _photo(*request.param)


ONE_SHAPE = pytest.mark.parametrize("photo", [(120, 200)], ids=["wide"], indirect=True)
"""For networks whose pictures are stretched to a square, whatever their shape."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("graphs")


@pytest.fixture(scope="module")
def owlv2(folder: Path) -> tuple[Any, Path]:
    return tiny_networks.owlv2(folder / "owlv2.onnx")


@pytest.fixture(scope="module")
def slimsam(folder: Path) -> tuple[Any, Path, Path]:
    return tiny_sams.slimsam(folder / "slimsam")


@pytest.fixture(scope="module")
def hq_sam(folder: Path) -> tuple[Any, Path, Path]:
    return tiny_sams.hq_sam(folder / "hq_sam")


@pytest.fixture(scope="module")
def dinov2(folder: Path) -> tuple[Any, Path]:
    return tiny_networks.dinov2(folder / "dinov2.onnx")


def test_owlv2_finds_the_same_boxes(owlv2: tuple[Any, Path], tmp_path: Path, photo: np.ndarray) -> None:
    model, graph = owlv2
    facade = Owlv2(graph, tiny_networks.clip_tokenizer(tmp_path / "tokenizer.json"), pool=SessionPool())
    phrases = ["a photo of chair", "a photo of red table"]
    processor = transformers.Owlv2ImageProcessorPil()
    pixels = processor(Image.fromarray(photo), return_tensors="pt")["pixel_values"]
    np.testing.assert_allclose(facade.pixels(photo), pixels.numpy(), atol=2e-3)
    ids, mask = facade.tokens(phrases)
    with torch.no_grad():
        out = model(input_ids=torch.from_numpy(ids), attention_mask=torch.from_numpy(mask), pixel_values=pixels)
    threshold = float(torch.sigmoid(out.logits.max(dim=-1).values).quantile(0.95))
    expected = processor.post_process_object_detection(out, threshold=threshold, target_sizes=[photo.shape[:2]])[0]
    found = facade.detect(photo, phrases, threshold)
    assert len(found) == len(expected["scores"]) > 0
    order = np.argsort(-expected["scores"].numpy(), kind="stable")
    height, width = photo.shape[:2]
    boxes = np.clip(expected["boxes"].numpy()[order], 0, [width, height, width, height])
    np.testing.assert_allclose(found.scores, expected["scores"].numpy()[order], atol=1e-3)
    np.testing.assert_allclose(_by_place(found.boxes), _by_place(boxes), atol=1.0)
    assert sorted(found.labels) == sorted(expected["labels"].numpy())


def _by_place(boxes: np.ndarray) -> np.ndarray:
    rounded = np.round(boxes / 2)
    return boxes[np.lexsort(rounded.T)]


def _drawn_alike(mask: np.ndarray, expected: torch.Tensor) -> None:
    assert (mask == expected.numpy()).mean() > 0.999
    assert 0.001 < mask.mean() < 0.999


IMAGENET = ((0.485, 0.456, 0.406), (0.229, 0.224, 0.225))


@ONE_SHAPE
@pytest.mark.parametrize(
    ("make", "tracker", "side", "statistics", "atol"),
    [
        (tiny_sams.sam2, Sam2, 1024, IMAGENET, 1e-5),
        # One of 255 steps, where halves are rounded.
        (tiny_sams.sam3_tracker, sam3_tracker, 1008, ((0.5,) * 3, (0.5,) * 3), 1.1 / 127.5),
    ],
    ids=["SAM 2", "SAM 3"],
)
def test_sams_trackers_draw_the_same_masks(
    tmp_path: Path, photo: np.ndarray, make: Any, tracker: Any, side: int, statistics: Any, atol: float
) -> None:
    model, encoder, decoder = make(tmp_path)
    facade = tracker(encoder, decoder, pool=SessionPool())
    height, width = photo.shape[:2]
    boxes = np.array([[20.0, 30.0, 100.0, 110.0], [5.0, 5.0, width - 5.0, height - 5.0]])
    mean, std = (torch.tensor(v).view(1, 3, 1, 1) for v in statistics)
    # Torchvision's stretch of a tensor, which the published processor uses.
    raw = torch.from_numpy(photo).permute(2, 0, 1)[None]
    stretched = torch.nn.functional.interpolate(raw, (side, side), mode="bilinear", antialias=True)
    pixels = (stretched / 255 - mean) / std
    assert np.abs(facade.pixels(photo) - pixels.numpy()).max() < atol
    with torch.no_grad():
        scaled = torch.from_numpy(boxes).float() * torch.tensor([side / width, side / height] * 2)
        out = model(pixel_values=pixels, input_boxes=scaled[None])
    for index, prompted in enumerate(facade.masks(photo, boxes)):
        best = int(out.iou_scores[0, index].argmax())
        logits = out.pred_masks[0, index, best][None, None]
        _drawn_alike(prompted.mask, torch.nn.functional.interpolate(logits, (height, width), mode="bilinear")[0, 0] > 0)


def _prepared(photo: np.ndarray, boxes: np.ndarray) -> tuple[Any, torch.Tensor]:
    """What the processor makes of a photo, and boxes in its pixels."""
    prepared = transformers.SamImageProcessorPil()(Image.fromarray(photo), return_tensors="pt")
    (height, width), (inner_h, inner_w) = photo.shape[:2], (int(v) for v in prepared["reshaped_input_sizes"][0])
    return prepared, torch.from_numpy(boxes).float() * torch.tensor([inner_w / width, inner_h / height] * 2)


def _best_mask(out: Any, prepared: Any) -> torch.Tensor:
    sizes = prepared["original_sizes"], prepared["reshaped_input_sizes"]
    return transformers.SamImageProcessorPil().post_process_masks(out.pred_masks, *sizes)[0][
        0, int(out.iou_scores[0, 0].argmax())
    ]


def test_hq_sam_draws_the_same_masks(hq_sam: tuple[Any, Path, Path], photo: np.ndarray) -> None:
    model, encoder, decoder = hq_sam
    facade = HqSam(encoder, decoder, pool=SessionPool())
    boxes = np.array([[20.0, 30.0, 100.0, 110.0], [40.0, 10.0, 90.0, 60.0]])
    prepared, scaled = _prepared(photo, boxes)
    with torch.no_grad():
        embeddings, inside = model.get_image_embeddings(prepared["pixel_values"])
        seen = {"image_embeddings": embeddings, "intermediate_embeddings": inside}
        for box, prompted in zip(scaled, facade.masks(photo, boxes), strict=True):
            out = model(**seen, input_boxes=box[None, None], multimask_output=True)
            _drawn_alike(prompted.mask, _best_mask(out, prepared))


def test_slimsam_draws_the_same_masks(slimsam: tuple[Any, Path, Path], photo: np.ndarray) -> None:
    model, encoder, decoder = slimsam
    facade = SlimSam(encoder, decoder, pool=SessionPool())
    boxes = np.array([[20.0, 30.0, 100.0, 110.0]])
    prepared, scaled = _prepared(photo, boxes)
    np.testing.assert_allclose(facade.pixels(photo), prepared["pixel_values"].numpy(), atol=1e-5)
    with torch.no_grad():
        out = model(pixel_values=prepared["pixel_values"], input_boxes=scaled[None], multimask_output=True)
    _drawn_alike(next(facade.masks(photo, boxes)).mask, _best_mask(out, prepared))


@ONE_SHAPE
@pytest.mark.parametrize("block", [None, 0, 2])
def test_dinov2_reads_the_same_features_from_any_block(
    dinov2: tuple[Any, Path], photo: np.ndarray, block: int | None
) -> None:
    model, graph = dinov2
    facade = Dinov2(graph, block=block, pool=SessionPool())
    found = facade.batch([photo, photo[::-1].copy()])
    pixels = torch.cat([_imagenet(p, 224) for p in (photo, photo[::-1].copy())])
    with torch.no_grad():
        states = model(pixels, output_hidden_states=True).hidden_states
        expected = model.layernorm(states[-1 if block is None else block + 1])[:, 1:]
    assert found.shape == (2, 16, 16, 24)
    np.testing.assert_allclose(found, expected.reshape(2, 16, 16, 24).numpy(), atol=1e-4)


def _imagenet(rgb: np.ndarray, side: int) -> torch.Tensor:
    small = np.asarray(Image.fromarray(rgb).resize((side, side), Image.Resampling.BILINEAR)).astype(np.float64) / 255
    return torch.from_numpy(((small - IMAGENET[0]) / IMAGENET[1]).transpose(2, 0, 1)[None]).float()


def test_a_block_that_is_not_there_is_one_clear_line(dinov2: tuple[Any, Path]) -> None:
    _, graph = dinov2
    with pytest.raises(UnavailableError, match="no block 9"):
        Dinov2(graph, block=9, pool=SessionPool()).patches(_photo(60, 60))


def test_openclip_embeds_the_same(tmp_path: Path, photo: np.ndarray) -> None:
    model, text, image, views = tiny_networks.clip(tmp_path)
    tokenizer = tiny_networks.clip_tokenizer(tmp_path / "tokenizer.json")
    facade = OpenClip(text, image, tokenizer, pool=SessionPool())
    pixels = transformers.CLIPImageProcessorPil()(Image.fromarray(photo), return_tensors="pt")["pixel_values"]
    np.testing.assert_allclose(clip_pixels(photo), pixels.numpy(), atol=1e-5)
    with torch.no_grad():
        seen = torch.nn.functional.normalize(tiny_networks.clip_image(model, pixels), dim=1)
        ids = torch.zeros(1, 77, dtype=torch.long)
        ids[0, :6] = torch.tensor([30, 2, 3, 4, 5, 31])
        read = torch.nn.functional.normalize(tiny_networks.clip_text(model, ids), dim=1)
    np.testing.assert_allclose(facade.images([photo]), seen.numpy(), atol=1e-4)
    np.testing.assert_allclose(facade.texts(["A  photo of CHAIR"]), read.numpy(), atol=1e-4)
    assert facade.texts([]).shape == (0, 512)
    several = [photo, photo[:, ::-1].copy(), photo[::-1].copy()]
    shape = DuoduoClip(views, pool=SessionPool())
    np.testing.assert_allclose(shape.shape(several), shape.shape(several[::-1]), atol=1e-5)
    assert np.linalg.norm(shape.shape([photo])) == pytest.approx(1.0, abs=1e-5)


@ONE_SHAPE
@pytest.mark.parametrize("make", [tiny_networks.birefnet, tiny_networks.mvanet], ids=["BiRefNet", "MVANet"])
def test_foreground_has_the_same_probabilities_and_is_sought_twice(
    tmp_path: Path, photo: np.ndarray, make: Any
) -> None:
    """Their authors' prediction: stretched to 1024, ImageNet statistics, the last output's sigmoid, stretched back."""
    network, graph = make(tmp_path / "model.onnx")
    facade = Foreground(graph, pool=SessionPool())
    with torch.no_grad():
        seen = torch.sigmoid(network(_imagenet(photo, 1024)))
        expected = torch.nn.functional.interpolate(seen, photo.shape[:2], mode="bilinear")[0, 0].numpy()
    found = facade.probability(photo)
    np.testing.assert_allclose(found, expected, atol=1e-4)
    assert np.ptp(expected) > 0.1
    painted = photo.copy()
    painted[found > 0.5] = 255
    np.testing.assert_array_equal(facade.mask(photo), (found > 0.5) | (facade.probability(painted) > 0.5))


@ONE_SHAPE
def test_lama_fills_the_hole_and_nothing_else(tmp_path: Path, photo: np.ndarray) -> None:
    network, graph = tiny_networks.lama(tmp_path / "model.onnx")
    hole = np.zeros(photo.shape[:2], dtype=bool)
    hole[20:80, 40:120] = True
    filled = Lama(graph, pool=SessionPool()).fill(photo, hole)
    np.testing.assert_array_equal(filled[~hole], photo[~hole])
    with torch.no_grad():
        small = np.asarray(Image.fromarray(photo).resize((512, 512), Image.Resampling.BILINEAR))
        mask = ndimage.zoom(hole.astype(float), np.divide(512, hole.shape), order=0, grid_mode=True, mode="nearest")
        image = torch.from_numpy(small.astype(np.float32).transpose(2, 0, 1)[None] / 255)
        out = network(image, torch.from_numpy(mask[None, None].astype(np.float32)))[0].permute(1, 2, 0).numpy()
    back = Image.fromarray(np.clip(out, 0, 255).round().astype(np.uint8))
    expected = np.asarray(back.resize(photo.shape[1::-1], Image.Resampling.BILINEAR)).astype(float)
    inner = ndimage.binary_erosion(hole, iterations=8)
    assert np.abs(filled.astype(float) - expected)[inner].mean() < 1.0
    np.testing.assert_array_equal(Lama(graph, pool=SessionPool()).fill(photo, np.zeros_like(hole)), photo)


def test_migan_is_told_where_to_keep(tmp_path: Path, photo: np.ndarray) -> None:
    hole = np.zeros(photo.shape[:2], dtype=bool)
    hole[20:80, 40:120] = True
    filled = Migan(tiny_networks.migan(tmp_path / "model.onnx"), pool=SessionPool()).fill(photo, hole)
    np.testing.assert_array_equal(filled[~hole], photo[~hole])
    assert (filled[40:60, 60:100] == 99).all()


def test_graphs_are_shared_and_can_be_freed(tmp_path: Path) -> None:
    pool = SessionPool()
    graph = tiny_networks.migan(tmp_path / "model.onnx")
    assert pool.get(graph) is pool.get(graph)
    assert [n.path for n in pool.report()] == [graph.resolve()]
    assert pool.report()[0].memory_bytes > 0
    pool.release(graph)
    assert pool.report() == ()
