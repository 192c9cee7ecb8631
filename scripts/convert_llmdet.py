"""Makes `llmdet-tiny/*` from your own copy of LLMDet (Fu et al. 2025), as its authors publish it for `transformers`.

    python scripts/convert_llmdet.py llmdet_tiny -o converted
    diorama models pull --from converted

The folder holds config.json, model.safetensors and tokenizer.json; needs the package `transformers`. Weights are read
without running code in them.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import torch

from diorama_core.models.grounding import SIDE, TOKENS
from diorama_core.models.onnx_export import write_graph

NEEDED = ("config.json", "model.safetensors", "tokenizer.json")
INPUTS = ["pixel_values", "pixel_mask", "input_ids", "attention_mask"]


class Detector(torch.nn.Module):
    """A picture [1, 3, s, s] with its mask, and tokens [1, 256], to logits [1, q, 256] and boxes [1, q, 4]."""

    def __init__(self, model: torch.nn.Module) -> None:
        super().__init__()
        self.model = model

    def forward(
        self, pixels: torch.Tensor, shown: torch.Tensor, ids: torch.Tensor, words: torch.Tensor
    ) -> tuple[torch.Tensor, torch.Tensor]:
        out = self.model(
            pixel_values=pixels,
            pixel_mask=shown,
            input_ids=ids,
            attention_mask=words,
            token_type_ids=torch.zeros_like(ids),
        )
        return out.logits, out.pred_boxes


def phrase_masks(input_ids: torch.Tensor, special_tokens: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Which tokens see each other (those of one phrase) and their places in it, by operators that graphs have."""
    count = input_ids.shape[1]
    special = (input_ids[..., None] == special_tokens.to(input_ids)).any(-1)
    index = torch.arange(count)
    earlier, later = index[None, :] < index[:, None], index[None, :] >= index[:, None]
    before = torch.where(special[:, None, :] & earlier[None], index[None, None, :], -1).amax(-1)
    after = torch.where(special[:, None, :] & later[None], index[None, None, :], count).amin(-1)
    inside = (after != 0) & (after != count - 1) & (after != count)
    together = (after[:, :, None] == after[:, None, :]) & inside[:, None, :]
    together = together | (index[:, None] == index[None, :])[None]
    return together, torch.where(inside, index[None] - before - 1, 0).clamp(min=0)


def unit_steps(start: float, end: float, steps: int, dtype: Any = None, device: Any = None) -> torch.Tensor:
    """What the model asks `torch.linspace` for; as a graph that one answers in double precision."""
    if abs(end - start - (steps - 1)) > 1e-6:
        raise ValueError("only steps of one can be exported")
    return torch.arange(steps, device=device).to(dtype) + start


@contextmanager
def exportable() -> Iterator[None]:
    """While it lasts, the model uses operators that onnxruntime has."""
    from transformers.models.mm_grounding_dino import modeling_mm_grounding_dino as modelling

    masks, linspace = modelling.generate_masks_with_special_tokens_and_transfer_map, torch.linspace
    modelling.generate_masks_with_special_tokens_and_transfer_map = phrase_masks
    torch.linspace = unit_steps  # type: ignore[assignment]
    try:
        yield
    finally:
        modelling.generate_masks_with_special_tokens_and_transfer_map = masks
        torch.linspace = linspace


def read_model(folder: Path) -> torch.nn.Module:
    missing = [name for name in NEEDED if not (folder / name).is_file()]
    if missing:
        sys.exit(f"{folder}: {', '.join(missing)} is missing; give the folder of a whole copy of LLMDet")
    try:
        from transformers import MMGroundingDinoForObjectDetection
    except ImportError:
        sys.exit("this needs the package transformers; run: pip install transformers")
    try:
        return MMGroundingDinoForObjectDetection.from_pretrained(folder, local_files_only=True).eval()
    except Exception as error:  # of the configuration, the weights or the package
        sys.exit(f"{folder}: cannot be read ({' '.join(str(error).split())[:160]}); is it LLMDet for transformers?")


def write_network(model: torch.nn.Module, target: Path, side: int = SIDE) -> None:
    ids = torch.zeros(1, TOKENS, dtype=torch.long)
    example = (torch.zeros(1, 3, side, side), torch.ones(1, side, side, dtype=torch.long), ids, torch.ones_like(ids))
    with exportable():
        write_graph(Detector(model), example, target, inputs=INPUTS, outputs=["logits", "pred_boxes"])


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    a = parser.parse_args(arguments)
    target = a.output / "llmdet-tiny"
    write_network(read_model(a.folder), target / "model.onnx")
    shutil.copyfile(a.folder / "tokenizer.json", target / "tokenizer.json")
    print(target)


if __name__ == "__main__":
    main()
