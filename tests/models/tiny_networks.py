"""Tiny random networks with the signatures of the real ones, exported on the spot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import torch
import transformers
from tokenizers import Tokenizer, models, pre_tokenizers, processors

from diorama_core.models.manifest import network
from diorama_core.models.onnx_export import write_graph as export
from diorama_core.models.store import FileRecord, Installed, ModelStore, sha256_of, write_json

START, END = "<|startoftext|>", "<|endoftext|>"
MARKS = {"bos_token_id": 30, "eos_token_id": 31, "pad_token_id": 0}


def clip_tokenizer(path: Path) -> Path:
    """Words split at spaces, with CLIP's marks around."""
    words = ["a", "photo", "of", "chair", "table", "lamp", "red", "blue", "wooden", "sofa"]
    vocabulary = {w: i + 2 for i, w in enumerate(words)} | {START: 30, END: 31, "<unk>": 1}
    tokenizer = Tokenizer(models.WordLevel(vocabulary, unk_token="<unk>"))
    tokenizer.pre_tokenizer = pre_tokenizers.Whitespace()
    tokenizer.post_processor = processors.TemplateProcessing(
        single=f"{START} $A {END}", special_tokens=[(START, 30), (END, 31)]
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    tokenizer.save(str(path))
    return path


class Called(torch.nn.Module):
    """A model that is called as a graph is: with tensors alone."""

    def __init__(self, model: torch.nn.Module, call: Callable[..., object]) -> None:
        super().__init__()
        self.model, self.call = model, call

    def forward(self, *given: torch.Tensor) -> object:
        return self.call(self.model, *given)


def _owl(
    model: transformers.Owlv2ForObjectDetection, ids: torch.Tensor, mask: torch.Tensor, pixels: torch.Tensor
) -> object:
    out = model(input_ids=ids, attention_mask=mask, pixel_values=pixels)
    return out.logits, out.pred_boxes


def owlv2(path: Path) -> tuple[transformers.Owlv2ForObjectDetection, Path]:
    torch.manual_seed(1)
    text = {"vocab_size": 32, "hidden_size": 16, "intermediate_size": 16, "num_hidden_layers": 1}
    vision = {"hidden_size": 16, "intermediate_size": 16, "num_hidden_layers": 1, "image_size": 960, "patch_size": 32}
    words = {"num_attention_heads": 2, "max_position_embeddings": 16, **MARKS}
    config = transformers.Owlv2Config(
        text_config=text | words, vision_config={**vision, "num_attention_heads": 2}, projection_dim=16
    )
    model = transformers.Owlv2ForObjectDetection(config).eval()
    for head in (model.box_head, model.class_head, model.owlv2.vision_model.encoder):
        for parameter in head.parameters():
            torch.nn.init.normal_(parameter, std=0.3)
    ids = torch.ones(3, 16, dtype=torch.long)
    arguments = (ids, ids.clone(), torch.zeros(1, 3, 960, 960))
    dynamic = {"input_ids": {0: "q"}, "attention_mask": {0: "q"}, "logits": {2: "q"}}
    names = ["input_ids", "attention_mask", "pixel_values"]
    return model, export(Called(model, _owl), arguments, path, names, ["logits", "pred_boxes"], dynamic)


def _dino(model: transformers.Dinov2Model, pixels: torch.Tensor) -> torch.Tensor:
    return model.layernorm(model.encoder(model.embeddings(pixels)).last_hidden_state)


def dinov2(path: Path) -> tuple[transformers.Dinov2Model, Path]:
    torch.manual_seed(4)
    config = transformers.Dinov2Config(
        hidden_size=24, num_hidden_layers=4, num_attention_heads=2, image_size=224, patch_size=14
    )
    model = transformers.Dinov2Model(config).eval()
    for parameter in model.parameters():
        torch.nn.init.normal_(parameter, std=0.2)
    dynamic = {"pixel_values": {0: "b"}, "last_hidden_state": {0: "b"}}
    arguments = (torch.zeros(2, 3, 224, 224),)
    return model, export(Called(model, _dino), arguments, path, ["pixel_values"], ["last_hidden_state"], dynamic)


def clip_text(model: transformers.CLIPModel, text: torch.Tensor) -> torch.Tensor:
    return model.text_projection(model.text_model(input_ids=text.long()).pooler_output)


def clip_image(model: transformers.CLIPModel, image: torch.Tensor) -> torch.Tensor:
    return model.visual_projection(model.vision_model(pixel_values=image).pooler_output)


def _many_views(model: transformers.CLIPModel, views: torch.Tensor) -> torch.Tensor:
    """Views [1, V, 3, 224, 224] of a shape to one vector, as DuoduoCLIP's converted tower."""
    return clip_image(model, views[0]).mean(dim=0, keepdim=True)


def clip(folder: Path, width: int = 512) -> tuple[transformers.CLIPModel, Path, Path, Path]:
    torch.manual_seed(5)
    common = {"hidden_size": 16, "intermediate_size": 16, "num_hidden_layers": 1, "num_attention_heads": 2}
    words, pictures = {"vocab_size": 32, "max_position_embeddings": 77}, {"image_size": 224, "patch_size": 32}
    config = transformers.CLIPConfig(
        text_config=common | words | MARKS, vision_config=common | pictures, projection_dim=width
    )
    model = transformers.CLIPModel(config).eval()
    graphs = (
        export(Called(model, call), (example,), folder / f"{name}.onnx", [name], ["embedding"], axes)
        for name, call, example, axes in (
            ("text", clip_text, torch.zeros(1, 77, dtype=torch.int32), None),
            ("image", clip_image, torch.zeros(1, 3, 224, 224), None),
            ("views", _many_views, torch.zeros(1, 3, 3, 224, 224), {"views": {1: "v"}}),
        )
    )
    return model, *graphs


class _Convolution(torch.nn.Module):
    """A picture in, a picture out, as BiRefNet, LaMa and MI-GAN have it."""

    def __init__(self, channels: int, out: int, scale: float) -> None:
        super().__init__()
        self.layer, self.scale = torch.nn.Conv2d(channels, out, 3, padding=1), scale

    def forward(self, *pictures: torch.Tensor) -> torch.Tensor:
        return self.layer(torch.cat([p.float() for p in pictures], dim=1)) * self.scale


def birefnet(path: Path) -> tuple[torch.nn.Module, Path]:
    torch.manual_seed(6)
    network = _Convolution(3, 1, 3.0).eval()
    return network, export(network, (torch.zeros(1, 3, 1024, 1024),), path, ["input_image"], ["output_image"])


class _Patches(torch.nn.Module):
    """Looks at the whole and at its four quarters, and joins them, as MVANet does."""

    def __init__(self) -> None:
        super().__init__()
        self.whole = torch.nn.Conv2d(3, 1, 4, stride=4)
        self.part = torch.nn.Conv2d(3, 1, 2, stride=2)

    def forward(self, picture: torch.Tensor) -> torch.Tensor:
        left, right = picture.chunk(2, dim=3)
        quarters = torch.cat([*left.chunk(2, dim=2), *right.chunk(2, dim=2)])
        near = self.part(quarters)
        joined = torch.cat([torch.cat([near[:1], near[1:2]], dim=2), torch.cat([near[2:3], near[3:]], dim=2)], dim=3)
        both = torch.nn.functional.interpolate(self.whole(picture), scale_factor=2.0, mode="bilinear") + joined
        return torch.nn.functional.interpolate(both, scale_factor=2.0, mode="bilinear") * 4.0


def mvanet(path: Path) -> tuple[torch.nn.Module, Path]:
    torch.manual_seed(8)
    network = _Patches().eval()
    return network, export(network, (torch.zeros(1, 3, 1024, 1024),), path, ["input"], ["output"])


def lama(path: Path) -> tuple[torch.nn.Module, Path]:
    torch.manual_seed(7)
    network = _Convolution(4, 3, 255.0).eval()
    arguments = (torch.zeros(1, 3, 512, 512), torch.zeros(1, 1, 512, 512))
    return network, export(network, arguments, path, ["image", "mask"], ["output"])


def _paint(_: torch.nn.Module, image: torch.Tensor, mask: torch.Tensor) -> torch.Tensor:
    """Paints the holes grey: what MI-GAN's pipeline would do if it had learnt nothing else."""
    return torch.where(mask > 127, image, torch.full_like(image, 99))


def migan(path: Path) -> Path:
    arguments = (torch.zeros(1, 3, 40, 50, dtype=torch.uint8), torch.zeros(1, 1, 40, 50, dtype=torch.uint8))
    dynamic = {"image": {2: "h", 3: "w"}, "mask": {2: "h", 3: "w"}, "result": {2: "h", 3: "w"}}
    return export(Called(torch.nn.Identity(), _paint), arguments, path, ["image", "mask"], ["result"], dynamic)


def install(store: ModelStore, network_id: str, files: Sequence[Path]) -> None:
    """Put graphs in a network's place, as if they had been pulled."""
    chosen = network(network_id)
    records = {}
    for file, source in zip(chosen.files, files, strict=True):
        target = store.folder_of(chosen) / file.path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(source.read_bytes())
        records[file.path] = FileRecord(bytes=target.stat().st_size, sha256=sha256_of(target))
    write_json(store.folder_of(chosen) / "installed.json", Installed(files=records).model_dump())
