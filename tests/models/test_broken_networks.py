"""Damaged graphs, other graphs in the right place, NaN and no memory: each ends in one line that names the file."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from tokenizers import Tokenizer
from tokenizers.models import WordLevel

from diorama_core.models.clip import DuoduoClip, OpenClip
from diorama_core.models.depth import DepthAnything3, Metric3d, Moge2
from diorama_core.models.features import Dinov2
from diorama_core.models.foreground import Foreground
from diorama_core.models.gigapose import GigaPoseScale
from diorama_core.models.grounding import GroundingDino
from diorama_core.models.inpainting import Lama, Migan
from diorama_core.models.owlv2 import Owlv2
from diorama_core.models.runtime import NetworkError, SessionPool
from diorama_core.models.segment_anything import HqSam, Sam2, SlimSam
from diorama_core.models.yolox import Yolox
from tests.models import small_graphs
from tests.models.tiny_networks import clip_tokenizer

RGB = np.full((60, 80, 3), 120, np.uint8)
HOLE = np.zeros((60, 80), bool)
HOLE[20:40, 20:40] = True
BOXES = np.array([[10.0, 10.0, 50.0, 50.0]])
CELLS = np.zeros((2, 2), np.int64)
PICTURE = {"pixel_values": ("f", 4)}
SAM = {"image_embeddings": ("f", 4), "input_boxes": ("f", 3)}
SAM_FEATURES = {"image_embeddings": (1, 8, 4, 4)}
SAM_MASKS = {"iou_scores": (1, 1, 3), "pred_masks": (1, 1, 3, 256, 256)}
HQ_FEATURES = SAM_FEATURES | {"interm_embeddings.0": (1, 4, 4, 8)}
HQ_MASKS = {"iou_predictions": (1, 3), "low_res_masks": (1, 3, 256, 256)}


@dataclass(frozen=True)
class Case:
    """One graph of one network."""

    inputs: Mapping[str, tuple[str, int]]
    outputs: Mapping[str, tuple[int, ...]]
    """Names and shapes of a right answer."""
    use: Callable[[Path, Path, SessionPool], object]
    """The network with this graph, given a folder with the others."""


def _numbers(outputs: Mapping[str, tuple[int, ...]], value: float = 0.5) -> dict[str, np.ndarray]:
    return {name: np.full(shape, value, np.float32) for name, shape in outputs.items()}


def _phrase_tokenizer(folder: Path) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / "tokenizer.json"
    Tokenizer(WordLevel({"[CLS]": 0, "[SEP]": 1, ".": 2, "chair": 3}, unk_token="chair")).save(str(path))
    return path


def _other(folder: Path, inputs: Mapping[str, tuple[str, int]], outputs: Mapping[str, tuple[int, ...]]) -> Path:
    """The sound one of a network's two graphs."""
    return small_graphs.constants(folder / "other.onnx", inputs, _numbers(outputs))


