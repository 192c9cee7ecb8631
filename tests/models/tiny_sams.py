"""Tiny random networks with the signatures of SAM 2, SAM 3's tracker, HQ-SAM and SlimSAM."""

from __future__ import annotations

from pathlib import Path
from typing import TypeAlias

import torch
import transformers

from diorama_core.models.onnx_export import write_graph as export
from tests.models.small_graphs import HQ_SAM
from tests.models.tiny_networks import Called

_PyramidModel: TypeAlias = "transformers.Sam2Model | transformers.Sam3TrackerModel"

_PROMPTS = {"hidden_size": 32}
_DECODER = _PROMPTS | {"num_hidden_layers": 1, "num_attention_heads": 2, "mlp_dim": 32, "iou_head_hidden_dim": 32}
PROMPT = {"input_points": {1: "n", 2: "k"}, "input_labels": {1: "n", 2: "k"}, "input_boxes": {1: "n"}}
"""Inputs of a decoder that say what is wanted, with the axes that may have any length."""
EXAMPLE = (torch.zeros(1, 1, 1, 2), torch.zeros(1, 1, 1, dtype=torch.long), torch.tensor([[[100.0, 100, 500, 600]]]))


def _pyramid_features(model: _PyramidModel, pixels: torch.Tensor) -> tuple[torch.Tensor, ...]:
    return tuple(model.get_image_embeddings(pixels))


def _pyramid_masks(model: _PyramidModel, e0, e1, e2, points, labels, boxes):
    out = model(image_embeddings=[e0, e1, e2], input_boxes=boxes, multimask_output=True)
    # Points count for nothing, as none are ever given, but they belong to the signature.
    return out.iou_scores + 0.0 * points.sum() + 0.0 * labels.sum(), out.pred_masks, out.object_score_logits


def sam2(folder: Path) -> tuple[transformers.Sam2Model, Path, Path]:
    torch.manual_seed(2)
    config = transformers.Sam2Config(
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
        prompt_encoder_config=_PROMPTS,
        mask_decoder_config=_DECODER | {"iou_head_depth": 2},
    )
    model = transformers.Sam2Model(config).eval()
    return model, *_exported(model, 1024, folder)


def sam3_tracker(folder: Path) -> tuple[transformers.Sam3TrackerModel, Path, Path]:
    torch.manual_seed(9)
    config = transformers.Sam3TrackerConfig(
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
        prompt_encoder_config=_PROMPTS,
        mask_decoder_config=_DECODER | {"iou_head_depth": 2},
    )
    model = transformers.Sam3TrackerModel(config).eval()
    return model, *_exported(model, 1008, folder)


def _exported(model: _PyramidModel, side: int, folder: Path) -> tuple[Path, Path]:
    """Encoder and decoder of a network that takes pictures of `side` pixels and answers features of three sizes."""
    names = ["image_embeddings.0", "image_embeddings.1", "image_embeddings.2"]
    pixels = torch.zeros(1, 3, side, side)
    encoder = export(Called(model, _pyramid_features), (pixels,), folder / "encoder.onnx", ["pixel_values"], names)
    with torch.no_grad():
        features = model.get_image_embeddings(pixels)
    given, outputs = [*names, *PROMPT], ["iou_scores", "pred_masks", "object_score_logits"]
    decoder = Called(model, _pyramid_masks)
    return encoder, export(decoder, (*features, *EXAMPLE), folder / "decoder.onnx", given, outputs, PROMPT)


def _hq_features(model: transformers.SamHQModel, picture: torch.Tensor) -> tuple[torch.Tensor, ...]:
    """Normalising and padding inside the graph, as HQ-SAM's exporter writes it."""
    mean, std = torch.tensor([123.675, 116.28, 103.53]), torch.tensor([58.395, 57.12, 57.375])
    pixels = ((picture - mean) / std).permute(2, 0, 1)[None]
    missing = (0, 1024 - picture.shape[1], 0, 1024 - picture.shape[0])
    embeddings, inside = model.get_image_embeddings(torch.nn.functional.pad(pixels, missing))
    return embeddings, *inside


