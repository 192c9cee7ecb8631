"""Makes `openclip-bigg14/*` from your own copy of OpenCLIP ViT-bigG-14, as it is published for `transformers`.

    python scripts/convert_openclip.py CLIP-ViT-bigG-14-laion2B-39B-b160k -o converted
    diorama models pull --from converted

The folder holds config.json, tokenizer.json and the weights as safetensors; needs the package `transformers` and about
25 GB of memory. Weights are written in half precision, beside the graphs (5 GB), and read without running code in them.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path
from typing import Any

import torch

from diorama_core.models.clip import SIDE, TOKENS
from diorama_core.models.onnx_export import write_graph

NEEDED = ("config.json", "tokenizer.json")


class TextTower(torch.nn.Module):
    """Tokens [1, 77] to a vector [1, d]."""

    def __init__(self, model: Any) -> None:
        super().__init__()
        self.tower, self.projection = model.text_model, model.text_projection

    def forward(self, text: torch.Tensor) -> torch.Tensor:
        return self.projection(self.tower(input_ids=text.long()).pooler_output)


class ImageTower(torch.nn.Module):
    """A picture [1, 3, 224, 224] to a vector [1, d]."""

    def __init__(self, model: Any) -> None:
        super().__init__()
        self.tower, self.projection = model.vision_model, model.visual_projection

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        return self.projection(self.tower(pixel_values=image).pooler_output)


def read_folder(folder: Path) -> Any:
    """The model of a folder."""
    missing = [name for name in NEEDED if not (folder / name).is_file()]
    if missing:
        sys.exit(f"{folder}: {', '.join(missing)} is missing; give the folder as it is published")
    try:
        from transformers import CLIPModel
    except ImportError:
        sys.exit("this needs the package transformers: pip install transformers")
    try:
        return CLIPModel.from_pretrained(folder, local_files_only=True, use_safetensors=True).eval()
    except Exception as error:  # damaged folders raise almost anything
        sys.exit(f"{folder}: cannot be read ({' '.join(str(error).split())[:120]})")


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    a = parser.parse_args(arguments)
    model, target = read_folder(a.folder), a.output / "openclip-bigg14"
    options: dict[str, Any] = {"outputs": ["embedding"], "half_weights": True, "data_beside": True}
    tokens, picture = torch.zeros(1, TOKENS, dtype=torch.int64), torch.zeros(1, 3, SIDE, SIDE)
    write_graph(TextTower(model), (tokens,), target / "textual" / "model.onnx", inputs=["text"], **options)
    write_graph(ImageTower(model), (picture,), target / "visual" / "model.onnx", inputs=["image"], **options)
    shutil.copyfile(a.folder / "tokenizer.json", target / "textual" / "tokenizer.json")
    print(target)


if __name__ == "__main__":
    main()
