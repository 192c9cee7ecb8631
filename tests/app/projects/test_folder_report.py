from __future__ import annotations

import os
import re
from pathlib import Path

from PIL import Image

from diorama_app.projects.folder_build import PhotoResult
from diorama_app.projects.folder_report import write_report


def test_failures_come_first_and_every_picture_is_inside(tmp_path: Path) -> None:
    project = tmp_path / "living"
    (project / "exports").mkdir(parents=True)
    for name in ("photo.jpg", "exports/scene.jpg"):
        Image.new("RGB", (900, 600), (90, 120, 150)).save(project / name)
    report = {
        "objects": [{"category": "chair"}, {"category": "chair"}, {"category": "sofa"}],
        "planes": [{"role": "wall"}, {"role": "floor"}],
        "notes": ["a <note>"],
    }
    done = PhotoResult(tmp_path / "living.jpg", project, report, seconds=12.3, tries=2)
    kept = PhotoResult(tmp_path / "gone.jpg", tmp_path / "gone", {**report, "seconds": 44.4}, kept=True)
    failed = PhotoResult(tmp_path / "<b>.jpg", tmp_path / "b", error="it is <broken>", tries=2)
    write_report(tmp_path / "report.html", (done, kept, failed), ("a remark",))
    page = (tmp_path / "report.html").read_text()
    assert page.index("&lt;b&gt;.jpg") < page.index("living.jpg")
    assert "it is &lt;broken&gt; It was tried twice." in page
    assert "2 of 3 photos became scenes with 6 objects; 1 of them were finished before" in page
    assert "2 × chair, sofa" in page
    assert "12 s, second try" in page
    assert "44 s, in an earlier run" in page
    assert len(re.findall(r'src="data:image/jpeg;base64,[A-Za-z0-9+/=]{200,}"', page)) == 2
    assert page.count("cannot be shown") == 2, "pictures of the other are gone"
    assert not re.search(r'src="(?!data:)|<script|<link', page)


def test_names_of_any_bytes_are_in_the_report(tmp_path: Path) -> None:
    """One photo with a name that is no UTF-8 ended the build of a folder before its report."""
    folder = tmp_path / os.fsdecode(b"caf\xe9 #1")
    report = {"objects": [], "planes": [], "notes": [os.fsdecode(b"a note on caf\xe9")]}
    results = (
        PhotoResult(folder.with_suffix(".jpg"), folder, report),
        PhotoResult(folder.with_suffix(".png"), folder, error=os.fsdecode(b"no caf\xe9")),
    )
    write_report(tmp_path / "report.html", results, (os.fsdecode(b"\xe9"),))
    page = (tmp_path / "report.html").read_text()
    assert 'href="caf%E9%20%231/scene.json"' in page
    assert page.count("caf\ufffd") >= 4
