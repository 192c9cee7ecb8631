"""Tiny random networks with the signatures of the real ones, exported on the spot."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import torch
from tokenizers import Tokenizer, models, pre_tokenizers, processors
from transformers import (
    CLIPConfig,
    CLIPModel,
    Dinov2Config,
    Dinov2Model,
    Owlv2Config,
    Owlv2ForObjectDetection,
    Sam2Config,
    Sam2Model,
    Sam3TrackerConfig,
    Sam3TrackerModel,
    SamConfig,
    SamHQConfig,
    SamHQModel,
    SamModel,
)

from diorama_core.models.manifest import network
from diorama_core.models.onnx_export import write_graph as export
from diorama_core.models.store import FileRecord, Installed, ModelStore, sha256_of, write_json

START, END = "<|startoftext|>", "<|endoftext|>"


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


class _Owl(torch.nn.Module):
    def __init__(self, model: Owlv2ForObjectDetection) -> None:
        super().__init__()
        self.model = model

    def forward(self, ids: torch.Tensor, mask: torch.Tensor, pixels: torch.Tensor) -> tuple[torch.Tensor, ...]:
        out = self.model(input_ids=ids, attention_mask=mask, pixel_values=pixels)
        return out.logits, out.pred_boxes


def owlv2(path: Path) -> tuple[Owlv2ForObjectDetection, Path]:
    torch.manual_seed(1)
    text = {"vocab_size": 32, "hidden_size": 16, "intermediate_size": 16, "num_hidden_layers": 1}
    vision = {"hidden_size": 16, "intermediate_size": 16, "num_hidden_layers": 1, "image_size": 960, "patch_size": 32}
    config = Owlv2Config(
        text_config={
            **text,
            "num_attention_heads": 2,
            "max_position_embeddings": 16,
            "pad_token_id": 0,
            "bos_token_id": 30,
            "eos_token_id": 31,
        },
        vision_config={**vision, "num_attention_heads": 2},
        projection_dim=16,
    )
    model = Owlv2ForObjectDetection(config).eval()
    for head in (model.box_head, model.class_head, model.owlv2.vision_model.encoder):
        for parameter in head.parameters():
            torch.nn.init.normal_(parameter, std=0.3)
    ids = torch.ones(3, 16, dtype=torch.long)
    arguments = (ids, ids.clone(), torch.zeros(1, 3, 960, 960))
    dynamic = {"input_ids": {0: "q"}, "attention_mask": {0: "q"}, "logits": {2: "q"}}
    names = ["input_ids", "attention_mask", "pixel_values"]
    return model, export(_Owl(model), arguments, path, names, ["logits", "pred_boxes"], dynamic)


class _Sam2Encoder(torch.nn.Module):
    def __init__(self, model: Sam2Model) -> None:
        super().__init__()
        self.model = model

    def forward(self, pixels: torch.Tensor) -> tuple[torch.Tensor, ...]:
        return tuple(self.model.get_image_embeddings(pixels))


class _Sam2Decoder(torch.nn.Module):
    def __init__(self, model: Sam2Model) -> None:
        super().__init__()
        self.model = model

    def forward(self, e0, e1, e2, points, labels, boxes):
        out = self.model(image_embeddings=[e0, e1, e2], input_boxes=boxes, multimask_output=True)
        # Points count for nothing, as none are ever given, but they belong to the signature.
        return out.iou_scores + 0.0 * points.sum() + 0.0 * labels.sum(), out.pred_masks, out.object_score_logits


def sam2(folder: Path) -> tuple[Sam2Model, Path, Path]:
    torch.manual_seed(2)
    config = Sam2Config(
        vision_config={
            "backbone_config": {
                "model_type": "sam2_hiera_det_model",
                "hidden_size": 8,
                "num_attention_heads": 1,
                "blocks_per_stage": [1, 1, 1, 1],
                "embed_dim_per_stage": [8, 16, 32, 64],
                "num_attention_heads_per_stage": [1, 1, 1, 1],
                "window_size_per_stage": [8, 4, 8, 8],
                "global_attention_blocks": [],
                "image_size": [1024, 1024],
            },
            "backbone_channel_list": [64, 32, 16, 8],
            "fpn_hidden_size": 32,
        },
        prompt_encoder_config={"hidden_size": 32},
        mask_decoder_config={
            "hidden_size": 32,
            "num_hidden_layers": 1,
            "num_attention_heads": 2,
            "mlp_dim": 32,
            "iou_head_hidden_dim": 32,
            "iou_head_depth": 2,
        },
    )
    model = Sam2Model(config).eval()
    names = ["image_embeddings.0", "image_embeddings.1", "image_embeddings.2"]
    pixels = torch.zeros(1, 3, 1024, 1024)
    encoder = export(_Sam2Encoder(model), (pixels,), folder / "encoder.onnx", ["pixel_values"], names)
    with torch.no_grad():
        features = model.get_image_embeddings(pixels)
    arguments = (
        *features,
        torch.zeros(1, 1, 1, 2),
        torch.zeros(1, 1, 1, dtype=torch.long),
        torch.tensor([[[100.0, 100.0, 500.0, 600.0]]]),
    )
    decoder = export(
        _Sam2Decoder(model),
        arguments,
        folder / "decoder.onnx",
        [*names, "input_points", "input_labels", "input_boxes"],
        ["iou_scores", "pred_masks", "object_score_logits"],
        {"input_points": {1: "n", 2: "k"}, "input_labels": {1: "n", 2: "k"}, "input_boxes": {1: "n"}},
    )
    return model, encoder, decoder


def sam3_tracker(folder: Path) -> tuple[Sam3TrackerModel, Path, Path]:
    torch.manual_seed(9)
    config = Sam3TrackerConfig(
        vision_config={
            "model_type": "sam3_vision_model",
            "backbone_config": {
                "model_type": "sam3_vit_model",
                "hidden_size": 16,
                "intermediate_size": 16,
                "num_hidden_layers": 1,
                "num_attention_heads": 2,
                "global_attn_indexes": [],
                "image_size": 1008,
            },
            "fpn_hidden_size": 32,
            "backbone_feature_sizes": [[288, 288], [144, 144], [72, 72]],
        },
        prompt_encoder_config={"hidden_size": 32},
        mask_decoder_config={
            "hidden_size": 32,
            "num_hidden_layers": 1,
            "num_attention_heads": 2,
            "mlp_dim": 32,
            "iou_head_hidden_dim": 32,
            "iou_head_depth": 2,
        },
    )
    model = Sam3TrackerModel(config).eval()
    names = ["image_embeddings.0", "image_embeddings.1", "image_embeddings.2"]
    pixels = torch.zeros(1, 3, 1008, 1008)
    encoder = export(_Sam2Encoder(model), (pixels,), folder / "encoder.onnx", ["pixel_values"], names)
    with torch.no_grad():
        features = model.get_image_embeddings(pixels)
    arguments = (
        *features,
        torch.zeros(1, 1, 1, 2),
        torch.zeros(1, 1, 1, dtype=torch.long),
        torch.tensor([[[100.0, 100.0, 500.0, 600.0]]]),
    )
    decoder = export(
        _Sam2Decoder(model),
        arguments,
        folder / "decoder.onnx",
        [*names, "input_points", "input_labels", "input_boxes"],
        ["iou_scores", "pred_masks", "object_score_logits"],
        {"input_points": {1: "n", 2: "k"}, "input_labels": {1: "n", 2: "k"}, "input_boxes": {1: "n"}},
    )
    return model, encoder, decoder


class _HqEncoder(torch.nn.Module):
    """Normalising and padding inside the graph, as HQ-SAM's exporter writes it."""

    def __init__(self, model: SamHQModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, picture: torch.Tensor) -> tuple[torch.Tensor, ...]:
        mean, std = torch.tensor([123.675, 116.28, 103.53]), torch.tensor([58.395, 57.12, 57.375])
        pixels = ((picture - mean) / std).permute(2, 0, 1)[None]
        missing = (0, 1024 - picture.shape[1], 0, 1024 - picture.shape[0])
        embeddings, inside = self.model.get_image_embeddings(torch.nn.functional.pad(pixels, missing))
        return embeddings, *inside


