from __future__ import annotations

from diorama_app.panels.layout_report import report_html
from diorama_app.session.layout_run import LayoutRun
from tests.app.panels.test_optimiser import finished


def test_the_result_is_said_in_sentences_and_figures_are_folded(session) -> None:
    run: LayoutRun = finished(session)
    assert run.report is not None
    run.report.before.update(overlapping_pairs=7.0)
    run.report.after.update(overlapping_pairs=0.0, moved_m=0.03, moved_most_m=0.12, structure=1.0)
    words, _, figures = report_html(run).partition("<details>")
    assert "0 pairs of objects overlap; 7 before." in words
    assert "100 % of the objects stand upright and touch their support." in words
    assert "Objects moved 3.0 cm on average, 12.0 cm at most." in words
    assert "Before → after" in figures
