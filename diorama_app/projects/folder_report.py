"""The report of a folder of photos: one HTML file that needs no other, with each photo beside its scene."""

from __future__ import annotations

import html
import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import quote

from PIL import Image

from diorama_app.projects.folder_build import PhotoResult
from diorama_app.projects.pictures import picture_uri
from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_picture
from diorama_core.io.text import clean_text, number_of

WIDTH_PX = 460
_STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #23272e; background: #f3f4f6; margin: 0 auto; max-width: 1080px;
  padding: 24px 16px; }
h1 { font-size: 22px; margin: 0 0 4px; } h2 { font-size: 16px; margin: 0; overflow-wrap: anywhere; }
p { margin: 4px 0; } .dim { color: #5a6370; }
article { background: #fff; border: 1px solid #dde2e8; border-radius: 10px; padding: 14px; margin: 16px 0; }
article.failed { border-color: #d9a1a1; background: #fff7f7; } .failed p.why { color: #a11; }
.pictures { display: grid; grid-template-columns: 1fr 1fr; gap: 10px; margin: 10px 0; }
.pictures img { width: 100%; border-radius: 6px; display: block; } ul { margin: 4px 0; padding-left: 20px; }
a { color: #1d5fc4; }
@media (max-width: 640px) { .pictures { grid-template-columns: 1fr; } }
"""


def write_report(path: Path, results: Sequence[PhotoResult], remarks: Sequence[str]) -> None:
    """Write the report; failures come first.

    Raises:
        ProjectError: the file cannot be written.
    """
    failed = [r for r in results if r.error]
    done = [r for r in results if not r.error]
    kept = sum(r.kept for r in done)
    objects = sum(len((r.report or {})["objects"]) for r in done)
    summary = f"{len(done)} of {number_of(len(results), 'photo')} became scenes with {number_of(objects)}"
    if kept:
        summary += f"; {kept} of them were finished before"
    parts = [
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Diorama: rooms from photos</title>',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<style>{_STYLE}</style></head><body><h1>Rooms from photos</h1><p>{summary}.</p>",
        *(f'<p class="dim">{html.escape(line)}</p>' for line in remarks),
        *(_failure(r) for r in failed),
        *(_scene(r, path.parent) for r in done),
        "</body></html>",
    ]
    write_atomically(path, clean_text("\n".join(parts)).encode(), error=ProjectError)


def _failure(result: PhotoResult) -> str:
    twice = " It was tried twice." if result.tries > 1 else ""
    return (
        f'<article class="failed"><h2>{html.escape(result.photo.name)}</h2>'
        f'<p class="why">{html.escape(result.error)}{twice}</p></article>'
    )


def _scene(result: PhotoResult, folder: Path) -> str:
    report = result.report or {}
    counts = Counter(str(o["category"]) for o in report["objects"])
    contents = ", ".join(name if n == 1 else f"{n} × {name}" for name, n in sorted(counts.items())) or "no objects"
    walls = sum(p["role"] == "wall" for p in report["planes"])
    when = f"{report.get('seconds', result.seconds):.0f} s"
    when += ", in an earlier run" if result.kept else ", second try" * (result.tries > 1)
    where = html.escape(result.project.relative_to(folder).as_posix(), quote=True)
    address = quote(os.fsencode(result.project.relative_to(folder).as_posix()))
    lines = "".join(f"<li>{html.escape(str(note))}</li>" for note in report["notes"])
    notes = f'<details class="dim"><summary>Notes ({len(report["notes"])})</summary><ul>{lines}</ul></details>'
    notes = notes if lines else ""
    return (
        f'<article id="{html.escape(result.project.name, quote=True)}"><h2>{html.escape(result.photo.name)}</h2>'
        f'<p class="dim">{number_of(len(report["objects"]))}, {number_of(walls, "wall")} · {when} · '
        f'<a href="{address}/scene.json">{where}</a></p>'
        f'<div class="pictures">{_picture(result.project / "photo.jpg", "the photo")}'
        f"{_picture(result.picture, 'the scene')}</div>"
        f"<p>{html.escape(contents)}</p>{notes}</article>"
    )


def _picture(path: Path, words: str) -> str:
    try:
        picture = Image.fromarray(read_picture(path, ProjectError))
    except DioramaError:
        return f'<p class="dim">{words} cannot be shown</p>'  # somebody removed it; the rest of the report stands
    picture.thumbnail((WIDTH_PX, 2 * WIDTH_PX))
    return f'<img alt="{words}" src="{picture_uri(picture, "JPEG", quality=82)}">'