CASES: dict[str, Case] = {
    "foreground": Case(PICTURE, {"logits": (1, 1, 1024, 1024)}, lambda g, f, pool: Foreground(g, pool=pool).mask(RGB)),
    "yolox": Case(
        {"images": ("f", 4)}, {"output": (1, 8400, 85)}, lambda g, f, pool: Yolox(g, pool=pool).detect(RGB, 0.3)
    ),
    "moge": Case(
        {"image": ("f", 4), "num_tokens": ("i", 0)},
        {"points": (1, 60, 80, 3), "normal": (1, 60, 80, 3), "mask": (1, 60, 80), "metric_scale": (1,)},
        lambda g, f, pool: Moge2(g, pool=pool).predict(RGB, None),
    ),
    "metric3d": Case(
        PICTURE,
        {"predicted_depth": (1, 1, 616, 1064), "predicted_normal": (1, 3, 616, 1064)},
        lambda g, f, pool: Metric3d(g, pool=pool).predict(RGB, None),
    ),
    "sam encoder": Case(
        PICTURE,
        SAM_FEATURES,
        lambda g, f, pool: list(Sam2(g, _other(f, SAM, SAM_MASKS), pool=pool).masks(RGB, BOXES)),
    ),
    "sam decoder": Case(
        SAM,
        SAM_MASKS,
        lambda g, f, pool: list(SlimSam(_other(f, PICTURE, SAM_FEATURES), g, pool=pool).masks(RGB, BOXES)),
    ),
    "hq-sam encoder": Case(
        {"input_image": ("f", 3)},
        HQ_FEATURES,
        lambda g, f, pool: list(HqSam(g, _other(f, small_graphs.HQ_SAM, HQ_MASKS), pool=pool).masks(RGB, BOXES)),
    ),
    "hq-sam decoder": Case(
        small_graphs.HQ_SAM,
        HQ_MASKS,
        lambda g, f, pool: list(
            HqSam(_other(f, {"input_image": ("f", 3)}, HQ_FEATURES), g, pool=pool).masks(RGB, BOXES)
        ),
    ),
    "depth anything": Case(
        {"image": ("f", 4)},
        {"depth": (1, 1, 504, 504), "sky": (1, 1, 504, 504)},
        lambda g, f, pool: DepthAnything3(g, pool=pool).predict(RGB, None),
    ),
    "lama": Case(
        {"image": ("f", 4), "mask": ("f", 4)},
        {"output": (1, 3, 512, 512)},
        lambda g, f, pool: Lama(g, pool=pool).fill(RGB, HOLE),
    ),
    "migan": Case(
        {"image": ("u", 4), "mask": ("u", 4)},
        {"result": (1, 3, 60, 80)},
        lambda g, f, pool: Migan(g, pool=pool).fill(RGB, HOLE),
    ),
    "dinov2": Case(PICTURE, {"last_hidden_state": (1, 257, 8)}, lambda g, f, pool: Dinov2(g, pool=pool).patches(RGB)),
    "clip texts": Case(
        {"input_ids": ("i", 2)},
        {"text_embeds": (1, 512)},
        lambda g, f, pool: OpenClip(g, g, clip_tokenizer(f / "tokenizer.json"), pool=pool).texts(["a chair"]),
    ),
    "clip pictures": Case(
        PICTURE,
        {"image_embeds": (1, 512)},
        lambda g, f, pool: OpenClip(g, g, clip_tokenizer(f / "tokenizer.json"), pool=pool).images([RGB]),
    ),
    "duoduoclip": Case(
        {"views": ("f", 5)}, {"shape": (1, 512)}, lambda g, f, pool: DuoduoClip(g, pool=pool).shape([RGB])
    ),
    "owlv2": Case(
        {"input_ids": ("i", 2), "attention_mask": ("i", 2), "pixel_values": ("f", 4)},
        {"logits": (1, 9, 1), "pred_boxes": (1, 9, 4)},
        lambda g, f, pool: Owlv2(g, clip_tokenizer(f / "tokenizer.json"), pool=pool).detect(RGB, ["a chair"], 0.1),
    ),
    "llmdet": Case(
        {"pixel_values": ("f", 4), "pixel_mask": ("i", 3), "input_ids": ("i", 2), "attention_mask": ("i", 2)},
        {"logits": (1, 9, 256), "pred_boxes": (1, 9, 4)},
        lambda g, f, pool: GroundingDino(g, _phrase_tokenizer(f), pool=pool).detect(RGB, ["chair"], 0.1),
    ),
    "gigapose features": Case(
        {"pixels": ("f", 4)}, {"maps": (1, 4, 16, 16)}, lambda g, f, pool: GigaPoseScale(g, g, pool=pool).maps([RGB])
    ),
    "gigapose regressor": Case(
        {"pairs": ("f", 2)},
        {"scale": (2, 1), "inplane": (2, 2)},
        lambda g, f, pool: GigaPoseScale(g, g, pool=pool).turns(
            np.ones((4, 3, 3), np.float32), np.ones((4, 3, 3), np.float32), CELLS, CELLS
        ),
    ),
}
NO_GEOMETRY = ("moge", "depth anything")
"""Of these, the same number everywhere is no picture of anything, or nothing but sky."""


