"""Tables of annotated photos."""

from __future__ import annotations

from diorama_core.evaluation.benchmarks.photo_build import PhotoScores
from diorama_core.evaluation.benchmarks.photo_tables import folds_table, fronts_table, overall_table
from diorama_core.evaluation.metrics.annotated import ObjectResult


def _photo(name: str, *errors_deg: float) -> PhotoScores:
    chairs = [ObjectResult(name, i, "chair", "chair", False, front_error_deg=e) for i, e in enumerate(errors_deg)]
    return PhotoScores(name, tuple(chairs))


def test_fronts_within_45_degrees_are_right() -> None:
    results = [_photo("a", 10.0, 100.0), _photo("b", 44.0, 46.0)]
    (row,) = fronts_table(results).rows
    assert (row.name, *row.values) == ("chair", 4, 0.5)
    front = [c.name for c in overall_table(results, named=True).columns].index("front")
    assert overall_table(results, named=True).rows[0].values[front] == 0.5


def test_folds_have_a_row_each_their_mean_and_their_spread() -> None:
    names = [row.name for row in folds_table([[_photo("a", 0.0)], [_photo("b", 90.0)]], fitted=False).rows]
    assert names == ["fold 1", "fold 2", "mean", "spread"]
