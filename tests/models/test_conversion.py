"""The scripts that convert users' own checkpoints, on small random ones with the published names of weights.

The networks here are written as their authors describe them, with torch's own modules; the scripts rebuild them from
the weights alone.
"""

from __future__ import annotations

import itertools
from collections import OrderedDict
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import nn

from diorama_core.models.clip import DuoduoClip, clip_pixels
from diorama_core.models.gigapose import GigaPoseScale
from diorama_core.models.manifest import network
from diorama_core.models.openshape import OpenShape, patches_of
from diorama_core.models.runtime import SessionPool
from diorama_core.models.store import ModelStore
from diorama_core.pipeline import network_stages
from scripts import convert_duoduoclip, convert_gigapose, convert_openclip, convert_openshape
from tests.models import tiny_networks

WIDTH, LAYERS, ALONE = 128, 4, 2


def _shaken(network_: nn.Module) -> nn.Module:
    """Random everywhere, running statistics included, so that no weight can be forgotten unnoticed."""
    generator = torch.Generator().manual_seed(0)
    with torch.no_grad():
        for name, value in network_.state_dict().items():
            if value.dtype.is_floating_point:
                random = torch.randn(value.shape, generator=generator)
                fan = max(1, value[0].numel()) if value.dim() > 1 else 25
                value.copy_(
                    random.abs() + 0.5 if "running_var" in name else random / fan**0.5 + (value.dim() == 1) * 0.5
                )
    return network_.eval()


def installed(folder: Path, network_id: str) -> ModelStore:
    """A store with what a script has made."""
    store = ModelStore(folder / "store")
    assert store.add_folder(folder / "made") == (network_id,)
    return store