def _cut(graph: Path) -> Path:
    graph.write_bytes(graph.read_bytes()[: graph.stat().st_size // 2])
    return graph


def _noise(graph: Path) -> Path:
    graph.write_bytes(np.random.default_rng(0).bytes(5000))
    return graph


def _other_inputs(case: Case, path: Path) -> Path:
    return small_graphs.constants(path, {"something": ("f", 2), "more": ("f", 2)}, _numbers(case.outputs))


def _few_dims(case: Case, path: Path) -> Path:
    """Equal names, but numbers alone go in."""
    return small_graphs.constants(path, {n: (k, 1) for n, (k, _) in case.inputs.items()}, _numbers(case.outputs))


BROKEN: dict[str, Callable[[Case, Path], object]] = {
    "cut off": lambda case, p: _cut(small_graphs.constants(p, case.inputs, _numbers(case.outputs))),
    "noise": lambda case, p: _noise(p),
    "empty": lambda case, p: p.touch(),
    "absent": lambda case, p: None,
    "other inputs": _other_inputs,
    "inputs of other dimensions": _few_dims,
    "other outputs": lambda case, p: small_graphs.constants(p, case.inputs, _numbers({"something": (1, 7)})),
    "answers of other shapes": lambda case, p: small_graphs.constants(
        p, case.inputs, _numbers(dict.fromkeys(case.outputs, (1, 7, 7)))
    ),
    "empty answers": lambda case, p: small_graphs.constants(
        p, case.inputs, _numbers({n: (0, *s[1:]) for n, s in case.outputs.items()})
    ),
    "answers that are no numbers": lambda case, p: small_graphs.constants(
        p, case.inputs, _numbers(case.outputs, np.nan)
    ),
    "fails": lambda case, p: small_graphs.failing(p, case.inputs, next(iter(case.outputs))),
    "out of memory": lambda case, p: small_graphs.greedy(p, case.inputs, next(iter(case.outputs))),
}


ANSWERS = ("answers of other shapes", "empty answers", "answers that are no numbers")
"""Every network reads these itself; the rest is found where all graphs are loaded and run: a few networks tell."""
BROKEN_NETWORKS = [
    (name, how) for k, name in enumerate(CASES) for j, how in enumerate(BROKEN) if how in ANSWERS or (j + k) % 4 == 0
]


@pytest.mark.parametrize(("name", "how"), BROKEN_NETWORKS)
def test_a_broken_network_is_one_line_that_names_it(name: str, how: str, tmp_path: Path) -> None:
    case, graph = CASES[name], tmp_path / "model.onnx"
    BROKEN[how](case, graph)
    with pytest.raises(NetworkError) as caught:
        case.use(graph, tmp_path / "others", SessionPool())
    line = str(caught.value)
    assert caught.value.graph.parent in (tmp_path, tmp_path / "others")
    assert "\n" not in line
    assert 20 < len(line) < 600
    assert any(advice in line for advice in ("diorama models", "diorama doctor", "--profile embedded")), line


@pytest.mark.parametrize("name", CASES)
def test_the_graphs_of_these_tests_are_right_but_for_what_is_broken(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    graph = small_graphs.constants(tmp_path / "model.onnx", case.inputs, _numbers(case.outputs))
    refused = pytest.raises(NetworkError, match="sees no geometry") if name in NO_GEOMETRY else nullcontext()
    with refused:
        case.use(graph, tmp_path / "others", SessionPool())


def test_no_memory_says_so(tmp_path: Path) -> None:
    case = CASES["dinov2"]
    graph = small_graphs.greedy(tmp_path / "model.onnx", case.inputs, "last_hidden_state")
    with pytest.raises(NetworkError, match=r"(?i)alloc|memory"):
        case.use(graph, tmp_path, SessionPool())


def test_the_error_crosses_processes() -> None:
    error = NetworkError(Path("a/b.onnx"), "fails")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.graph) == (str(error), error.graph)


def test_a_tokenizer_that_is_damaged_is_one_line(tmp_path: Path) -> None:
    case = CASES["clip texts"]
    graph = small_graphs.constants(tmp_path / "model.onnx", case.inputs, _numbers(case.outputs))
    tokenizer = tmp_path / "tokenizer.json"
    tokenizer.write_text("{}")
    with pytest.raises(NetworkError, match=r"tokenizer\.json: cannot be read"):
        OpenClip(graph, graph, tokenizer, pool=SessionPool()).texts(["a chair"])


def test_an_inner_block_of_a_damaged_graph_is_one_line(tmp_path: Path) -> None:
    graph = _noise(tmp_path / "model.onnx")
    with pytest.raises(NetworkError, match="diorama models verify"):
        Dinov2(graph, block=17, pool=SessionPool()).patches(RGB)
