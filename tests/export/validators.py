"""What independent validators say about exported files."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

_GLTF = Path(__file__).resolve().parents[2] / ".venv" / "node" / "node_modules" / "gltf-validator"
needs_gltf_validator = pytest.mark.skipif(
    shutil.which("node") is None or not _GLTF.is_dir(),
    reason="node or the Khronos validator is missing: npm install --prefix .venv/node gltf-validator",
)


def gltf_findings(*paths: Path) -> list[str]:
    """Errors, warnings, information and hints of the Khronos validator, as one line each."""
    script = Path(__file__).with_name("validate_gltf.js")
    command = ["node", str(script), str(_GLTF), *map(str, paths)]
    lines = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300).stdout.splitlines()
    assert len(lines) == len(paths)
    reports = zip(paths, map(json.loads, lines), strict=True)
    return [f"{p.name}: {m['code']} {m['message']} {m.get('pointer', '')}" for p, found in reports for m in found]


def usd_findings(path: Path) -> list[str]:
    """What all validators of usd-core's registry say about a stage."""
    from pxr import Usd, UsdValidation

    stage = Usd.Stage.Open(str(path))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    return [f"{e.GetName()}: {e.GetMessage()}" for e in errors]
