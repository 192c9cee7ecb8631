"""A short round of damaged inputs for every reader, and every input that once broke one."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.fuzzing.parsers import CORPUS, PARSERS
from tests.fuzzing.rounds import Round

CASES = sorted(CORPUS.glob("*-*"))


@pytest.mark.parametrize("name", PARSERS)
def test_damaged_inputs_end_in_a_value_or_one_line(name: str) -> None:
    count = PARSERS[name].round
    done = Round(PARSERS[name], seed=21).run(count=count)
    assert done.read + done.refused == count, list(done.kinds)


@pytest.mark.parametrize("name", PARSERS)
def test_the_samples_themselves_are_read(name: str) -> None:
    parser = PARSERS[name]
    read = 0
    for sample in parser.samples():
        done = Round(parser, seed=0)
        done.one(sample)
        assert not done.findings, list(done.kinds)
        read += done.read
    assert read, "a parser that refuses everything shows nothing"


@pytest.mark.parametrize("case", CASES, ids=[c.name for c in CASES])
def test_what_once_broke_a_reader_no_longer_does(case: Path) -> None:
    done = Round(PARSERS[case.name.partition("-")[0]], seed=0)
    done.one(case.read_bytes())
    assert not done.findings, list(done.kinds)
