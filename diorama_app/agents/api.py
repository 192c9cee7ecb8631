"""A client of the HTTP interface of this machine's editor; `docs/api.md` describes the addresses."""

from __future__ import annotations

import json
import secrets
import urllib.error
import urllib.request
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote, urlencode

from diorama_core.errors import DioramaError, InputError

REQUEST_S = 300.0
"""The longest single request: a described room, or a picture on a busy machine."""


class RefusedRequestError(DioramaError):
    """What the server answered instead, in its own line."""


@dataclass(frozen=True)
class Api:
    """A server and its token."""

    address: str
    token: str | None = None

    def get(self, path: str, **query: Any) -> Any:
        """The JSON at a path."""
        return json.loads(self.content(path, **query))

    def content(self, path: str, **query: Any) -> bytes:
        """The bytes at a path."""
        known = {k: str(v).lower() if isinstance(v, bool) else v for k, v in query.items() if v is not None}
        return self._send("GET", f"{path}?{urlencode(known)}" if known else path)

    def post(self, path: str, body: Mapping[str, Any] | None = None) -> Any:
        """What a path answers to JSON."""
        content = json.dumps(body or {}).encode()
        return json.loads(self._send("POST", path, content, "application/json"))

    def send_photo(self, path: str, photo: Path, fields: Mapping[str, str], files: Mapping[str, Path]) -> Any:
        """What a path answers to a photo.

        Args:
            path: of the server.
            photo: the file.
            fields: of the form.
            files: further ones, by their field.
        """
        boundary = secrets.token_hex(16)
        parts = [_field(boundary, name, value.encode()) for name, value in fields.items()]
        for name, file in {"photo": photo, **files}.items():
            try:
                parts.append(_field(boundary, name, file.read_bytes(), file.name))
            except OSError as error:
                raise InputError(f"{file} cannot be read ({error.strerror}); give the path of a file here") from error
        body = b"".join(parts) + f"--{boundary}--\r\n".encode()
        return json.loads(self._send("POST", path, body, f"multipart/form-data; boundary={boundary}"))

    def _send(self, method: str, path: str, body: bytes | None = None, kind: str | None = None) -> bytes:
        headers = {} if self.token is None else {"Authorization": f"Bearer {self.token}"}
        if kind is not None:
            headers["Content-Type"] = kind
        request = urllib.request.Request(f"{self.address}{quote(path, safe='/?&=%:,')}", body, headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=REQUEST_S) as reply:
                content: bytes = reply.read()
                return content
        except urllib.error.HTTPError as error:
            with error:
                raise RefusedRequestError(_line_of(error.read(), error.reason)) from error
        except (TimeoutError, urllib.error.URLError, OSError) as error:
            raise RefusedRequestError(f"the editor does not answer ({error}); start 'diorama mcp' again") from error


def _line_of(body: bytes, otherwise: str) -> str:
    try:
        return str(json.loads(body)["error"])
    except (ValueError, LookupError, TypeError):
        return str(otherwise)


def _field(boundary: str, name: str, content: bytes, file_name: str | None = None) -> bytes:
    head = f'--{boundary}\r\nContent-Disposition: form-data; name="{name}"'
    if file_name is not None:
        plain = file_name.replace('"', "_").replace("\r", "_").replace("\n", "_")
        head += f'; filename="{plain}"\r\nContent-Type: application/octet-stream'
    return f"{head}\r\n\r\n".encode() + content + b"\r\n"
