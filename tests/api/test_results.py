"""Rooms optimised, drawn and exported as a script does it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

import diorama_core as diorama
from diorama_core.errors import ExportError, InputError


def test_optimising_reports_costs_and_leaves_the_original(room: diorama.Reconstruction) -> None:
    before = room.scene
    optimised = diorama.optimise(room, recipe="feasible")
    assert optimised.layout is not None
    assert optimised.layout.after["overlapping_pairs"] == 0
    assert dict(optimised.scene.metrics) == pytest.approx(optimised.layout.after)
    assert room.scene is before
    with pytest.raises(InputError, match="feasible, paper, all-in-one"):
        diorama.optimise(room, recipe="magic")


def test_export_takes_the_format_from_the_name(room: diorama.Reconstruction, tmp_path: Path) -> None:
    diorama.export(room, tmp_path / "room.GLB")
    diorama.export(room, tmp_path / "room.xml")
    assert "<mujoco" in (tmp_path / "room.xml").read_text()
    assert len(trimesh.load_scene(tmp_path / "room.GLB", file_type="glb").geometry) >= len(room.scene.objects)
    with pytest.raises(ExportError, match=r"files end in \.stl"):
        diorama.export(room, tmp_path / "room.glb", format="stl")
    with pytest.raises(ExportError, match="choose one of: glb"):
        diorama.export(room, tmp_path / "room.doc")


@pytest.mark.parametrize("view", ["photo", "planes", "top"])
def test_render_draws_a_picture_of_the_asked_size(room: diorama.Reconstruction, view: str) -> None:
    picture = diorama.render(room, view=view, size=(160, 120))
    assert picture.shape == (120, 160, 3)
    assert picture.dtype == np.uint8
    assert picture.std() > 5


def test_planes_need_a_photo(room: diorama.Reconstruction) -> None:
    with pytest.raises(InputError, match="no photo"):
        diorama.render(replace(room, given=None), view="planes")
