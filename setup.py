"""Puts `assets` into the package when a wheel is built; all else about the package is in `pyproject.toml`."""

from __future__ import annotations

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py


class BuildWithAssets(build_py):
    """Builds the package, then copies the assets to where `diorama_core.io.assets` looks for them first."""

    def run(self) -> None:
        """Does nothing more for an editable installation: it reads the assets of the checkout."""
        super().run()
        if not self.editable_mode:
            shutil.copytree("assets", Path(self.build_lib) / "diorama_core" / "assets", dirs_exist_ok=True)


setup(cmdclass={"build_py": BuildWithAssets})
