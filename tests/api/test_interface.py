"""The names that `import diorama_core as diorama` promises."""

from __future__ import annotations

import inspect
import subprocess
import sys

import pytest

import diorama_core as diorama

HEAVY = ("numpy", "scipy", "trimesh", "PIL", "pydantic", "torch", "open3d", "onnxruntime", "cv2", "sklearn", "openai")


def test_importing_the_package_loads_nothing_heavy() -> None:
    code = f"import sys, diorama_core; print(*[m for m in {HEAVY!r} if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split() == []


def test_there_are_under_a_dozen_public_names_and_each_is_documented() -> None:
    assert len(diorama.__all__) < 12
    assert set(diorama.__all__) <= set(dir(diorama))
    for name in diorama.__all__:
        assert inspect.getdoc(getattr(diorama, name)), name


@pytest.mark.parametrize("function", [diorama.build, diorama.optimise, diorama.export, diorama.render, diorama.load])
def test_every_argument_is_documented(function: object) -> None:
    assert callable(function)
    documented = inspect.getdoc(function) or ""
    for argument in inspect.signature(function).parameters:
        assert f"\n    {argument}: " in documented, argument


def test_modules_do_not_replace_the_functions_that_share_their_package_s_name() -> None:
    code = "\n".join(
        f"import {module}, diorama_core as d; from {module} import __doc__; print(callable(d.{module.split('.')[1]}))"
        for module in ("diorama_core.export.gltf", "diorama_core.render.picture")
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True\nTrue\n"


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'reconstruct'"):
        diorama.reconstruct  # noqa: B018
