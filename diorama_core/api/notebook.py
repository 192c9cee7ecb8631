"""A scene as a notebook shows it: its picture, and its objects in a table that opens."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Mapping
from typing import TYPE_CHECKING

from diorama_core.io.text import number_of

if TYPE_CHECKING:
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.perception.inputs.arrays import Picture
    from diorama_core.scene.types import Scene

SIZE, WITHOUT_PHOTO = (480, 360), "orbit:35"
"""A picture of this size takes a second or two."""
QUALITY = 85


def notebook_html(scene: Scene, library: ShapeLibrary, textures: Mapping[str, Picture]) -> str:
    """The scene as HTML.

    Args:
        scene: what is shown.
        library: where its shapes are.
        textures: pictures of its planes.
    """
    head = html.escape(f"{number_of(len(scene.objects))}, {number_of(len(scene.architecture.planes), 'plane')}")
    if not scene.objects and not scene.architecture.planes:
        return f"<p>{head}</p>"
    rows = "".join(
        f"<tr><td>{html.escape(o.id)}</td><td>{html.escape(o.label)}</td>"
        f"<td>{' × '.join(f'{side:.2f}' for side in o.size_m)}</td></tr>"
        for o in scene.objects
    )
    table = f"<table><tr><th>id</th><th>name</th><th>depth × width × height, m</th></tr>{rows}</table>"
    picture = f'<img alt="{head}" src="data:image/jpeg;base64,{_picture(scene, library, textures)}">'
    return f"<div>{picture}<details><summary>{head}</summary>{table}</details></div>"


def _picture(scene: Scene, library: ShapeLibrary, textures: Mapping[str, Picture]) -> str:
    from PIL import Image

    from diorama_core.render.picture import picture

    content = io.BytesIO()
    view = "photo" if scene.camera is not None else WITHOUT_PHOTO
    Image.fromarray(picture(scene, library, view=view, size=SIZE, textures=textures)).save(
        content, "JPEG", quality=QUALITY
    )
    return base64.b64encode(content.getvalue()).decode()
