from __future__ import annotations

import io

import pytest

pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[api]')")

from fastapi import UploadFile  # after the check for its library

from diorama_app.http_api.forms import read_upload
from diorama_core.errors import InputError


def test_the_form_is_read_as_an_upload_of_a_page() -> None:
    photo = UploadFile(io.BytesIO(b"photo"), filename="a/b/room.jpg")
    upload = read_upload(photo, boxes="[]", intrinsics="500, 500, 320, 240", depth=UploadFile(io.BytesIO(b"d")))
    assert (upload.photo, upload.name, upload.boxes, upload.depth) == (b"photo", "room.jpg", b"[]", b"d")
    assert upload.intrinsics == (500.0, 500.0, 320.0, 240.0)
    with pytest.raises(InputError, match="four numbers"):
        read_upload(photo, intrinsics="1,2")
