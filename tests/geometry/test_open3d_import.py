"""Open3D loads without its plots, which load when they are called."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
import sys
import numpy as np
from diorama_core.geometry.open3d_import import o3d
print("dash" in sys.modules or "IPython" in sys.modules, "open3d.visualization.draw_plotly" in sys.modules)
cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(np.eye(3)))
print(type(o3d.visualization.get_plotly_fig([cloud])).__name__, "dash" in sys.modules)
"""


def test_plots_load_on_call() -> None:
    run = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True, timeout=120)
    assert run.stdout.split() == ["False", "False", "Figure", "True"]
