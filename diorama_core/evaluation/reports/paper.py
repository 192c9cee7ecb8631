"""The paper's own numbers (Diorama, ICCV 2025, and its supplement), to stand beside ours; other dataset throughout."""

from __future__ import annotations

from collections.abc import Mapping

from diorama_core.evaluation.reports.tables import Value

Rows = Mapping[str, tuple[Value, ...]]

SYSTEM: Rows = {
    "ACDC": (0.20, 0.56, 0.36, 0.04, 14.0, None, 23.2 * 60),
    "Diorama": (0.23, 0.68, 0.49, 0.08, 9.5, None, 3.7 * 60),
}
"""rAcc, tAcc, sAcc, Acc, CD, failures, seconds a scene."""

LANGUAGE_MODEL: Rows = {"Diorama, GPT-4o": (2, None, None, 0.12, None)}
"""Calls, tokens, seconds, cost in US dollars and unusable replies of a picture."""

ARCHITECTURE: Rows = {
    "RaC, DAv2": (236 / 344, 40.3, 39.8, 23.2, 0.67, 0.645, 43.0),
    "RaC, M3Dv2": (258 / 344, 45.2, 33.7, 21.0, 1.23, 0.908, 49.0),
    "ACDC, DAv2": (1.0, 46.8, 17.0, 31.0, 1.54, 0.563, 32.0),
    "PlainRecon, DAv2": (1.0, 47.8, 13.3, 27.5, 1.26, 0.503, 23.0),
    "PlainRecon, M3Dv2": (1.0, 58.6, 9.6, 18.9, 1.37, 0.447, 29.0),
}
"""Success, IoU, PE, EE, RMSE, CDb, seconds."""

RETRIEVAL: Rows = {
    "CLIP-H": (8.5, 11.2, 5.1, 8.8, 8.5, 11.3, 7.3, 10.2, 8.2, 11.1, 6.0, 8.9),
    "OS-H": (8.6, 25.3, 4.6, 8.9, 8.1, 22.9, 7.5, 21.3, 8.4, 22.5, 4.6, 19.5),
    "DD-T": (9.4, 12.4, 5.9, 10.9, 9.1, 12.6, 8.3, 11.6, 9.2, 12.3, 6.5, 10.8),
    "DD-V": (6.4, 12.0, 8.9, 12.1, 10.3, 14.3, 4.1, 10.0, 6.9, 12.6, 7.0, 9.1),
    "DD-H (Diorama)": (5.5, 9.9, 3.2, 7.6, 5.7, 9.5, 4.4, 9.4, 5.4, 10.2, 3.0, 6.1),
}
"""Chamfer distance, same source then out of distribution: household, furniture, occluded, complete, supported,
supporting."""

POSE_TRUE_DEPTH: Rows = {
    "ZSP": (0.36, 0.92, 0.59, 0.25, 8.76, 0.60),
    "GigaPose": (0.36, 0.95, 0.71, 0.27, 7.91, 0.61),
    "Diorama": (0.47, 0.95, 0.70, 0.37, 6.42, 0.62),
}
"""rAcc, tAcc, sAcc, Acc, collision, relation."""
POSE_ESTIMATED_DEPTH: Rows = {
    "ZSP": (0.32, 0.88, 0.50, 0.18, 8.87, 0.59),
    "GigaPose": (0.36, 0.89, 0.67, 0.24, 7.43, 0.61),
    "Diorama": (0.41, 0.91, 0.61, 0.28, 6.93, 0.61),
}

GROUPS: Rows = {
    "Household": (5577, 0.46, 0.87, 0.71, 0.32),
    "Furniture": (1137, 0.54, 0.86, 0.71, 0.39),
    "Occluded": (3175, 0.44, 0.84, 0.62, 0.28),
    "Complete": (3539, 0.50, 0.89, 0.78, 0.38),
    "Supported": (5715, 0.48, 0.87, 0.71, 0.34),
    "Supporting": (1634, 0.46, 0.84, 0.69, 0.31),
}
"""Instances, rAcc, tAcc, sAcc, Acc."""

RETRIEVALS: Rows = {
    "1": (0.22, 0.92, 0.52, 0.11, 0.21, 0.88, 0.47, 0.10),
    "4": (0.32, 0.96, 0.68, 0.20, 0.32, 0.93, 0.63, 0.18),
    "8": (0.37, 0.97, 0.72, 0.23, 0.37, 0.94, 0.68, 0.21),
}
"""With true depth, then estimated: rAcc, tAcc, sAcc, Acc."""

ABLATION: Rows = {
    "none": (6.42, 0.19, 0.01, 0.00),
    "O": (5.17, 0.98, 0.01, 0.01),
    "O, P": (8.08, 0.98, 0.93, 0.91),
    "O, P, S": (6.08, 0.98, 0.54, 0.54),
    "O, P, S, R": (3.78, 0.98, 0.95, 0.93),
    "true graph": (3.12, 0.98, 0.94, 0.92),
    "true architecture": (3.88, 0.96, 0.93, 0.90),
}
"""Collision, orientation, placement, overall."""
ALL_IN_ONE: Rows = {"all-in-one": (12.80, 0.19, 0.92, 0.16), "stage-wise": (3.78, 0.98, 0.95, 0.93)}

CATEGORIES: tuple[str, ...] = (
    "bed",
    "bookshelf",
    "cabinet",
    "chair",
    "sofa",
    "table",
    "bin",
    "bathtub",
    "display",
    "others",
)
BY_CATEGORY: Rows = {
    "ROCA": (7.02, 3.62, 7.56, 20.03, 5.26, 9.16, 13.19, 8.11, 13.21, None, 8.72, 12.87),
    "DiffCAD, 5 hypotheses": (12.28, 0.72, 6.72, 14.2, 7.89, 1.58, None, None, None, None, 4.34, 6.84),
    "Diorama": (0.00, 0.74, 4.24, 9.72, 3.95, 4.27, 0.00, 0.00, 10.36, 5.56, 3.33, 6.66),
}
"""ScanNet25k with Scan2CAD: percent aligned per category, class average, instance average."""
