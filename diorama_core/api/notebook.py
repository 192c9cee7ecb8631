"""A scene as a notebook shows it: its picture, and its objects in a table that opens."""

from __future__ import annotations

import base64
import html
import io
from typing import TYPE_CHECKING

from diorama_core.io.text import number_of

if TYPE_CHECKING:
    from diorama_core.api.reconstruction import Reconstruction

SIZE, WITHOUT_PHOTO = (480, 360), "orbit:35"
"""A picture of this size takes a second or two."""
QUALITY = 85


def notebook_html(room: Reconstruction) -> str:
    """The scene as HTML."""
    scene = room.scene
    head = html.escape(f"{number_of(len(scene.objects))}, {len(scene.architecture.planes)} planes")
    if not scene.objects and not scene.architecture.planes:
        return f"<p>{head}</p>"
    rows = "".join(
        f"<tr><td>{html.escape(o.id)}</td><td>{html.escape(o.label)}</td>"
        f"<td>{' × '.join(f'{side:.2f}' for side in o.size_m)}</td></tr>"
        for o in scene.objects
    )
    table = f"<table><tr><th>id</th><th>name</th><th>depth × width × height, m</th></tr>{rows}</table>"
    picture = f'<img alt="{head}" src="data:image/jpeg;base64,{_picture(room)}">'
    return f"<div>{picture}<details><summary>{head}</summary>{table}</details></div>"


def _picture(room: Reconstruction) -> str:
    from PIL import Image

    from diorama_core.api.results import render

    content = io.BytesIO()
    view = "photo" if room.scene.camera is not None else WITHOUT_PHOTO
    Image.fromarray(render(room, view=view, size=SIZE)).save(content, "JPEG", quality=QUALITY)
    return base64.b64encode(content.getvalue()).decode()
