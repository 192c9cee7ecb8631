from __future__ import annotations

from pathlib import Path

from tests.app.soaking import Soak


def test_hundreds_of_random_edits_leave_the_document_valid_and_saved(tmp_path: Path) -> None:
    soak = Soak(tmp_path, seed=1)
    try:
        soak.run(150)
        kept = soak.kept_messages()
        soak.run(150)
        soak.check()
        assert soak.saved()
        assert soak.refused < 0.5 * soak.done
        objects = len(soak.room.scene.objects)
        assert soak.kept_messages() < kept + 60 * objects, "messages kept for late joiners do not pile up"
    finally:
        soak.close()
