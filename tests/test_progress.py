"""Progress of parts of a job on the whole job's scale."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import Cancelled
from diorama_core.progress import CancelToken, Progress, ProgressEvent


@given(st.lists(st.floats(0.01, 5.0), min_size=1, max_size=12), st.floats(0.0, 0.5), st.floats(0.5, 1.0))
def test_parts_follow_each_other_without_stepping_back(shares: list[float], start: float, end: float) -> None:
    events: list[ProgressEvent] = []
    whole, done = Progress(on_event=events.append).part(start, end), 0.0
    for share in shares:
        part = whole.part(done / sum(shares), (done + share) / sum(shares))
        part.report(0.0, "begun")
        part.report(1.0, "done")
        done += share
    fractions = [event.fraction for event in events]
    assert fractions == sorted(fractions)
    assert fractions[0] == start
    assert fractions[-1] == pytest.approx(end)


@given(st.floats(-2.0, 3.0))
def test_a_part_reports_within_its_bounds(fraction: float) -> None:
    events: list[ProgressEvent] = []
    Progress(on_event=events.append).part(0.2, 0.6).report(fraction, "at work")
    assert 0.2 - 1e-12 <= events[0].fraction <= 0.6 + 1e-12


def test_what_was_found_is_told_at_the_end_and_only_with_words() -> None:
    events: list[ProgressEvent] = []
    part = Progress(on_event=events.append).part(0.0, 0.5)
    part.report_finding("")
    part.report_finding("three chairs")
    assert events == [ProgressEvent(fraction=0.5, message="three chairs", found="three chairs")]


def test_a_cancelled_job_stops_at_its_next_report() -> None:
    token = CancelToken()
    progress = Progress(token=token).part(0.0, 0.5)
    progress.report(0.1, "at work")
    token.cancel()
    with pytest.raises(Cancelled):
        progress.report(0.2, "at work")
