"""The table of formats, and files that are whole or not there."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from diorama_core.errors import Cancelled, ExportError, UnavailableError
from diorama_core.export import FORMATS, export_scene, format_named
from diorama_core.export.files import companion_folder, whole_file, write_package
from diorama_core.export.gathering import gather
from diorama_core.scene.types import Scene
from tests.export.scenes import stopping_at
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()


BEFORE_WRITING = [(name, chosen.suffixes[0], 0.5) for name, chosen in FORMATS.items()]
IN_THE_MIDST = [
    *(("svg", ".svg", 0.54), ("pdf", ".pdf", 0.54), ("dxf", ".dxf", 0.54)),
    *(("obj", ".obj", 0.75), ("obj", ".zip", 0.75), ("ply", ".ply", 0.75), ("stl", ".stl", 0.75)),
]


@pytest.mark.parametrize(("name", "suffix", "fraction"), [*BEFORE_WRITING, *IN_THE_MIDST])
def test_cancelling_leaves_the_older_file(name: str, suffix: str, fraction: float, tmp_path: Path) -> None:
    if FORMATS[name].missing:
        pytest.skip(FORMATS[name].missing)
    path = tmp_path / f"room{suffix}"
    path.write_bytes(b"old")
    with pytest.raises(Cancelled):
        export_scene(furnished_room(LIBRARY), LIBRARY, path, name, progress=stopping_at(fraction))
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("name", ["glb", "obj", "ply", "stl"])
def test_a_folder_that_cannot_be_written_is_one_clear_line(name: str, tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    for folder in (tmp_path / "missing", blocked):
        with pytest.raises(ExportError, match="cannot write") as caught:
            export_scene(Scene(), LIBRARY, folder / f"room{FORMATS[name].suffixes[0]}", name)
        assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == [blocked]


@pytest.mark.parametrize(("name", "suffix"), [(n, s) for n, f in FORMATS.items() for s in f.suffixes])
def test_a_full_disk_is_one_clear_line_and_leaves_what_was_there(name: str, suffix: str, tmp_path: Path) -> None:
    """No file may grow as large as it must, which fails in the midst of writing as a full disk does."""
    resource = pytest.importorskip("resource", reason="limits of processes are POSIX")
    if FORMATS[name].missing:
        pytest.skip(FORMATS[name].missing)
    path = tmp_path / f"room{suffix}"
    export_scene(furnished_room(LIBRARY), LIBRARY, path, name)
    before = contents(tmp_path)
    assert len(before[Path(path.name)]) > 100
    assert not [p for p in before if p.name.startswith(".")]
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (max(map(len, before.values())) * 2 // 3, hard))
    try:
        with pytest.raises(ExportError, match="cannot write") as error:
            export_scene(furnished_room(LIBRARY), LIBRARY, path, name)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert "\n" not in str(error.value)
    assert contents(tmp_path) == before


def contents(folder: Path) -> dict[Path, bytes]:
    return {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_unknown_formats_and_endings_are_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="choose one of: glb"):
        format_named("docx")
    with pytest.raises(ExportError, match=r"end in \.glb"):
        export_scene(furnished_room(LIBRARY), LIBRARY, tmp_path / "room.obj", "glb")
    assert not list(tmp_path.iterdir())


def test_a_missing_library_is_named_with_its_remedy() -> None:
    absent = replace(FORMATS["usdz"], needs="no_such_module")
    with pytest.raises(UnavailableError, match=r"pip install 'diorama\[usd\]'"):
        absent.writer()


def test_listing_the_formats_loads_no_heavy_library() -> None:
    code = (
        "import sys, diorama_core.export; print([m for m in ('trimesh', 'pxr', 'cv2', 'mujoco') if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_a_failing_writer_leaves_nothing(tmp_path: Path) -> None:
    def fail_half_way() -> None:
        with whole_file(tmp_path / "room.glb") as temporary:
            temporary.write_bytes(b"half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail_half_way()
    assert not list(tmp_path.iterdir())


def test_a_package_beside_keeps_what_else_lies_there(tmp_path: Path) -> None:
    path = tmp_path / "room.urdf"
    folder = companion_folder(path, "urdf")
    (tmp_path / folder).mkdir()
    (tmp_path / folder / "mine.txt").write_text("keep")
    write_package(path, "room.urdf", [(f"{folder}/a/b.obj", b"mesh"), ("room.urdf", b"main")])
    assert path.read_bytes() == b"main"
    assert (tmp_path / folder / "a" / "b.obj").read_bytes() == b"mesh"
    assert (tmp_path / folder / "mine.txt").read_text() == "keep"


def test_what_a_hidden_object_carries_moves_up() -> None:
    scene = furnished_room(LIBRARY)
    hidden = replace(scene, objects=tuple(replace(o, hidden=o.id == "t") for o in scene.objects))
    assert gather(scene, LIBRARY).object("b").parent == "t"
    assert gather(hidden, LIBRARY).object("b").parent is None


def test_equal_materials_are_one_with_a_unique_name() -> None:
    gathered = gather(furnished_room(LIBRARY), LIBRARY)
    names = [m.name for m in gathered.materials]
    assert len(names) == len(set(names))
    used = {id(s.material) for mesh in gathered.meshes.values() for s in mesh.surfaces}
    assert used == {id(m) for m in gathered.materials}