def _hq_masks(model: transformers.SamHQModel, embeddings, inside, points, labels, mask, has_mask, size):
    seen = {"image_embeddings": embeddings, "intermediate_embeddings": list(inside)}
    out = model(**seen, input_boxes=points.reshape(1, 1, 4), multimask_output=True)
    nothing = 0.0 * (labels.sum() + mask.sum() + has_mask.sum() + size.sum())
    return out.pred_masks[:, 0], out.iou_scores[:, 0] + nothing, out.pred_masks[:, 0]


def hq_sam(folder: Path) -> tuple[transformers.SamHQModel, Path, Path]:
    torch.manual_seed(10)
    config = transformers.SamHQConfig(
        vision_config={
            "hidden_size": 16,
            "output_channels": 32,
            "num_hidden_layers": 2,
            "num_attention_heads": 1,
            "mlp_dim": 16,
            "global_attn_indexes": [0, 1],
            "use_rel_pos": False,
            "num_pos_feats": 16,
            "initializer_range": 0.1,
        },
        prompt_encoder_config=_PROMPTS,
        mask_decoder_config=_DECODER | {"vit_dim": 16},
    )
    model = transformers.SamHQModel(config).eval()
    picture = torch.zeros(768, 1024, 3)
    between = ["image_embeddings", "interm_embeddings.0", "interm_embeddings.1"]
    shape = {"input_image": {0: "height", 1: "width"}}
    encoder = export(Called(model, _hq_features), (picture,), folder / "encoder.onnx", ["input_image"], between, shape)
    with torch.no_grad():
        embeddings, *inside = _hq_features(model, picture)
    arguments = (
        embeddings,
        torch.stack(inside),
        torch.tensor([[[100.0, 100.0], [500.0, 600.0]]]),
        torch.tensor([[2.0, 3.0]]),
        torch.zeros(1, 1, 256, 256),
        torch.zeros(1),
        torch.tensor([600.0, 800.0]),
    )
    outputs, axes = ["masks", "iou_predictions", "low_res_masks"], {"point_coords": {1: "k"}, "point_labels": {1: "k"}}
    decoder = Called(model, _hq_masks)
    return model, encoder, export(decoder, arguments, folder / "decoder.onnx", list(HQ_SAM), outputs, axes)


def _sam_features(model: transformers.SamModel, pixels: torch.Tensor) -> tuple[torch.Tensor, ...]:
    return model.get_image_embeddings(pixels), model.get_image_wide_positional_embeddings()


def _sam_masks(model: transformers.SamModel, points, labels, boxes, embeddings, positions):
    out = model(image_embeddings=embeddings, input_boxes=boxes, multimask_output=True)
    nothing = 0.0 * points.sum() + 0.0 * labels.sum() + 0.0 * positions.sum()
    return out.iou_scores + nothing, out.pred_masks


def slimsam(folder: Path) -> tuple[transformers.SamModel, Path, Path]:
    torch.manual_seed(3)
    config = transformers.SamConfig(
        vision_config={
            "hidden_size": 16,
            "output_channels": 32,
            "num_hidden_layers": 1,
            "num_attention_heads": 2,
            "mlp_dim": 16,
            "global_attn_indexes": [],
            "num_pos_feats": 16,
        },
        prompt_encoder_config=_PROMPTS,
        mask_decoder_config=_DECODER,
    )
    model = transformers.SamModel(config).eval()
    pixels = torch.zeros(1, 3, 1024, 1024)
    between = ["image_embeddings", "image_positional_embeddings"]
    encoder = export(Called(model, _sam_features), (pixels,), folder / "encoder.onnx", ["pixel_values"], between)
    with torch.no_grad():
        features = _sam_features(model, pixels)
    given, outputs = [*PROMPT, *between], ["iou_scores", "pred_masks"]
    decoder = Called(model, _sam_masks)
    return model, encoder, export(decoder, (*EXAMPLE, *features), folder / "decoder.onnx", given, outputs, PROMPT)
