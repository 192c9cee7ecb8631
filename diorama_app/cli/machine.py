"""Checks of what Diorama needs on this machine, and `diorama doctor`: can this machine run Diorama?"""

from __future__ import annotations

import argparse
import importlib
import importlib.metadata
import json
import os
import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import diorama_core as diorama
from diorama_app.cli.arguments import command
from diorama_core.io.large_libraries import o3d

PACKAGES = {
    "viser": "viser",
    "trimesh": "trimesh",
    "open3d": "open3d",
    "torch": "torch",
    "onnxruntime": "onnxruntime",
    "opencv-python-headless": "cv2",
    "python-fcl": "fcl",
    "numpy": "numpy",
    "scipy": "scipy",
    "scikit-learn": "sklearn",
    "manifold3d": "manifold3d",
}
OPTIONAL_PACKAGES = {"mujoco": "mujoco"}


@dataclass(frozen=True)
class Finding:
    """The result of one check."""

    name: str
    ok: bool
    detail: str
    needed: bool = True


def examine() -> tuple[Finding, ...]:
    """Check everything Diorama depends on, in the order in which to fix it."""
    version = ".".join(map(str, sys.version_info[:3]))
    return (
        Finding("python", sys.version_info >= (3, 11), f"{version} (3.11 or later)"),
        *(_package(name, module, needed=True) for name, module in PACKAGES.items()),
        *(_package(name, module, needed=False) for name, module in OPTIONAL_PACKAGES.items()),
        _library(),
        _cache(),
        _cores(),
        _accelerator(),
        _browser(),
    )


def _package(name: str, module: str, *, needed: bool) -> Finding:
    try:
        if module == "open3d":  # as the program loads it, without its plots; there are several packages of it
            return Finding(name, True, str(o3d.__version__), needed)
        importlib.import_module(module)
    except (ImportError, OSError) as error:
        hint = " (run: sudo apt-get install -y libusb-1.0-0 libgl1)" if name == "open3d" else ""
        return Finding(name, False, f"does not load: {error}{hint}", needed)
    return Finding(name, True, importlib.metadata.version(name), needed)


def _library() -> Finding:

    shapes = diorama.open_library().shapes()
    return Finding(
        "shape library", bool(shapes), f"{len(shapes)} shapes, {len({s.category for s in shapes})} categories"
    )


def _cache() -> Finding:
    from diorama_core.library.catalogue import default_cache_dir

    folder = default_cache_dir()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        return Finding(
            "cache folder", False, f"{folder}: {error.strerror}; set DIORAMA_CACHE to a folder you may write to"
        )
    return Finding("cache folder", True, f"{folder}, {shutil.disk_usage(folder).free / 1e9:.0f} GB free")


def _cores() -> Finding:
    memory = Path("/proc/meminfo")
    total = f", {int(memory.read_text().split()[1]) / 1e6:.0f} GB memory" if memory.exists() else ""
    return Finding("processor", True, f"{os.cpu_count()} cores{total}")


def _accelerator() -> Finding:
    """What onnxruntime, which runs the networks, can use; torch only lays out scenes."""
    from diorama_core.io.large_libraries import load_onnxruntime
    from diorama_core.models.runtime import ACCELERATORS

    onnxruntime = load_onnxruntime()

    offered = [ACCELERATORS[p] for p in onnxruntime.get_available_providers() if p in ACCELERATORS]
    if offered:
        return Finding("accelerator", True, f"{', '.join(offered)} for networks", needed=False)
    card = shutil.which("nvidia-smi")
    hint = "; for NVIDIA cards: pip uninstall onnxruntime && pip install 'diorama[gpu]'" if card else "; optional"
    return Finding("accelerator", False, f"networks run on the processor{hint}", needed=False)


def _browser() -> Finding:
    names = ("chromium", "chromium-browser", "google-chrome", "firefox")
    path_of_browser = next((path for name in names if (path := shutil.which(name))), None)
    return Finding(
        "browser",
        path_of_browser is not None,
        path_of_browser or "none on this machine; open the page from another",
        needed=False,
    )


def add_doctor(commands: Any) -> None:
    """Declare `diorama doctor`."""
    p = command(commands, "doctor", _doctor, "diorama doctor")
    p.add_argument("--json", action="store_true", help="print the findings as JSON")


def _doctor(a: argparse.Namespace) -> int:
    """Check that this machine can run Diorama."""

    findings = examine()
    if a.json:
        print(json.dumps([finding.__dict__ for finding in findings]))
    else:
        for finding in findings:
            mark = "ok  " if finding.ok else "FAIL" if finding.needed else "none"
            print(f"{mark}  {finding.name:<22} {finding.detail}")
    broken = [finding.name for finding in findings if finding.needed and not finding.ok]
    if broken:
        print(f"diorama: this machine lacks {', '.join(broken)}; see the lines above", file=sys.stderr)
    return 1 if broken else 0