class _HqDecoder(torch.nn.Module):
    def __init__(self, model: SamHQModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, embeddings, inside, points, labels, mask, has_mask, size):
        out = self.model(
            image_embeddings=embeddings,
            intermediate_embeddings=list(inside),
            input_boxes=points.reshape(1, 1, 4),
            multimask_output=True,
        )
        nothing = 0.0 * (labels.sum() + mask.sum() + has_mask.sum() + size.sum())
        return out.pred_masks[:, 0], out.iou_scores[:, 0] + nothing, out.pred_masks[:, 0]


def hq_sam(folder: Path) -> tuple[SamHQModel, Path, Path]:
    torch.manual_seed(10)
    config = SamHQConfig(
        vision_config={
            "hidden_size": 16,
            "output_channels": 32,
            "num_hidden_layers": 2,
            "num_attention_heads": 2,
            "mlp_dim": 16,
            "global_attn_indexes": [0, 1],
            "num_pos_feats": 16,
            "initializer_range": 0.1,
        },
        prompt_encoder_config={"hidden_size": 32},
        mask_decoder_config={
            "hidden_size": 32,
            "num_hidden_layers": 1,
            "num_attention_heads": 2,
            "mlp_dim": 32,
            "iou_head_hidden_dim": 32,
            "vit_dim": 16,
        },
    )
    model = SamHQModel(config).eval()
    picture = torch.zeros(768, 1024, 3)
    between = ["image_embeddings", "interm_embeddings.0", "interm_embeddings.1"]
    shape = {"input_image": {0: "height", 1: "width"}}
    encoder = export(_HqEncoder(model), (picture,), folder / "encoder.onnx", ["input_image"], between, shape)
    with torch.no_grad():
        embeddings, *inside = _HqEncoder(model)(picture)
    arguments = (
        embeddings,
        torch.stack(inside),
        torch.tensor([[[100.0, 100.0], [500.0, 600.0]]]),
        torch.tensor([[2.0, 3.0]]),
        torch.zeros(1, 1, 256, 256),
        torch.zeros(1),
        torch.tensor([600.0, 800.0]),
    )
    names = [
        "image_embeddings",
        "interm_embeddings",
        "point_coords",
        "point_labels",
        "mask_input",
        "has_mask_input",
        "orig_im_size",
    ]
    decoder = export(
        _HqDecoder(model),
        arguments,
        folder / "decoder.onnx",
        names,
        ["masks", "iou_predictions", "low_res_masks"],
        {"point_coords": {1: "k"}, "point_labels": {1: "k"}},
    )
    return model, encoder, decoder


