"""The editor in a notebook's cell, and a notebook that is run with it."""

from __future__ import annotations

import re
import urllib.request
from pathlib import Path

import pytest

import diorama_core as diorama
from diorama_app.notebook import EditorCell, show
from diorama_core.api import Reconstruction
from diorama_core.errors import InputError
from diorama_core.scene import edits
from tests.app.small_room import PlainLibrary, furnished_scene, make_project


def room(folder: Path) -> Reconstruction:
    return diorama.load(make_project(folder).folder, library=PlainLibrary())


def address_in(cell: EditorCell) -> str:
    (address,) = re.findall(r'<iframe src="([^"]+)"', cell._repr_html_())
    return address


def test_a_cell_shows_an_editor_that_its_origins_may_frame(tmp_path: Path) -> None:
    cell = show(room(tmp_path / "demo"), origins=("http://localhost:9999",), height_px=500)
    try:
        assert 'height="500"' in cell._repr_html_()
        with urllib.request.urlopen(address_in(cell), timeout=60) as reply:
            assert reply.headers["Content-Security-Policy"].endswith("frame-ancestors 'self' http://localhost:9999")
            assert "X-Frame-Options" not in reply.headers
        session = cell.running.session
        session.ui_thread.post(lambda: session.edit("remove", lambda s: edits.remove(s, ("lamp_1",))))
        assert session.ui_thread.wait()
        assert len(cell.room().scene.objects) == 4
    finally:
        cell.stop()
    assert cell.running.stopped.is_set()


def test_a_cell_that_runs_again_takes_the_place_of_its_earlier_editor(tmp_path: Path) -> None:
    given = Reconstruction(furnished_scene(), PlainLibrary(), {})
    earlier = show(given, tmp_path / "demo")
    cell = show(given, tmp_path / "demo")
    try:
        assert earlier.running.stopped.is_set()
        assert cell.running.session.read_only == ""
    finally:
        cell.stop()


def test_a_room_without_a_folder_is_asked_for_one() -> None:
    with pytest.raises(InputError, match=r"show\(room, 'my-room'\)"):
        show(Reconstruction(furnished_scene(), PlainLibrary(), {}))


CELL = """
from diorama_app.notebook import show
from tests.app.test_notebook import Path, room
shown = show(room(Path({folder!r})))
shown
"""


@pytest.mark.slow
def test_a_notebook_that_is_run_shows_the_editor(tmp_path: Path) -> None:
    nbclient = pytest.importorskip("nbclient", reason="needs nbclient (extra 'dev')")
    pytest.importorskip("ipykernel", reason="needs ipykernel (extra 'dev')")
    import nbformat

    codes = (CELL.format(folder=str(tmp_path / "demo")), "len(shown.room().scene.objects)", "shown.stop()")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code) for code in codes])
    root = Path(__file__).resolve().parents[2]
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(root)}}).execute()
    page = notebook.cells[0].outputs[-1]["data"]["text/html"]
    assert page.startswith('<iframe src="http://127.0.0.1:')
    assert notebook.cells[1].outputs[-1]["data"]["text/plain"] == "5"
