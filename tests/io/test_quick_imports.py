"""SciPy loads without rewriting its documentation, and works."""

from __future__ import annotations

import subprocess
import sys

from diorama_core.io.quick_imports import GARBAGE_EVERY

SCRIPT = """
import gc
from diorama_core.io.quick_imports import load_quickly
load_quickly()
import numpy as np
from scipy import ndimage, optimize, special, spatial
root = optimize.brentq(lambda x: x * x - 2.0, 0.0, 2.0)
print(gc.get_threshold()[0], "SCIPY_ARRAY_API" in special.logsumexp.__doc__, round(root**2, 6))
print(special.expit(0.0), ndimage.gaussian_filter(np.ones(5), 1.0).sum().round(6))
"""


def test_scipy_works_with_its_own_documentation() -> None:
    run = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True, timeout=120)
    assert run.stdout.split() == [str(GARBAGE_EVERY), "False", "2.0", "0.5", "5.0"]
