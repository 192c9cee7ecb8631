from __future__ import annotations

from pathlib import Path

from tests.app.soaking import Soak


def test_hundreds_of_random_edits_leave_the_document_valid_and_saved(tmp_path: Path) -> None:
    soak = Soak(tmp_path, seed=1)
    try:
        soak.run(150)
        retained = soak.retained_messages()
        soak.run(150)
        soak.check()
        assert soak.saved()
        assert soak.refused < 0.5 * soak.done
        objects = len(soak.session.scene.objects)
        assert soak.retained_messages() < retained + 60 * objects, "messages kept for late joiners do not pile up"
    finally:
        soak.close()