class _Block(nn.Module):
    def __init__(self) -> None:
        super().__init__()
        self.ln_1, self.attn, self.ln_2 = nn.LayerNorm(WIDTH), nn.MultiheadAttention(WIDTH, 2), nn.LayerNorm(WIDTH)
        inner = {"c_fc": nn.Linear(WIDTH, 4 * WIDTH), "gelu": nn.GELU(), "c_proj": nn.Linear(4 * WIDTH, WIDTH)}
        self.mlp = nn.Sequential(OrderedDict(inner))

    def forward(self, x: torch.Tensor, frames: int) -> torch.Tensor:
        """Tokens first [tokens, shapes x frames, width]; attention joins the frames of each shape."""
        tokens, rows, width = x.shape
        q = self.ln_1(x).reshape(tokens, rows // frames, frames, width).permute(0, 2, 1, 3)
        q = q.reshape(tokens * frames, rows // frames, width)
        seen = self.attn(q, q, q, need_weights=False)[0]
        x = x + seen.reshape(tokens, frames, rows // frames, width).permute(0, 2, 1, 3).reshape(tokens, rows, width)
        return x + self.mlp(self.ln_2(x))


class _Visual(nn.Module):
    """The many-view vision transformer of DuoduoCLIP."""

    def __init__(self) -> None:
        super().__init__()
        self.conv1 = nn.Conv2d(3, WIDTH, 32, stride=32, bias=False)
        self.class_embedding = nn.Parameter(torch.zeros(WIDTH))
        self.positional_embedding = nn.Parameter(torch.zeros(50, WIDTH))
        self.ln_pre, self.ln_post = nn.LayerNorm(WIDTH), nn.LayerNorm(WIDTH)
        self.transformer = nn.Module()
        self.transformer.resblocks = nn.ModuleList(_Block() for _ in range(LAYERS))
        self.proj = nn.Parameter(torch.zeros(WIDTH, 512))

    def forward(self, views: torch.Tensor, alone: int) -> torch.Tensor:
        x = self.conv1(views).flatten(2).permute(0, 2, 1)
        x = torch.cat([self.class_embedding.expand(len(x), 1, -1), x], dim=1) + self.positional_embedding
        x = self.ln_pre(x).permute(1, 0, 2)
        for index, block in enumerate(self.transformer.resblocks):
            x = block(x, 1 if index < alone else len(views))
        return self.ln_post(x.permute(1, 0, 2))[:, 0].mean(dim=0, keepdim=True) @ self.proj


@pytest.mark.parametrize("alone", [0, ALONE], ids=["all layers joined", "early layers alone"])
def test_duoduoclips_shape_tower_is_rebuilt_from_a_checkpoint(
    tmp_path: Path, rng: np.random.Generator, alone: int
) -> None:
    visual = _shaken(_Visual())
    state = {f"duoduoclip.visual.{k}": v for k, v in visual.state_dict().items()}
    state["duoduoclip.token_embedding.weight"] = torch.zeros(3, 4)  # the text tower's, which is not taken
    settings = {"model": {"network": {"layers_threshold": alone, "base_name": "ViT-B-32"}}}
    torch.save({"state_dict": state, "hyper_parameters": settings, "epoch": 3}, tmp_path / "own.ckpt")
    convert_duoduoclip.main([str(tmp_path / "own.ckpt"), "-o", str(tmp_path / "made")])
    store = installed(tmp_path, "duoduoclip")
    facade = DuoduoClip(store.path(network("duoduoclip"), "visual.onnx"), pool=SessionPool())
    for count in (1, 2, 5):
        views = [rng.integers(0, 255, (224, 224, 3)).astype(np.uint8) for _ in range(count)]
        with torch.no_grad():
            expected = visual(torch.from_numpy(np.concatenate([clip_pixels(v) for v in views])), alone)[0].numpy()
        np.testing.assert_allclose(facade.shape(views), expected / np.linalg.norm(expected), atol=1e-4)


class _Mixing(nn.Module):
    """One block of OpenShape's transformer, with its authors' names of weights."""

    def __init__(self) -> None:
        super().__init__()
        attention = nn.Module()
        attention.to_qkv = nn.Linear(WIDTH, 3 * WIDTH, bias=False)
        attention.to_out = nn.Sequential(nn.Linear(WIDTH, WIDTH), nn.Dropout(0.0))
        forward = nn.Module()
        forward.net = nn.Sequential(
            nn.Linear(WIDTH, 2 * WIDTH), nn.GELU(), nn.Dropout(0.0), nn.Linear(2 * WIDTH, WIDTH), nn.Dropout(0.0)
        )
        pair = []
        for inner in (attention, forward):
            wrapped = nn.Module()
            wrapped.norm, wrapped.fn = nn.LayerNorm(WIDTH), inner
            pair.append(wrapped)
        self.pair = nn.ModuleList(pair)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        attention, feed = self.pair
        q, k, v = (
            part.reshape(*x.shape[:2], WIDTH // 64, 64).permute(0, 2, 1, 3)
            for part in attention.fn.to_qkv(attention.norm(x)).chunk(3, dim=-1)
        )
        mixed = torch.softmax(torch.einsum("bhid,bhjd->bhij", q, k) / 8.0, dim=-1) @ v
        x = x + attention.fn.to_out(mixed.permute(0, 2, 1, 3).reshape(x.shape))
        return x + feed.fn.net(feed.norm(x))


class _PointBert(nn.Module):
    """OpenShape's point encoder, narrower, after its patches are made."""

    def __init__(self) -> None:
        super().__init__()
        channels = (9, 8, 8, 16)
        self.ppat = nn.Module()
        self.ppat.sa = nn.Module()
        pairs = list(itertools.pairwise(channels))
        self.ppat.sa.mlp_convs = nn.ModuleList(nn.Conv2d(a, b, 1) for a, b in pairs)
        self.ppat.sa.mlp_bns = nn.ModuleList(nn.BatchNorm2d(b) for _, b in pairs)
        self.ppat.lift = nn.Sequential(nn.Conv1d(19, WIDTH, 1), nn.Identity(), nn.LayerNorm([WIDTH]))
        self.ppat.cls_token = nn.Parameter(torch.zeros(WIDTH))
        self.ppat.transformer = nn.Module()
        self.ppat.transformer.layers = nn.ModuleList(_Mixing().pair for _ in range(2))
        self.proj = nn.Linear(WIDTH, 1280)

    def forward(self, centres: torch.Tensor, patches: torch.Tensor) -> torch.Tensor:
        x = patches.permute(0, 3, 2, 1)
        for convolution, norm in zip(self.ppat.sa.mlp_convs, self.ppat.sa.mlp_bns, strict=True):
            x = torch.relu(norm(convolution(x)))
        x = self.ppat.lift[0](torch.cat([centres.permute(0, 2, 1), x.max(dim=2).values], dim=1))
        x = self.ppat.lift[2](x.permute(0, 2, 1))
        x = torch.cat([self.ppat.cls_token.expand(len(x), 1, -1), x], dim=1)
        for pair in self.ppat.transformer.layers:
            block = _Mixing()
            block.pair = pair
            x = block.eval()(x)
        return self.proj(x[:, 0])


def test_openshapes_point_encoder_is_rebuilt_from_a_checkpoint(tmp_path: Path, rng: np.random.Generator) -> None:
    encoder = _shaken(_PointBert())
    torch.save({"state_dict": {f"module.{k}": v for k, v in encoder.state_dict().items()}}, tmp_path / "own.pt")
    convert_openshape.main([str(tmp_path / "own.pt"), "-o", str(tmp_path / "made")])
    store = installed(tmp_path, "openshape")
    facade = OpenShape(store.path(network("openshape"), "points.onnx"), pool=SessionPool())
    points, colours = rng.normal(size=(1500, 3)), rng.random((1500, 3))
    with torch.no_grad():
        expected = encoder(*(torch.from_numpy(part[None]) for part in patches_of(points, colours)))[0].numpy()
    np.testing.assert_allclose(facade.shape(points, colours), expected / np.linalg.norm(expected), atol=1e-4)


def test_openclip_is_converted_from_a_folder_with_its_weights_beside_the_graphs(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    model, *_ = tiny_networks.clip(tmp_path, network_stages.OPENCLIP_WIDTHS["openclip-bigg14"])
    model.save_pretrained(tmp_path / "own")
    tiny_networks.clip_tokenizer(tmp_path / "own" / "tokenizer.json")
    convert_openclip.main([str(tmp_path / "own"), "-o", str(tmp_path / "made")])
    written = sorted(p.name for p in (tmp_path / "made" / "openclip-bigg14" / "visual").iterdir())
    assert written == ["model.onnx", "model.onnx_data"]
    store = installed(tmp_path, "openclip-bigg14")
    facade = network_stages.open_clip(store, network("openclip-bigg14"))
    picture = rng.integers(0, 255, (300, 240, 3)).astype(np.uint8)
    with torch.no_grad():
        seen = tiny_networks.clip_image(model, torch.from_numpy(clip_pixels(picture)))
        ids = torch.zeros(1, 77, dtype=torch.long)
        ids[0, :6] = torch.tensor([30, 2, 3, 4, 5, 31])
        read = tiny_networks.clip_text(model, ids)
    for found, expected in ((facade.images([picture]), seen), (facade.texts(["a photo of chair"]), read)):
        np.testing.assert_allclose(found, nn.functional.normalize(expected, dim=1).numpy(), atol=5e-3)


class _Residual(nn.Module):
    def __init__(self, before: int, after: int, stride: int) -> None:
        super().__init__()
        self.conv1 = nn.Conv2d(before, after, 3, stride=stride, padding=1, bias=False)
        self.conv2 = nn.Conv2d(after, after, 3, padding=1, bias=False)
        self.bn1, self.bn2 = nn.BatchNorm2d(after), nn.BatchNorm2d(after)
        shortcut = nn.Sequential(nn.Conv2d(before, after, 1, stride=stride, bias=False), nn.BatchNorm2d(after))
        self.downsample = None if stride == 1 else shortcut

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        y = self.bn2(self.conv2(torch.relu(self.bn1(self.conv1(x)))))
        return torch.relu(y + (x if self.downsample is None else self.downsample(x)))


class _Backbone(nn.Module):
    """GigaPose's residual network, narrower."""

    def __init__(self) -> None:
        super().__init__()
        self.conv1, self.bn1 = nn.Conv2d(3, 8, 7, stride=2, padding=3, bias=False), nn.BatchNorm2d(8)
        sizes = ((8, 8, 1), (8, 12, 2), (12, 16, 2), (16, 24, 2))
        for index, (before, after, stride) in enumerate(sizes, start=1):
            blocks = _Residual(before, after, stride), _Residual(after, after, 1)
            setattr(self, f"layer{index}", nn.Sequential(*blocks))
        self.layer4_outconv = nn.Conv2d(24, 6, 1, bias=False)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        x = nn.functional.interpolate(x, (256, 256), mode="bilinear", align_corners=True)
        x = torch.relu(self.bn1(self.conv1(x)))
        return self.layer4_outconv(self.layer4(self.layer3(self.layer2(self.layer1(x)))))


class _Regressor(nn.Module):
    def __init__(self) -> None:
        super().__init__()

        def layers(out: int) -> list[nn.Module]:
            return [nn.Linear(12, 16), nn.ReLU(), nn.Linear(16, 8), nn.ReLU(), nn.Linear(8, out)]

        self.scale_predictor, self.inplane_predictor = nn.Sequential(*layers(1)), nn.Sequential(*layers(2), nn.Tanh())


@pytest.mark.parametrize("prefix", ["ist_net.", ""], ids=["inside both networks", "as published"])
def test_gigaposes_scale_network_is_rebuilt_from_a_checkpoint(
    tmp_path: Path, rng: np.random.Generator, prefix: str
) -> None:
    backbone, regressor = _shaken(_Backbone()), _shaken(_Regressor())
    state = {f"{prefix}backbone.{k}": v for k, v in backbone.state_dict().items()}
    state |= {f"{prefix}regressor.{k}": v for k, v in regressor.state_dict().items()}
    state["ae_net.dinov2.cls_token"] = torch.zeros(1)  # the first network's, which is not taken
    torch.save({"state_dict": state}, tmp_path / "own.ckpt")
    convert_gigapose.main([str(tmp_path / "own.ckpt"), "-o", str(tmp_path / "made")])
    store = installed(tmp_path, "gigapose-scale")
    graphs = (store.path(network("gigapose-scale"), name) for name in ("features.onnx", "regressor.onnx"))
    facade = GigaPoseScale(*graphs, pool=SessionPool())
    crops = [rng.integers(0, 255, (224, 224, 3)).astype(np.uint8) for _ in range(2)]
    mean, std = np.array([0.48145466, 0.4578275, 0.40821073]), np.array([0.26862954, 0.26130258, 0.27577711])
    pixels = torch.from_numpy(np.stack([((c / 255 - mean) / std).transpose(2, 0, 1) for c in crops])).float()
    template, photo = facade.maps(crops)
    with torch.no_grad():
        expected = backbone(pixels)
        np.testing.assert_allclose(np.stack([template, photo]), expected.numpy(), atol=1e-4)
        pairs = torch.cat([expected[1, :, 8, 7], expected[0, :, 4, 3]])[None]
        scale, turn = regressor.scale_predictor(pairs)[0, 0], regressor.inplane_predictor(pairs)[0]
    cells, others = np.array([[3, 4]]), np.array([[7, 8]])
    found = facade.turns(template, photo, cells, others)
    assert len(facade.turns(template, photo, cells[:0], others[:0]).scale) == 0
    assert found.scale[0] == pytest.approx(float(scale), abs=1e-4)
    assert found.angle_rad[0] == pytest.approx(float(torch.atan2(turn[1], turn[0])), abs=1e-4)


@pytest.mark.parametrize("script", ["convert_duoduoclip", "convert_gigapose", "convert_openshape"])
@pytest.mark.parametrize("damage", ["absent", "no checkpoint", "another network"])
def test_checkpoints_that_cannot_be_used_are_one_clear_line(tmp_path: Path, script: str, damage: str) -> None:
    path = tmp_path / "own.ckpt"
    if damage == "no checkpoint":
        path.write_bytes(b"<html>sign in</html>")
    elif damage == "another network":
        torch.save({"state_dict": {"layer.weight": torch.zeros(2)}}, path)
    with pytest.raises(SystemExit) as error:
        import_module(f"scripts.{script}").main([str(path), "-o", str(tmp_path / "made")])
    assert len(str(error.value.code).splitlines()) == 1
    assert not (tmp_path / "made").exists()
