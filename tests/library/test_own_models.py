from __future__ import annotations

from pathlib import Path

import pytest

from diorama_core.errors import LibraryError
from diorama_core.library.own_models import OwnModels, read_own_models, write_own_models


def test_names_folders_and_deletions_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "own.json"
    assert read_own_models(path) == OwnModels()
    models = OwnModels().named("lamp", "  Grandma's\nlamp ").filed("lamp", "Heirlooms").without("vase").without("lamp")
    write_own_models(path, models)
    assert read_own_models(path) == models
    assert models.names == {"lamp": "Grandma's lamp"}
    assert models.restored("lamp").deleted == ("vase",)
    assert models.named("lamp", " ").names == {}


def test_a_corrected_model_takes_name_and_folder_of_the_one_before() -> None:
    models = OwnModels().named("lamp", "Lamp").filed("lamp", "Old").superseded("lamp", "lamp~2")
    assert models.names["lamp~2"] == "Lamp"
    assert models.folders["lamp~2"] == "Old"
    assert models.deleted == ("lamp",)


def test_a_damaged_document_says_which_file(tmp_path: Path) -> None:
    path = tmp_path / "own.json"
    path.write_text('{"names": 3}')
    with pytest.raises(LibraryError, match=r"own\.json cannot be read .*delete it"):
        read_own_models(path)
