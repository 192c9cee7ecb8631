"""Every source is stored and read back as the enums and counts that it is."""

from __future__ import annotations

from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.io.bounded import field_types
from diorama_core.pipeline import codec
from diorama_core.provenance import (
    AttitudeSource,
    CameraSource,
    FocalSource,
    GraphSource,
    HeadingSource,
    LanguageModelUse,
    RoomSource,
)
from tests.scene.strategies import texts

METRES = st.floats(0, 1e3)
USES = st.builds(LanguageModelUse, model=texts, trouble=texts, cost=st.none() | METRES)
SOURCES = st.one_of(
    st.builds(CameraSource),
    st.builds(RoomSource, wall_height_m=st.none() | METRES, ceilings_m=st.lists(METRES).map(tuple)),
    st.builds(GraphSource, asked=st.none() | USES),
)


@given(SOURCES)
def test_sources_survive_a_project_file(source: object) -> None:
    again = codec.load(codec.dump(source), type(source))
    assert again == source
    hints = field_types(type(source))
    for field in fields(source):
        if isinstance(hints[field.name], type):
            assert isinstance(getattr(again, field.name), hints[field.name])


def test_a_known_camera_is_given_in_every_respect() -> None:
    source = CameraSource.exact()
    assert source == CameraSource(FocalSource.GIVEN, AttitudeSource.GIVEN, HeadingSource.GIVEN)
    assert not source.attitude_corrected


def test_a_source_cannot_be_changed() -> None:
    with pytest.raises(AttributeError):
        CameraSource.exact().few_lines = True
