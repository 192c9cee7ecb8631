"""A client made of nothing but a server's OpenAPI document: one method an operation, answers checked by schema."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from dataclasses import dataclass
from functools import partial
from typing import Any
from urllib.parse import quote, urlencode

import pytest

BOUNDARY = "a5d1c0e2f7"


@dataclass(frozen=True)
class Answer:
    """What came back."""

    status: int
    kind: str
    body: Any
    """JSON as values, otherwise bytes."""


def send(method: str, url: str, body: bytes | None = None, headers: dict[str, str] | None = None) -> Answer:
    request = urllib.request.Request(url, data=body, method=method, headers=headers or {})
    try:
        with urllib.request.urlopen(request, timeout=120) as reply:
            status, kind, content = reply.status, reply.headers.get("Content-Type", ""), reply.read()
    except urllib.error.HTTPError as error:
        with error:
            status, kind, content = error.code, error.headers.get("Content-Type", ""), error.read()
    return Answer(status, kind, json.loads(content) if kind == "application/json" else content)


class Client:
    """Calls operations by their ids: `client.create_job(photo=b"...", boxes="[]")`."""

    def __init__(self, url: str, token: str | None = None) -> None:
        self.url = url.rstrip("/")
        self.headers = {} if token is None else {"Authorization": f"Bearer {token}"}
        reply = send("GET", f"{self.url}/openapi.json", headers=self.headers)
        assert reply.status == 200, reply
        self.document = reply.body
        self.operations = {
            about["operationId"]: (method.upper(), path, about)
            for path, methods in self.document["paths"].items()
            for method, about in methods.items()
        }

    def __getattr__(self, name: str) -> Any:
        if name not in self.operations:
            raise AttributeError(name)
        return partial(self._call, name)

    def _call(self, name: str, /, **given: Any) -> Answer:
        method, path, about = self.operations[name]
        query = {}
        for parameter in about.get("parameters", ()):
            if parameter["name"] not in given:
                assert not parameter.get("required"), parameter
                continue
            value = given.pop(parameter["name"])
            if parameter["in"] == "path":
                path = path.replace("{" + parameter["name"] + "}", quote(str(value), safe=""))
            else:
                query[parameter["name"]] = value
        headers, body = dict(self.headers), None
        if given:
            (kind,) = about["requestBody"]["content"]
            known = self._schema(about["requestBody"]["content"][kind]["schema"])["properties"]
            assert set(given) <= set(known), f"{set(given) - set(known)} are not in the document"
            if kind == "application/json":
                body, headers["Content-Type"] = json.dumps(given).encode(), kind
            else:
                assert kind == "multipart/form-data"
                body = b"".join(_part(key, value) for key, value in given.items()) + f"--{BOUNDARY}--\r\n".encode()
                headers["Content-Type"] = f"{kind}; boundary={BOUNDARY}"
        url = f"{self.url}{path}" + (f"?{urlencode(query)}" if query else "")
        reply = send(method, url, body, headers)
        self._check(about, reply)
        return reply

    def _check(self, about: dict, reply: Answer) -> None:
        """The answer is one that the document names."""
        jsonschema = pytest.importorskip("jsonschema")
        assert str(reply.status) in about["responses"], f"{reply} is not in the document"
        content = about["responses"][str(reply.status)].get("content", {})
        assert reply.kind in content or (not content and not reply.body), f"{reply.kind}: {list(content)}"
        if reply.kind == "application/json":
            schema = {**content[reply.kind]["schema"], "components": self.document["components"]}
            jsonschema.validate(reply.body, schema)

    def _schema(self, schema: dict) -> dict:
        if "$ref" not in schema:
            return schema
        return self.document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]


def _part(name: str, value: Any) -> bytes:
    head = f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="{name}"'
    if isinstance(value, tuple):
        file_name, content = value
        head += f'; filename="{file_name}"\r\nContent-Type: application/octet-stream'
    else:
        content = str(value).encode()
    return f"{head}\r\n\r\n".encode() + content + b"\r\n"