class _SamEncoder(torch.nn.Module):
    def __init__(self, model: SamModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, pixels: torch.Tensor) -> tuple[torch.Tensor, ...]:
        return self.model.get_image_embeddings(pixels), self.model.get_image_wide_positional_embeddings()


class _SamDecoder(torch.nn.Module):
    def __init__(self, model: SamModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, points, labels, boxes, embeddings, positions):
        out = self.model(image_embeddings=embeddings, input_boxes=boxes, multimask_output=True)
        nothing = 0.0 * points.sum() + 0.0 * labels.sum() + 0.0 * positions.sum()
        return out.iou_scores + nothing, out.pred_masks


def slimsam(folder: Path) -> tuple[SamModel, Path, Path]:
    torch.manual_seed(3)
    config = SamConfig(
        vision_config={
            "hidden_size": 16,
            "output_channels": 32,
            "num_hidden_layers": 1,
            "num_attention_heads": 2,
            "mlp_dim": 16,
            "global_attn_indexes": [],
            "num_pos_feats": 16,
        },
        prompt_encoder_config={"hidden_size": 32},
        mask_decoder_config={
            "hidden_size": 32,
            "num_hidden_layers": 1,
            "num_attention_heads": 2,
            "mlp_dim": 32,
            "iou_head_hidden_dim": 32,
        },
    )
    model = SamModel(config).eval()
    pixels = torch.zeros(1, 3, 1024, 1024)
    between = ["image_embeddings", "image_positional_embeddings"]
    encoder = export(_SamEncoder(model), (pixels,), folder / "encoder.onnx", ["pixel_values"], between)
    with torch.no_grad():
        features = _SamEncoder(model)(pixels)
    arguments = (
        torch.zeros(1, 1, 1, 2),
        torch.zeros(1, 1, 1, dtype=torch.long),
        torch.tensor([[[100.0, 100.0, 500.0, 600.0]]]),
        *features,
    )
    decoder = export(
        _SamDecoder(model),
        arguments,
        folder / "decoder.onnx",
        ["input_points", "input_labels", "input_boxes", *between],
        ["iou_scores", "pred_masks"],
        {"input_points": {1: "n", 2: "k"}, "input_labels": {1: "n", 2: "k"}, "input_boxes": {1: "n"}},
    )
    return model, encoder, decoder


