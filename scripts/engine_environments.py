"""Environments of the engines: of Python one each, so that none asks another for an older package, of node likewise."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

PACKAGES = {
    "mujoco": ("mujoco", "pillow"),
    "pybullet": ("pybullet", "numpy", "pillow"),
    "sapien": ("sapien", "numpy", "setuptools<81"),
    "drake": ("drake",),
    "newton": ("newton[sim,importers]",),
    "Blender": ("bpy==5.0.1",),
    "three.js": ("three",),
    "Babylon.js": ("babylonjs", "babylonjs-loaders"),
}
"""What pip installs for each, or npm for those of JavaScript. Blender's is that of `diorama_core.export.blender`."""


def environment(folder: Path, engine: str) -> Path:
    """The folder of an engine."""
    return folder / engine.lower().replace(".", "")


def python_of(folder: Path, engine: str) -> Path:
    """The Python that has an engine, whether or not it is there."""
    return environment(folder, engine) / "bin" / "python"


def make(folder: Path, engines: Iterable[str]) -> None:
    """Makes the environments that are missing; one that cannot be made leaves nothing, and says why.

    Args:
        folder: That they lie in.
        engines: Names; those that need no environment are passed over.
    """
    for engine in engines:
        if engine not in PACKAGES or environment(folder, engine).exists():
            continue
        print(f"installing {', '.join(PACKAGES[engine])}", file=sys.stderr, flush=True)
        try:
            _install(environment(folder, engine), engine)
        except (OSError, subprocess.CalledProcessError) as error:
            said = getattr(error, "stderr", "") or str(error)
            print(f"{engine} cannot be installed: {said.strip().splitlines()[-1]}", file=sys.stderr)
            shutil.rmtree(environment(folder, engine), ignore_errors=True)


def _install(where: Path, engine: str) -> None:
    if engine.endswith(".js"):
        commands = [["npm", "install", "--silent", "--prefix", str(where), *PACKAGES[engine]]]
    else:
        pip = [str(where / "bin" / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        commands = [[sys.executable, "-m", "venv", str(where)], [*pip, *PACKAGES[engine]]]
    for command in commands:
        subprocess.run(command, capture_output=True, text=True, check=True)
