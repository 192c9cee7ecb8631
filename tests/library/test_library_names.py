"""Names of libraries, which the page asks for before anything is loaded."""

from __future__ import annotations

import subprocess
import sys

from diorama_core.library.library_names import BUILT_IN, ESCAPED_PLUS


def test_names_need_no_meshes() -> None:
    code = "import sys; import diorama_core.library.library_names; print('trimesh' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "False\n"


def test_an_escaped_plus_joins_nothing() -> None:
    assert "+" not in ESCAPED_PLUS + BUILT_IN
