"""An OpenAI-compatible endpoint on loopback that answers as told: well, badly, slowly, or not at all."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

Answer = str | int | Callable[[dict[str, Any]], str]
"""The text of a reply, an HTTP status, or a function of the request."""


@dataclass
class StubLmm:
    """Answers in turn; the last one again and again."""

    answers: list[Answer]
    delay_s: float = 0.0
    refuses_formats: tuple[str, ...] = ()
    """Response formats answered with 400."""
    requests: list[dict[str, Any]] = field(default_factory=list)
    images: list[dict[str, Any]] = field(default_factory=list)
    picture: str = ""
    """Base64 of what images/generations returns."""
    retry_after: str = "0"
    drip_s: float = 0.0
    """Between two bytes of a reply."""
    flood_bytes: int = 0
    """Of spaces before a reply."""
    address: str = ""

    def next_answer(self, request: dict[str, Any]) -> str | int:
        answer = self.answers[0] if len(self.answers) == 1 else self.answers.pop(0)
        return answer(request) if callable(answer) else answer


def completion(text: str | None, refusal: str | None = None) -> dict[str, Any]:
    message = {"role": "assistant", "content": text, "refusal": refusal}
    return {
        "id": "1",
        "object": "chat.completion",
        "created": 0,
        "model": "stub",
        "choices": [{"index": 0, "message": message, "finish_reason": "stop"}],
        "usage": {"prompt_tokens": 1000, "completion_tokens": 50, "total_tokens": 1050},
    }


def _handler(stub: StubLmm) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        def log_message(self, *args: Any) -> None:
            pass

        def do_POST(self) -> None:
            request = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            time.sleep(stub.delay_s)
            if self.path.endswith("/images/generations"):
                stub.images.append(request)
                answer = stub.next_answer(request)
                if isinstance(answer, int):
                    return self._send(answer, {"error": {"message": "no"}})
                return self._send(200, {"created": 0, "data": [{"b64_json": stub.picture}]})
            stub.requests.append(request)
            asked = request.get("response_format", {}).get("type", "text")
            if asked in stub.refuses_formats:
                return self._send(400, {"error": {"message": f"response_format {asked} is not supported"}})
            answer = stub.next_answer(request)
            if isinstance(answer, int):
                return self._send(answer, {"error": {"message": "told to fail"}})
            return self._send(200, completion(answer))

        def _send(self, status: int, body: dict[str, Any]) -> None:
            data = json.dumps(body).encode()
            try:
                self.send_response(status)
                self.send_header("Content-Type", "application/json")
                self.send_header("Content-Length", str(len(data) + stub.flood_bytes))
                self.send_header("Retry-After", stub.retry_after)
                self.end_headers()
                for _ in range(stub.flood_bytes // 1_000_000):
                    self.wfile.write(b" " * 1_000_000)
                if not stub.drip_s:
                    self.wfile.write(data)
                    return
                for byte in data:
                    time.sleep(stub.drip_s)
                    self.wfile.write(bytes([byte]))
                    self.wfile.flush()
            except OSError:
                return  # who asked has gone

    return Handler


@contextmanager
def answering(stub: StubLmm) -> Iterator[StubLmm]:
    """The endpoint, at `stub.address`."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), _handler(stub))
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()
    stub.address = f"http://127.0.0.1:{server.server_address[1]}/v1"
    try:
        yield stub
    finally:
        server.shutdown()
        server.server_close()
