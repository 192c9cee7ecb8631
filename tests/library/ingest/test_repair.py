"""Materials of model files as physically based ones."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_core.errors import LibraryError
from diorama_core.export.colliders import body_of
from diorama_core.library.ingest.correct import correct
from diorama_core.library.ingest.given import Given
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.models import read_model
from diorama_core.library.ingest.repair import notes_of_node, repair
from diorama_core.library.ingest.shaping import ModelSource, ingest_file
from diorama_core.library.opening import articulation_of, can_open, open_parts
from diorama_core.library.part_notes import KEY, PartNotes, notes_of
from diorama_core.library.store import StoredLibrary
from diorama_core.library.stretch import stretch_parts
from diorama_core.scene.types import Architecture, Pose, Scene, SceneObject, Support
from tests.app.small_room import room_planes
from tests.library.ingest.models import known_shapes, table

PAGE = Path(__file__).parents[3] / "docs" / "adding.md"
(EXAMPLE,) = re.findall(
    r"^```python\n((?:(?!^```).)*def cabinet.*?)^```$", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL
)


@pytest.mark.parametrize(
    ("entries", "metallic", "roughness"),
    [
        ("", 0.0, None),
        ("Pm 0.0\nPr 0.55\n", 0.0, 0.55),
        ("Pm 1.0\nPr 0.2\n", 1.0, 0.2),
        ("Pm nan\nPr 7\n", 0.0, 1.0),
        ("Pm\n", 0.0, None),
    ],
)
def test_a_material_of_an_obj_is_metal_only_where_it_says_so(
    tmp_path: Path, entries: str, metallic: float, roughness: float | None
) -> None:
    (tmp_path / "box.mtl").write_text(f"newmtl wood\nKd 0.6 0.4 0.2\nKs 0.5 0.5 0.5\nNs 200\n{entries}")
    text = trimesh.creation.box().export(file_type="obj", header=None)
    (tmp_path / "box.obj").write_text(f"mtllib box.mtl\nusemtl wood\n{text}")
    made = repair(read_model(tmp_path / "box.obj", tmp_path).scene, DEFAULT_LIMITS)
    (mesh,) = made.meshes
    assert mesh.visual.material.metallicFactor == metallic
    if roughness is not None:
        assert mesh.visual.material.roughnessFactor == roughness


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> StoredLibrary:
    folder, names = tmp_path_factory.mktemp("cabinet"), dict[str, object]()
    exec(EXAMPLE, names)
    names["cabinet"]().export(folder / "cabinet.glb")
    source = ModelSource(folder / "cabinet.glb", folder, "cabinet", "key", Given(category="cabinet", front="+z"))
    taken = ingest_file(source, known_shapes(("table", table())))
    assert not [line for line in taken.warnings if "left out" in line]
    stored = StoredLibrary(folder / "library", create=True)
    stored.add(taken)
    return stored


def bounds_of(parts: trimesh.Scene, word: str) -> np.ndarray:
    """Bounds of the meshes with a word in their names, or in their roles."""
    meshes = [m for n, m in parts.geometry.items() if word in n or (notes_of(m) or PartNotes()).role == word]
    return np.stack([np.min([m.bounds[0] for m in meshes], axis=0), np.max([m.bounds[1] for m in meshes], axis=0)])


def test_the_example_opens_about_its_hinge(library: StoredLibrary) -> None:
    assert can_open(library, "cabinet")
    (joint,) = articulation_of(library, "cabinet").joints
    assert (joint.name, joint.kind, joint.upper) == ("door", "hinge", pytest.approx(np.radians(110.0)))
    np.testing.assert_allclose(joint.origin, (0.18, -0.4, 0.1), atol=1e-6)
    closed, opened = (bounds_of(open_parts(library, "cabinet", share), "door") for share in (0.0, 1.0))
    np.testing.assert_allclose(closed, [[0.18, -0.4, -0.3], [0.2, 0.4, 0.5]], atol=1e-6)
    assert opened[1, 0] > 0.18 + 0.8 * np.sin(np.radians(70.0)), "the leaf stands out into the room"
    np.testing.assert_allclose(opened[:, 2], closed[:, 2], atol=1e-6)


def test_exports_have_the_joint_and_bodies_of_both_parts(library: StoredLibrary) -> None:
    item = SceneObject("cabinet_1", "cabinet", "cabinet", "cabinet", (0.4, 0.8, 1.0), Pose.upright((0, 2, 0.5), 0.0))
    scene = Scene(None, Architecture(room_planes()), (item,), (Support("cabinet_1", "floor"),))
    body = body_of(scene, library, "cabinet_1")
    (moving,) = body.moving
    assert (moving.limb.name, moving.limb.kind) == ("door", "hinge")
    corners = np.concatenate(moving.parts)
    np.testing.assert_allclose(np.ptp(corners, axis=0), (0.02, 0.8, 0.8), atol=0.01)


def test_legs_keep_their_thickness(library: StoredLibrary) -> None:
    parts, scale = library.parts("cabinet"), (1.0, 2.0, 1.0)
    wide = stretch_parts(parts, scale)
    np.testing.assert_allclose(bounds_of(wide, ""), bounds_of(parts, ""), atol=1e-6)
    names = [name for name, mesh in parts.geometry.items() if (notes := notes_of(mesh)) and notes.role == "leg"]
    legs = [body for name in names for body in wide.geometry[name].split(only_watertight=False)]
    assert [float(np.ptp(leg.bounds[:, 1])) * scale[1] for leg in legs] == pytest.approx([0.24] * 4, rel=0.05)


def test_a_corrected_shape_keeps_its_hinge(library: StoredLibrary) -> None:
    turned = correct(library, "cabinet", up="+z", front="+y", scale=2.0)
    assert turned.record.size_m == pytest.approx((1.6, 0.8, 2.0), abs=1e-5)
    other = StoredLibrary(library.folder.parent / "turned", create=True)
    other.add(turned)
    (joint,) = articulation_of(other, "cabinet").joints
    np.testing.assert_allclose(joint.origin, (-0.8, -0.36, 0.2), atol=1e-6)
    assert joint.upper == pytest.approx(np.radians(110.0))


def noted(**extras: object) -> tuple[PartNotes | None, list[str]]:
    """The notes on a node below one that has extras, and the warnings."""
    scene, warnings = trimesh.Scene(), list[str]()
    scene.graph.update("outer", metadata={"role": "case", **extras})
    scene.add_geometry(trimesh.creation.box((1, 1, 1)), node_name="inner", parent_node_name="outer")
    return notes_of_node(scene, "inner", warnings), warnings


@pytest.mark.parametrize(
    ("extras", "sign", "words"),
    [
        ({"joint": "revolute y 10 90"}, False, "0 is within the limits"),
        ({"joint": "revolute w 0 90"}, False, "revolute y 0 110"),
        ({"joint": {"type": "revolute"}}, False, "revolute y 0 110"),
        ({"joint": "prismatic z 0 nan"}, False, "prismatic z 0 0.4"),
        ({"joint": "prismatic z 0 0.4"}, True, ""),
        ({"joint": "continuous -y"}, True, ""),
        ({"parameter": "length"}, False, "rigid"),
        ({"parameter": "width, height"}, False, ""),
    ],
)
def test_what_cannot_be_read_is_one_line(extras: dict[str, object], sign: bool, words: str) -> None:
    notes, warnings = noted(**extras)
    assert notes is not None
    assert (notes.role, notes.joint is not None) == ("case", sign)
    assert len(warnings) == (1 if words else 0)
    assert all(words in line and "\n" not in line for line in warnings)
    assert (notes.stretches == (False, True, True)) == (extras == {"parameter": "width, height"})


def test_damaged_notes_of_a_library_are_one_line() -> None:
    mesh = trimesh.creation.box((1, 1, 1))
    for damaged in (7, {}, {"role": "", "joint": {"kind": "hinge"}, "stretches": None}, {"role": 1, "joint": None}):
        mesh.metadata[KEY] = damaged
        with pytest.raises(LibraryError, match="add the shape to its library again"):
            notes_of(mesh)
