"""A page read and used without a browser: what the panels put on it, and what a person can press and write there."""

from __future__ import annotations

import asyncio
import html
import json
from typing import Any, TypeVar

import viser

from diorama_app.session.client import Client
from diorama_app.session.connected_client import Panel

P = TypeVar("P", bound=Panel)


class Page(viser.GuiApi):
    """Stands before a server's panel API, makes everything for real, and remembers it by label."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self.gui = gui
        self.client = client
        self.made: list[tuple[str, str, Any]] = []
        """Kind, label and handle, in the order they were made."""
        self.sent = 0
        """How many actions were sent."""

    def __getattribute__(self, name: str) -> Any:
        if name in vars(Page) or name in object.__getattribute__(self, "__dict__") or name == "__dict__":
            return object.__getattribute__(self, name)
        real = getattr(self.gui, name)
        if not name.startswith("add_"):
            return real

        def add(*given: Any, **more: Any) -> Any:
            handle = real(*given, **more)
            label = str(given[0]) if given else str(more.get("label", ""))
            self.made.append((name.removeprefix("add_"), label, handle))
            return handle

        return add

    def put(self, kind: type[P], *more: Any) -> P:
        """Make a panel on the page, the only one that follows what is done."""
        made = kind(self, self.client, *more)
        self.client.panels = [made]
        made.refresh()
        return made

    # -- reading ----------------------------------------------------------------------------------------------

    @property
    def html(self) -> str:
        """All HTML that is shown."""
        return "\n".join(h.content for kind, _, h in self.made if kind == "html" and h.visible)

    def field(self, label: str) -> Any:
        """The newest field or button that was made with this label, or has it now."""
        found = [h for kind, name, h in self.made if kind != "html" and label in (name, getattr(h, "label", None))]
        assert found, f"there is no '{label}' on the page: {[n for k, n, _ in self.made if k != 'html']}"
        return found[-1]

    def shows(self, do: str, arg: object | None = None, kind: str = "do") -> bool:
        """Whether something with this action is drawn and can be pressed."""
        return any(self._offers(content, do, arg, kind) for _, content in self._pieces())

    # -- using ------------------------------------------------------------------------------------------------

    def press(self, label: str) -> None:
        """Press a button that is shown and enabled."""
        handle = self.field(label)
        assert handle.visible, f"'{label}' is hidden"
        assert not handle.disabled, f"'{label}' is greyed out"
        self._told(handle)

    def write(self, label: str, value: Any) -> None:
        """Change a field that is shown."""
        handle = self.field(label)
        assert handle.visible, f"'{label}' is hidden"
        handle.value = value
        self._told(handle)

    def upload(self, label: str, name: str, content: bytes) -> None:
        """Choose a file for an upload button."""
        handle = self.field(label)
        handle._impl.value = viser.UploadedFile(name, content)
        self._told(handle)

    def act(self, do: str, arg: object = "", *, kind: str = "do") -> None:
        """Click something drawn in HTML (`do`), change an input (`change`), or point at something (`peek`)."""
        fields = [f for f, content in self._pieces() if self._offers(content, do, None if kind != "do" else arg, kind)]
        assert fields, f"nothing on the page does '{do}' with '{arg}':\n{self.html[-3000:]}"
        self.send(fields[0], do, arg)

    def change(self, do: str, value: str, arg: str = "") -> None:
        """Write into an input drawn in HTML."""
        self.act(do, json.dumps([arg, value]), kind="change")

    def send(self, hidden: Any, do: str, arg: object, *, add: bool = False) -> None:
        """Write a message into the hidden field of a piece of HTML, as its handler does."""
        self.sent += 1
        hidden.value = json.dumps([{"do": do, "arg": str(arg), "add": add, "number": self.sent}])
        self._told(hidden)

    def settle(self) -> None:
        """Wait until everything asked for is done; what was uploaded is read in a process of its own."""
        assert self.client.session.ui_thread.wait(60.0)
        assert self.client.session.reader.wait()
        assert self.client.session.ui_thread.wait(60.0)

    def _told(self, handle: Any) -> None:
        event = viser.GuiEvent(self.client.viser_client, self.client.id, handle)
        for callback in list(handle._impl.update_cb):
            asyncio.run(callback(event))
        self.settle()

    def _pieces(self) -> list[tuple[Any, str]]:
        """Every hidden field with the HTML that it serves."""
        found = []
        for k, (kind, label, handle) in enumerate(self.made):
            if kind == "text" and label == "·":
                shown = self.made[k + 1][2]
                found.append((handle, shown.content if shown.visible else ""))
        return found

    @staticmethod
    def _offers(content: str, do: str, arg: object | None, kind: str) -> bool:
        if kind == "peek":
            return f'data-peek="{html.escape(do)}"' in content or "data-peek" in content
        wanted = f'data-{kind}="{html.escape(do)}"'
        if arg is not None and str(arg):
            wanted += f' data-arg="{html.escape(str(arg))}"'
        at = content.find(wanted)
        return at >= 0 and " disabled>" not in content[at : content.find(">", at) + 1]
