"""Wall elevations: what is drawn at which wall, what is measured, and the three formats."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import ExportError
from diorama_core.export import export_scene
from diorama_core.export.drawings import write_elevations
from diorama_core.export.elevations import elevations
from diorama_core.export.gathering import gather
from diorama_core.scene.types import Pose, Scene, SceneObject, Support
from tests.export.test_plan import LIBRARY, room_with_door_and_window

SCENE = room_with_door_and_window()
"""A room of 4 x 5 x 2.6 m, its door in the wall at the back, its window in the one at the left."""


def test_a_wall_shows_its_openings_and_what_is_at_it() -> None:
    size = LIBRARY.shape("print").size_m
    picture = SceneObject("p", "picture", "picture", "print", size, Pose.upright((-0.5, 4.99, 1.6), -np.pi / 2))
    far = replace(picture, id="far", pose=Pose.upright((-0.5, 3.0, 1.6), -np.pi / 2))
    scene = replace(
        SCENE,
        objects=(*SCENE.objects, picture, far),
        supports=(*SCENE.supports, Support("p", "back", "mounted on")),
    )
    by_name = {frozenset(p.label for p in e.pieces): e for e in elevations(gather(scene, LIBRARY))}
    drawn = next(e for labels, e in by_name.items() if "door" in labels)
    door, hung = drawn.pieces[0], next(p for p in drawn.pieces if p.id == "p")
    assert "far" not in {p.id for p in drawn.pieces}
    (outline,) = door.outlines
    # Seen from inside, the wall at the back runs from x = -2 at the left to 2 at the right.
    np.testing.assert_allclose([outline.min(axis=0), outline.max(axis=0)], [[2.56, 0.01], [3.44, 1.99]], atol=0.02)
    assert hung.extent_m == pytest.approx((size[1], size[2]))
    np.testing.assert_allclose(np.concatenate(hung.outlines).mean(axis=0), [1.5, 1.6], atol=0.02)
    lengths = {d.text for d in drawn.dimensions}
    assert {"4.00", "2.60", f"{door.extent_m[0]:.2f}", f"{size[1]:.2f}"} <= lengths
    placed = np.array([d.start + d.offset for d in drawn.dimensions])
    assert ((placed < 0.0) | (placed > [4.0, 2.6])).any(axis=1).all(), "lengths stand outside the wall"


def test_each_format_has_every_wall(tmp_path: Path) -> None:
    pytest.importorskip("reportlab", reason="needs the extra [plan]")
    ezdxf = pytest.importorskip("ezdxf", reason="needs the extra [plan]")
    for ending in ("svg", "pdf", "dxf"):
        export_scene(SCENE, LIBRARY, tmp_path / f"walls.{ending}", "elevations", name="hall")
    names = {f"hall, wall {k}" for k in range(1, 5)}
    pages = [e for e in ET.parse(tmp_path / "walls.svg").getroot() if e.tag.endswith("svg")]
    assert {e.findtext("{*}title") for e in pages} == names
    assert (tmp_path / "walls.pdf").read_bytes().count(b"/Type /Page\n") == 4
    document = ezdxf.readfile(tmp_path / "walls.dxf")
    assert document.audit().errors == []
    assert names <= {t.dxf.text for t in document.modelspace().query("TEXT")}


def test_a_scene_without_walls_has_none(tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="no walls"):
        write_elevations(gather(Scene(), LIBRARY), tmp_path / "walls.svg")