class _Dino(torch.nn.Module):
    def __init__(self, model: Dinov2Model) -> None:
        super().__init__()
        self.encoder, self.embeddings, self.layernorm = model.encoder, model.embeddings, model.layernorm

    def forward(self, pixels: torch.Tensor) -> torch.Tensor:
        return self.layernorm(self.encoder(self.embeddings(pixels)).last_hidden_state)


def dinov2(path: Path) -> tuple[Dinov2Model, Path]:
    torch.manual_seed(4)
    config = Dinov2Config(hidden_size=24, num_hidden_layers=4, num_attention_heads=2, image_size=224, patch_size=14)
    model = Dinov2Model(config).eval()
    for parameter in model.parameters():
        torch.nn.init.normal_(parameter, std=0.2)
    dynamic = {"pixel_values": {0: "b"}, "last_hidden_state": {0: "b"}}
    arguments = (torch.zeros(2, 3, 224, 224),)
    return model, export(_Dino(model), arguments, path, ["pixel_values"], ["last_hidden_state"], dynamic)


class _ClipText(torch.nn.Module):
    def __init__(self, model: CLIPModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, text: torch.Tensor) -> torch.Tensor:
        pooled = self.model.text_model(input_ids=text.long()).pooler_output
        return self.model.text_projection(pooled)


class _ClipImage(torch.nn.Module):
    def __init__(self, model: CLIPModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        return self.model.visual_projection(self.model.vision_model(pixel_values=image).pooler_output)


class _ManyViews(torch.nn.Module):
    """Views [1, V, 3, 224, 224] of a shape to one vector, as DuoduoCLIP's converted tower."""

    def __init__(self, model: CLIPModel) -> None:
        super().__init__()
        self.one = _ClipImage(model)

    def forward(self, views: torch.Tensor) -> torch.Tensor:
        return self.one(views[0]).mean(dim=0, keepdim=True)


def clip(folder: Path) -> tuple[CLIPModel, Path, Path, Path]:
    torch.manual_seed(5)
    common = {"hidden_size": 16, "intermediate_size": 16, "num_hidden_layers": 1, "num_attention_heads": 2}
    config = CLIPConfig(
        text_config={
            **common,
            "vocab_size": 32,
            "max_position_embeddings": 77,
            "eos_token_id": 31,
            "bos_token_id": 30,
            "pad_token_id": 0,
        },
        vision_config={**common, "image_size": 224, "patch_size": 32},
        projection_dim=512,
    )
    model = CLIPModel(config).eval()
    text = export(
        _ClipText(model), (torch.zeros(1, 77, dtype=torch.int32),), folder / "text.onnx", ["text"], ["embedding"]
    )
    image = export(_ClipImage(model), (torch.zeros(1, 3, 224, 224),), folder / "image.onnx", ["image"], ["embedding"])
    views = export(
        _ManyViews(model),
        (torch.zeros(1, 3, 3, 224, 224),),
        folder / "views.onnx",
        ["views"],
        ["embedding"],
        {"views": {1: "v"}},
    )
    return model, text, image, views


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


class _Painter(torch.nn.Module):
    """Paints the holes grey: what MI-GAN's pipeline would do if it had learnt nothing else."""

    def forward(self, image: torch.Tensor, mask: torch.Tensor) -> torch.Tensor:
        return torch.where(mask > 127, image, torch.full_like(image, 99))


def migan(path: Path) -> Path:
    arguments = (torch.zeros(1, 3, 40, 50, dtype=torch.uint8), torch.zeros(1, 1, 40, 50, dtype=torch.uint8))
    dynamic = {"image": {2: "h", 3: "w"}, "mask": {2: "h", 3: "w"}, "result": {2: "h", 3: "w"}}
    return export(_Painter(), arguments, path, ["image", "mask"], ["result"], dynamic)


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
