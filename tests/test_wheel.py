"""A wheel is complete: it has every file of the packages and the assets, and runs without the checkout."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.posix
ROOT = Path(__file__).resolve().parents[1]
PLACE_OF = {"diorama_core": "diorama_core", "diorama_app": "diorama_app", "assets": "diorama_core/assets"}
"""Where the folders of the checkout are within a wheel."""
SHOWS_ASSETS = """
from diorama_app.panels.start_page import PICTURES
from diorama_app.projects.example import EXAMPLE
from diorama_core.layout.problem.parts import BUILT_IN_PARTS
from diorama_core.io.assets import FOLDER, has_own_recogniser

assert has_own_recogniser() and EXAMPLE.is_dir() and PICTURES.is_dir() and BUILT_IN_PARTS.is_file()
print(FOLDER)
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder, copy = tmp_path_factory.mktemp("wheel"), tmp_path_factory.mktemp("checkout")
    for name in ("pyproject.toml", "setup.py", "MANIFEST.in", "README.md", "LICENSE", *PLACE_OF):
        (copy / name).symlink_to(ROOT / name)
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", str(copy)]
    subprocess.run([*command, "--wheel-dir", str(folder)], check=True, cwd=folder)
    return next(folder.glob("*.whl"))


def test_it_has_every_file_of_the_packages_and_the_assets(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    files = {
        f"{place}/{path.relative_to(ROOT / folder).as_posix()}"
        for folder, place in PLACE_OF.items()
        for path in (ROOT / folder).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert len(files) > 1000
    assert files - names == set()


def test_it_runs_without_the_checkout(wheel: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
    run = [sys.executable, "-c", SHOWS_ASSETS]
    environment = {"PYTHONPATH": str(tmp_path / "site"), "PATH": ""}
    said = subprocess.run(run, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True).stdout
    assert Path(said.strip()) == tmp_path / "site" / "diorama_core" / "assets" / "models"
